"""From a record to the experiment that is inferred from: chains to simulate, noise checked against the quiet
stretch.

The noise that a record states is compared with what its traces show before the pulse arrives. Where that is
larger, or correlated from sample to sample, it is taken instead.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from sonicvacuum.discover.experiment import (
    MODULUS_REL_SIGMA,
    Batch,
    Experiment,
    Gauge,
    RunData,
    Scalar,
    lag_one,
)
from sonicvacuum.files import InputError
from sonicvacuum.records.assemble import assemble, chain_of, duration_of, interval_of
from sonicvacuum.records.record import Record

# Smooth error of the simulation and of the interpolation, relative to the largest reading of a gauge.
MODEL_FLOOR = 1e-4
# The quiet stretch ends well before the first sample that exceeds the larger of these.
_QUIET_SIGMAS, _QUIET_PEAK, _QUIET_SHARE = 6.0, 0.03, 0.7
_FEWEST = 40
# Deviations from the stated white noise count from so many standard errors on.
_SURE = 4.0


def experiment(record: Record) -> Experiment:
    """The data set of a record."""
    runs = tuple(_run(record, run) for run in record.runs)
    sigma, correlation = noise((record,))
    named = record.modulus_rel_sigma(record.surface.name)
    return Experiment(
        name=record.name or record.title,
        runs=runs,
        batches=batches(record),
        gauges=tuple(Gauge(g.id, g.kind, g.bead) for g in record.gauges),
        sigma=sigma,
        correlation=correlation,
        gain_rel_sigma=np.array([g.gain_rel_sigma for g in record.gauges]),
        trigger_sigma=record.trigger_sigma_s,
        modulus_rel_sigma=named or MODULUS_REL_SIGMA,
        diameter=record.diameter_m,
        record=record,
    )


def together(records: Sequence[Record]) -> Experiment:
    """The data set of records of one laboratory: the same beads, materials and gauges with their gains.

    Gauges may sit elsewhere, static force and orientation may differ from record to record; where orientation
    does, nothing can be said of gravity.

    Raises:
        InputError: where records have different beads or gauges, or scalars beside the first record's.
    """
    first, *others = [experiment(r) for r in records]
    for record, other in zip(records[1:], others, strict=True):
        _check_alike(records[0], record, other)
    for record, other in zip(records[1:], others, strict=True):
        first = _joined(first, record, other)
    turned = len({r.gravity_m_s2 for r in records}) > 1
    sigma, correlation = noise(records)
    return replace(
        first, sigma=sigma, correlation=correlation, excluded=("gravity",) if turned else first.excluded
    )


def _check_alike(record, other, seen: Experiment):
    for what, one, two in (
        ("beads", record.beads, other.beads),
        ("bead", (record.diameter_m, record.bead_mass_kg), (other.diameter_m, other.bead_mass_kg)),
        ("material", record.surface, other.surface),
        ("sensors", [g.id for g in record.gauges], [g.id for g in other.gauges]),
    ):
        if one != two:
            raise InputError(f"{other.name}: {what} is {two}, in {record.name} {one}; discover them apart")
    if any(r.scalars for r in seen.runs):
        raise InputError(f"{other.name}: observables; only the first of records taken together may have them")


def _joined(first: Experiment, record, other: Experiment) -> Experiment:
    """Two data sets in one; runs of the second are numbered on."""
    known = {r.id for r in first.runs}
    named = [replace(r, id=f"{record.name} {r.id}" if r.id in known else r.id) for r in other.runs]
    start = len(first.runs)
    moved = [replace(b, runs=tuple(start + k for k in b.runs), gauges=other.gauges) for b in other.batches]
    return replace(first, runs=(*first.runs, *named), batches=(*first.batches, *moved))


def _run(record, run):
    signals = run.signals
    time = signals.time_s if signals else np.zeros(0)
    gauges = [signals.readings[g.id] if signals else np.zeros(0) for g in record.gauges]
    readings = np.array(gauges).reshape(len(record.gauges), len(time))
    scalars = tuple(Scalar(o.quantity, o.value, _error(o), o.options) for o in run.observables)
    return RunData(run.id, time, readings, scalars, run.striker.speed_rel_sigma)


def _error(observable):
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
            room = interval_of(record, runs, chain)
            duration = duration_of(record, runs, chain) + 4.0 * room
            result.append(Batch(chain, tuple(places), room, duration))
    return tuple(result)


def noise(records: Sequence[Record]) -> tuple[np.ndarray, np.ndarray]:
    """(S,) standard deviation of one sample in N and correlation of neighbours, stated or seen."""
    found = [_noise_of(records, g) for g in records[0].gauges]
    return np.array([f[0] for f in found]), np.array([f[1] for f in found])


def _noise_of(records, gauge):
    traces = [r.signals.readings[gauge.id] for record in records for r in record.runs if r.signals]
    if not traces:
        return max(gauge.sigma, 1e-12), 0.0
    peak = max(float(np.abs(t).max()) for t in traces)
    floor = math.hypot(gauge.sigma, MODEL_FLOOR * peak)
    quiet = [q for t in traces if len(q := _quiet(t, gauge.sigma)) >= _FEWEST]
    if not quiet:
        return floor, 0.0
    count = sum(len(q) for q in quiet)
    seen = math.sqrt(sum(q @ q for q in quiet) / count)
    rho = float(np.average([lag_one(q) for q in quiet], weights=[len(q) for q in quiet]))
    error = _SURE / math.sqrt(count)
    sigma = max(floor, seen) if seen > floor * (1.0 + error) else floor
    return max(sigma, 1e-12), min(rho, 0.99) if rho > error else 0.0


def _quiet(trace, sigma):
    """The samples before the pulse arrives, or none."""
    peak = float(np.abs(trace).max())
    loud = np.abs(trace) > max(_QUIET_SIGMAS * sigma, _QUIET_PEAK * peak)
    first = int(loud.argmax()) if loud.any() else len(trace)
    return trace[: int(_QUIET_SHARE * first)]
