"""From a record to the experiment that is inferred from: chains to simulate, noise checked against the quiet
stretch.

The noise that a record states is compared with what its traces show before the pulse arrives. Where that is
larger, or correlated from sample to sample, it is taken instead. Spikes and samples that were cut off are
left out (`masks`).
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from sonicvacuum.discover.model.beginnings import begun
from sonicvacuum.discover.model.experiment import (
    Batch,
    Experiment,
    RunData,
    Scalar,
    lag_one,
)
from sonicvacuum.discover.model.masks import cut, spikes
from sonicvacuum.discover.model.nuisances import MODULUS_REL_SIGMA, shared
from sonicvacuum.discover.model.present import acting, stated
from sonicvacuum.discover.model.slow import slow
from sonicvacuum.discover.model.start import started
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.files import InputError
from sonicvacuum.records.assemble import assemble, chain_of, duration_of, interval_of
from sonicvacuum.records.record import Record

# Smooth error of the simulation and of the interpolation, relative to the largest reading of a gauge.
MODEL_FLOOR = 1e-4
# Traces are read between samples by polynomials of the fifth degree, so that these may lie further apart than
# where pulses are measured on them.
COARSER = 2.0
# The quiet stretch ends well before the first sample that exceeds so many standard errors, and this share of
# the peak.
QUIET_SIGMAS, QUIET_PEAK, QUIET_SHARE = 6.0, 0.03, 0.7
_FEWEST, _LEAST = 40, 12
# Deviations from the stated white noise count from so many standard errors on.
_SURE = 4.0
# So many third differences of white noise are worth one independent sample: 1 + 2 (15² + 6² + 1)/20², from
# their correlations −15/20, 6/20, −1/20. They and the quiet stretch agree within so many standard errors.
_RIPPLE, _AGREE = 1.0 + 2.0 * (15.0**2 + 6.0**2 + 1.0) / 20.0**2, 3.0


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
    return begun(started(replace(data, slow=slow(data)), unknown))


def _experiment(record, catalogue):
    runs = tuple(_run(record, run) for run in record.runs)
    sigma, correlation = noise((record,))
    named = record.modulus_rel_sigma(record.specimen.first.surface.name)
    parts = batches(record)
    odds = _priors(record, catalogue)
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
        modulus_rel_sigma=MODULUS_REL_SIGMA if named is None else named,
        diameter=record.specimen.diameters,
        record=record,
        catalogue=informed.held(present),
        excluded=tuple(name for name, odds in record.priors.items() if odds == 0.0),
        prior_odds=odds,
        present=present,
        model_floor_rel=record.model_floor_rel,
        shared=shared(record, parts[0].chain),
        notes=_notes(record, runs),
    )


def _priors(record, catalogue):
    """The record's odds, of effects that the catalogue holds."""
    for name in (*record.priors, *record.present):
        if name not in catalogue:
            known = ", ".join(catalogue.ids)
            raise InputError(f"{record.name}: priors.{name}: no such effect; the catalogue holds {known}")
    return record.priors


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
    sigma, correlation = noise(records) if others else (first.sigma, first.correlation)
    whole = replace(first, sigma=sigma, correlation=correlation, excluded=excluded)
    return _ready(whole, records)


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
    """Two data sets in one; runs of the second are numbered on."""
    known = {r.id for r in first.runs}
    named = [replace(r, id=f"{record.name} {r.id}" if r.id in known else r.id) for r in other.runs]
    start = len(first.runs)
    moved = [replace(b, runs=tuple(start + k for k in b.runs), gauges=other.gauges) for b in other.batches]
    return replace(first, runs=(*first.runs, *named), batches=(*first.batches, *moved))


def _run(record, run):
    signals = run.signals
    time = signals.time_s if signals else np.zeros(0)
    shape = (len(record.gauges), len(time))
    readings, present = np.zeros(shape), np.zeros(shape, dtype=bool)
    for s, gauge in enumerate(record.gauges):
        if signals and gauge.id in signals.readings:
            readings[s] = signals.readings[gauge.id]
            present[s] = believed(readings[s], gauge.sigma)
    scalars = tuple(
        Scalar(o.quantity, o.value, _error(o), o.options, o.bound, o.shared) for o in run.observables
    )
    there = None if present.all() else present
    return RunData(run.id, time, readings, scalars, run.striker.speed_rel_sigma, there)


def believed(trace: np.ndarray, sigma: float) -> np.ndarray:
    """(T,) whether a sample counts: it is neither a spike nor cut off."""
    return _believed(np.asarray(trace, dtype=float).tobytes(), float(sigma))


@lru_cache(maxsize=512)
def _believed(samples: bytes, sigma):
    """The same, remembered: each hypothesis of a slip asks again of traces that it leaves as they are."""
    found = ~np.logical_or(*_doubtful(samples, sigma))
    found.flags.writeable = False
    return found


@lru_cache(maxsize=512)
def _doubtful(samples: bytes, sigma):
    """Which samples of a trace are spikes, and which are cut off."""
    trace = np.frombuffer(samples)
    noise_ = max(sigma, flicker(trace))
    return spikes(trace, noise_), cut(trace, noise_)


def _notes(record, runs):
    """What was left out, gauge by gauge."""
    notes = []
    for gauge in record.gauges:
        counts = {"spikes": 0, "samples cut off at the end of the range": 0}
        for run in record.runs:
            if run.signals and gauge.id in run.signals.readings:
                trace = np.asarray(run.signals.readings[gauge.id], dtype=float)
                found = _doubtful(trace.tobytes(), float(gauge.sigma))
                for what, at in zip(counts, found, strict=True):
                    counts[what] += int(np.count_nonzero(at))
        notes += [f"{gauge.id}: {n} {what} left out" for what, n in counts.items() if n]
    return tuple(notes)


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
            coarser = 1.0 if any(r.observables for r in runs) else COARSER
            room = interval_of(record, runs, chain, coarser)
            duration = duration_of(record, runs, chain) + 4.0 * room
            result.append(Batch(chain, tuple(places), room, duration))
    return tuple(result)


def _as_long(batch: Batch, record: Record) -> Batch:
    """A batch simulated for as long as its chains ask for with all that acts in them."""
    runs = [record.runs[k] for k in batch.runs]
    return replace(batch, duration=duration_of(record, runs, batch.chain) + 4.0 * batch.interval)


def noise(records: Sequence[Record]) -> tuple[np.ndarray, np.ndarray]:
    """(S,) standard deviation of one sample and correlation of its neighbours, stated or seen."""
    gauges = records[0].gauges
    traces = [_traces(records, g) for g in gauges]
    quiet = [_quiet_of(own, g) for own, g in zip(traces, gauges, strict=True)]
    sigma = [_sigma(own, g, q) for own, g, q in zip(traces, gauges, quiet, strict=True)]
    return np.array(sigma), _correlations(quiet)


def _traces(records, gauge):
    """Its traces, what is not believed left out."""
    runs = [r for record in records for r in record.runs if r.signals and gauge.id in r.signals.readings]
    traces = [r.signals.readings[gauge.id] for r in runs]
    return [t[believed(t, gauge.sigma)] for t in traces]


def _quiet_of(traces, gauge):
    """The quiet stretches of a gauge that are long enough."""
    sigma = gauge.sigma or max(map(flicker, traces), default=0.0)
    quiet = [q for t in traces if len(q := _quiet(t, sigma)) >= _LEAST]
    if gauge.baseline_sigma or gauge.drift_sigma:
        # Where level and slope are open, noise is what is left of both.
        quiet = [_off_its_line(q) for q in quiet]
    return quiet if sum(map(len, quiet)) >= _FEWEST else []


def _off_its_line(stretch):
    """A stretch without its straight line."""
    place = np.arange(len(stretch)) - 0.5 * (len(stretch) - 1)
    return stretch - stretch.mean() - place * (place @ stretch / (place @ place))


def _sigma(traces, gauge, quiet):
    """What the record states, or more where the quiet stretches are surely louder."""
    peak = max((float(np.abs(t).max()) for t in traces), default=0.0)
    floor = max(math.hypot(gauge.sigma or _estimated(traces, quiet), MODEL_FLOOR * peak), 1e-12)
    if not quiet:
        return floor
    count = sum(len(q) for q in quiet)
    seen = math.sqrt(sum(q @ q for q in quiet) / count)
    return seen if seen > floor * (1.0 + _SURE / math.sqrt(count)) else floor


def _estimated(traces, quiet):
    """Noise that nobody stated: of the quiet stretches, and of what makes the other samples flicker.

    Where noise is white and signals are smooth, third differences of all samples show the same noise as the
    few before the pulse, and by far more of them; both are averaged by their numbers. Where they disagree, or
    neighbours are correlated, only the quiet stretches count.
    """
    if not quiet:
        return max(map(flicker, traces), default=0.0)
    count = sum(map(len, quiet))
    level = math.sqrt(sum(float(q @ q) for q in quiet) / count)
    steps = np.concatenate([np.diff(t, 3) for t in traces])
    ripple, worth = math.sqrt(float(steps @ steps) / len(steps) / 20.0), len(steps) / _RIPPLE
    error = math.hypot(1.0 / math.sqrt(2.0 * count), 1.0 / math.sqrt(2.0 * worth))
    white = abs(_correlation(quiet)) < _SURE / math.sqrt(count)
    if white and abs(ripple - level) < _AGREE * error * level:
        level = math.sqrt((count * level**2 + worth * ripple**2) / (count + worth))
    return max(level, max(map(rounding, traces)))


def flicker(trace: np.ndarray) -> float:
    """Noise of one sample from third differences, which a smooth pulse hardly moves; white noise assumed.

    The median of their absolute values over 0.6745 √20: third differences of white noise have the variance
    1 + 9 + 9 + 1 = 20.
    """
    return float(np.median(np.abs(np.diff(trace, 3)))) / (0.6745 * math.sqrt(20.0)) if len(trace) > 3 else 0.0


def rounding(trace: np.ndarray) -> float:
    """Standard deviation of the rounding of a trace whose values repeat: its smallest step over √12."""
    values = np.unique(trace)
    if len(values) < 2 or len(values) > len(trace) / 2:
        return 0.0
    return float(np.diff(values).min()) / math.sqrt(12.0)


def _correlations(quiet):
    """(S,) correlation of neighbours: one for all gauges, or each its own where they surely differ; 0 where
    none is sure.
    """
    weights = np.array([sum(len(q) for q in stretches) for stretches in quiet], dtype=float)
    if not weights.any():
        return np.zeros(len(quiet))
    own = np.array([_correlation(stretches) for stretches in quiet])
    shared = float(np.average(own, weights=weights))
    if shared <= _SURE / math.sqrt(weights.sum()):
        # One gauge alone may still be correlated.
        return np.where(own > _SURE / np.sqrt(np.maximum(weights, 1.0)), np.minimum(own, 0.99), 0.0)
    error = np.sqrt((1.0 - shared**2) / np.maximum(weights, 1.0))
    differs = (np.abs(own - shared) > _SURE * error) & (weights > 0.0)
    return np.clip(np.where(differs, own, shared), 0.0, 0.99)


def _correlation(stretches):
    """Lag-one correlation, its bias −(1 + 3ρ)/n removed (Marriott & Pope, Biometrika 41, 390, 1954)."""
    if not stretches:
        return 0.0
    seen = [(lag_one(q), len(q)) for q in stretches]
    return float(np.average([r + (1.0 + 3.0 * r) / n for r, n in seen], weights=[n for _, n in seen]))


def _quiet(trace, sigma):
    """The samples before the pulse arrives, or none."""
    peak = float(np.abs(trace).max())
    loud = np.abs(trace) > max(QUIET_SIGMAS * sigma, QUIET_PEAK * peak)
    first = int(loud.argmax()) if loud.any() else len(trace)
    return trace[: int(QUIET_SHARE * first)]
