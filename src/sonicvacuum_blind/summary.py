"""The summary of a study: what is asked of the method, as measured, beside what an ideal rule could reach."""

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from sonicvacuum_blind import design
from sonicvacuum_blind.breakdown import KINDS, LEVELS, coverage, ideal_share, pit
from sonicvacuum_blind.calibration import BASE_RATES, ece, honest, resampled
from sonicvacuum_blind.score import UNKNOWN, Row, SummaryLine
from sonicvacuum_blind.shares import counted, counted_of, quantile, ratio_of_sums, share, strength_bin
from sonicvacuum_blind.stated import CREDIBLE, SET, Parameter
from sonicvacuum_blind.study import STRENGTHS

# Of d′: from here on places are asked for, and leftovers of outside effects count.
STRONG, LEFTOVER = 9.0, 7.5
OF_IDEAL = ">= 0.97 of ideal"
# Kind of record that only a study of its own holds.
BESIDE = "beside"
ADDED, HONEST = "with the records added", "right probabilities"
RIGHT = "of sets named exactly, truths at an end left out"


def summary(rows: Iterable[Row], parameters: Iterable[Parameter] = ()) -> list[SummaryLine]:
    """The table, a line for each goal and some without.

    What is added up over unlike records is so over the main list alone, whose shares are fixed; records that
    a study has besides count among their like: by design and d′, and by kind of noise. Stated intervals are
    all counted, since they should hold at any strength.
    """
    rows, parameters = list(rows), list(parameters)
    main = [r for r in rows if not r.added]
    of = {kind: [r for r in main if r.kind == kind] for kind in (*KINDS, BESIDE)}
    every = {kind: [r for r in rows if r.kind == kind] for kind in KINDS}
    return [
        *_exact("exact name", of["single"], every["single"], OF_IDEAL),
        *_exact("exact pair", of["pair"], every["pair"], OF_IDEAL),
        *_exact("exact set of three", of["set"], every["set"], ""),
        *_places(main),
        *_classes(of),
        *_nulls(every["null"]),
        *_outside(of["foreign"]),
        *_beside(of[BESIDE]),
        *_wrong(of),
        *_probabilities(main, rows),
        *_intervals(main, parameters),
        *_intervals_of_right_names(rows, parameters),
        *_located(main),
        *_errors(main),
        *_gaps([r for r in of["single"] if r.reached >= STRONG and r.exact]),
        *_gaps_together([r for r in of["single"] if r.design == "traces" and r.noise == "white" and r.exact]),
        *_seconds(of),
    ]


def _exact(measure, main, rows, goal):
    """All of the main list, then all rows by design and d′."""
    yield from _judged(measure, "all", main, "")
    for kind in design.KINDS:
        for strength in (0.0, *STRENGTHS):
            chosen = [r for r in rows if r.design == kind and strength_bin(r) == strength]
            group = f"{kind}, d' {strength:g}" if strength else f"{kind}, d' below 2.4"
            if chosen:
                yield from _judged(measure, group, chosen, goal)


def _judged(measure, group, rows, goal):
    """The share of all; where some have no ideal rule, the goal is one of the rest."""
    known = [r for r in rows if not math.isnan(r.ideal)]
    if known and len(known) < len(rows):
        yield counted_of(measure, group, rows, "exact")
        group += ", where an ideal rule is known"
    found, ideal = counted_of(measure, group, known or rows, "exact", goal), ideal_share(known)
    yield replace(found, ideal=ideal, of_ideal=found.value / ideal if ideal else math.nan)


def _places(rows):
    chosen = [r for r in rows if not math.isnan(r.place)]
    strong = [r for r in chosen if r.reached >= STRONG]
    yield counted_of("place right", "d' 10 and more", strong, "place", ">= 0.95")
    yield counted_of("place right", "d' below 10", [r for r in chosen if r.reached < STRONG], "place")
    odds = [r for r in rows if not math.isnan(r.place_in)]
    if odds:
        yield counted_of(f"place in its {100 * SET:.0f} % set", "all", odds, "place_in")


def _classes(of):
    for kind in KINDS:
        yield counted_of(f"truth in the {100 * CREDIBLE:.0f} % credible set", kind, of[kind], "credible")
        sizes = [float(r.credible_size) for r in of[kind]]
        yield SummaryLine("size of that set", f"{kind}, median", *quantile(sizes, 0.5))


def _nulls(rows):
    for noise in ("white", "ar1", "quantised"):
        chosen = [r for r in rows if r.noise == noise]
        yield counted_of("named on null", noise, chosen, "false_alarm", "<= 0.01")
        yield counted_of("slip named on null", noise, chosen, "slip", "<= 0.01")
    yield counted_of("unknown on null", "all", rows, "says_unknown")


def _outside(rows):
    group = "outside the catalogue, leftover d' 8 and more"
    chosen = [r for r in rows if r.leftover >= LEFTOVER]
    yield counted_of("says unknown", group, chosen, "says_unknown", ">= 0.90")
    yield counted_of("wrong name, unqualified", "outside the catalogue", rows, "wrong", "<= 0.05")
    for name in sorted({r.effects for r in rows}):
        own = [r for r in chosen if r.effects == name]
        if own:
            yield counted_of("says unknown", f"outside, {name}", own, "says_unknown")
            yield counted_of("wrong name, unqualified", f"outside, {name}", own, "wrong")


def _beside(rows):
    """An effect of the catalogue and one from outside, hidden together: what is said of either."""
    if not rows:
        return
    yield counted_of("exact name and unknown", BESIDE, rows, "exact")
    yield counted_of("says unknown", BESIDE, rows, "says_unknown")
    named = [r for r in rows if r.says_unknown and r.named != UNKNOWN]
    told = [int(r.effects.split("+")[0] in r.named.split("+")) for r in named]
    yield counted("effect named beside unknown is there", BESIDE, told)
    yield counted("no other effect is named", BESIDE, [1 - r.false_alarm for r in named])
    yield counted_of("wrong name, unqualified", BESIDE, rows, "wrong")


def _wrong(of):
    for kind in ("single", "pair", "set", "foreign"):
        if kind != "foreign":
            yield counted_of("wrong name, unqualified", kind, of[kind], "wrong")
        yield counted_of("the same with probability 0.9", kind, of[kind], "confident_wrong")
        yield counted_of("slip named where none is", kind, of[kind], "slip")


def _probabilities(rows, with_added):
    yield SummaryLine("calibration error (ECE)", "all", *ece(rows), goal="<= 0.02")
    below = [r for r in rows if r.stated < 0.9]
    yield SummaryLine("calibration error (ECE)", "stated below 0.9", *ece(below), goal="<= 0.05")
    for group, chosen in (("all", rows), ("stated below 0.9", below)):
        yield SummaryLine("calibration error (ECE)", f"{group}, {HONEST}", *honest(chosen))
    if len(with_added) > len(rows):
        yield SummaryLine("calibration error (ECE)", ADDED, *ece(with_added))
    for name, rates in BASE_RATES.items():
        chosen = [r for r in rows if r.kind in rates]
        yield SummaryLine("calibration error (ECE)", f"base rates: {name}", *ece(chosen, rates))
    scores = np.array([r.brier for r in rows])
    yield SummaryLine(
        "Brier score", "all", len(rows), *resampled(lambda k: float(scores[k].mean()), len(rows))
    )


def _intervals(rows, parameters):
    known = [line for line in pit(parameters) if line.count]
    for line in known[:1]:
        inside = int(line.inside == "yes")
        yield SummaryLine(
            "PIT-ECDF inside its band", "all parameters", line.count, inside, math.nan, math.nan
        )
    effects = known[1:]
    outside = sum(line.inside == "no" for line in effects)
    group = "effects whose ECDF leaves it"
    yield SummaryLine(
        "PIT-ECDF inside its band", group, len(effects), outside, math.nan, math.nan, goal="<= 0"
    )
    yield from _covered("all", parameters)
    held, count = sum(r.held for r in rows), sum(r.limits for r in rows)
    yield SummaryLine("upper limit holds truth", "hidden, not named", count, *share(held, count))


def _intervals_of_right_names(rows, parameters):
    """An interval is stated given the set that is named: beside another one it is of another model. One
    between quantiles cannot hold a truth at an end of what a parameter can be, whatever the data.
    """
    right = {r.id for r in rows if r.exact}
    return _covered(RIGHT, [p for p in parameters if p.id in right and not p.at_an_end])


def _covered(group, parameters):
    for one in coverage(parameters)[: len(LEVELS)]:
        measure = f"{100 * one.level:.0f} % interval holds truth"
        yield SummaryLine(measure, group, one.count, one.value, one.low, one.high)


def _located(rows):
    """Cells pooled over records; precision and recall of cells make F1."""
    cells = np.array(
        [(r.cells_right, r.cells_wrong, r.cells_seen, r.cells_large) for r in rows], dtype=float
    ).reshape(-1, 4)
    used = cells[cells.any(axis=1)]

    def f1(index):
        right, wrong, seen, large = used[index].sum(axis=0)
        precision, recall = right / (right + wrong), seen / large
        return 2.0 * precision * recall / (precision + recall)

    def false(index):
        right, wrong = used[index].sum(axis=0)[:2]
        return wrong / (right + wrong)

    yield SummaryLine("localisation F1", "cells", len(used), *resampled(f1, len(used)), goal=">= 0.9")
    yield SummaryLine("false discoveries", "cells", len(used), *resampled(false, len(used)), goal="<= 0.05")


def _errors(rows):
    """What the record's own errors are off, with and without what is named."""
    chosen = [r for r in rows if r.kind in ("single", "pair", "set") and r.exact]
    for when, of in (("moved if nothing is named", "before"), ("off beside what is named", "after")):
        values = [getattr(r, f"errors_{of}") for r in chosen]
        yield SummaryLine("record's own errors, in stated ones", f"{when}, median", *quantile(values, 0.5))


def _gaps(rows):
    group = "d' 10 and more, median"
    yield SummaryLine("held-out gap closed", group, *quantile([r.closed for r in rows], 0.5))
    yield SummaryLine("held-out chi2/N", group, *quantile([r.chi2 for r in rows], 0.5))


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
        yield SummaryLine("held-out gap closed", group, len(chosen), *found)


def _seconds(of):
    for kind in KINDS:
        times = [r.seconds for r in of[kind]]
        yield SummaryLine("seconds per record", f"{kind}, median", *quantile(times, 0.5))
        yield SummaryLine("seconds per record", f"{kind}, 90th percentile", *quantile(times, 0.9))
