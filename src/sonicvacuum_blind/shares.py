"""Shares and quantiles of the cases of a study with their 95 % intervals.

What `scipy.stats` has of this is a line of `scipy.special` each; to load it takes a second of every verb.
"""

import math
from collections.abc import Iterable

import numpy as np
import scipy

from sonicvacuum_blind.score import Line, Row
from sonicvacuum_blind.study import STRENGTHS

CONFIDENCE = 0.95
RESAMPLES = 9999


def wilson(successes: int, count: int) -> tuple[float, float]:
    """95 % interval of a share (Wilson, J. Am. Stat. Assoc. 22, 209, 1927), as scipy.stats.binomtest has it;
    NaN without cases.
    """
    if not count:
        return math.nan, math.nan
    z, p = scipy.special.ndtri(0.5 + 0.5 * CONFIDENCE), successes / count
    whole = 2.0 * (count + z**2)
    centre = (2.0 * count * p + z**2) / whole
    away = z / whole * math.sqrt(4.0 * count * p * (1.0 - p) + z**2)
    low, high = centre - away if successes else 0.0, centre + away if successes < count else 1.0
    return float(low), float(high)


def share(hits: int, count: int) -> tuple[float, float, float]:
    """A share with its interval; NaN without cases."""
    return (hits / count if count else math.nan, *wilson(hits, count))


def counted(measure: str, group: str, hits: Iterable[int], goal: str = "") -> Line:
    """A line of a summary: the share of ones among hits, 1 or 0 for each case."""
    hits = list(hits)
    return Line(measure, group, len(hits), *share(int(sum(hits)), len(hits)), goal=goal)


def quantile(values, level: float) -> tuple[int, float, float, float]:
    """(count, quantile, low, high) of those values that are not NaN.

    The interval is that of the order statistics, without assumption on the distribution (David & Nagaraja,
    Order Statistics, 3rd ed., Eq. 7.1.2); its ends are cut to the sample.
    """
    values = np.sort([v for v in values if not math.isnan(v)])
    n = len(values)
    if not n:
        return 0, math.nan, math.nan, math.nan
    below, above = (_binomial_quantile(0.5 + side * CONFIDENCE / 2.0, n, level) for side in (-1, 1))
    return n, float(np.quantile(values, level)), float(values[below]), float(values[min(above, n - 1)])


def _binomial_quantile(probability, n, share):
    """Least number of n cases, each taken with this chance, that is not exceeded with that probability."""
    found = math.ceil(scipy.special.bdtrik(probability, n, share))
    # Where a step of the distribution meets the probability, rounding may put the inverse beyond it.
    return found - 1 if found and scipy.special.bdtr(found - 1.0, n, share) >= probability else found


def ratio_of_sums(upper: np.ndarray, lower: np.ndarray) -> tuple[float, float, float]:
    """Σ upper / Σ lower over cases (n,), with its interval from resampled cases: percentiles of the
    bootstrap, as scipy.stats.bootstrap has them.
    """
    count = len(lower)
    if count < 2:
        return (float(upper.sum() / lower.sum()) if count else math.nan, math.nan, math.nan)
    drawn = np.random.default_rng(np.random.SeedSequence(20061)).integers(count, size=(RESAMPLES, count))
    above, below = upper[drawn].sum(axis=1), lower[drawn].sum(axis=1)
    # A resample may hold none of the cases that count below.
    ratio = np.sort(np.divide(above, below, out=np.full(RESAMPLES, math.inf), where=below != 0.0))
    low, high = (_between(ratio, 0.5 + side * CONFIDENCE / 2.0) for side in (-1, 1))
    return float(upper.sum() / lower.sum()), low, high


def _between(ordered, level):
    """Quantile of sorted numbers, linear between neighbours, which may be infinite."""
    place = level * (len(ordered) - 1)
    whole = int(place)
    part = place - whole
    return float((1.0 - part) * ordered[whole] + part * ordered[whole + 1])


def strength_bin(row: Row) -> float:
    """The study's strength that is nearest to the d′ reached, on a logarithmic scale; 0 below 2.4."""
    return bin_of(row.reached)


def bin_of(d_prime: float) -> float:
    """The same of a number."""
    return min(STRENGTHS, key=lambda s: abs(math.log(d_prime / s))) if d_prime >= 2.4 else 0.0
