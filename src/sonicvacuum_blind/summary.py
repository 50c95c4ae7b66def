"""The summary of a study: what is asked of the method, as measured, beside what an ideal rule could reach."""

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from sonicvacuum_blind.breakdown import KINDS, ideal_share, reliability
from sonicvacuum_blind.score import Line, Row
from sonicvacuum_blind.shares import counted, quantile, ratio_of_sums, share, strength_bin
from sonicvacuum_blind.study import STRENGTHS


def summary(rows: Iterable[Row]) -> list[Line]:
    """The table, a line for each goal and some without."""
    rows = list(rows)
    of = {kind: [r for r in rows if r.kind == kind] for kind in ("null", "single", "pair", "foreign")}
    strong = [r for r in of["single"] if r.reached >= 9.0]
    return [
        *_nulls(of["null"]),
        *_singles(of["single"], strong),
        *_outside(of["foreign"]),
        *_pairs(of["pair"]),
        *_gaps([r for r in strong if r.exact]),
        *_gaps_together([r for r in of["single"] if r.design == "traces" and r.noise == "white" and r.exact]),
        _calibration([r for r in rows if r.kind != "pair"]),
        _intervals(rows),
        *_seconds(rows),
    ]


def _nulls(rows):
    for noise, goal in (("white", "<= 0.01"), ("ar1", "<= 0.02"), ("quantised", "<= 0.02")):
        yield _share("named on null", noise, [r for r in rows if r.noise == noise], "false_alarm", goal)
    yield _share("unknown on null", "all", rows, "says_unknown")


def _singles(rows, strong):
    goals = {5.0: ">= 0.77", 7.5: ">= 0.91", 10.0: ">= 0.95", 20.0: ">= 0.99"}
    for strength in STRENGTHS:
        goal = goals.get(strength, "")
        chosen = [r for r in rows if r.design == "traces" and strength_bin(r) == strength]
        yield _share("exact name", f"traces, d' {strength:g}", chosen, "exact", goal)
    for design, goal in (
        ("one-speed", ">= 0.87"),
        ("scalars", ">= 0.83"),
        ("varied", ""),
        ("ball", ""),
    ):
        chosen = [r for r in rows if r.design == design]
        yield _share("exact name", f"{design}, d' {_typical(chosen):.3g}", chosen, "exact", goal)
    yield _share("class-level name", "d' 10 and more", strong, "class_level", ">= 0.97")
    yield _share("confident wrong name", "singles", rows, "confident_wrong")


def _outside(rows):
    chosen = [r for r in rows if r.leftover >= 7.5]
    group = "outside the catalogue, leftover d' 8 and more"
    yield _share("says unknown", group, chosen, "says_unknown", ">= 0.90")
    yield _share("confident wrong name", "outside the catalogue", chosen, "confident_wrong", "<= 0.05")


def _pairs(rows):
    for strength, goal in ((10.0, ">= 0.86"), (20.0, ">= 0.96")):
        chosen = [r for r in rows if strength_bin(r) == strength]
        yield _share("exact pair", f"each d' {strength:g}", chosen, "exact", goal)


def _gaps(rows):
    group = "d' 10 and more, median"
    yield _quantile("held-out gap closed", group, [r.closed for r in rows], goal=">= 0.95")
    yield _quantile("held-out chi2/N", group, [r.chi2 for r in rows], goal="<= 1.05")


def _gaps_together(rows):
    """A gap of d′² in N samples is lost in their noise, √(2 N), where d′ is 10: the share closed of one case
    may be anything, and so may the median. Gaps added up are not, where the floor is known to be 1: with
    white noise.
    """
    for strength in (10.0, 20.0):
        chosen = [r for r in rows if strength_bin(r) == strength and not math.isnan(r.before)]
        gaps = np.array([(r.before - 1.0, r.chi2 - 1.0) for r in chosen]).reshape(-1, 2)
        found = ratio_of_sums(gaps[:, 0] - gaps[:, 1], gaps[:, 0])
        group = f"white noise, d' {strength:g}, gaps added up"
        yield Line("held-out gap closed", group, len(chosen), *found)


def _calibration(rows):
    bins = [b for b in reliability(rows) if b.count]
    count = sum(b.count for b in bins)
    error = sum(b.count * abs(b.stated - b.value) for b in bins) / count if count else math.nan
    return Line(
        "calibration error (ECE)", "single verdicts", count, error, math.nan, math.nan, goal="<= 0.03"
    )


def _intervals(rows):
    hits, count = sum(r.inside for r in rows), sum(r.intervals for r in rows)
    return Line("90 % interval holds truth", "named rightly", count, *share(hits, count), goal="0.87 to 0.93")


def _seconds(rows):
    goals = {"single": "<= 5", "pair": "<= 30"}
    for kind in KINDS:
        times = [r.seconds for r in rows if r.kind == kind]
        yield _quantile("seconds per record", f"{kind}, median", times, goal=goals.get(kind, ""))
        yield _quantile("seconds per record", f"{kind}, 90th percentile", times, 0.9)


def _typical(rows):
    return float(np.median([r.reached for r in rows])) if rows else math.nan


def _share(measure, group, rows: list[Row], what: str, goal=""):
    found = counted(measure, group, (getattr(r, what) for r in rows), goal)
    ideal = ideal_share(rows) if measure in ("exact name", "exact pair") else math.nan
    return replace(found, ideal=ideal, of_ideal=found.value / ideal if ideal else math.nan)


def _quantile(measure, group, values, level=0.5, goal=""):
    return Line(measure, group, *quantile(values, level), goal=goal)
