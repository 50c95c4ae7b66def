"""Scores of made-up verdicts whose value is known."""

import csv
import json
import math

import pytest
from click.testing import CliRunner

from sonicvacuum.blind.score import Row, calibration_bins, row, score, summary, wilson
from sonicvacuum.cli import cli
from sonicvacuum.files import InputError


def truth(id="x", kind="single", effects=("tsuji",), d_prime=10.0, **changes):
    hidden = [{"id": e, "parameters": {"alpha": 0.1}, "d_prime": d_prime} for e in effects]
    base = {
        "id": id,
        "kind": kind,
        "design": "traces",
        "noise": "white",
        "effects": list(effects),
        "d_prime": d_prime,
        "hidden": hidden,
        "leftover_d_prime": 9.0 if kind == "foreign" else 0.5,
        "nearest": {"id": "viscous-drag", "leaves_d_prime": 3.0},
        "ideal": {"tsuji": 0.9, "viscous-drag": 0.1},
    }
    return base | changes


def verdict(named=("tsuji",), probabilities=None, **changes):
    base = {
        "named": list(named),
        "probabilities": probabilities or {"none": 0.0, "unknown": 0.02, "tsuji": 0.98},
        "confusable": [],
        "parameters": {"tsuji": {"alpha": {"value": 0.11, "sigma": 0.01}}},
        "gap": {"held_out": {"before": 50.0, "after": 1.02, "floor": 1.0, "closed": 0.9996}},
        "timing_s": {"total": 2.0},
        "simulations": 100,
    }
    return base | changes


def test_right_name():
    found = row(truth(), verdict())
    assert (found.exact, found.class_level, found.false_alarm, found.confident_wrong) == (1, 1, 0, 0)
    assert found.ideal == 0.9
    assert (found.inside, found.intervals) == (1, 1)
    assert found.chi2 == pytest.approx(1.02)


def test_interval_that_misses():
    far = {"tsuji": {"alpha": {"value": 0.12, "sigma": 0.01}}}
    assert row(truth(), verdict(parameters=far)).inside == 0


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


def test_outside_the_catalogue():
    known = row(truth(kind="foreign", effects=("dimer",)), verdict(["unknown"]))
    assert (known.exact, known.says_unknown, known.reached) == (1, 1, 9.0)
    fooled = row(truth(kind="foreign", effects=("dimer",)), verdict(["tsuji"]))
    assert (fooled.exact, fooled.confident_wrong) == (0, 1)


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
    stated, right, count = calibration_bins(rows)[-1]
    assert (stated, right, count) == pytest.approx((0.98, 0.9, 10))
    line = next(one for one in summary(rows) if one.measure.startswith("calibration"))
    assert line.value == pytest.approx(0.08)


def test_summary_puts_cases_where_they_belong():
    rows = [row(truth(str(k), d_prime=d), verdict()) for k, d in enumerate((5.0, 5.2, 9.6, 21.0))]
    exact = {one.group: one for one in summary(rows) if one.measure == "exact name"}
    assert [exact[f"traces, d' {s}"].count for s in ("5", "7.5", "10", "20")] == [2, 0, 1, 1]
    assert exact["traces, d' 5"].ideal == pytest.approx(0.9)
    assert exact["traces, d' 5"].value == 1.0


def put(folder, id, name, content):
    (folder / id).mkdir(parents=True)
    (folder / id / name).write_text(json.dumps(content))


def test_command_writes_both_tables(tmp_path):
    for id in ("p", "q"):
        put(tmp_path / "truth" / "0", id, "truth.json", truth(id))
        put(tmp_path / "verdicts" / "0", id, "verdict.json", verdict())
    arguments = ["score", "--truth", tmp_path / "truth", "--verdicts", tmp_path / "verdicts"]
    outputs = ["--out", tmp_path / "score.csv", "--summary", tmp_path / "summary.csv"]
    done = CliRunner().invoke(cli, [str(a) for a in arguments + outputs], catch_exceptions=False)
    assert done.exit_code == 0
    with open(tmp_path / "score.csv", newline="") as stream:
        assert [r["exact"] for r in csv.DictReader(stream)] == ["1", "1"]
    assert "exact name" in (tmp_path / "summary.csv").read_text()
    assert set(Row.__dataclass_fields__) == set(
        (tmp_path / "score.csv").read_text().splitlines()[0].split(",")
    )


def test_missing_verdicts_are_named(tmp_path):
    put(tmp_path / "truth", "p", "truth.json", truth("p"))
    (tmp_path / "verdicts").mkdir()
    with pytest.raises(InputError, match="no verdict for 1 of 1 cases, first p"):
        score(tmp_path / "truth", tmp_path / "verdicts")
    with pytest.raises(InputError, match=r"holds no truth\.json"):
        score(tmp_path / "verdicts", tmp_path / "verdicts")


def test_verdicts_without_a_needed_key_are_named():
    broken = verdict()
    del broken["probabilities"]
    with pytest.raises(InputError, match="probabilities: missing"):
        row(truth(), broken, "here/verdict.json")


def test_hide_command_lists_cases_and_asks_for_folders(tmp_path):
    runner = CliRunner()
    listed = runner.invoke(cli, ["hide", "--study", "small", "--list", str(tmp_path / "cases.csv")])
    assert listed.exit_code == 0
    assert len((tmp_path / "cases.csv").read_text().splitlines()) > 24
    for arguments, words in (
        (["hide"], "--study or --cases"),
        (["hide", "--study", "small"], "--records and --truth"),
        (["hide", "--study", "small", "--batch", "4/4", "--records", "r", "--truth", "t"], "write k/n"),
    ):
        refused = runner.invoke(cli, arguments)
        assert isinstance(refused.exception, InputError)
        assert words in str(refused.exception)
