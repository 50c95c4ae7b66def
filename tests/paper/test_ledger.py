"""The ledger made from a few metrics: which column decides, what the reason says, how rows are ranked."""

import csv
import math
from dataclasses import fields, replace

import pandas as pd
import pytest

from sonicvacuum.files import InputError
from sonicvacuum_paper import assumptions, ladder, ledger
from sonicvacuum_paper.assumptions import Assumption
from sonicvacuum_paper.columns import Metrics
from sonicvacuum_paper.ledger import Claim
from sonicvacuum_paper.report import steps
from sonicvacuum_paper.rows import Row, absent

COLUMNS = {"handbook": ["handbook", "nominal"], "matched": ["matched", "nominal"]}


def claim(test="equals", value="197", sigma="19.7", metric="fig3a/speed/g9-g5", unit="m/s", name="speed"):
    return Claim(name, "Fig. 3a", "", "speed", unit, value, sigma, "", test, metric, "A note.")


def assumption(test="at_most", limit="0.1", metric="fig3a/depth/"):
    return Assumption("depth", "stated", "Shallow.", "ratio", "1", limit, test, metric, "A note.")


def speeds(handbook, matched, error=0.0):
    return [
        Row("fig3a.handbook", "speed", "g9-g5", handbook, "m/s", error),
        Row("fig3a.matched", "speed", "g9-g5", matched, "m/s", error),
    ]


def one(rows, a_claim, columns=None):
    return ledger.build(Metrics(rows, columns or COLUMNS), [a_claim])[0]


def test_matched_decides_without_a_layer_and_the_other_is_told_where_it_differs():
    row = one(speeds(113.1, 219.7), claim())
    assert (row.handbook, row.matched) == (113.1, 219.7)
    assert row.verdict == "reproduced"
    assert row.difference_sigma == pytest.approx(22.7 / 19.7, rel=1e-12)
    assert row.reason == "Hertz, 15 GPa: speed 219.7 against 197 ± 19.7 m/s (+1.2 σ)."
    assert (row.agrees, row.fitted, row.excluded) == ("matched", "", "handbook -4.3")


def test_the_layer_decides_where_there_is_one():
    rows = [*speeds(113.1, 219.7), Row("fig3a.layer", "speed", "g9-g5", 300.0, "m/s")]
    row = one(rows, claim(), {**COLUMNS, "layer": ["layer"]})
    assert row.verdict == "disagrees" and row.difference_sigma == pytest.approx(103 / 19.7)
    assert row.agrees == "matched"


def test_no_model_is_credited_with_what_it_was_fitted_to():
    row = one(speeds(113.1, 219.7), replace(claim(), fitted="matched handbook"))
    assert (row.agrees, row.fitted, row.excluded) == ("", "matched", "handbook -4.3")
    assert row.verdict == "not testable" and "every model that gives it was fitted" in row.reason
    # The next of the ladder decides instead.
    other = one(speeds(113.1, 219.7), replace(claim(), fitted="matched"))
    assert other.verdict == "disagrees" and other.difference_sigma == pytest.approx(-83.9 / 19.7)


def test_what_needs_a_loss_is_outside_a_model_without():
    rows = [
        *(
            Row(f"fig3a.{c}", "loss_effects", "", float(c == "layer_loss"), "1")
            for c in ("layer", "layer_loss")
        ),
        *(
            Row(f"fig3a.{c}", "speed", "g9-g5", v, "m/s")
            for c, v in (("layer", 300.0), ("layer_loss", 200.0))
        ),
    ]
    columns = {"layer": ["layer"], "layer_loss": ["layer_loss"]}
    row = one(rows, replace(claim(), needs="loss"), columns)
    assert (row.verdict, row.agrees, row.excluded) == ("outside the model", "layer_loss", "")


def test_arithmetic_that_does_not_come_out_is_the_papers():
    row = one([Row("paper", "width", "", 9.0, "1")], claim(metric="paper/width/", value="5", sigma="1"))
    assert (row.kind, row.verdict, row.excluded) == ("arithmetic", "inconsistent in the paper", "")
    told = one([], claim("misprint", "", "", ""))
    assert (told.kind, told.verdict, told.reason) == ("text", "inconsistent in the paper", "A note.")


def test_totals_count_what_needs_a_simulation():
    rows = [
        one(speeds(113.1, 219.7), claim()),
        one(speeds(113.1, 219.7), replace(claim(), fitted="matched")),
        one([Row("theory", "slope", "", 1.0, "1")], claim(metric="theory/slope/", value="1", sigma="1")),
    ]
    text = [{f.name: str(getattr(r, f.name)) for f in fields(r)} for r in rows]
    found = {t.model: t for t in ladder.totals(text)}
    assert found["matched"] == ladder.Total("matched", 1, 1, 0, 0)
    assert found["handbook"] == ladder.Total("handbook", 0, 0, 2, 0)


def test_one_value_for_all_columns_names_none():
    row = one(
        [Row("fig3b.nominal", "speed", "g9-g5", 570.0, "m/s")], claim(metric="fig3b/speed/g9-g5", value="578")
    )
    assert row.handbook == row.matched == 570.0
    assert row.reason.startswith("speed 570 against 578")


def test_named_column_is_filled_once_there_is_one():
    rows = [*speeds(113.1, 260.0), Row("fig3a.named", "speed", "g9-g5", 200.0, "m/s")]
    without = one(rows, claim())
    assert math.isnan(without.named) and without.verdict == "disagrees"
    with_named = one(rows, claim(), {**COLUMNS, "named": ["named"]})
    assert with_named.named == 200.0
    assert with_named.verdict == "disagrees"
    assert (with_named.agrees, with_named.excluded) == ("named", "handbook -4.3; matched +3.2")


def test_named_decides_what_nothing_else_tells():
    rows = [
        absent("compare.matched", "losses", "g9", "1", "no loss effect has been named"),
        Row("compare.named", "losses", "g9", 1.0, "1"),
    ]
    row = one(rows, claim("order", "1", "", "compare/losses/g9", "1"), {**COLUMNS, "named": ["named"]})
    assert (row.verdict, row.reason) == ("reproduced", "as discovered: the order holds.")


def test_an_order_quotes_what_it_compares():
    rows = [
        Row("fig3a.matched", "decay", "g9-g5", 1.003, "1"),
        Row("fig3b.nominal", "decay", "g9-g5", 1.002, "1"),
        Row("compare.matched", "decay_coated_faster", "g9-g5", 0.0, "1"),
    ]
    row = one(rows, claim("order", "1", "", "compare/decay_coated_faster/g9-g5", "1"))
    assert row.reason == "the order does not hold (fig3a decay 1.003, fig3b decay 1.002)."


def test_digits_grow_until_a_number_is_told_from_its_bound():
    row = one(speeds(1.0, 1.0000555), claim("at_least", "1", ""))
    assert "speed 1.0001 against at least 1 m/s" in row.reason


def test_digits_resolve_sigma():
    row = one(speeds(1.0, 0.16666670), claim(value="0.1666667", sigma="1e-6", unit="1"))
    assert row.reason == "Hertz, 15 GPa: speed 0.1666667 against 0.1666667 ± 1e-6."


def test_absent_metric_is_not_testable_and_quotes_its_companion():
    rows = [
        absent("fig3a.matched", "duration", "g9", "us", "merged: the tail"),
        Row("fig3a.matched", "duration_05", "g9", 88.2, "us"),
    ]
    row = one(rows, claim(metric="fig3a/duration/g9", unit="us"))
    assert row.verdict == "not testable"
    assert row.reason == "Not testable: merged: the tail; duration_05 is 88.2 us."


def test_metric_that_no_run_made_is_not_testable():
    row = one([], claim())
    assert row.verdict == "not testable" and "fig3a/speed/g9-g5 has not been found" in row.reason


def test_numerical_error_keeps_a_difference_from_counting():
    assert one(speeds(1.0, 300.0), claim()).verdict == "disagrees"
    assert one(speeds(1.0, 300.0, error=110.0), claim()).verdict == "reproduced"


def test_disagreements_by_size_those_without_sigma_last():
    rows = speeds(0.0, 300.0)
    claims = [
        claim("at_most", "100", "", name="strict"),
        claim(name="five"),
        claim(name="larger", sigma="1"),
        claim(name="fine", sigma="100"),
    ]
    ranked = ledger.disagreements(ledger.build(Metrics(rows, COLUMNS), claims))
    assert [r.claim for r in ranked] == ["larger", "five", "strict"]


def test_written_ledger_has_the_promised_columns(tmp_path):
    ledger.write([one(speeds(113.1, 219.7), claim())], tmp_path / "ledger.csv")
    with open(tmp_path / "ledger.csv", newline="") as stream:
        header, row = csv.reader(stream)
    assert ",".join(header) == (
        "claim,section,kind,quantity,unit,measured,sigma,handbook,layer,layer_membrane,matched,layer_loss,matched_loss,"
        "named,ideal,numerical_error,difference_sigma,verdict,agrees,fitted,excluded,probability,reason"
    )
    assert row[5:11] == ["197", "19.7", "113.1", "", "", "219.7"]


def test_malformed_metric_and_table_are_refused(tmp_path):
    with pytest.raises(
        InputError, match=r"claims\.csv: speed: metric is 'fig3a'; write case/quantity/sensor"
    ):
        one([], claim(metric="fig3a"))
    path = tmp_path / "claims.csv"
    path.write_text("claim,value\n")
    with pytest.raises(InputError, match="the first line must read claim,section,statement"):
        ledger.read_table(path, Claim)
    names = (
        "claim,section,statement,quantity,unit,value,sigma,sigma_source,test,metric,note,needs,fitted,reading"
    )
    path.write_text(f"{names}\n" + "a,,,,,1,1,,equals,x/y/z,,,,\n" * 2)
    with pytest.raises(InputError, match="a stands here 2 times"):
        ledger.read_table(path, Claim)


@pytest.mark.parametrize(
    ("handbook", "matched", "verdict"),
    [
        (0.05, 0.05, "holds"),
        (0.2, 0.3, "fails"),
        (0.2, 0.05, "holds for Hertz, 15 GPa only"),
        (0.05, 0.2, "holds for Hertz, 2.76 GPa only"),
    ],
)
def test_assumption_verdicts(handbook, matched, verdict):
    rows = [Row(f"fig3a.{c}", "depth", "", v, "1") for c, v in (("handbook", handbook), ("matched", matched))]
    row = assumptions.build(Metrics(rows, COLUMNS), [assumption()])[0]
    assert row.verdict == verdict
    assert row.reason == f"Hertz, 2.76 GPa: {handbook:g}; Hertz, 15 GPa: {matched:g} against at most 0.1."


def test_assumption_without_metric_or_value():
    untested = assumptions.build(Metrics([], COLUMNS), [assumption("not-testable", "", "")])[0]
    assert (untested.verdict, untested.reason) == ("not testable", "A note.")
    gone = Metrics([absent("fig3a.matched", "depth", "", "1", "no pulse")], COLUMNS)
    assert assumptions.build(gone, [assumption()])[0].verdict == "not testable"


def test_the_audit_looks_at_the_layer_too():
    rows = [Row(f"fig3a.{c}", "depth", "", v, "1") for c, v in (("handbook", 0.05), ("layer", 0.2))]
    row = assumptions.build(Metrics(rows, COLUMNS | {"layer": ["layer"]}), [assumption()])[0]
    assert row.layer == 0.2 and row.verdict == "holds for Hertz, 2.76 GPa only"


def test_assumption_within_numerical_error_holds():
    rows = [Row("fig3a.matched", "depth", "", 0.101, "1", 0.002)]
    assert assumptions.build(Metrics(rows, COLUMNS), [assumption()])[0].verdict == "holds"


def test_written_audit_has_the_promised_columns(tmp_path):
    rows = assumptions.build(Metrics([], COLUMNS), [assumption()])
    assumptions.write(rows, tmp_path / "a.csv")
    header = (tmp_path / "a.csv").read_text().splitlines()[0]
    assert (
        header
        == "assumption,section,statement,quantity,unit,limit,handbook,matched,layer,layer_loss,verdict,reason"
    )


def test_probabilities_stand_beside_the_models():
    found = Metrics(speeds(113.1, 219.7), COLUMNS)
    (row,) = ledger.build(found, [claim()], probable={claim().claim: {"handbook": 0.0104, "matched": 0.5}})
    assert row.probability == "handbook 0.01; matched 0.5"
    assert ledger.build(found, [claim()])[0].probability == ""


def test_steps_tell_what_turns_and_leave_out_what_was_fitted():
    cells = {"kind": "simulation", "fitted": "", **dict.fromkeys(ladder.COLUMNS, "1")}
    rows = [
        {**cells, "claim": "speed", "agrees": "layer_loss"},
        {**cells, "claim": "force", "agrees": "layer"},
        {**cells, "claim": "time", "agrees": "", "fitted": "layer_loss"},
        {**cells, "claim": "slope", "agrees": "layer", "layer_loss": ""},
    ]
    loss = next(s for s in steps.steps(rows) if s["models"].endswith("layer, 2.76 GPa, loss"))
    assert (loss["won"], loss["lost"]) == (["speed"], ["force"])


def test_settings_tell_the_numbers_that_move():
    cells = {"kind": "simulation", "unit": "N", "measured": "3"}
    rows = [
        {**cells, "claim": "force", "ideal": "4.9", "layer": "4.8"},
        {**cells, "claim": "speed", "ideal": "226.3", "layer": "226.7"},
        {**cells, "claim": "count", "ideal": "", "layer": "1"},
    ]
    assert steps.settings(rows) == [{"claim": "force", "unit": "N", "cells": ["3", "4.9", "4.8"]}]


def test_masses_stand_side_by_side_where_both_were_simulated():
    models = ("layer", "layer-geometry", "layer-loss", "layer-loss-geometry")
    rows = [(f"fig6a.{m}", "amplitude", "wall", str(k)) for k, m in enumerate(models, 1)]
    rows += [("fig6b.layer", "amplitude", "wall", "9")]
    table = pd.DataFrame(rows, columns=["case", "quantity", "sensor", "value"])
    assert steps.masses(table) == [["Fig. 6(a), peak at the wall, N", "1", "2", "3", "4"]]
