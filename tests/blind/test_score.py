"""Scores of made-up verdicts whose value is known."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from made_truths import IDEAL, truth, verdict
from scipy import stats

from sonicvacuum_blind import breakdown
from sonicvacuum_blind.score import Row, read_table, row, write_table
from sonicvacuum_blind.shares import wilson
from sonicvacuum_blind.stated import parameters
from sonicvacuum_blind.summary import summary


def test_right_name():
    found = row(truth(), verdict(), ideal=IDEAL)
    assert (found.exact, found.class_level, found.false_alarm, found.confident_wrong) == (1, 1, 0, 0)
    assert found.ideal == 0.9
    assert (found.stated, found.credible, found.credible_size, found.wrong) == (0.98, 1, 1, 0)
    assert found.brier == pytest.approx(2 * 0.02**2)
    assert found.chi2 == pytest.approx(1.02)


def test_what_stands_beside_a_verdict_is_scored(tmp_path):
    """Two draws of three below the truth; the right bead; one cell found rightly, one wrongly, one missed."""
    (tmp_path / "posterior.csv").write_text(
        "effect,parameter,how,value,weight\n"
        + "".join(f"tsuji,alpha,sampled,{v},1\n" for v in (0.08, 0.09, 0.2))
    )
    assert parameters(truth(), verdict(), tmp_path)[0].pit == pytest.approx(2 / 3)
    (tmp_path / "model.json").write_text(json.dumps({"effects": {"tsuji": {"alpha": 0.1, "bead": 4.0}}}))
    placed = [{"id": "tsuji", "parameters": {"alpha": 0.1}, "d_prime": 10.0, "bead": 4}]
    assert row(truth(hidden=placed), verdict(), folder=tmp_path).place == 1.0
    placed[0]["bead"] = 5
    assert row(truth(hidden=placed), verdict(), folder=tmp_path).place == 0.0
    assert math.isnan(row(truth(hidden=placed), verdict(), folder=tmp_path).place_in)
    with (tmp_path / "posterior.csv").open("a") as stream:
        stream.writelines(f"tsuji,bead,places,{at},{p}\n" for at, p in ((4, 0.3), (6, 0.09), (5, 0.61)))
    # Beads 5 and 4 have 0.91 together.
    for bead, inside in ((5, 1.0), (4, 1.0), (6, 0.0), (7, 0.0)):
        placed[0]["bead"] = bead
        assert row(truth(hidden=placed), verdict(), folder=tmp_path).place_in == inside
    cells = "r1,g1,delay,0.001\nr1,g1,width,0.001\nr2,g1,delay,0.002\nr2,wall,delay,0.3\n"
    (tmp_path / "where.csv").write_text("run,sensor,feature,q_before\n" + cells)
    found = row(truth(), verdict(), folder=tmp_path, ideal=IDEAL)
    assert (found.cells_right, found.cells_wrong, found.cells_seen, found.cells_large) == (1, 1, 1, 2)


def test_without_draws_an_interval_is_normal():
    (found,) = parameters(truth(), verdict())
    assert found.pit == pytest.approx(stats.norm.cdf(-1.0))
    assert parameters(truth(), verdict(["gravity"])) == []


def test_limits_count_for_hidden_effects_that_are_not_named():
    def held(limit):
        return row(truth(), verdict([], upper_limits={"tsuji": {"alpha": limit}})).held

    assert (held(0.2), held(0.05)) == (1, 0)
    assert row(truth(), verdict(upper_limits={"tsuji": {"alpha": 0.2}})).limits == 0


def test_name_of_the_same_class():
    found = row(truth(), verdict(["viscous-drag"], confusable=[["tsuji", "viscous-drag"]]))
    assert (found.exact, found.class_level, found.false_alarm) == (0, 1, 1)
    assert row(truth(), verdict(["viscous-drag"])).class_level == 0


def test_confident_wrong_name():
    sure = {"none": 0.0, "unknown": 0.0, "gravity": 1.0}
    assert row(truth(), verdict(["gravity"], sure)).confident_wrong == 1
    assert row(truth(), verdict(["gravity", "unknown"], sure)).confident_wrong == 0
    assert row(truth(), verdict(["gravity"], {"none": 0.0, "gravity": 0.6})).confident_wrong == 0


def test_null():
    silent = row(truth(kind="null", effects=()), verdict([], {"none": 0.99, "unknown": 0.01}))
    assert (silent.exact, silent.false_alarm) == (1, 0)
    assert row(truth(kind="null", effects=()), verdict()).false_alarm == 1


@pytest.mark.parametrize("probability, counts", [(0.999, 1), (0.5, 1), (0.4, 0)])
def test_a_slip_named_where_none_is(probability, counts):
    fault = {"fault": "drift", "run": None, "sensor": "g1", "probability": probability, "value": 0.3}
    nothing = verdict([], {"none": 0.99, "unknown": 0.01})
    assert row(truth(kind="null", effects=()), nothing | {"faults": [fault]}).slip == counts
    assert row(truth(kind="null", effects=()), nothing).slip == 0


def test_outside_the_catalogue():
    known = row(truth(kind="foreign", effects=("dimer",)), verdict(["unknown"]))
    assert (known.exact, known.says_unknown, known.reached) == (1, 1, 9.0)
    fooled = row(truth(kind="foreign", effects=("dimer",)), verdict(["tsuji"]))
    assert (fooled.exact, fooled.confident_wrong) == (0, 1)


def test_an_effect_beside_one_from_outside():
    together = truth(kind="beside", effects=("tsuji", "dimer"))
    right = row(together, verdict(["tsuji", "unknown"], {"tsuji + unknown": 0.7, "unknown": 0.3}))
    assert (right.exact, right.stated, right.false_alarm, right.says_unknown) == (1, 0.7, 0, 1)
    alone = row(together, verdict())
    assert (alone.exact, alone.false_alarm, alone.wrong) == (0, 0, 0)
    other = row(together, verdict(["gravity", "unknown"]))
    assert (other.exact, other.false_alarm, other.wrong) == (0, 1, 0)
    found = {line.measure: line for line in summary([right, alone, other]) if line.group == "beside"}
    assert found["exact name and unknown"].value == pytest.approx(1 / 3)
    assert found["says unknown"].value == pytest.approx(2 / 3)
    assert found["effect named beside unknown is there"].value == pytest.approx(1 / 2)


def test_pairs_need_both():
    pair = truth(kind="pair", effects=("tsuji", "gravity"))
    assert row(pair, verdict(["gravity", "tsuji"])).exact == 1
    assert row(pair, verdict(["tsuji"])).exact == 0
    assert row(pair, verdict(["tsuji"])).class_level == 0


def test_wilson_interval():
    """Brown, Cai & DasGupta, Stat. Sci. 16, 101 (2001), Eq. 4, at 9 of 10."""
    z, n, p = 1.959963985, 10, 0.9
    middle = (p + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z / (1 + z**2 / n) * math.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
    assert wilson(9, 10) == pytest.approx((middle - half, middle + half), abs=1e-9)
    assert all(math.isnan(v) for v in wilson(0, 0))


def test_calibration_counts_how_often_the_top_is_right():
    rows = [row(truth(str(k)), verdict()) for k in range(9)]
    rows.append(row(truth(kind="null", effects=()), verdict()))
    last = breakdown.reliability(rows)[-1]
    assert (last.stated, last.value, last.count) == pytest.approx((0.98, 0.9, 10))
    line = next(one for one in summary(rows) if one.measure.startswith("calibration"))
    assert line.value == pytest.approx(0.08)


def test_records_that_a_study_has_besides_count_among_their_like_alone():
    rows = [row(truth(str(k), d_prime=50.0), verdict()) for k in range(4)]
    rows = [replace(one, added=1, exact=0) for one in rows[:2]] + rows[2:]
    found = {(one.measure, one.group): one for one in summary(rows)}
    assert (found["exact name", "all"].count, found["exact name", "all"].value) == (2, 1.0)
    like = found["exact name", "traces, d' 50"]
    assert (like.count, like.value) == (4, 0.5)
    stated = "calibration error (ECE)"
    assert (found[stated, "all"].count, found[stated, "with the records added"].count) == (2, 4)
    assert sum(one.count for one in breakdown.reliability(rows)) == 2
    assert {one.count for one in breakdown.accuracy(rows)} == {4}


def test_scores_of_a_study_without_such_records_can_be_read(tmp_path):
    """As studies before kept them: without the column."""
    write_table([row(truth(), verdict())], Row, tmp_path / "score.csv")
    lines = (tmp_path / "score.csv").read_text().splitlines()
    (tmp_path / "before.csv").write_text("".join(f"{line.rpartition(',')[0]}\n" for line in lines))
    then, now = (read_table(Row, tmp_path / name) for name in ("before.csv", "score.csv"))
    assert [str(one) for one in then] == [str(one) for one in now]  # as text: what does not apply is NaN


def test_gaps_are_added_up_where_one_is_lost_in_noise():
    """Noise of ±0.02 on gaps of 0.02, 5 % of them left: single shares scatter, their sum does not."""
    noise = 0.02 * np.random.default_rng(5).standard_normal(400)
    gap = {"floor": 1.0}
    rows = [
        row(truth(str(k), d_prime=10.0), verdict() | {"gap": {"held_out": gap | {"before": b, "after": a}}})
        for k, (b, a) in enumerate(zip(1.02 + noise, 1.001 + noise, strict=True))
    ]
    line = next(one for one in summary(rows) if one.group == "white noise, d' 10, gaps added up")
    assert line.value == pytest.approx(0.95, abs=0.1)  # standard error of 400 gaps 5 %
    assert line.low < 0.95 < line.high


def test_summary_puts_cases_where_they_belong():
    strengths = enumerate((5.0, 5.2, 9.6, 21.0))
    rows = [row(truth(str(k), d_prime=d), verdict(), ideal=IDEAL) for k, d in strengths]
    exact = {one.group: one for one in summary(rows) if one.measure == "exact name"}
    assert [exact[f"traces, d' {s}"].count for s in ("5", "10", "20")] == [2, 1, 1]
    assert exact["all"].count == 4
    assert exact["traces, d' 5"].ideal == pytest.approx(0.9)
    assert exact["traces, d' 5"].value == 1.0
    assert exact["traces, d' 5"].of_ideal == pytest.approx(1.0 / 0.9)


def test_a_goal_beside_the_ideal_rule_is_one_of_records_that_have_one():
    # Named wrongly is the record without: it counts in the share of all, and not against the ideal rule.
    wrong, unknown = verdict(["gravity"]), IDEAL | {"ideal": "nan"}
    rows = [row(truth("a"), verdict(), ideal=IDEAL), row(truth("b"), wrong, ideal=unknown)]
    exact = {one.group: one for one in summary(rows) if one.measure == "exact name"}
    assert (exact["traces, d' 10"].value, exact["traces, d' 10"].goal) == (0.5, "")
    judged = exact["traces, d' 10, where an ideal rule is known"]
    assert (judged.count, judged.value, judged.ideal) == (1, 1.0, pytest.approx(0.9))
    assert judged.goal
