"""Verdicts against truths: one row for each case, and a table of shares with 95 % intervals."""

import csv
import json
import math
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np
from scipy import stats

from sonicvacuum.blind.study import STRENGTHS
from sonicvacuum.files import InputError, replacing

CONFIDENT = 0.9
NINETY = 1.6448536269514722  # standard deviations on either side of a 90 % interval
NONE, UNKNOWN = "none", "unknown"
BINS = 10


@dataclass(frozen=True)
class Row:
    """One case. Truths: 1 or 0; numbers that do not apply are NaN.

    Attributes:
        id, kind, design, noise, effects, d_prime: as asked for; effects joined by `+`.
        reached: least d′ of the effects as hidden; 0 for null.
        leftover: d′ that no single effect of the catalogue explains.
        nearest: the other effect that explains the hidden one best.
        ideal: share of data sets of this record in which an ideal rule gives the true name (singles).
        named: verdict, joined by `+`.
        top, confidence: most probable entry of the probabilities, and its probability.
        exact: named exactly what is hidden; nothing for null, unknown for foreign.
        class_level: single named, or one that the verdict itself calls confusable with it.
        false_alarm: an effect of the catalogue was named that is not hidden.
        says_unknown: the verdict holds unknown.
        confident_wrong: such a name with probability 0.9 or more and no word of unknown.
        closed, chi2: held-out gap closed, and what is left over the floor.
        inside, intervals: stated 90 % intervals of rightly named effects that hold the truth, of so many.
        seconds, simulations: what it cost.
    """

    id: str
    kind: str
    design: str
    noise: str
    effects: str
    d_prime: float
    reached: float
    leftover: float
    nearest: str
    ideal: float
    named: str
    top: str
    confidence: float
    exact: int
    class_level: int
    false_alarm: int
    says_unknown: int
    confident_wrong: int
    closed: float
    chi2: float
    inside: int
    intervals: int
    seconds: float
    simulations: int


def score(truth_folder, verdict_folder) -> list[Row]:
    """Rows of all cases below a folder of truths, by id.

    Folders may be nested; a case is found by the name of the folder that holds its file.

    Raises:
        InputError: where a case has no verdict, or a file is not what it should be.
    """
    truths, verdicts = _found(truth_folder, "truth.json"), _found(verdict_folder, "verdict.json")
    if not truths:
        raise InputError(f"{truth_folder}: holds no truth.json; make cases with sonicvacuum hide")
    missing = sorted(set(truths) - set(verdicts))
    if missing:
        raise InputError(
            f"{verdict_folder}: no verdict for {len(missing)} of {len(truths)} cases, first {missing[0]}; "
            "run sonicvacuum discover on their records"
        )
    return [row(_load(truths[id]), _load(verdicts[id]), verdicts[id]) for id in sorted(truths)]


def _found(folder, name):
    return {path.parent.name: path for path in Path(folder).rglob(name)}


def _load(path):
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except json.JSONDecodeError as error:
        raise InputError(f"{path}: not valid JSON ({error})") from None


def row(truth: dict, verdict: dict, path="verdict.json") -> Row:
    """One case.

    Raises:
        InputError: where the verdict lacks a key that is needed; the message names it.
    """
    try:
        return _row(truth, verdict)
    except KeyError as error:
        raise InputError(f"{path}: {error.args[0]}: missing; this key is required") from None


def _row(truth, verdict):
    effects, named = truth["effects"], verdict["named"]
    claimed = [n for n in named if n != UNKNOWN]
    probabilities = verdict["probabilities"]
    top = max(probabilities, key=lambda name: (probabilities[name], name))
    real = [] if truth["kind"] == "foreign" else effects
    wrong = [n for n in claimed if n not in real]
    held_out = (verdict.get("gap") or {}).get("held_out") or {}
    inside, intervals = _coverage(truth, verdict) if real else (0, 0)
    return Row(
        id=truth["id"],
        kind=truth["kind"],
        design=truth["design"],
        noise=truth["noise"],
        effects="+".join(effects),
        d_prime=truth["d_prime"],
        reached=_reached(truth),
        leftover=truth["leftover_d_prime"],
        nearest=truth["nearest"]["id"],
        ideal=truth["ideal"].get(effects[0], 0.0) if truth["kind"] == "single" else math.nan,
        named="+".join(named),
        top=top,
        confidence=probabilities[top],
        exact=int(set(named) == ({UNKNOWN} if truth["kind"] == "foreign" else set(effects))),
        class_level=int(_class_level(effects, named, verdict["confusable"])),
        false_alarm=int(bool(wrong)),
        says_unknown=int(UNKNOWN in named),
        confident_wrong=int(
            UNKNOWN not in named and any(probabilities.get(n, 0.0) >= CONFIDENT for n in wrong)
        ),
        closed=_number(held_out.get("closed")),
        chi2=_over_floor(held_out),
        inside=inside,
        intervals=intervals,
        seconds=_number((verdict.get("timing_s") or {}).get("total")),
        simulations=int(verdict.get("simulations") or 0),
    )


def _reached(truth):
    if truth["kind"] == "foreign":
        return truth["leftover_d_prime"]
    return min((h["d_prime"] for h in truth["hidden"]), default=0.0)


def _number(value):
    return math.nan if value is None else float(value)


def _over_floor(gap):
    after, floor = _number(gap.get("after")), _number(gap.get("floor"))
    return after / floor if floor else math.nan


def _class_level(effects, named, confusable):
    """Every hidden effect named, itself or by one that the verdict cannot tell from it."""
    if len(named) != len(effects):
        return False
    classes = [set(c) for c in confusable]

    def covers(one, other):
        return one == other or any({one, other} <= c for c in classes)

    return all(any(covers(e, n) for n in named) for e in effects)


def _coverage(truth, verdict):
    """(inside, all) of the stated 90 % intervals of effects that are hidden and named."""
    inside = total = 0
    for hidden in truth["hidden"]:
        stated = verdict["parameters"].get(hidden["id"], {}) if hidden["id"] in verdict["named"] else {}
        for name, true in hidden["parameters"].items():
            found = stated.get(name)
            if not isinstance(found, dict) or not found.get("sigma"):
                continue
            total += 1
            inside += abs(found["value"] - true) <= NINETY * found["sigma"]
    return inside, total


@dataclass(frozen=True)
class Line:
    """One line of the summary: a share of so many cases, its 95 % interval, the ideal rule's share."""

    measure: str
    group: str
    count: int
    value: float
    low: float
    high: float
    ideal: float
    goal: str


def wilson(successes: int, count: int) -> tuple[float, float]:
    """95 % interval of a share (Wilson 1927; scipy.stats.binomtest); NaN without cases."""
    if not count:
        return math.nan, math.nan
    interval = stats.binomtest(successes, count).proportion_ci(0.95, method="wilson")
    return float(interval.low), float(interval.high)


def strength_bin(row: Row) -> float:
    """The study's strength that is nearest to the d′ reached, on a logarithmic scale; 0 below 4."""
    if row.reached < 4.0:
        return 0.0
    return min(STRENGTHS, key=lambda s: abs(math.log(row.reached / s)))


def summary(rows: Iterable[Row]) -> list[Line]:
    """The table: what is asked of the method, as measured."""
    rows = list(rows)
    of = {kind: [r for r in rows if r.kind == kind] for kind in ("null", "single", "pair", "foreign")}
    lines = []

    def share(measure, group, chosen, what, goal=""):
        lines.append(_share(measure, group, chosen, what, goal))

    for noise, goal in (("white", "<= 0.01"), ("ar1", "<= 0.02"), ("quantised", "<= 0.02")):
        share("named on null", noise, [r for r in of["null"] if r.noise == noise], _false_alarm, goal)
    share("unknown on null", "all", of["null"], _says_unknown)
    goals = dict(zip(STRENGTHS, (">= 0.77", ">= 0.91", ">= 0.95", ">= 0.99"), strict=True))
    for strength, goal in goals.items():
        chosen = [r for r in of["single"] if r.design == "traces" and strength_bin(r) == strength]
        share("exact name", f"traces, d' {strength:g}", chosen, _exact, goal)
    for design, goal in (("one-speed", ">= 0.87"), ("scalars", ">= 0.83"), ("ball", "")):
        chosen = [r for r in of["single"] if r.design == design]
        share("exact name", f"{design}, d' {_typical(chosen):.3g}", chosen, _exact, goal)
    strong = [r for r in of["single"] if r.reached >= 9.0]
    share("class-level name", "d' 10 and more", strong, lambda r: r.class_level, ">= 0.97")
    share("confident wrong name", "singles", of["single"], _confident_wrong)
    outside = [r for r in of["foreign"] if r.leftover >= 7.5]
    share("says unknown", "outside the catalogue, leftover d' 8 and more", outside, _says_unknown, ">= 0.90")
    share("confident wrong name", "outside the catalogue", outside, _confident_wrong, "<= 0.05")
    for strength, goal in ((10.0, ">= 0.86"), (20.0, ">= 0.96")):
        chosen = [r for r in of["pair"] if strength_bin(r) == strength]
        share("exact pair", f"each d' {strength:g}", chosen, _exact, goal)
    named = [r for r in strong if r.exact]
    lines.append(
        _median("held-out gap closed", "d' 10 and more, median", [r.closed for r in named], ">= 0.95")
    )
    lines.append(_median("held-out chi2/N", "d' 10 and more, median", [r.chi2 for r in named], "<= 1.05"))
    lines.append(_calibration([r for r in rows if r.kind != "pair"]))
    lines.append(_intervals(rows))
    lines.append(_median("seconds per record", "median", [r.seconds for r in rows], ""))
    return lines


def _exact(row):
    return row.exact


def _false_alarm(row):
    return row.false_alarm


def _says_unknown(row):
    return row.says_unknown


def _confident_wrong(row):
    return row.confident_wrong


def _typical(rows):
    return float(np.median([r.reached for r in rows])) if rows else math.nan


def _share(measure, group, rows: list[Row], what: Callable, goal):
    hits = sum(what(r) for r in rows)
    ideal = [r.ideal for r in rows if not math.isnan(r.ideal)] if measure == "exact name" else []
    return Line(
        measure,
        group,
        len(rows),
        hits / len(rows) if rows else math.nan,
        *wilson(hits, len(rows)),
        float(np.mean(ideal)) if ideal else math.nan,
        goal,
    )


def _median(measure, group, values, goal):
    """A median with the 95 % interval of its order statistics."""
    values = np.sort([v for v in values if not math.isnan(v)])
    n = len(values)
    if not n:
        return Line(measure, group, 0, math.nan, math.nan, math.nan, math.nan, goal)
    low = int(stats.binom.ppf(0.025, n, 0.5))
    high = min(int(stats.binom.ppf(0.975, n, 0.5)), n - 1)
    middle = float(np.median(values))
    return Line(measure, group, n, middle, float(values[low]), float(values[high]), math.nan, goal)


def calibration_bins(rows: Iterable[Row]) -> list[tuple[float, float, int]]:
    """(mean stated probability, share right, count) in ten bins of the most probable entry's probability."""
    bins = [[] for _ in range(BINS)]
    for row in rows:
        truth = {"null": NONE, "foreign": UNKNOWN}.get(row.kind, row.effects)
        bins[min(int(row.confidence * BINS), BINS - 1)].append((row.confidence, row.top == truth))
    return [(*(float(m) for m in np.mean(b, axis=0)), len(b)) if b else (math.nan, math.nan, 0) for b in bins]


def _calibration(rows):
    bins = [b for b in calibration_bins(rows) if b[2]]
    count = sum(n for _, _, n in bins)
    error = sum(n * abs(p - right) for p, right, n in bins) / count if count else math.nan
    return Line(
        "calibration error (ECE)", "single verdicts", count, error, math.nan, math.nan, math.nan, "<= 0.03"
    )


def _intervals(rows):
    inside, count = sum(r.inside for r in rows), sum(r.intervals for r in rows)
    share = inside / count if count else math.nan
    return Line(
        "90 % interval holds truth",
        "named rightly",
        count,
        share,
        *wilson(inside, count),
        math.nan,
        "0.87 to 0.93",
    )


def write_table(lines: list, kind: type, path) -> None:
    """Rows or lines as CSV, numbers to six digits."""
    with replacing(path) as stream:
        writer = csv.DictWriter(stream, [f.name for f in fields(kind)], lineterminator="\n")
        writer.writeheader()
        for line in lines:
            writer.writerow({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in asdict(line).items()})
