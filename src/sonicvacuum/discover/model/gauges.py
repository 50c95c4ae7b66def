"""Readings between the samples of a simulation, at the times of a recorder whose clock and channels err."""

from functools import lru_cache

import numpy as np

# Simulated samples after the last time at which a trace is read: it is read between neighbours.
AFTER = 4


def lagrange(fraction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights of `resample.POINTS` neighbours (L, POINTS) at `fraction` of the way to the next sample, and
    their slopes.

    Lagrange polynomials; exact for polynomials of degree 5.
    """
    value, slope = _coefficients()
    powers = np.vander(np.asarray(fraction, dtype=float), len(value), increasing=True)
    return powers @ value, powers @ slope


@lru_cache(maxsize=1)
def _coefficients():
    """(POINTS, POINTS) coefficients, by ascending power, of each neighbour's polynomial and its slope."""
    from sonicvacuum.physics.resample import BEFORE, POINTS

    value, slope = np.zeros((2, POINTS, POINTS))
    offsets = np.arange(POINTS) - BEFORE
    for k, node in enumerate(offsets):
        others = np.delete(offsets, k)
        one = np.polynomial.Polynomial.fromroots(others) / np.prod(node - others)
        value[:, k], slope[:-1, k] = one.coef, one.deriv().coef
    return value, slope


def shifted(simulated, interval: float, time, shift, rated=slice(None), chain=None, gain=None):
    """Readings at recorded times, and their time derivative.

    Args:
        simulated: (L, S, T') readings of L chains, first sample at true time 0, at rest before.
        interval: between simulated samples in s.
        time: (T,) recorded times in s, their interval a multiple of the simulated one.
        shift: (N,) trigger shift in s of N records; recorded time = true time + shift.
        rated: of which records the derivative is wanted.
        chain: (N,) which chain each record is of; None: in their order.
        gain: (N, S) what the readings are multiplied by; None: 1.

    Returns:
        Arrays (N, S, T) in the gauges' units and (·, S, T) in the same per second.
    """
    from sonicvacuum.physics.resample import resampled  # compiled: not for a verdict that is only read

    stride = round((time[-1] - time[0]) / (len(time) - 1) / interval)
    place = (time[0] - shift) / interval
    whole = np.floor(place).astype(int)
    weights, slopes = lagrange(place - whole)
    chain = np.arange(len(shift)) if chain is None else chain
    gain = np.ones((len(shift), simulated.shape[1])) if gain is None else gain
    value = resampled(simulated, chain, whole, weights, gain, stride, len(time))
    some = (chain[rated], whole[rated], slopes[rated] / interval, gain[rated])
    return value, resampled(simulated, *some, stride, len(time))


def at_record(layout, sigma, interval: float, time: np.ndarray, signals, chain, gain, shift, nu, rated):
    """Readings at recorded times and their slopes to time zero, clock and delays.

    The clock's error is taken to first order: it moves no sample by more than a part of a pulse.

    Args:
        layout: of the nuisances, whose standard errors are `sigma`.
        interval: between simulated samples in s.
        time: (T,) recorded times in s.
        signals: (L, S, T') simulated readings of L chains.
        chain: (N,) which chain each of N records is of.
        gain: (N, S) of the gauges.
        shift: (N,) trigger shift in s.
        nu: (N, q) nuisances over their standard errors.
        rated: (n,) records whose slopes are wanted.

    Returns:
        (N, S, T) readings and (n, times, S, T) slopes.
    """
    clock, delays = layout.other("clock"), layout.other("delay")
    some = np.arange(len(nu)) if clock else rated
    if not delays:
        value, rate = shifted(signals, interval, time, shift, some, chain, gain)
    else:
        late = np.zeros((len(nu), signals.shape[1]))
        channels = [layout.others[k - layout.modulus - 1].gauge for k in delays]
        late[:, channels] = nu[:, delays] * sigma[delays]
        parts = [
            shifted(signals[:, s : s + 1], interval, time, shift + delay, some, chain, gain[:, s : s + 1])
            for s, delay in enumerate(late.T)
        ]
        value, rate = (np.concatenate(p, axis=1) for p in zip(*parts, strict=True))
    slopes = [-rate]
    for k in clock:
        slopes.append(-rate * (time - shift[:, None])[:, None])
        value = value + (nu[:, k] * sigma[k])[:, None, None] * slopes[1]
        slopes = [s[rated] for s in slopes]
    if delays:
        slopes += [slopes[0] * (np.arange(signals.shape[1]) == s)[:, None] for s in channels]
    return value, np.stack(slopes, axis=1)


def shifts(e, layout, sigma, runs, nu) -> np.ndarray:
    """(R, L) trigger shifts in s of R runs in L lanes; the rest as in `traces`."""
    trigger = layout.trigger(np.array(runs))
    return np.array([e.runs[r].shift for r in runs])[:, None] + (nu[:, trigger] * sigma[trigger]).T


def last_read(e, layout, sigma, batch, nu) -> float:
    """True time in s of the last simulated sample from which `traces` reads those of a batch."""
    traced = [run for run in batch.runs if e.runs[run].has_signals]
    if not traced:
        return AFTER * batch.interval
    delays = layout.other("delay")
    late = shifts(e, layout, sigma, traced, nu) + (nu[:, delays] * sigma[delays]).min(axis=1, initial=0.0)
    end = np.array([e.runs[run].time[-1] for run in traced])[:, None] - late
    return float(end.max(initial=0.0, where=np.isfinite(end))) + AFTER * batch.interval


def traces(e, layout, sigma, batch, places, readings, gain, nu, rate_of: int):
    """Readings of some runs and their slopes to times, over the noise of single samples.

    Args:
        e: the data set.
        layout: of its nuisances, whose standard errors are `sigma`.
        batch: what was simulated, its R runs for each of L lanes.
        places: of the runs in the batch that are wanted; their samples were taken, and count, alike.
        readings: (L R, S, T') simulated readings.
        gain: (L, S) of the gauges.
        nu: (L, q) nuisances over their standard errors.
        rate_of: slopes are wanted of every so many lanes.

    Returns:
        Run → (L, S, T) readings and (·, times, S, T) slopes.
    """
    lanes, runs = len(nu), [batch.runs[k] for k in places]
    lane, which = np.tile(np.arange(lanes), len(runs)), np.repeat(np.arange(len(runs)), lanes)
    rated = np.flatnonzero(lane % rate_of == 0)
    data = e.runs[runs[0]]
    if data.has_signals:
        shift = shifts(e, layout, sigma, runs, nu)
        chain = lane * len(batch.runs) + np.array(places)[which]
        # All that follows is linear in the gain: over the noise from the start.
        own = (gain / e.sigma)[lane], shift.ravel(), nu[lane], rated
        value, timing = at_record(layout, sigma, batch.interval, data.time, readings, chain, *own)
    else:
        value = np.zeros((len(lane), len(e.gauges), 0))
        times = 1 + len(layout.other("clock")) + len(layout.other("delay"))
        timing = np.zeros((len(rated), times, len(e.gauges), 0))
    value, timing = (e.noise_whitened(runs[0], x) for x in (value, timing))
    parts = (x.reshape(len(runs), len(x) // len(runs), *x.shape[1:]) for x in (value, timing))
    return dict(zip(runs, zip(*parts, strict=True), strict=True))
