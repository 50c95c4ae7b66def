"""Shares and quantiles of the cases of a study with their 95 % intervals."""

import math
from collections.abc import Iterable

import numpy as np
import scipy

from sonicvacuum_blind.score import Row, SummaryLine
from sonicvacuum_blind.study import STRENGTHS

CONFIDENCE = 0.95


def wilson(successes: int, count: int) -> tuple[float, float]:
    """95 % interval of a share (Wilson 1927; scipy.stats.binomtest); NaN without cases."""
    if not count:
        return math.nan, math.nan
    interval = scipy.stats.binomtest(successes, count).proportion_ci(CONFIDENCE, method="wilson")
    return float(interval.low), float(interval.high)


def share(hits: int, count: int) -> tuple[float, float, float]:
    """A share with its interval; NaN without cases."""
    return (hits / count if count else math.nan, *wilson(hits, count))


def counted(measure: str, group: str, hits: Iterable[int], goal: str = "") -> SummaryLine:
    """A line of a summary: the share of ones among hits, 1 or 0 for each case."""
    hits = list(hits)
    return SummaryLine(measure, group, len(hits), *share(int(sum(hits)), len(hits)), goal=goal)


def counted_of(measure: str, group: str, rows: Iterable, what: str, goal: str = "") -> SummaryLine:
    """The same of an attribute of rows, 1 or 0."""
    return counted(measure, group, (int(getattr(row, what)) for row in rows), goal)


def quantile(values, level: float) -> tuple[int, float, float, float]:
    """(count, quantile, low, high) of those values that are not NaN.

    The interval is that of the order statistics, without assumption on the distribution (David & Nagaraja,
    Order Statistics, 3rd ed., Eq. 7.1.2); its ends are cut to the sample.
    """
    values = np.sort([v for v in values if not math.isnan(v)])
    n = len(values)
    if not n:
        return 0, math.nan, math.nan, math.nan
    below, above = scipy.stats.binom.ppf([0.5 - CONFIDENCE / 2.0, 0.5 + CONFIDENCE / 2.0], n, level).astype(
        int
    )
    return n, float(np.quantile(values, level)), float(values[below]), float(values[min(above, n - 1)])


def ratio_of_sums(upper: np.ndarray, lower: np.ndarray) -> tuple[float, float, float]:
    """Σ upper / Σ lower over cases (n,), with its interval from resampled cases (scipy.stats.bootstrap)."""
    if len(lower) < 2:
        return (float(upper.sum() / lower.sum()) if len(lower) else math.nan, math.nan, math.nan)
    # The standard error, which scipy works out besides, does not exist where a resample gives infinity.
    with np.errstate(invalid="ignore"):
        found = scipy.stats.bootstrap(
            (upper, lower),
            _ratio,
            paired=True,
            vectorized=True,
            confidence_level=CONFIDENCE,
            method="percentile",
            rng=np.random.default_rng(np.random.SeedSequence(20061)),
        )
    interval = found.confidence_interval
    return float(upper.sum() / lower.sum()), float(interval.low), float(interval.high)


def _ratio(upper, lower, axis):
    above, below = upper.sum(axis=axis), lower.sum(axis=axis)
    # A resample may hold none of the cases that count below.
    return np.divide(above, below, out=np.full(np.shape(above), math.inf), where=below != 0.0)


def strength_bin(row: Row) -> float:
    """The study's strength that is nearest to the d′ reached, on a logarithmic scale; 0 below 2.4."""
    d_prime = row.reached
    return min(STRENGTHS, key=lambda s: abs(math.log(d_prime / s))) if d_prime >= 2.4 else 0.0
