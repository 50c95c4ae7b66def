"""What a slip makes of a record, undone: (record, value) → the record put right.

Sizes are logarithms of ratios; numbers of beads, ids and shifts in microseconds are as they are.
"""

import itertools
import math
from collections.abc import Mapping
from dataclasses import replace

import msgspec
import numpy as np

from sonicvacuum.gauges import KINDS
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.blocks import SCALED, SUFFIXES, DecayBlock

# (run id, gauge id) → (T,) samples that must not be believed.
Lost = dict[tuple[str, str], np.ndarray]


def _block(record: Record, **given) -> Record:
    return replace(record, block=msgspec.structs.replace(record.block, **given))


def _scaled(body, key, ratio):
    """A bead's block, or a change of one, with one of its numbers times a ratio."""
    value = getattr(body, key, None)
    return msgspec.structs.replace(body, **{key: value * ratio}) if isinstance(value, float | int) else body


def beads(record: Record, key: str, log_ratio: float) -> Record:
    """All beads with their mass or diameter times a ratio."""
    chain, ratio = record.block.chain, math.exp(log_ratio)
    given = {"bodies": {n: _scaled(b, key, ratio) for n, b in chain.bodies.items()}}
    if chain.bead is not None:
        given["bead"] = _scaled(chain.bead, key, ratio)
    if chain.pattern is not None:
        given["pattern"] = [_scaled(b, key, ratio) for b in chain.pattern]
    return _block(record, chain=msgspec.structs.replace(chain, **given))


def strikers(record: Record, key: str, log_ratio: float, runs=None) -> Record:
    """The strikers of some runs, or of all, with mass or speed times a ratio."""

    def changed(run):
        if runs is not None and run.id not in runs:
            return run
        return msgspec.structs.replace(run, striker=_scaled(run.striker, key, math.exp(log_ratio)))

    return _block(record, runs=[changed(r) for r in record.block.runs])


def bead_count(record: Record, by: int, from_wall: bool = False) -> Record:
    """A chain with so many beads more; gauges and single beads that differ stay where they are as counted
    from one end or the other.
    """
    chain = record.block.chain
    changed = msgspec.structs.replace(chain, beads=chain.beads + by)
    sensors = record.block.sensors
    if from_wall:
        changed = msgspec.structs.replace(changed, bodies={n + by: b for n, b in chain.bodies.items()})
        sensors = [
            s if s.bead is None else msgspec.structs.replace(s, bead=s.bead + by)
            for s in record.block.sensors
        ]
    return _block(record, chain=changed, sensors=sensors)


def gauge_moved(record: Record, id: str, by: int) -> Record:
    """A gauge so many beads further on."""
    return gauges_at(record, {s.id: s.bead + by for s in record.block.sensors if s.id == id})


def gauges_at(record: Record, beads: Mapping[str, int]) -> Record:
    """Gauges in other beads: id → bead."""
    moved = [
        msgspec.structs.replace(s, bead=beads[s.id]) if s.id in beads else s for s in record.block.sensors
    ]
    return _block(record, sensors=moved)


def gauge_seated(record: Record, id: str, bead: int | None) -> Record:
    """A force gauge embedded in a bead, or, where that is None, at the wall."""
    given = {"kind": "wall" if bead is None else "embedded", "bead": bead}
    changed = [msgspec.structs.replace(s, **given) if s.id == id else s for s in record.block.sensors]
    return _block(record, sensors=changed)


def gauges_swapped(record: Record, one: str, two: str) -> Record:
    """The readings of two gauges exchanged; noise and gain stay with the cables."""
    return gauges_renamed(record, {one: two, two: one})


def gauges_renamed(record: Record, names: Mapping[str, str]) -> Record:
    """The readings of gauges and the steps in them under other names, id → id; noise and gain stay with the
    cables.
    """

    def renamed(signals):
        return Signals(signals.time_us, {names.get(k, k): v for k, v in signals.readings.items()})

    if not record.signals:
        return _block(record, runs=[_renamed(run, names) for run in record.block.runs])
    steps = {names.get(id, id): step for id, step in record.steps.items()}
    return replace(record, signals={k: renamed(s) for k, s in record.signals.items()}, steps=steps)


def _renamed(run, names):
    """A run whose amplitudes and durations are other gauges'; speeds are of the same two places, or none."""

    def renamed(one):
        keys = ("from_", "to") if isinstance(one, DecayBlock) else ("sensor",)
        own = {key: getattr(one, key) for key in keys if hasattr(one, key)}
        return msgspec.structs.replace(one, **{key: names.get(id, id) for key, id in own.items()})

    return msgspec.structs.replace(run, observables=[renamed(one) for one in run.observables])


def gauges_swapped_in(record: Record, run: str, one: str, two: str) -> Record:
    """The readings of two gauges exchanged in one run."""
    own, other = record.signals[run], {one: two, two: one}
    readings = {other.get(id, id): v for id, v in own.readings.items()}
    return replace(record, signals={**record.signals, run: Signals(own.time_us, readings)})


def runs_swapped(record: Record, one: str, two: str) -> Record:
    """The strikers of two runs exchanged."""
    return runs_struck(record, {one: two, two: one})


def runs_struck(record: Record, others: Mapping[str, str]) -> Record:
    """Runs with the strikers of others: run → the one whose striker it has."""
    strikers_ = {r.id: r.striker for r in record.block.runs}
    runs = [
        msgspec.structs.replace(r, striker=strikers_[others[r.id]]) if r.id in others else r
        for r in record.block.runs
    ]
    return _block(record, runs=runs)


def traces_swapped(record: Record, id: str, one: str, two: str) -> Record:
    """The traces of one gauge in two runs exchanged."""
    other = {one: two, two: one}

    def exchanged(run, signals):
        if run not in other:
            return signals
        return Signals(signals.time_us, {**signals.readings, id: record.signals[other[run]].readings[id]})

    return replace(record, signals={k: exchanged(k, s) for k, s in record.signals.items()})


def trace_scaled(record: Record, run: str, id: str, ratio: float) -> Record:
    """One trace times a ratio; without it where that is 0."""
    own = record.signals[run]
    readings = {g: v * ratio if g == id else v for g, v in own.readings.items() if ratio or g != id}
    return replace(record, signals={**record.signals, run: Signals(own.time_us, readings)})


def gains(record: Record, log_ratio: float) -> Record:
    """All readings over a ratio, with what is in their unit: noise, offset, drift, the recorder's steps."""
    ratio = math.exp(-log_ratio)
    sensors = [_scaled_noise(s, ratio) for s in record.block.sensors]
    signals = {
        k: Signals(s.time_us, {g: v * ratio for g, v in s.readings.items()})
        for k, s in record.signals.items()
    }
    steps = {id: step * ratio for id, step in record.steps.items()}
    return replace(_block(record, sensors=sensors), signals=signals, steps=steps)


def _scaled_noise(sensor, ratio):
    for key, suffix in itertools.product(SCALED, SUFFIXES):
        sensor = _scaled(sensor, f"{key}_{suffix}", ratio)
    return sensor


def clock(record: Record, log_ratio: float, runs=None) -> Record:
    """Recorded times of some runs, or of all, over a ratio."""
    ratio = math.exp(-log_ratio)
    changed = {
        k: Signals(s.time_us * ratio, s.readings)
        for k, s in record.signals.items()
        if runs is None or k in runs
    }
    return replace(record, signals={**record.signals, **changed})


def time_zero(record: Record, late_us: dict[str, float], sigma_us: float) -> Record:
    """Times of each run put later by so many microseconds, and known only so well from there on."""
    signals = {k: Signals(s.time_us + late_us.get(k, 0.0), s.readings) for k, s in record.signals.items()}
    given = record.block.trigger_sigma_us
    wider = given if given == "unknown" else max(given, sigma_us)
    return replace(_block(record, trigger_sigma_us=wider), signals=signals)


def triggered(record: Record, sigma_us: float | str) -> Record:
    """Time zeros known so well, in us."""
    return _block(record, trigger_sigma_us=sigma_us)


def delayed(record: Record, id: str, late_us: float) -> Record:
    """One gauge's readings put earlier by so many microseconds."""

    def shifted(signals):
        if id not in signals.readings:
            return signals
        samples = late_us * 1e-6 / signals.interval_s
        return Signals(signals.time_us, {**signals.readings, id: earlier(signals.readings[id], samples)})

    return replace(record, signals={k: shifted(s) for k, s in record.signals.items()})


def delay_known_to(record: Record, id: str, sigma_us: float) -> Record:
    """The record that knows the delay of one gauge only so well, in us."""

    def looser_one(sensor):
        wider = max(sensor.delay_sigma_us, sigma_us)
        return msgspec.structs.replace(sensor, delay_sigma_us=wider) if sensor.id == id else sensor

    return _block(record, sensors=[looser_one(s) for s in record.block.sensors])


def looser(record: Record, errors: Mapping[str, Mapping[str, float]]) -> Record:
    """The record whose gauges may rest elsewhere, or drift, by at least so much.

    Args:
        record: as it is.
        errors: gauge id → "baseline" or "drift" → standard error in the gauge's unit.
    """

    def looser_one(sensor):
        given = errors.get(sensor.id, {})
        keys = {f"{what}_sigma_{KINDS[sensor.kind].suffix}": error for what, error in given.items()}
        wider = {key: max(getattr(sensor, key) or 0.0, error) for key, error in keys.items()}
        return msgspec.structs.replace(sensor, **wider)

    return _block(record, sensors=[looser_one(s) for s in record.block.sensors])


def straightened(record: Record, id: str, lines: dict[str, tuple[float, float]]) -> Record:
    """One gauge's readings without a straight line in each run: level at the first sample, slope a sample."""

    def without(run, signals):
        if run not in lines or id not in signals.readings:
            return signals
        (level, slope), trace = lines[run], signals.readings[id]
        line = level + slope * np.arange(len(trace))
        return Signals(signals.time_us, {**signals.readings, id: trace - line})

    return replace(record, signals={k: without(k, s) for k, s in record.signals.items()})


def earlier(trace: np.ndarray, samples: float) -> np.ndarray:
    """A trace put earlier by so many samples, its ends held.

    The whole part moves samples, the rest goes by the Fourier transform, which keeps white noise white; the
    straight line between both ends is taken off meanwhile, so that nothing wraps around with a step.
    """
    whole = round(samples)
    moved = trace[np.clip(np.arange(len(trace)) + whole, 0, len(trace) - 1)]
    straight = np.linspace(moved[0], moved[-1], len(moved))
    turn = np.exp(2j * np.pi * np.fft.rfftfreq(len(moved)) * (samples - whole))
    return straight + np.fft.irfft(np.fft.rfft(moved - straight) * turn, len(moved))


def lost_by_delay(lost: Lost, record: Record, id: str, late_us: float) -> Lost:
    """Samples that must not be believed once a gauge's readings are put earlier: those that were not, where
    they stand then, and the ones for which there is no reading.
    """
    found = dict(lost)
    for run, signals in record.signals.items():
        if id not in signals.readings:
            continue
        place = np.arange(len(signals.time_us)) + round(late_us * 1e-6 / signals.interval_s)
        gone = (place < 0) | (place >= len(place))
        if (run, id) in lost:
            gone |= lost[run, id][place.clip(0, len(place) - 1)]
        if gone.any():
            found[run, id] = gone
    return found
