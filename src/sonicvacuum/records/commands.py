"""What the command line does with records: start one from a template, say what is in one."""

import json
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from sonicvacuum.files import InputError, replacing, writing
from sonicvacuum.records.blocks import RunBlock, schema
from sonicvacuum.records.described import chain_of
from sonicvacuum.records.reader import FILE
from sonicvacuum.records.record import Record, Run

if TYPE_CHECKING:
    from sonicvacuum.records.review import Review


def template() -> str:
    """A commented `record.yaml`, valid as it is."""
    return files("sonicvacuum.records").joinpath("template.yaml").read_text(encoding="utf-8")


def schema_text() -> str:
    """JSON schema of `record.yaml` as a file: what an editor needs to complete and check keys."""
    return json.dumps(schema(), indent=1, sort_keys=True) + "\n"


def new(folder) -> Path:
    """Write the template into a folder, made if need be, and return its path.

    Raises:
        InputError: when the folder has a record already, or cannot be written.
    """
    file = Path(folder) / FILE
    if file.exists():
        raise InputError(f"{file}: exists already; choose another folder or remove it")
    with writing(folder), replacing(file) as stream:
        stream.write(template())
    return file


def summary(record: Record, seen: "Review") -> str:
    """What is in a record, and what its review says of it."""
    from sonicvacuum.records.review import lines  # which brings the engine; a new record needs none

    gauges = ", ".join(f"{g.id} ({'wall' if g.bead is None else f'bead {g.bead}'})" for g in record.gauges)
    said = [
        f"{record.name}: {' '.join(record.title.split())}",
        f"  {chain_of(record)}; gauges: {gauges or 'none'}",
        *(
            line
            for run, block in zip(record.runs, record.block.runs, strict=True)
            for line in _run(record, run, block)
        ),
    ]
    return "\n".join([*said, *lines(seen)])


def _run(record: Record, run: Run, block: RunBlock):
    s, count = run.striker, len(run.observables)
    yield (
        f"  run {run.id}: striker {s.surface.name}, {s.mass_kg * 1e3:g} g, {s.speed_m_s:g} m/s; "
        f"{count} scalar{'' if count == 1 else 's'}" + (", traces:" if run.signals else ", no traces")
    )
    if run.signals:
        yield (
            f"    {run.signals.samples} samples, {run.signals.interval_s * 1e6:g} us apart, from "
            f"{round(run.signals.start_s * 1e6, 3) + 0.0:g} us"
        )
        for g in record.gauges:
            if g.id not in run.signals.readings:
                yield f"    {g.id}: not recorded in this run"
                continue
            peak = float(run.signals.readings[g.id].max())
            noise = f"{peak / g.sigma:.3g} times the noise" if g.sigma else "noise not stated"
            yield f"    {g.id}: peak {peak:.4g}{f' {g.unit}' if g.calibrated else ', uncalibrated'}, {noise}"
    for o, given in zip(run.observables, block.observables, strict=True):
        unit = "" if str(given.unit) == "1" else f" {given.unit}"
        sign = {None: "=", "at_most": "≤", "at_least": "≥"}[given.bound]
        common = "".join(f", and {100.0 * size:g} % shared: {name}" for name, size in given.shared.items())
        yield f"    {o.label} {sign} {given.value:g} ± {given.sigma:g}{unit}{common}"
