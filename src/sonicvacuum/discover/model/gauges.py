"""Readings between the samples of a simulation, at the times of a recorder whose clock and channels err."""

import numpy as np

from sonicvacuum.physics.resample import BEFORE, POINTS, resampled

_OFFSETS = np.arange(POINTS) - BEFORE


def lagrange(fraction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights of `POINTS` neighbours (L, POINTS) at `fraction` of the way to the next sample, and their
    slopes.

    Lagrange polynomials; exact for polynomials of degree 5.
    """
    powers = np.vander(np.asarray(fraction, dtype=float), POINTS, increasing=True)
    return powers @ _VALUE, powers @ _SLOPE


def _coefficients():
    """(POINTS, POINTS) coefficients, by ascending power, of each neighbour's polynomial and its slope."""
    value, slope = np.zeros((2, POINTS, POINTS))
    for k, node in enumerate(_OFFSETS):
        others = np.delete(_OFFSETS, k)
        one = np.polynomial.Polynomial.fromroots(others) / np.prod(node - others)
        value[:, k], slope[:-1, k] = one.coef, one.deriv().coef
    return value, slope


_VALUE, _SLOPE = _coefficients()


def shifted(simulated: np.ndarray, interval: float, time: np.ndarray, shift: np.ndarray, rate_of: int = 1):
    """Readings at recorded times, and their time derivative.

    Args:
        simulated: (L, S, T') readings, first sample at true time 0, at rest before.
        interval: between simulated samples in s.
        time: (T,) recorded times in s, their interval a multiple of the simulated one.
        shift: (L,) trigger shift in s; recorded time = true time + shift.
        rate_of: the derivative of every so many lanes, from the first on.

    Returns:
        Arrays (L, S, T) in the gauges' units and (L / rate_of, S, T) in the same per second.
    """
    stride = round((time[-1] - time[0]) / (len(time) - 1) / interval)
    place = (time[0] - shift) / interval
    whole = np.floor(place).astype(int)
    weights, slopes = lagrange(place - whole)
    rated = slice(None, None, rate_of)
    value = resampled(simulated, whole, weights, stride, len(time))
    rate = resampled(simulated[rated], whole[rated], slopes[rated], stride, len(time))
    rate /= interval
    return value, rate


def at_record(layout, sigma, interval: float, time: np.ndarray, signals, shift, nu, rate_of: int):
    """Readings at recorded times and their slopes to time zero, clock and delays.

    The clock's error is taken to first order: it moves no sample by more than a part of a pulse.

    Args:
        layout: of the nuisances, whose standard errors are `sigma`.
        interval: between simulated samples in s.
        time: (T,) recorded times in s.
        signals: (L, S, T') simulated readings.
        shift: (L,) trigger shift in s.
        nu: (L, q) nuisances over their standard errors.
        rate_of: slopes of every so many lanes.

    Returns:
        (L, S, T) readings and (·, n, S, T) slopes.
    """
    clock, delays = layout.other("clock"), layout.other("delay")
    late = np.zeros((len(nu), signals.shape[1]))
    channels = [layout.others[k - layout.modulus - 1].gauge for k in delays]
    late[:, channels] = nu[:, delays] * sigma[delays]
    parts = [
        shifted(signals[:, own], interval, time, shift + delay, 1 if clock else rate_of)
        for own, delay in ([(slice(None), late[:, 0])] if not delays else _by_gauge(late))
    ]
    value, rate = (np.concatenate(p, axis=1) for p in zip(*parts, strict=True))
    slopes = [-rate]
    for k in clock:
        slopes.append(-rate * (time - shift[:, None])[:, None])
        value = value + (nu[:, k] * sigma[k])[:, None, None] * slopes[1]
        slopes = [s[::rate_of] for s in slopes]
    slopes += [slopes[0] * (np.arange(signals.shape[1]) == s)[:, None] for s in channels]
    return value, np.stack(slopes, axis=1)


def _by_gauge(late):
    """(slice, (L,) delay) of each gauge."""
    return [(slice(s, s + 1), late[:, s]) for s in range(late.shape[1])]
