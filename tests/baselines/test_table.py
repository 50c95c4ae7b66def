"""The table of all rules: who is counted where, and what the command writes."""

import csv
import json
import math

import pytest
from click.testing import CliRunner
from made_cases import case, cell, single

from sonicvacuum.cli import cli
from sonicvacuum.files import InputError
from sonicvacuum_blind.baselines import forest, names, state, table
from sonicvacuum_blind.score import Row
from sonicvacuum_blind.shares import wilson


def cases():
    return [
        case([single("tsuji", 50.0), single("gravity", 1.0)], id="a"),
        case([single("tsuji", 50.0), single("gravity", 60.0)], id="b", design="ball"),
        case([single("tsuji", 1.0)], id="n", kind="null", effects="", named=""),
        case([single("tsuji", 30.0)], id="f", kind="foreign", effects="dimer", named="unknown"),
        case([single("tsuji", 30.0)], id="p", kind="pair", effects="tsuji+gravity"),
    ]


def found(rule, lines):
    return {(x.measure, x.group): x for x in lines if x.rule == rule}


def test_each_rule_is_counted_on_the_cases_that_it_can_name():
    lines = table.compare(cases(), [], ("best-chi2", "bic", "nearest-shape"), 1)
    chi2, bic = found("best-chi2", lines), found("bic", lines)
    assert chi2[names.EXACT, names.SINGLES].count == 2
    assert chi2[names.EXACT, names.SINGLES].value == 0.5
    assert (chi2[names.EXACT, "traces, d' 10"].value, chi2[names.EXACT, "ball"].value) == (1.0, 0.0)
    assert chi2[names.ALARM, names.NULLS].value == 1.0
    assert bic[names.ALARM, names.NULLS].value == 0.0
    assert bic[names.WRONG, names.OUTSIDE].value == 1.0
    one = chi2[names.EXACT, names.SINGLES]
    assert (one.low, one.high) == wilson(1, 2)
    assert not found("nearest-shape", lines)


@pytest.mark.parametrize("kind", ["pair", "set", "beside"])
def test_rules_that_learn_are_given_no_case_of_several_effects(kind, monkeypatch):
    """Each such case would be a class of its own: the forest could not share its classes out evenly."""
    several = case([single("tsuji", 30.0)], [cell("r1", "g1", "tail", 1.0)], id="s", kind=kind)
    seen = []
    monkeypatch.setattr(forest, "cross_validated", lambda cases: seen.extend(cases) or {})
    monkeypatch.setattr(forest, "trained", lambda known, cases: seen.extend([*known, *cases]) or {})
    monkeypatch.setattr(state, "name", lambda case, quieter: seen.append(case) or "none")
    alone = case([single("tsuji", 30.0)], [cell("r1", "g1", "tail", 1.0)], id="a")
    table.compare([alone, several], [alone, several], ("forest", "state"), 10)
    assert {c.row.id for c in seen} == {"a"}


def test_method_and_ideal_rule_stand_first():
    lines = table.compare(cases(), [], (), 1)
    assert list(dict.fromkeys(x.rule for x in lines)) == [table.METHOD, table.IDEAL]
    own, ideal = found(table.METHOD, lines), found(table.IDEAL, lines)
    assert own[names.EXACT, names.SINGLES].value == 1.0
    assert own[names.WRONG, names.OUTSIDE].value == 0.0
    assert ideal[names.EXACT, names.SINGLES].value == pytest.approx(0.9)
    assert math.isnan(ideal[names.EXACT, names.SINGLES].low)


def test_cosines_count_when_the_tables_have_them():
    made = [case([single("tsuji", 5.0, cosine=0.4)], id="a"), case(id="n", kind="null", effects="", named="")]
    nulls = [case([single("gravity", 1.0, cosine=0.5)], id="t", kind="null", effects="", named="")]
    for training, value in (([], 1.0), (nulls, 0.0)):
        lines = found("nearest-shape", table.compare(made, training, ("nearest-shape",), 1))
        assert lines[names.EXACT, names.SINGLES].value == value


def test_words_cover_every_rule_that_the_table_can_hold():
    assert {table.METHOD, table.IDEAL, "best-chi2", "bic", "nearest-shape"} <= set(names.RULES)


def write(folder, files):
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


@pytest.fixture
def study(tmp_path):
    """Folders of one case as hide and discover leave them."""
    truth = {
        **{"id": "x", "kind": "single", "design": "traces", "noise": "white", "effects": ["tsuji"]},
        **{"d_prime": 10.0, "leftover_d_prime": 0.0, "nearest": {"id": "gravity"}},
        "hidden": [{"id": "tsuji", "parameters": {"alpha": 0.1}, "d_prime": 10.0}],
    }
    verdict = {"named": ["tsuji"], "probabilities": {"tsuji": 1.0}, "confusable": [], "parameters": {}}
    files = {
        "records/0/x/record.yaml": "runs: []\n",
        "ideal.csv": "id,ideal,before,cells\nx,0.8,0.1,r1/g1=3\n",
        "truth/0/x/truth.json": json.dumps(truth),
        "verdicts/0/x/verdict.json": json.dumps(verdict),
        "verdicts/0/x/candidates.csv": "effects,delta_chi2,parameters\ngravity,9,gravity fraction 0.5\n"
        "tsuji,12,tsuji alpha 0.1\ntsuji+gravity,40,\n",
        "verdicts/0/x/gap.csv": "run,data,before\nr1,500,1.2\nall,1000,1.1\n",
        "verdicts/0/x/where.csv": "run,sensor,feature,z_before,q_before,size\nr1,g1,delay,3.0,0.02,\n",
    }
    write(tmp_path, files)
    return tmp_path


def run(study, *more):
    folders = [f"--{part}={study / part}" for part in ("records", "truth", "verdicts")]
    return CliRunner().invoke(cli, ["blind", "baselines", *folders, f"--out={study / 'out.csv'}", *more])


def test_command_writes_the_table(study):
    done = run(study, "--rule", "best-chi2", "--rule", "bic", f"--ideal={study / 'ideal.csv'}")
    assert done.exit_code == 0, done.output
    with open(study / "out.csv", newline="") as stream:
        lines = list(csv.DictReader(stream))
    right = {x["rule"]: x["value"] for x in lines if x["group"] == names.SINGLES}
    assert right == {"sonicvacuum": "1", "ideal rule": "0.8", "best-chi2": "1", "bic": "1"}


def test_command_names_the_missing_record(study):
    (study / "records" / "0" / "x" / "record.yaml").unlink()
    failed = run(study)
    assert isinstance(failed.exception, InputError)
    assert "no record of 1 cases, first x" in str(failed.exception)
    assert not (study / "out.csv").exists()


def test_command_names_the_missing_table(study):
    (study / "verdicts" / "0" / "x" / "where.csv").unlink()
    failed = run(study)
    assert isinstance(failed.exception, InputError)
    assert "where.csv" in str(failed.exception)


@pytest.mark.parametrize(
    "name, text",
    [
        ("candidates", "effects,delta_chi2,parameters\ntsuji,much,\n"),
        ("gap", "run,data,before\nall,many,1.1\n"),
        ("where", "run,sensor,feature,z_before,size\nr1,g1,delay,large,\n"),
        *((name, "name,price\ntea,2\n") for name in ("candidates", "gap", "where")),
    ],
)
def test_command_names_the_foreign_table(study, name, text):
    path = study / "verdicts" / "0" / "x" / f"{name}.csv"
    path.write_text(text)
    failed = run(study)
    assert isinstance(failed.exception, InputError), failed.exception
    assert str(path) in str(failed.exception)
    assert not (study / "out.csv").exists()


def test_rows_of_cases_are_scores():
    assert isinstance(case().row, Row)
