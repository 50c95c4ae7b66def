"""From a record to the experiment that is inferred from: chains to simulate, readings that count, and how
loud their noise is (`colour`).
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from sonicvacuum.discover.model.beginnings import begun
from sonicvacuum.discover.model.colour import colours
from sonicvacuum.discover.model.experiment import Batch, Experiment, RunData, Scalar
from sonicvacuum.discover.model.masks import repeated
from sonicvacuum.discover.model.noise import MODEL_FLOOR, believed, doubtful, noise, rounded, stepped
from sonicvacuum.discover.model.nuisances import shared
from sonicvacuum.discover.model.present import acting, check_known, stated
from sonicvacuum.discover.model.scatter import scattered
from sonicvacuum.discover.model.slow import slow
from sonicvacuum.discover.model.start import started
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.files import InputError
from sonicvacuum.records.assemble import assemble, chain_of, duration_of, interval_of
from sonicvacuum.records.record import Record

# Traces are read between samples by polynomials of the fifth degree, so that these may lie further apart than
# where pulses are measured on them.
COARSER = 2.0


def experiment(record: Record, catalogue: Catalogue = CATALOGUE) -> Experiment:
    """The data set of a record, which may lack effects of a catalogue; unknown gains and time zeros start at
    what the data ask for.
    """
    return _ready(_experiment(record, catalogue), (record,))


def _ready(data: Experiment, records) -> Experiment:
    """The data set with baselines and drifts in its noise, with a start for what is not known, and with what
    is simulated at first.
    """
    unknown = any(not math.isfinite(r.trigger_sigma_s) for r in records)
    said = _of_colour(data)
    data = replace(data, notes=(*data.notes, said)) if said else data
    return scattered(begun(started(replace(data, slow=slow(data)), unknown)))


def _experiment(record, catalogue):
    sigma, correlation = noise((record,))
    runs = tuple(_run(record, run, sigma) for run in record.runs)
    parts = batches(record)
    check_known(record, catalogue)
    informed = catalogue.informed(parts[0].chain, record.tolerances)
    present = stated(record, parts[0].chain, informed)
    parts = tuple(_as_long(b, record) for b in acting(parts, present, informed)) if present else parts
    return Experiment(
        name=record.name or record.title,
        runs=runs,
        batches=parts,
        gauges=record.gauges,
        sigma=sigma,
        correlation=correlation,
        gain_rel_sigma=np.array([g.log_gain_sigma for g in record.gauges]),
        trigger_sigma=record.trigger_width_s,
        modulus_rel_sigma=record.taken_modulus_rel_sigma(record.specimen.first.surface.name),
        diameter=record.specimen.diameters,
        record=record,
        catalogue=informed.held(present),
        excluded=tuple(name for name, odds in record.priors.items() if odds == 0.0),
        prior_odds=record.priors,
        present=present,
        model_floor_rel=record.model_floor_rel,
        shared=shared(record, [part.chain for part in parts]),
        notes=_notes(record, runs),
        colours=colours((record,), sigma),
    )


def together(records: Sequence[Record], catalogue: Catalogue = CATALOGUE) -> Experiment:
    """The data set of records of one laboratory: the same beads, materials and gauges with their gains.

    Gauges may sit elsewhere, static force and orientation may differ from record to record; where orientation
    does, nothing can be said of effects that are off at the recorded one.

    Raises:
        InputError: where records have different beads or gauges, or scalars beside the first record's.
    """
    first, *others = [_experiment(r, catalogue) for r in records]
    for record, other in zip(records[1:], others, strict=True):
        _check_alike(records[0], record, other)
    for record, other in zip(records[1:], others, strict=True):
        first = _joined(first, record, other)
    turned = len({r.specimen.gravity_m_s2 for r in records}) > 1
    unasked = tuple(e.id for e in catalogue if turned and e.depends_on_orientation)
    excluded = tuple(dict.fromkeys((*first.excluded, *unasked)))
    if others:
        sigma, correlation = noise(records)
        first = replace(first, sigma=sigma, correlation=correlation, colours=colours(records, sigma))
    return _ready(replace(first, excluded=excluded), records)


def _of_colour(experiment: Experiment) -> str | None:
    """What is said of gauges whose noise remembers more than one sample."""
    ids = [g.id for g, own in zip(experiment.gauges, experiment.colours, strict=False) if own]
    if not ids:
        return None
    return f"{', '.join(ids)}: noise that is not white, its spectrum taken from the samples at rest"


def _check_alike(record, other, seen: Experiment):
    for what, one, two in (
        ("beads", record.beads, other.beads),
        ("chain", _described(record.specimen), _described(other.specimen)),
        ("sensors", [g.id for g in record.gauges], [g.id for g in other.gauges]),
        ("priors", record.block.priors, other.block.priors),
    ):
        if one != two:
            raise InputError(f"{other.name}: {what} is {two}, in {record.name} {one}; discover them apart")
    if any(r.scalars for r in seen.runs):
        raise InputError(f"{other.name}: observables; only the first of records taken together may have them")


def _described(specimen):
    """Sizes, masses and materials of the kinds of beads."""
    kinds = [
        f"{1e3 * b.diameter_m:g} mm, {1e3 * b.mass_kg:g} g of {b.surface.name} "
        f"({b.surface.modulus_Pa / 1e9:g} GPa{', flat' if b.flat else ''})"
        for b in specimen.bodies.kinds
    ]
    return "; ".join(kinds + [f"but at bead {bead}" for bead in specimen.bodies.exceptions])


def _joined(first: Experiment, record, other: Experiment) -> Experiment:
    """Two data sets in one; runs of the second are numbered on. A static force, and materials of strikers,
    that only these have are open as well.
    """
    known = {r.id for r in first.runs}
    named = [replace(r, id=f"{record.name} {r.id}" if r.id in known else r.id) for r in other.runs]
    start = len(first.runs)
    moved = [replace(b, runs=tuple(start + k for k in b.runs), gauges=other.gauges) for b in other.batches]
    open_ = {(one.kind, one.of) for one in first.shared}
    own = [o for o in other.shared if o.kind in ("modulus", "static-force") and (o.kind, o.of) not in open_]
    joined = replace(first, runs=(*first.runs, *named), batches=(*first.batches, *moved))
    return replace(joined, shared=(*first.shared, *own))


def _run(record, run, sigma):
    signals = run.signals
    time = signals.time_s if signals else np.zeros(0)
    shape = (len(record.gauges), len(time))
    readings, present = np.zeros(shape), np.zeros(shape, dtype=bool)
    for s, gauge in enumerate(record.gauges):
        if signals and gauge.id in signals.readings:
            readings[s] = signals.readings[gauge.id]
            known = rounded(record, gauge.id)
            present[s] = believed(readings[s], max(gauge.sigma, known))
            if stepped(readings[s], sigma[s], known):
                present[s] &= ~repeated(readings[s], record.steps.get(gauge.id, 0.0))
    scalars = tuple(
        Scalar(o.quantity, o.value, error(o), o.options, o.bound, o.shared) for o in run.observables
    )
    there = None if present.all() else present
    return RunData(run.id, time, readings, scalars, run.striker.speed_rel_sigma, there)


def _notes(record, runs):
    """What was left out, gauge by gauge."""
    notes = []
    for gauge in record.gauges:
        counts = {"spikes": 0, "samples cut off at the end of the range": 0}
        for run in record.runs:
            if run.signals and gauge.id in run.signals.readings:
                trace = np.asarray(run.signals.readings[gauge.id], dtype=float)
                found = doubtful(trace.tobytes(), float(max(gauge.sigma, rounded(record, gauge.id))))
                for what, at in zip(counts, found, strict=True):
                    counts[what] += int(np.count_nonzero(at))
        if gauge.id in record.steps:
            what = "repeated readings on a step of the recorder"
            counts[what] = _missing(record, runs, gauge) - sum(counts.values())
        notes += [f"{gauge.id}: {n} {what} left out" for what, n in counts.items() if n]
    return tuple(notes)


def _missing(record, runs, gauge) -> int:
    """How many readings of a gauge do not count in the runs that have it."""
    place = record.gauges.index(gauge)
    having = [gauge.id in run.signals.readings if run.signals else False for run in record.runs]
    present = [
        data.present for data, has in zip(runs, having, strict=True) if has and data.present is not None
    ]
    return sum(int(np.count_nonzero(~one[place])) for one in present)


def error(observable) -> float:
    """Standard error of an observable; one that is given as exact is known to the simulation's accuracy."""
    return max(observable.sigma, MODEL_FLOOR * abs(observable.value), 1e-12)


def batches(record: Record) -> tuple[Batch, ...]:
    """Runs that can be simulated together: strikers alike, one sampling interval."""
    result = []
    for part in assemble(record):
        by_interval: dict[float, list[int]] = {}
        for place in part.runs:
            signals = record.runs[place].signals
            by_interval.setdefault(round(signals.interval_s, 12) if signals else 0.0, []).append(place)
        for places in by_interval.values():
            runs = [record.runs[k] for k in places]
            chain = chain_of(record, runs)
            coarser = 1.0 if any(r.observables for r in runs) else COARSER
            room = interval_of(runs, chain, coarser)
            duration = duration_of(record, runs, chain) + 4.0 * room
            result.append(Batch(chain, tuple(places), room, duration))
    return tuple(result)


def _as_long(batch: Batch, record: Record) -> Batch:
    """A batch simulated for as long as its chains ask for with all that acts in them."""
    runs = [record.runs[k] for k in batch.runs]
    return replace(batch, duration=duration_of(record, runs, batch.chain) + 4.0 * batch.interval)
