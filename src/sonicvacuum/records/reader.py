"""Reading a record: closed schema, physical ranges, traces; the first fault ends it with one message."""

import hashlib
import os
from contextlib import suppress
from pathlib import Path

from sonicvacuum.files import InputError, check_values, convert, in_one_line, read_yaml
from sonicvacuum.laboratory.checks import TIME
from sonicvacuum.laboratory.ranges import FORCE, LONGEST_INTERVAL, READING, SHORTEST_RECORD, LaboratoryError
from sonicvacuum.outputs import cut_off
from sonicvacuum.physics.scales import impact_scales
from sonicvacuum.records import signals
from sonicvacuum.records.assemble import assemble
from sonicvacuum.records.blocks import AMPLITUDES, OBSERVABLES, UNITS, RecordBlock
from sonicvacuum.records.missing import missing
from sonicvacuum.records.record import Record
from sonicvacuum.records.validate import validate
from sonicvacuum.schema_errors import likely

FILE = "record.yaml"
# A trace that reaches so many stated standard deviations shows more than noise.
CLEAR = 10.0
_TOO_SMALL = ("smaller", " only", ", or write 0 where nothing was read")
_NAME = "use letters, digits and _ . + - only (a to z, A to Z, 0 to 9), a letter or digit first"
_CURES = {
    "format": "this program reads format: 1",
    "id": _NAME,
    "shared[]": _NAME,
    "from": "name a sensor's id",
    "to": "name a sensor's id",
    "sensor": "name a sensor's id",
    "signals": "name a CSV file that lies beside record.yaml",
}


def read(path) -> Record:
    """The record in a folder.

    Args:
        path: the folder, or its `record.yaml`.

    Raises:
        InputError: naming the file, the key or line, the value and the cure.
    """
    folder = _folder(path)
    file = folder / FILE
    states = {file: _state(file)}
    block = parse(read_yaml(file), file)
    _check_beside(block, folder)
    ids, traces = [s.id for s in block.sensors], {}
    for run in block.runs:
        if run.signals:
            states.setdefault(folder / run.signals, _state(folder / run.signals))
            traces[run.id] = signals.read(folder / run.signals, ids)
    record = Record(block, traces, folder.resolve().name, _digest(states))
    for run in block.runs:
        if run.signals:
            check_scales(record, run.id, folder / run.signals)
    _check_readings(record, folder)
    return record


def _folder(path):
    """The folder of a record; InputError where there is none, or none that could be told in one line."""
    if not os.fspath(path):  # of a shell's unset variable; to Python it is the folder at work
        raise InputError(f"the path of a record is empty; give the folder that holds {FILE}")
    folder = Path(path)
    if folder.name == FILE and folder.is_file():
        folder = folder.parent
    if not folder.is_dir():
        raise InputError(f"{path}: no such folder; give the folder that holds {FILE}")
    if in_one_line(name := folder.resolve().name) != name:
        raise InputError(f"{path}: the folder's name holds control characters; rename it")
    if not (folder / FILE).is_file():
        cure = cut_off(folder) or f"sonicvacuum record new {folder} writes one to fill in"
        raise InputError(f"{folder}: has no {FILE}; {cure}")
    return folder


def _check_beside(block, folder):
    """InputError for a file of traces that is not there, with the key that names it."""
    named = [run.signals for run in block.runs]
    for k, name in enumerate(named):
        if name and not os.path.exists(folder / name):
            spare = {f.name.lower(): f.name for f in folder.glob("*.[cC][sS][vV]") if f.name not in named}
            near = spare.get(name.lower())
            meant = f"did you mean {near}?" if near else likely(name, list(spare.values()))
            raise InputError(
                f"{folder / FILE}: runs[{k}].signals: is {name!r}, and there is no such file in the record's "
                f"folder; {meant}{' Otherwise put' if meant else 'put'} it there, or correct the name"
            )


def _state(file):
    """What changes where a file is written; None where there is none, which its reader tells."""
    with suppress(OSError, ValueError):
        s = os.stat(file)
        return s.st_ino, s.st_size, s.st_mtime_ns
    return None


def _digest(states):
    """SHA-256 of some files one after the other, as `cat … | sha256sum` gives it.

    InputError for one that is not in the state any more in which it was before it was read: the digest would
    be of other numbers than those read.
    """
    found = hashlib.sha256()
    for file in states:
        found.update(file.read_bytes())
    for file, state in states.items():
        if _state(file) != state:
            raise InputError(f"{file}: was changed while it was read; try again once nobody writes it")
    return found.hexdigest()


def parse(content: dict, path=FILE) -> RecordBlock:
    """The checked block of a YAML mapping; InputError as in `read`."""
    check_values(content, path)
    _check_observables(content, path)
    lacking = missing(content, RecordBlock)
    if len(lacking) > 1:
        raise InputError(f"{path}: {', '.join(lacking)}: missing; these keys are required")
    block = convert(content, RecordBlock, path, cures=_CURES)
    try:
        validate(block)
    except LaboratoryError as error:
        raise InputError(f"{path}: {error}") from None
    return block


def _check_observables(content, path):
    """Unknown quantities and units, with the list of known ones."""
    for place, entry in _observables(content):
        if "quantity" not in entry:
            continue
        quantity, unit = entry["quantity"], entry.get("unit")
        if not isinstance(quantity, str) or quantity not in OBSERVABLES:
            raise InputError(f"{path}: {place}.quantity: is {quantity!r}; known: {', '.join(OBSERVABLES)}")
        allowed = AMPLITUDES if quantity == "amplitude" else (UNITS[quantity],)
        if unit is not None and str(unit) not in allowed:
            raise InputError(
                f"{path}: {place}.unit: is {unit!r}; {quantity} is given in {' or '.join(allowed)}: "
                "convert value and sigma"
            )


def _observables(content):
    runs = content.get("runs")
    for k, run in enumerate(runs if isinstance(runs, list) else []):
        entries = run.get("observables") if isinstance(run, dict) else None
        for j, entry in enumerate(entries if isinstance(entries, list) else []):
            if isinstance(entry, dict):
                yield f"runs[{k}].observables[{j}]", entry


def check_scales(record: Record, run: str, path) -> None:
    """Times and forces of a run's traces against the scales of its impact.

    Raises:
        InputError: where time or force is so far off that its unit must be another.
    """
    place = next(k for k, r in enumerate(record.runs) if r.id == run)
    batch = next(b for b in assemble(record) if place in b.runs)
    force, contact = impact_scales(batch.chain.take([batch.runs.index(place)]))
    traces = record.signals[run]
    _check_times(traces, contact, path)
    stated = [traces.readings[g.id] for g in record.gauges if g.unit == "N" and g.id in traces.readings]
    if not stated or not all(g.calibrated for g in record.gauges if g.unit == "N"):
        return
    peak = max(float(abs(r).max()) for r in stated)
    expected = f"the impact makes about {force:.2g} N"
    if peak > FORCE[1] * force:
        unit = "mN" if peak / 1e3 <= FORCE[1] * force else "another unit"
        raise InputError(
            f"{path}: forces reach {peak:.3g} N, while {expected}: they look like {unit}; convert them to N, "
            "or correct the striker in record.yaml"
        )
    if 0.0 < peak < FORCE[0] * force and peak > CLEAR * _noise(record):
        raise InputError(
            f"{path}: forces reach {peak:.3g} N only, while {expected}: they look like kN or volts; convert "
            "them to N, or correct the striker in record.yaml"
        )


def _check_readings(record, folder):
    """InputError for a gauge whose peaks are so large or small that squares, or noise, are no numbers."""
    files = {run.id: folder / run.signals for run in record.block.runs if run.signals}
    low, high = READING
    for gauge in record.gauges:
        recorded = {run: s.readings[gauge.id] for run, s in record.signals.items() if gauge.id in s.readings}
        peak, run = max(((float(abs(r).max()), run) for run, r in recorded.items()), default=(0.0, ""))
        # A channel that shows nothing but its stated noise may show as little as it likes.
        if low <= peak <= high or peak <= CLEAR * gauge.sigma:
            continue
        way, only, dead = ("larger", "", "") if peak > high else _TOO_SMALL
        unit = gauge.unit if gauge.calibrated else f"a {way} unit"
        raise InputError(
            f"{files[run]}, column {gauge.id}: readings reach {peak:.3g}{only}; their peak must lie between "
            f"{low:g} and {high:g}: convert them to {unit}{dead}"
        )


def _noise(record):
    return max((g.sigma for g in record.gauges if g.unit == "N"), default=0.0)


def _check_times(traces, contact, path):
    span, interval = traces.interval_s * (traces.samples - 1), traces.interval_s
    shown = f"a contact of this impact lasts about {contact * 1e6:.2g} us"
    if span < SHORTEST_RECORD * contact:
        units = [
            u for u, f in (("ms", 1e3), ("s", 1e6)) if SHORTEST_RECORD * contact <= span * f < 1e4 * contact
        ]
        look = f"times look like {' or '.join(units)}" if units else "the record is too short"
        raise InputError(
            f"{path}, column {TIME}: the record lasts {span * 1e6:.3g} us, while {shown}: {look}; "
            "convert times to microseconds"
        )
    if interval > LONGEST_INTERVAL * contact:
        raise InputError(
            f"{path}, column {TIME}: samples are {interval * 1e6:.3g} us apart, while {shown}: times "
            "look like ns, or the sampling is too coarse; convert times to microseconds"
        )
    if traces.start_s > span or traces.start_s < -0.9 * span:
        raise InputError(
            f"{path}, column {TIME}: the record starts at {traces.start_s * 1e6:g} us; count time "
            "from about the moment of impact"
        )
