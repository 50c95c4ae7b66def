"""A study's scores in detail: what is taken for what, accuracy against d′, reliability, coverage, time.

Each function makes the rows of one CSV; the figures are drawn from these files and from nothing else.
"""

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from sonicvacuum_blind import catalogue, design
from sonicvacuum_blind.calibration import BINS, band, bin_of, distance
from sonicvacuum_blind.score import NONE, UNKNOWN, Row
from sonicvacuum_blind.shares import quantile, share, strength_bin
from sonicvacuum_blind.stated import Parameter
from sonicvacuum_blind.study import STRENGTHS

KINDS = ("single", "pair", "set", "null", "foreign")
# Kinds of which one name is right: an effect, none or unknown.
ONE_NAME = ("single", "null", "foreign")
LEVELS = (0.5, 0.8, 0.9, 0.95)
# More than one effect, or an effect and a rest that nothing explains.
SEVERAL = "several"


@dataclass(frozen=True)
class Confusion:
    """How many cases with `hidden` were given the name `named`, and the share of all with `hidden`."""

    hidden: str
    named: str
    count: int
    share: float


@dataclass(frozen=True)
class Accuracy:
    """Singles of one design and strength: exact and class-level names with 95 % intervals, and the ceiling.

    `d_prime` is the median reached in the bin; `strength` the bin's nominal one, 0 for less than 2.4.
    """

    design: str
    strength: float
    d_prime: float
    count: int
    exact: float
    exact_low: float
    exact_high: float
    class_level: float
    class_low: float
    class_high: float
    ideal: float


@dataclass(frozen=True)
class Bin:
    """Verdicts that give the name (or names) given a probability from `low_edge` to `high_edge`: the mean of
    what they state, and the share that is right with its 95 % interval.
    """

    low_edge: float
    high_edge: float
    stated: float
    count: int
    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Coverage:
    """Share of central intervals of one level that hold the truth, of an effect's parameters (`all`: of all)
    where it is hidden and named.
    """

    effect: str
    level: float
    count: int
    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Pit:
    """Posterior probabilities below the truth, of an effect's parameters (`all`: of all).

    Attributes:
        effect, count: whose, and how many.
        distance: largest distance of their ECDF from the diagonal.
        band: what that is below in 95 % of studies with right intervals, in all effects at once.
        inside: whether it is; empty without parameters.
        offset: mean of (stated value − truth) / standard error, zero where nothing is biased.
        ecdf: the ECDF at 0.01, 0.02 … 0.99, in words `0.004 0.021 …`.
    """

    effect: str
    count: int
    distance: float
    band: float
    inside: str
    offset: float
    ecdf: str


@dataclass(frozen=True)
class Seconds:
    """Time per record of one kind in seconds: median, 90th percentile, largest."""

    kind: str
    count: int
    median: float
    percentile_90: float
    largest: float


def label_of_truth(row: Row) -> str:
    """The name that would be right: an effect, none or unknown."""
    return {"null": NONE, "foreign": UNKNOWN}.get(row.kind, row.effects)


def label_of_verdict(row: Row) -> str:
    """The name given; `several` where more than one is."""
    names = row.named.split("+") if row.named else [NONE]
    return names[0] if len(names) == 1 else SEVERAL


def confusion(rows: Iterable[Row]) -> list[Confusion]:
    """All combinations of what is hidden (22 effects, none, unknown) with what is named (and several), in the
    main list.
    """
    hidden = [*(e.id for e in catalogue.ENTRIES), NONE, UNKNOWN]
    chosen = [r for r in rows if r.kind in ONE_NAME and not r.added]
    counts = Counter((label_of_truth(r), label_of_verdict(r)) for r in chosen)
    total = Counter(label_of_truth(r) for r in chosen)
    return [
        Confusion(h, n, counts[h, n], counts[h, n] / total[h] if total[h] else math.nan)
        for h in hidden
        for n in (*hidden, SEVERAL)
    ]


def accuracy(rows: Iterable[Row]) -> list[Accuracy]:
    """Singles by design and strength, groups without cases left out."""
    singles = [r for r in rows if r.kind == "single"]
    groups = {
        (d, s): [r for r in singles if r.design == d and strength_bin(r) == s]
        for d in design.KINDS
        for s in (0.0, *STRENGTHS)
    }
    return [_accuracy(*key, group) for key, group in groups.items() if group]


def _accuracy(design, strength, rows):
    count = len(rows)
    exact = share(sum(r.exact for r in rows), count)
    alike = share(sum(r.class_level for r in rows), count)
    middle = float(np.median([r.reached for r in rows]))
    return Accuracy(design, strength, middle, count, *exact, *alike, ideal_share(rows))


def ideal_share(rows: Iterable[Row]) -> float:
    """Mean share that the ideal rule names rightly, NaN where no case has one."""
    known = [r.ideal for r in rows if not math.isnan(r.ideal)]
    return float(np.mean(known)) if known else math.nan


def reliability(rows: Iterable[Row]) -> list[Bin]:
    """Ten bins of the probability of the name given, of the main list."""
    bins = [[] for _ in range(BINS)]
    for row in rows:
        if not row.added:
            bins[bin_of(row)].append((row.stated, row.exact))
    return [_bin(k, members) for k, members in enumerate(bins)]


def _bin(place, members):
    stated = float(np.mean([m[0] for m in members])) if members else math.nan
    right = share(sum(m[1] for m in members), len(members))
    return Bin(place / BINS, (place + 1) / BINS, stated, len(members), *right)


def coverage(parameters: Iterable[Parameter]) -> list[Coverage]:
    """By effect and level; all intervals together first."""
    found = []
    for name, group in _by_effect(parameters).items():
        for level in LEVELS:
            hits = sum(abs(p.pit - 0.5) <= 0.5 * level for p in group)
            found.append(Coverage(name, level, len(group), *share(hits, len(group))))
    return found


def pit(parameters: Iterable[Parameter]) -> list[Pit]:
    """By effect; all together first, held against a band of their own."""
    groups = _by_effect(parameters)
    filled = sum(bool(group) for name, group in groups.items() if name != "all")
    at, found = np.linspace(0.01, 0.99, 99), []
    for name, group in groups.items():
        numbers = np.array([p.pit for p in group])
        far, limit = distance(numbers), band(len(group), 1 if name == "all" else max(filled, 1))
        inside = ("yes" if far <= limit else "no") if group else ""
        offset = float(np.mean([(p.value - p.truth) / p.sigma for p in group])) if group else math.nan
        ecdf = " ".join(f"{np.mean(numbers <= x):.4g}" for x in at) if group else ""
        found.append(Pit(name, len(group), far, limit, inside, offset, ecdf))
    return found


def _by_effect(parameters):
    """Name → parameters: `all`, and each effect's first of every record: others are not independent."""
    parameters = list(parameters)
    first = {(p.id, p.effect): p for p in reversed(parameters)}.values()
    return {"all": parameters} | {
        e.id: sorted((p for p in first if p.effect == e.id), key=lambda p: p.id) for e in catalogue.ENTRIES
    }


def seconds(rows: Iterable[Row]) -> list[Seconds]:
    """By kind of case, of the main list."""
    rows = [r for r in rows if not r.added]
    found = []
    for kind in KINDS:
        times = [r.seconds for r in rows if r.kind == kind and not math.isnan(r.seconds)]
        largest = max(times, default=math.nan)
        found.append(Seconds(kind, len(times), quantile(times, 0.5)[1], quantile(times, 0.9)[1], largest))
    return found


# File name → (class of its rows, function that makes them).
TABLES = {
    "confusion": (Confusion, confusion),
    "accuracy": (Accuracy, accuracy),
    "reliability": (Bin, reliability),
    "seconds": (Seconds, seconds),
}
# The same of stated intervals.
INTERVALS = {"parameters": (Parameter, list), "coverage": (Coverage, coverage), "pit": (Pit, pit)}
