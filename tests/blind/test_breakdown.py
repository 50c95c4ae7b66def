"""Tables of a study worked out of its scores: confusion, accuracy, intervals, times."""

import pytest
from made_truths import IDEAL, truth, verdict

from sonicvacuum_blind import breakdown
from sonicvacuum_blind.score import row
from sonicvacuum_blind.shares import quantile, wilson
from sonicvacuum_blind.stated import Parameter, parameters
from sonicvacuum_blind.summary import summary


def test_confusion_has_every_name_and_counts_every_single_case():
    two = truth("b", effects=("tsuji", "gravity"), kind="pair")
    rows = [
        row(truth("a"), verdict()),
        row(truth("c"), verdict(["gravity", "tsuji"])),
        row(truth("d"), verdict(["tsuji", "unknown"])),
        row(truth("e", kind="foreign", effects=("dimer",)), verdict(["tsuji"])),
        row(truth("f", kind="null", effects=()), verdict([])),
        row(two, verdict(["gravity", "tsuji"])),
    ]
    cells = {(c.hidden, c.named): c for c in breakdown.confusion(rows)}
    assert len(cells) == 24 * 25
    filled = {key: c.count for key, c in cells.items() if c.count}
    assert filled == {
        ("tsuji", "tsuji"): 1,
        ("tsuji", "several"): 2,
        ("unknown", "tsuji"): 1,
        ("none", "none"): 1,
    }
    assert cells["tsuji", "several"].share == pytest.approx(2 / 3)


def test_accuracy_by_design_and_strength():
    rows = [row(truth(str(k), d_prime=d), verdict()) for k, d in enumerate((5.0, 5.4, 20.0))]
    alike = verdict(["gravity"], confusable=[["gravity", "tsuji"]])
    rows.append(row(truth("w", design="ball"), alike, ideal=IDEAL))
    found = {(a.design, a.strength): a for a in breakdown.accuracy(rows)}
    assert set(found) == {("traces", 5.0), ("traces", 20.0), ("ball", 10.0)}
    assert found["traces", 5.0].d_prime == pytest.approx(5.2)
    ball = found["ball", 10.0]
    assert (ball.exact, ball.class_level, ball.ideal) == (0.0, 1.0, 0.9)
    assert (ball.exact_low, ball.exact_high) == wilson(0, 1)


def test_coverage_by_effect_and_seconds_by_kind():
    far = verdict(parameters={"tsuji": {"alpha": {"value": 0.12, "sigma": 0.01}}}, timing_s={"total": 4.0})
    rows = [row(truth("a"), verdict()), row(truth("b"), far)]
    intervals = [*parameters(truth("a"), verdict()), *parameters(truth("b"), far)]
    found = {(c.effect, c.level): c for c in breakdown.coverage(intervals)}
    assert (found["tsuji", 0.9].count, found["tsuji", 0.9].value) == (2, 0.5)
    assert found["tsuji", 0.5].value == 0.0
    assert (found["all", 0.9].count, found["gravity", 0.9].count) == (2, 0)
    times = {s.kind: s for s in breakdown.seconds(rows)}
    # Linear between order statistics, numpy's default.
    assert (times["single"].median, times["single"].percentile_90) == pytest.approx((3.0, 3.8))
    assert times["null"].count == 0


def test_intervals_are_counted_of_right_names_apart_and_without_truths_at_an_end():
    """Four records: an interval that holds, one that does not, one of a set that is wrong, one at an end."""
    given = {"a": verdict(), "b": verdict(), "c": verdict(["gravity"]), "d": verdict()}
    rows = [row(truth(id), one) for id, one in given.items()]
    case = "single", "traces", 10.0
    middle = [
        Parameter(id, *case, "tsuji", "alpha", 0.1, 0.1, 0.01, pit)
        for id, pit in zip("abc", (0.5, 0.999, 0.0), strict=True)
    ]
    end = Parameter("d", *case, "gravity", "fraction", 1.0, 0.99, 0.01, 1.0)
    lines = [s for s in summary(rows, [*middle, end]) if "interval holds" in s.measure]
    assert [s.count for s in lines] == [4] * 4 + [2] * 4
    assert [s.value for s in lines] == [0.25] * 4 + [0.5] * 4


def test_interval_of_a_median():
    """The binomial interval of the median of ten values is from the third to the ninth; binom(10, 1/2) holds
    1.07 % below 2 and 5.47 % up to 2, so 2 and 8 are its 2.5 % and 97.5 % points.
    """
    assert quantile(range(10), 0.5) == (10, 4.5, 2.0, 8.0)
