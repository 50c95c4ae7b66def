"""Verdicts on records with smooth systematic errors or several effects: a row for each, shares of them."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from sonicvacuum_blind.extra_cases import SIZES
from sonicvacuum_blind.score import UNKNOWN, SummaryLine, cases, confidently, load, whole
from sonicvacuum_blind.shares import counted_of, quantile
from sonicvacuum_blind.stated import of_named

# What is hidden can be told from all else where an ideal test sees it by this d′.
TELLING = 5.0
CURE = "give truths of sonicvacuum blind extras, and verdicts of discover on their records"


@dataclass(frozen=True)
class ExtraRow:
    """One record. Truths: 1 or 0; numbers that do not apply are NaN.

    Attributes:
        id, kind, effects, size: what was made; `size` of the systematic error as a share of the peak.
        d_prime: wanted, of each effect, systematic errors aside.
        reached: least d′ of the effects as hidden.
        ideal: the d′ that an ideal test sees: beside the systematic error, whose covariance it knows; of a
            set, beside what comes of it if one effect is taken away or exchanged.
        named, confidence: verdict, joined by `+`, and its probability.
        found: all that is hidden is named.
        exact: and nothing else but unknown.
        wrong: an effect is named that is not hidden.
        wrong_class: such an effect that the verdict does not call confusable with a hidden one.
        confident_wrong: such a name with probability 0.9 or more and no word of unknown.
        says_unknown: the verdict holds unknown.
        before, after: mean squared residual over noise, fitted, without and with what is named.
        floor: what is left of noise and systematic error with the true effects known.
        closed: (before − after)/(before − floor), at most 1.
        seconds: of the verdict.
    """

    id: str
    kind: str
    effects: str
    size: float
    d_prime: float
    reached: float
    ideal: float
    named: str
    confidence: float
    found: int
    exact: int
    wrong: int
    wrong_class: int
    confident_wrong: int
    says_unknown: int
    before: float
    after: float
    floor: float
    closed: float
    seconds: float

    @property
    def telling(self) -> bool:
        """Whether an ideal test could name what is hidden."""
        return self.ideal >= TELLING


def score(truth_folder, verdict_folder, partly: bool = False) -> list[ExtraRow]:
    """Rows of all cases below a folder of truths, by kind, size and strength.

    Args:
        truth_folder: of truths.
        verdict_folder: of verdicts.
        partly: leave out cases that have no verdict yet.

    Raises:
        InputError: where a case has no verdict, or its truth is not one of extras.
    """
    rows = []
    for truth, verdict in cases(truth_folder, verdict_folder, partly):
        with whole(f"{verdict} (truth: {truth})", CURE):
            rows.append(row(load(truth), load(verdict)))
    return sorted(rows, key=lambda r: (r.kind, r.size, r.d_prime, r.effects, r.id))


def row(truth: dict, verdict: dict) -> ExtraRow:
    """One case.

    Raises:
        KeyError, TypeError, ValueError: where truth or verdict is not whole.
    """
    effects, named = truth["effects"], verdict["named"]
    claimed = [n for n in named if n != UNKNOWN]
    wrong = [n for n in claimed if n not in effects]
    fitted = verdict["gap"]["fitted"]
    floor = 1.0 + truth["chi2_systematic"]
    ideal = truth["d_prime_exchanged"] if truth["kind"] == "set" else truth["d_prime_beside"]
    return ExtraRow(
        id=truth["id"],
        kind=truth["kind"],
        effects="+".join(effects),
        size=float(truth["size"]),
        d_prime=float(truth["d_prime"]),
        reached=min(truth["d_prime_hidden"], default=0.0),
        ideal=float(ideal),
        named="+".join(named),
        confidence=of_named(verdict),
        found=int(set(effects) <= set(claimed)),
        exact=int(set(effects) == set(claimed)),
        wrong=int(bool(wrong)),
        wrong_class=int(any(not _alike(n, effects, verdict["confusable"]) for n in wrong)),
        confident_wrong=int(UNKNOWN not in named and confidently(verdict["probabilities"], wrong)),
        says_unknown=int(UNKNOWN in named),
        before=fitted["before"],
        after=fitted["after"],
        floor=floor,
        closed=_closed(fitted, floor) if effects else math.nan,
        seconds=float(verdict["timing_s"]["total"]),
    )


def _alike(name, effects, confusable):
    """Whether a verdict calls an effect confusable with one that is hidden."""
    return any({name, e} <= set(group) for group in confusable for e in effects)


def _closed(fitted, floor):
    """Share of the gap down to the floor that is closed; NaN where the hidden effects make none."""
    gap = fitted["before"] - floor
    return min(1.0, (fitted["before"] - fitted["after"]) / gap) if gap > 0.0 else math.nan


def summary(rows: Iterable[ExtraRow]) -> list[SummaryLine]:
    """Shares with their 95 % intervals (Wilson): with systematic errors, by size, and of sets; seconds."""
    rows = list(rows)
    smooth, sets = [r for r in rows if r.kind != "set"], [r for r in rows if r.kind == "set"]
    lines = [*_smooth(smooth, "systematic errors")]
    for size in SIZES:
        lines += _smooth([r for r in smooth if r.size == size], f"{100.0 * size:g} %")
    telling = [r for r in sets if r.telling]
    for group, own in (("sets", sets), (f"sets of d′ ≥ {TELLING:g} to an ideal test", telling)):
        lines.append(counted_of("all found", group, own, "found", ">= 0.75"))
        lines.append(counted_of("wrong name", group, own, "wrong", "<= 0.05"))
        lines.append(counted_of("exactly these", group, own, "exact"))
    closed = _quantile("gap closed, median", "sets", [r.closed for r in sets], 0.5)
    seconds = [r.seconds for r in rows]
    return [
        *lines,
        closed,
        _quantile("seconds per record, median", "all", seconds, 0.5),
        _quantile("seconds per record, 90th percentile", "all", seconds, 0.9),
    ]


def _smooth(rows, group):
    """Lines of records with systematic errors."""
    singles, nulls = [r for r in rows if r.kind == "single"], [r for r in rows if r.kind == "null"]
    telling = [r for r in singles if r.telling]
    named = [r for r in singles if r.found]
    return [
        counted_of("wrong name", f"{group}, nulls and singles", rows, "wrong", "<= 0.02"),
        counted_of("wrong name", f"{group}, nulls", nulls, "wrong"),
        counted_of("wrong name not called confusable", f"{group}, nulls and singles", rows, "wrong_class"),
        counted_of("confident wrong name", f"{group}, nulls and singles", rows, "confident_wrong"),
        counted_of("truth among what is named", f"{group}, singles", singles, "found", ">= 0.9"),
        counted_of(
            "truth among what is named",
            f"{group}, singles of d′ ≥ {TELLING:g} beside it",
            telling,
            "found",
            ">= 0.9",
        ),
        _quantile("gap to the floor closed, median", f"{group}, truth named", [r.closed for r in named], 0.5),
    ]


def _quantile(measure, group, values, level):
    return SummaryLine(measure, group, *quantile(values, level))
