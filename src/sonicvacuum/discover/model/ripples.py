"""What differences of all samples say of a trace's noise: smooth signals hardly move them, and the higher
their order the less.

Noise of variance 1 whose neighbours are correlated (ρᵏ at every lag k) has differences of a known mean square
at every order. Two orders in a row show the same ρ within `_SAME` of its standard error over the order, and
another one where signals show in them, or for noise of another kind (of a low-pass, or with white noise
beside it): drawn noise, ρ up to 0.95.
"""

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

# Differences of this order hold nothing of a pulse of eight samples or more.
CLEAR = 6
# Orders of differences that are tried, the first one first; each is held against the next.
ORDERS = (3, 4, 5, 6, 7)
_NEIGHBOURS = np.linspace(-0.9, 0.995, 400)
_SAME = 0.51
# Neighbours of n samples are correlated surely from so many standard errors, 1/√n, on.
_SURE = 4.0
# Mean square and median agree within so many standard errors, and two orders as well.
AGREE = 3.0


@lru_cache(maxsize=16)
def _weights(order):
    """(order + 1,) sums of products of a difference's coefficients, such as 1, −3, 3, −1, with themselves at
    every lag: 20, −15, 6, −1.
    """
    steps = np.diff(np.eye(order + 1), order, axis=0)[0]
    return np.correlate(steps, steps, "full")[order:]


@lru_cache(maxsize=16)
def _power(order):
    """Mean square of differences of an order as a polynomial of ρ."""
    own, *others = _weights(order)
    return np.polynomial.Polynomial((own, *(2.0 * other for other in others)))


def differenced(correlations: np.ndarray, order: int) -> np.ndarray:
    """(n − order,) autocovariance at the lags 0, 1, … of differences of noise of variance 1.

    Args:
        correlations: (n,) its autocorrelation at the lags 0, 1, …
        order: of the differences.
    """
    own = _weights(order)
    both = np.concatenate([correlations[:0:-1], correlations])
    found = np.convolve(both, np.concatenate([own[:0:-1], own]), "valid")
    return found[len(found) // 2 :]


def share(order: int) -> float:
    """So many differences of white noise are worth one independent sample: 1 + 2 (15² + 6² + 1)/20² of third
    ones.
    """
    own, *others = _weights(order)
    return 1.0 + 2.0 * float(np.square(others).sum()) / float(own) ** 2


def ripple(traces: Sequence[np.ndarray], sigma: float, of_sigma: float) -> tuple[float, float]:
    """Correlation of neighbours that differences of traces show, and its variance; infinite where spikes or
    noise of another kind show in them, or signals that are not smooth. `of_sigma` is the relative variance of
    σ², of white noise.

    Third differences tell it, or the lowest order without signals, which make noise look less correlated
    than the next order does.
    """
    before = -1.0
    for order in ORDERS:
        each = [np.diff(t / sigma, order) for t in traces]
        steps, finer = np.concatenate(each), np.concatenate([np.diff(one) for one in each])
        if not len(finer):
            break
        power, error = float(steps @ steps) / len(steps), 2.0 * share(order) / len(steps)
        median = (float(np.median(np.abs(steps))) / 0.6745) ** 2
        rho, again = shown(power, order), shown(float(finer @ finer) / len(finer), order + 1)
        scale = abs(power / _power(order).deriv()(rho))
        # A median errs 1.65 times as much as a mean square, of which it is not independent.
        spiky = abs(median - power) > AGREE * 1.31 * math.sqrt(error) * power
        if not spiky and abs(again - rho) <= AGREE * _SAME / order * scale * math.sqrt(error):
            return rho, scale**2 * (error + of_sigma * (1.0 + rho**2) / (1.0 - rho**2))
        if not before < rho < again:
            break
        before = rho
    return 0.0, math.inf


def shown(power: float, order: int) -> float:
    """Correlation of neighbours that the mean square of differences of an order shows, σ being 1."""
    return float(np.interp(power, _power(order)(_NEIGHBOURS)[::-1], _NEIGHBOURS[::-1]))


def swing(traces: Sequence[np.ndarray], rho: np.ndarray) -> np.ndarray:
    """(…) standard deviation of noise whose neighbours are correlated by (…) `rho`, as differences of traces
    show it; 0 of traces that are too short.
    """
    steps = np.concatenate([np.diff(t, CLEAR) for t in traces])
    return np.sqrt(float(steps @ steps) / max(len(steps), 1) / _power(CLEAR)(np.asarray(rho)))


def of_all(
    traces: Sequence[np.ndarray], quiet: Sequence[np.ndarray], correlation: float
) -> tuple[float, float]:
    """Noise of a gauge as all its samples tell it, and how many samples at rest would tell it as well.

    Where noise is white and signals are smooth, third differences of all samples show the same noise as the
    few before the pulse, and by far more of them; both are averaged by their numbers. Where they disagree, or
    neighbours at rest show a `correlation`, only the quiet stretches count.
    """
    count = sum(map(len, quiet))
    level = math.sqrt(sum(float(q @ q) for q in quiet) / count)
    steps = np.concatenate([np.diff(t, 3) for t in traces])
    seen, worth = math.sqrt(float(steps @ steps) / len(steps) / 20.0), len(steps) / share(3)
    error = math.hypot(1.0 / math.sqrt(2.0 * count), 1.0 / math.sqrt(2.0 * worth))
    white = abs(correlation) < _SURE / math.sqrt(count)
    if white and abs(seen - level) < AGREE * error * level:
        level, count = math.sqrt((count * level**2 + worth * seen**2) / (count + worth)), count + worth
    return level, count
