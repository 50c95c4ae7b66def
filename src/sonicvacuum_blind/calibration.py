"""Whether what is stated comes true: probabilities of names, and posterior probabilities of parameters."""

import math
from collections.abc import Callable, Iterable, Mapping

import numpy as np
import scipy

from sonicvacuum_blind.score import Row

BINS = 10
RESAMPLES = 500
# Base rates of kinds of record unlike those of the study, to which its records are weighed.
BASE_RATES: Mapping[str, Mapping[str, float]] = {
    "half empty": {"null": 0.5, "single": 0.4, "pair": 0.05, "foreign": 0.05},
    "nine in ten empty": {"null": 0.9, "single": 0.08, "pair": 0.01, "foreign": 0.01},
    "a third foreign": {"null": 0.2, "single": 0.4, "pair": 0.05, "foreign": 0.35},
}


def bin_of(row: Row) -> int:
    """Which of the bins the probability of the name given falls in."""
    return min(int(row.stated * BINS), BINS - 1)


def ece(rows: Iterable[Row], rates: Mapping[str, float] | None = None) -> tuple[int, float, float, float]:
    """(count, error, low, high): mean distance of stated probabilities of names given from shares right.

    In ten bins, weighed by the records in them; with base rates, each kind of record weighs as much as these
    say. An error without sign is on average a little larger than the true one, so that it errs to the
    unfavourable side.
    """
    rows = list(rows)
    if not rows:
        return 0, math.nan, math.nan, math.nan
    sizes = {kind: sum(r.kind == kind for r in rows) for kind in {r.kind for r in rows}}
    weight = np.array([rates[r.kind] / sizes[r.kind] if rates else 1.0 for r in rows])
    place = np.array([bin_of(r) for r in rows])
    off = np.array([r.stated - r.exact for r in rows])

    def error(index):
        sums = np.bincount(place[index], weight[index] * off[index], BINS)
        return float(np.abs(sums).sum() / weight[index].sum())

    return len(rows), *resampled(error, len(rows))


def honest(rows: Iterable[Row]) -> tuple[int, float, float, float]:
    """(count, error, low, high): the mean of `ece`, and 95 % of its values, if every probability of a name
    given came true as stated: what chance alone makes of so many records.
    """
    rows, random = list(rows), np.random.default_rng(np.random.SeedSequence(20061))
    if not rows:
        return 0, math.nan, math.nan, math.nan
    stated, place = np.array([(r.stated, bin_of(r)) for r in rows]).T
    off = stated - (random.random((RESAMPLES, len(rows))) < stated)
    errors = sum(np.abs(off[:, place == k].sum(axis=1)) for k in range(BINS)) / len(rows)
    return len(rows), float(errors.mean()), *map(float, np.quantile(errors, [0.025, 0.975]))


def resampled(statistic: Callable[[np.ndarray], float], count: int) -> tuple[float, float, float]:
    """A statistic of records (by their places), which is not negative, with its 95 % interval from resampled
    records, shifted so that their mean is the statistic: resampling alone makes errors without sign larger.
    """
    random = np.random.default_rng(np.random.SeedSequence(20061))
    if not count:
        return math.nan, math.nan, math.nan
    with np.errstate(invalid="ignore", divide="ignore"):
        found = [statistic(random.integers(count, size=count)) for _ in range(RESAMPLES)]
        value = float(statistic(np.arange(count)))
        low, high = np.nanquantile(found, [0.025, 0.975]) - np.nanmean(found) + value
    return value, max(float(low), 0.0), float(high)


def band(count: int, groups: int = 1) -> float:
    """Half width of the band that holds the ECDF of uniform numbers everywhere in 95 % of samples, in all of
    so many groups at once: Kolmogorov's distribution for `count` numbers (scipy.stats.kstwo), the level
    divided by Šidák's rule.
    """
    return float(scipy.stats.kstwo.ppf(0.95 ** (1.0 / groups), count)) if count else math.nan


def distance(pit: Iterable[float]) -> float:
    """Largest distance of the ECDF of numbers in 0 to 1 from the diagonal, Kolmogorov's statistic."""
    x = np.sort(list(pit))
    steps = np.arange(len(x) + 1) / max(len(x), 1)
    return float(max(np.max(steps[1:] - x), np.max(x - steps[:-1]))) if len(x) else math.nan
