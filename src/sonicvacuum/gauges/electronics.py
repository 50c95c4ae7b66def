"""How the electronics of a gauge shape its reading: bandwidth and droop, the same for every kind.

Daraio & Nesterenko, PRE 73, 026612 (2006) read piezoelectric gauges, which show the change from rest (the
static force has leaked away), limited by their bandwidth (a first-order low pass) and by the discharge
through their resistance (a first-order high pass, "droop"; RC about 1 ms in the paper). Both filters are
exact for a signal that is linear between samples, and so is their sequence; the low pass, whose time constant
may be as short as a sample, also for one that is bent between them as through its neighbours.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

# Equal time constants are parted by this fraction either way: errors of its square, and of rounding over it.
_EQUAL = 1e-5


def filtered(
    signal: ArrayLike,
    interval_s: float,
    lowpass_s: ArrayLike = 0.0,
    droop_s: ArrayLike = math.inf,
    high_pass: Callable[..., np.ndarray] | None = None,
) -> np.ndarray:
    """Low pass 1/(1 + s b), then high pass s d/(1 + s d), of a signal at rest before its first sample.

    The sequence equals d/(d − b) (H_d − H_b) with H the high pass, by partial fractions: no error from
    treating the low-passed signal as linear between samples. Two equal constants are parted a little about
    their mean. Off values (b = 0, d = ∞) return the signal itself, exactly.

    Args:
        signal: shape (S, ...), linear between samples; a first sample other than 0 is a jump.
        interval_s: time between samples in s.
        lowpass_s: b in s, a number or an array that broadcasts to the trailing shape of `signal`.
        droop_s: d in s, likewise; `inf`: none.
        high_pass: does what `high_passed` does, which does it where none is given.
    """
    high_pass = high_pass or high_passed
    b, d = np.asarray(lowpass_s, dtype=float), np.asarray(droop_s, dtype=float)
    filters = (b != 0.0) | np.isfinite(d)
    if not np.all(filters):
        shown = np.array(signal, dtype=float)
        if np.any(filters):
            # Of many chains side by side, a search has the gauge filter in few.
            b, d, filters = (np.broadcast_to(x, shown.shape[1:]) for x in (b, d, filters))
            shown[:, filters] = filtered(shown[:, filters], interval_s, b[filters], d[filters], high_pass)
        return shown
    equal, mean = np.abs(d - b) < _EQUAL * b, 0.5 * (b + d)
    short, long = np.where(equal, mean * (1.0 - _EQUAL), b), np.where(equal, mean * (1.0 + _EQUAL), d)
    weight = np.where(equal, d, 1.0) / np.where(equal, long, 1.0) / (1.0 - short / long)
    beyond = high_pass(signal, interval_s, long)
    if np.any(short):
        # Without a low pass there is nothing to be taken off: H_0 is 0.
        beyond -= high_pass(signal, interval_s, short, bent=True)
    return weight * beyond


def high_passed(
    signal: ArrayLike, interval_s: float, time_constant_s: ArrayLike, bent: bool = False
) -> np.ndarray:
    """First-order high pass: the exact solution of y' = x' − y/τ for x linear between samples.

    y[n + 1] = E y[n] + (1 − E)/h (x[n + 1] − x[n]), h = interval/τ, E = exp(−h), y[0] = x[0]. The recursion
    is summed by doubling its reach, log2(S) passes over whole arrays. τ = ∞ returns the signal, τ = 0 returns
    zeros. Shapes as in `filtered`.

    With `bent`, x(t) lies below the straight line by c t (1 − t)/2 over each interval, t in intervals and c
    the mean of the second differences at its ends: drawn straight, a pulse is smoother than it is, and a time
    constant of a few intervals comes out some per cent too short.
    """
    signal = np.asarray(signal, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        h = interval_s / np.asarray(time_constant_s, dtype=float)
        weight = -np.expm1(-h) / h
    response = signal.copy()
    response[1:] = weight * np.diff(signal, axis=0)
    if bent and len(signal) > 3:
        response[2:-1] += bending(h) * (signal[3:] - signal[2:-1] - signal[1:-2] + signal[:-3])
    reach, decay = 1, np.exp(-h)
    while reach < len(signal) and np.any(decay > 0.0):
        response[reach:] += decay * response[:-reach]
        reach, decay = 2 * reach, decay * decay
    return np.where(h == 0.0, signal, np.where(np.isinf(h), 0.0, response))


def bending(h):
    """¼ ∫ e^{−hu} h u (1 − u) du over an interval, u back from its end: half of c is the sum of four samples.

    A sum of exponentials that cancel where h, intervals per time constant, is small: a series there.
    """
    # Where the other branch is what counts, or h is infinite.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        whole = (h - 2.0 + (h + 2.0) * np.exp(-h)) / h**2
        series = h * (1.0 / 6.0 - h * (1.0 / 12.0 - h * (1.0 / 40.0 - h / 180.0)))
    return 0.25 * np.where(h < 0.01, series, np.where(np.isinf(h), 0.0, whole))
