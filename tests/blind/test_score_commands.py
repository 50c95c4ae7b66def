"""The verbs that score verdicts and list cases, and what they say where something is missing."""

import csv

import pytest
from case_files import put
from click.testing import CliRunner
from made_truths import truth, verdict

from sonicvacuum.cli import cli
from sonicvacuum.files import InputError
from sonicvacuum_blind.score import Row, row, score


def test_command_writes_both_tables(tmp_path):
    for id in ("p", "q"):
        put(tmp_path / "truth" / "0", id, "truth.json", truth(id))
        put(tmp_path / "verdicts" / "0", id, "verdict.json", verdict())
    arguments = ["blind", "score", "--truth", tmp_path / "truth", "--verdicts", tmp_path / "verdicts"]
    outputs = ["--out", tmp_path / "score.csv", "--summary", tmp_path / "summary.csv"]
    done = CliRunner().invoke(cli, [str(a) for a in arguments + outputs], catch_exceptions=False)
    assert done.exit_code == 0
    with open(tmp_path / "score.csv", newline="") as stream:
        assert [r["exact"] for r in csv.DictReader(stream)] == ["1", "1"]
    assert "exact name" in (tmp_path / "summary.csv").read_text()
    assert set(Row.__dataclass_fields__) == set(
        (tmp_path / "score.csv").read_text().splitlines()[0].split(",")
    )


def test_tables_of_several_studies_count_all_their_records(tmp_path):
    """Studies number their records alike: none takes the place of another."""
    for study in ("one", "other"):
        put(tmp_path / study / "truth", "p", "truth.json", truth("p"))
        put(tmp_path / study / "verdicts", "p", "verdict.json", verdict())
        folder = tmp_path / study
        arguments = ["--truth", folder / "truth", "--verdicts", folder / "verdicts", "--tables", folder]
        arguments += ["--out", folder / "score.csv", "--summary", folder / "summary.csv"]
        CliRunner().invoke(cli, ["blind", "score", *map(str, arguments)], catch_exceptions=False)
    both = [str(tmp_path / study) for study in ("one", "other")]
    for folders, records in ((both[:1], 1), (both, 2)):
        out = tmp_path / f"of-{records}"
        CliRunner().invoke(cli, ["blind", "tables", *folders, "--out", str(out)], catch_exceptions=False)
        with open(out / "summary.csv", newline="") as stream:
            lines = {(line["measure"], line["group"]): line for line in csv.DictReader(stream)}
        assert lines["exact name", "all"]["count"] == str(records)
        with open(out / "coverage.csv", newline="") as stream:
            held = {(line["effect"], line["level"]): line for line in csv.DictReader(stream)}
        assert held["all", "0.9"]["count"] == str(records)


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
    listed = runner.invoke(cli, ["blind", "hide", "--study", "small", "--list", str(tmp_path / "cases.csv")])
    assert listed.exit_code == 0
    assert len((tmp_path / "cases.csv").read_text().splitlines()) > 24
    for arguments, words in (
        (["blind", "hide"], "--study or --cases"),
        (["blind", "hide", "--study", "small"], "--records and --truth"),
        (
            ["blind", "hide", "--study", "small", "--batch", "4/4", "--records", "r", "--truth", "t"],
            "write k/n",
        ),
    ):
        refused = runner.invoke(cli, arguments)
        assert isinstance(refused.exception, InputError)
        assert words in str(refused.exception)
