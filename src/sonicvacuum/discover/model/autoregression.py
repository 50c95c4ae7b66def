"""Noise of any spectrum, as an autoregression: what samples before it foretell of one, and what they do not.

Predictors of every order follow from partial autocorrelations, and these from an autocorrelation, by the
recursion of Levinson (J. Math. Phys. 25, 261, 1947). What is not foretold is white.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from sonicvacuum.discover.correlation import correlated

# Orders from which on transforms are faster than sums.
_MANY = 32


@dataclass(frozen=True)
class Autoregression:
    """Stationary noise.

    Attributes:
        reflections: partial autocorrelations at the lags 1, 2, …, below 1 in size.
        free: how many of them were chosen freely; the others follow from these and from a law.
        scale: its standard deviation. All else is told of noise of variance 1.
    """

    reflections: tuple[float, ...]
    free: int
    scale: float = 1.0

    @property
    def order(self) -> int:
        """From how many samples before it one is foretold."""
        return len(self.reflections)

    @cached_property
    def innovations(self) -> np.ndarray:
        """(1 + order,) variance of what 0, 1, … samples before one do not foretell."""
        return np.cumprod([1.0, *(1.0 - k * k for k in self.reflections)])

    @cached_property
    def predictors(self) -> np.ndarray:
        """(1 + order, order) weights of the last samples, the nearest first; row m is of the last m alone."""
        found = np.zeros((1 + self.order, self.order))
        for m, k in enumerate(self.reflections):
            found[m + 1, :m] = found[m, :m] - k * found[m, :m][::-1]
            found[m + 1, m] = k
        return found

    def correlations(self, n: int) -> np.ndarray:
        """(n,) autocorrelation at the lags 0, 1, …"""
        return _correlations(replace(self, scale=1.0), 1 << max(n - 1, 1).bit_length())[:n]

    def error_of_mean(self, n: int) -> float:
        """Standard error of the mean of so many samples."""
        return self._error(np.full(n, 1.0 / n))

    def error_of_slope(self, n: int) -> float:
        """Standard error of the slope, per sample, of a straight line through so many samples."""
        place = np.arange(n) - 0.5 * (n - 1)
        return self._error(place / (place @ place))

    def about_line(self, n: int) -> tuple[float, float]:
        """Standard deviation of so many samples about a straight line, and the standard error of its
        logarithm, that of samples about no line (M. S. Bartlett, J. R. Stat. Soc. Suppl. 8, 27, 1946).
        """
        place = np.arange(n) - 0.5 * (n - 1)
        taken = sum(self._error(v / math.sqrt(v @ v)) ** 2 for v in (np.ones(n), place))
        left = max(n * self.scale**2 - taken, 1e-12)
        r = self.correlations(n)
        free = self.scale**2 * math.sqrt(n + 2.0 * float((n - np.arange(1, n)) @ np.square(r[1:])))
        return math.sqrt(left / (n - 2)), free / left / math.sqrt(2.0)

    def _error(self, weights):
        """Standard error of a sum of neighbouring samples times (n,) weights."""
        own = correlated(weights, weights)[len(weights) - 1 :]
        total = own[0] + 2.0 * float(own[1:] @ self.correlations(len(weights))[1:])
        return self.scale * math.sqrt(max(total, 0.0))

    @cached_property
    def first(self) -> np.ndarray:
        """(order, order) lower triangle that makes independent numbers of the first samples."""
        triangle = np.zeros((self.order, self.order))
        for m in range(self.order):
            triangle[m, :m] = -self.predictors[m, :m][::-1]
            triangle[m, m] = 1.0
        return triangle / (self.scale * np.sqrt(self.innovations[:-1, None]))

    def whitened(self, noise: np.ndarray, at: np.ndarray | None = None) -> np.ndarray:
        """(…, n) independent numbers of variance 1 from (…, n) samples, one after another or at the places
        (n,) `at`, which rise.
        """
        if at is not None and len(at) and at[-1] - at[0] >= len(at):
            return _summed(noise, _beside_gaps(self, at.tobytes()))
        if not self.order:
            return noise / self.scale
        few = min(self.order, noise.shape[-1])
        beginning = noise[..., :few] @ self.first[:few, :few].T
        if few == noise.shape[-1]:
            return beginning
        white = _filtered(noise, self._filter)
        white[..., :few] = beginning
        return white

    @cached_property
    def _filter(self):
        """(1 + order,) what a sample and those before it are multiplied by."""
        return np.append(1.0, -self.predictors[-1]) / (self.scale * math.sqrt(self.innovations[-1]))


@lru_cache(maxsize=64)
def _correlations(noise: Autoregression, n: int) -> np.ndarray:
    found = np.zeros(n)
    found[0] = 1.0
    for lag in range(1, n):
        m = min(lag - 1, noise.order)
        found[lag] = noise.predictors[m, :m] @ found[lag - m : lag][::-1]
        if lag <= noise.order:
            found[lag] += noise.reflections[lag - 1] * noise.innovations[lag - 1]
    return found


def _filtered(noise, filter_):
    """(…, n) convolution of (…, n) samples with (m,) a filter, as long as they are."""
    n = noise.shape[-1]
    if len(filter_) <= _MANY:
        return _summed(noise, np.repeat(filter_[:, None], n, axis=1))
    size = 1 << (n + len(filter_) - 2).bit_length()
    product = np.fft.rfft(noise, size) * np.fft.rfft(filter_, size)
    return np.fft.irfft(product, size)[..., :n]


def _summed(noise, weights):
    """(…, n) sums of samples and those before them times (m, n) weights: row k is for the k-th before."""
    white = weights[0] * noise
    for back in range(1, min(len(weights), noise.shape[-1])):
        white[..., back:] += weights[back, back:] * noise[..., :-back]
    return white


@lru_cache(maxsize=64)
def _beside_gaps(noise: Autoregression, places: bytes) -> np.ndarray:
    """(m, n) what samples at some places and those before them are multiplied by.

    Each is foretold from the nearest `_MANY` at most that are there, by what these tell at their distances
    (Vecchia, J. R. Stat. Soc. B 50, 297, 1988).
    """
    at = np.frombuffer(places, dtype=int)
    near = min(noise.order, _MANY)
    result, known = np.zeros((1 + near, len(at))), {}
    for k in range(len(at)):
        before = tuple(int(b) for b in (at[k] - at[max(0, k - near) : k])[::-1])
        if before not in known:
            known[before] = _foretold(noise, before)
        result[: 1 + len(before), k] = known[before]
    return result


def _foretold(noise, before):
    """(1 + m,) weights that make an independent number of a sample and those so long `before`."""
    far = np.array((0, *before))
    alike = noise.correlations(1 + int(far.max()))[np.abs(np.subtract.outer(far, far))]
    weights = np.linalg.solve(alike[1:, 1:] + 1e-12 * np.eye(len(before)), alike[0, 1:])
    left = max(1.0 - float(weights @ alike[0, 1:]), float(noise.innovations[-1]))
    return np.append(1.0, -weights) / (noise.scale * math.sqrt(left))


def from_correlations(correlations: Sequence[float] | np.ndarray, free: int) -> Autoregression:
    """The autoregression of (1 + order,) autocorrelations at the lags 0, 1, …"""
    r = np.asarray(correlations) / correlations[0]
    weights, left, found = np.zeros(0), 1.0, []
    for lag in range(1, len(r)):
        k = float(r[lag] - weights @ r[lag - 1 : 0 : -1]) / left
        weights = np.append(weights - k * weights[::-1], k)
        left *= 1.0 - k * k
        found.append(k)
    return Autoregression(tuple(found), free)
