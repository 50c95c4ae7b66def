"""What counts as resolved, on made-up verdicts whose value is known."""

import csv
import json
import math

import pytest
from case_files import put
from click.testing import CliRunner

from sonicvacuum.cli import cli
from sonicvacuum.files import InputError
from sonicvacuum_blind.resolved import Followed, resolved, row, summary
from sonicvacuum_blind.shares import wilson

TRUTH = {"id": "x", "design": "traces", "noise": "white", "effects": ["tsuji"], "d_prime": 10.0}
FIRST = {
    "named": ["gravity"],
    "confusable": [["gravity", "tsuji"]],
    "next_experiment": {"change": {"striker.mass_g": 2.5}, "delta_chi2": 50.0},
}
CHANGE = {"choice": "proposed", "change": {"striker.mass_g": 2.5}}
RANDOM = {"choice": "random", "change": {"chain.orientation": "vertical"}}
DECIDED = {"named": ["tsuji"], "confusable": []}
STILL = {"named": ["tsuji"], "confusable": [["tsuji", "gravity"]]}
WRONG = {"named": ["gravity"], "confusable": []}


def test_resolved_is_the_right_name_and_no_other():
    found = row(TRUTH, FIRST, CHANGE, DECIDED)
    assert (found.resolved, found.exact, found.exact_before) == (1, 1, 0)
    assert (found.before, found.left_before, found.left) == ("gravity", "tsuji", "")
    assert (found.change, found.predicted) == ("striker.mass_g=2.5", 50.0)
    open_still = row(TRUTH, FIRST, CHANGE, STILL)
    assert (open_still.resolved, open_still.exact, open_still.left) == (0, 1, "gravity")
    for joint in (WRONG, {"named": ["tsuji", "unknown"], "confusable": []}, {"named": [], "confusable": []}):
        assert (row(TRUTH, FIRST, CHANGE, joint).resolved, row(TRUTH, FIRST, CHANGE, joint).exact) == (0, 0)


def test_a_law_and_one_that_it_is_a_limit_of_are_told_apart_by_no_run():
    hidden = TRUTH | {"effects": ["kuwabara-kono"]}
    beside = {"named": ["kuwabara-kono"], "confusable": [["kuwabara-kono", "relaxing-contact"]]}
    more = {"named": ["kuwabara-kono"], "confusable": [["kuwabara-kono", "relaxing-contact", "tsuji"]]}
    rows = [row(hidden | {"id": id}, FIRST, CHANGE, joint) for id, joint in (("a", beside), ("b", more))]
    rows.append(row(TRUTH | {"id": "c"}, FIRST, CHANGE, DECIDED))
    found = {(line.measure, line.group): line.value for line in summary(rows)}
    assert found["resolved by one more run", "proposed"] == pytest.approx(1 / 3)
    assert found["resolved, but for limits", "proposed"] == pytest.approx(2 / 3)


def test_nothing_is_predicted_of_a_random_run():
    found = row(TRUTH, FIRST, RANDOM, DECIDED)
    assert (found.choice, found.change) == ("random", "chain.orientation=vertical")
    assert math.isnan(found.predicted)


def test_shares_by_choice():
    rows = [
        row(TRUTH | {"id": id}, FIRST, change, joint)
        for id, one, other in (("a", DECIDED, DECIDED), ("b", DECIDED, WRONG), ("c", DECIDED, STILL))
        for change, joint in ((CHANGE, one), (RANDOM, other))
    ]
    found = {(line.measure, line.group): line for line in summary(rows)}
    proposed = found["resolved by one more run", "proposed"]
    assert (proposed.count, proposed.value, (proposed.low, proposed.high)) == (3, 1.0, wilson(3, 3))
    assert found["resolved by one more run", "random"].value == pytest.approx(1 / 3)
    assert found["resolved by this run alone", "proposed"].value == pytest.approx(2 / 3)
    assert found["resolved by this run alone", "random"].value == 0.0
    ratio = found["resolved, ratio", "proposed over random"]
    assert (ratio.count, ratio.value) == (3, pytest.approx(3.0))
    assert ratio.low <= 3.0 <= ratio.high
    exact = {g: line.value for (m, g), line in found.items() if m.startswith("exact name")}
    assert exact == pytest.approx({"before": 0.0, "proposed": 1.0, "random": 2 / 3})


@pytest.fixture
def folders(tmp_path):
    """Truth, first verdicts, further runs and joint verdicts of one case, as folders."""
    put(tmp_path / "truth" / "0", "x", "truth.json", TRUTH)
    put(tmp_path / "first" / "0", "x", "verdict.json", FIRST)
    for choice, change, joint in (("proposed", CHANGE, DECIDED), ("random", RANDOM, WRONG)):
        put(tmp_path / "runs" / choice / "0", "x", "change.json", change)
        put(tmp_path / "joint" / choice / "0", "x", "verdict.json", joint)
    return tmp_path


def test_command_writes_rows_and_table(folders):
    call = ["blind", "resolved", "--truth", "truth", "--verdicts", "first"]
    for choice in ("proposed", "random"):
        call += [f"--{choice}", f"runs/{choice}", f"joint/{choice}"]
    call += ["--out", "resolved.csv", "--summary", "summary.csv"]
    call = [c if c.startswith("--") or c in ("blind", "resolved") else str(folders / c) for c in call]
    done = CliRunner().invoke(cli, call, catch_exceptions=False)
    assert done.exit_code == 0
    with open(folders / "resolved.csv", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [(r["choice"], r["resolved"]) for r in rows] == [("proposed", "1"), ("random", "0")]
    assert set(rows[0]) == set(Followed.__dataclass_fields__)
    assert "resolved by one more run,proposed,1,1," in (folders / "summary.csv").read_text()


def test_what_is_missing_is_named(folders):
    runs, joint = folders / "runs" / "proposed", folders / "joint" / "proposed"
    with pytest.raises(InputError, match="choice is proposed, not random"):
        resolved(folders / "truth", folders / "first", "random", runs, joint)
    (joint / "0" / "x" / "verdict.json").write_text(json.dumps({"named": ["tsuji"]}))
    with pytest.raises(InputError, match="confusable: missing"):
        resolved(folders / "truth", folders / "first", "proposed", runs, joint)
    (joint / "0" / "x" / "verdict.json").unlink()
    with pytest.raises(InputError, match=r"no joint verdict .* for 1 of 1 cases: x"):
        resolved(folders / "truth", folders / "first", "proposed", runs, joint)
