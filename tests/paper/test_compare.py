"""Comparisons of two cases: values, propagated errors, and what is said where a case is missing."""

import pytest

from sonicvacuum_paper import compare
from sonicvacuum_paper.columns import Metrics
from sonicvacuum_paper.rows import Row, absent

COLUMNS = {"matched": ["matched", "nominal"], "named": ["named"]}


def compared(rows, name, column="matched", sensor=None):
    found = compare.column_rows(Metrics(rows, COLUMNS), column)
    return next(r for r in found if r.quantity == name and sensor in (None, r.sensor))


def test_ratio_and_its_error():
    rows = [
        Row("fig3a.matched", "speed", "g9-g5", 200.0, "m/s", 2.0),
        Row("fig3b.nominal", "speed", "g9-g5", 600.0, "m/s", 3.0),
    ]
    ratio = compared(rows, "speed_ratio_fig3b_fig3a")
    assert ratio.case == "compare.matched" and ratio.value == 3.0
    # 1 % and 0.5 % of 3, summed; 2 %: second order of the larger one
    assert ratio.numerical_error == pytest.approx(0.045, rel=0.02)


@pytest.mark.parametrize(
    ("coated", "error", "holds", "uncertain"), [(0.9, 0, 1, 0), (0.995, 0, 0, 0), (0.9895, 1e-3, 1, 1)]
)
def test_order_is_uncertain_where_an_error_would_turn_it(coated, error, holds, uncertain):
    rows = [
        Row("fig3a.matched", "decay", "g9-g5", coated, "1", error),
        Row("fig3b.nominal", "decay", "g9-g5", 1.0, "1", 0.0),
    ]
    flag = compared(rows, "decay_coated_faster")
    assert (flag.value, flag.numerical_error) == (holds, uncertain)


def test_missing_case_and_absent_metric_are_told_apart():
    assert "fig3b/speed/g9-g5 has not been found" in compared([], "speed_ratio_fig3b_fig3a").reason
    rows = [
        absent("fig3a.matched", "speed", "g9-g5", "m/s", "no pulse"),
        Row("fig3b.nominal", "speed", "g9-g5", 600.0, "m/s"),
    ]
    assert compared(rows, "speed_ratio_fig3b_fig3a").reason == "fig3a.matched/speed/g9-g5: no pulse"


def lossy(case, *row, effects=1.0):
    return [Row(case, *row), Row(case, "loss_effects", "", effects, "1")]


def test_losses_are_compared_with_the_lossless_twin():
    named = lossy("fig5a.named", "valley_depth", "g9", 0.8, "1")
    assert "no loss effect has been named" in compared(named, "losses_delay_splitting", "named").reason
    twin = Row("fig5a.named-lossless", "valley_depth", "g9", 0.95, "1")
    assert compared([*named, twin], "losses_delay_splitting", "named").value == 1.0
    alike = Row("fig5a.named-lossless", "valley_depth", "g9", 0.81, "1")
    assert compared([*named, alike], "losses_delay_splitting", "named").value == 0.0
    elastic = lossy("fig5a.named", "valley_depth", "g9", 0.8, "1", effects=0.0)
    assert not compared([*elastic, twin], "losses_delay_splitting", "named").known


def test_decay_counts_only_where_a_loss_is_named():
    elastic = lossy("fig3a.named", "decay", "g9-g5", 0.9, "1", effects=0.0)
    assert not compared(elastic, "decay_with_losses", "named").known
    damped = lossy("fig3a.named", "decay", "g9-g5", 0.9, "1")
    assert compared(damped, "decay_with_losses", "named").value == 0.9


def test_modulus_of_the_printed_speed_is_exact_for_a_power_law():
    # speed = 197 m/s at 11 GPa, growing as E^(2/5)
    moduli = {"fig3a.a": 2.76e9, "fig3a.b": 4.75e9, "fig3a.c": 15e9}
    rows = [Row(n, "speed", "g9-g5", 197.0 * (e / 11e9) ** 0.4, "m/s", 0.1) for n, e in moduli.items()]
    found = compare.modulus_row(Metrics(rows, COLUMNS), moduli)
    assert found.value == pytest.approx(11.0, rel=1e-12)  # rounding
    assert 0.0 < found.numerical_error < 0.1
    assert not compare.modulus_row(Metrics(rows[:1], COLUMNS), {"fig3a.a": 2.76e9}).known


def test_simulated_flags_are_whole_numbers(metrics):
    names = {name for name, *_ in compare.COMPARISONS if "ratio" not in name and "change" not in name}
    assert len(names) > 5
    for row in compare.column_rows(metrics, "matched"):
        if row.quantity in names:
            assert row.value in (0.0, 1.0) and row.numerical_error == 0.0
