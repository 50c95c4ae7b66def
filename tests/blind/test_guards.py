"""No verb of the blind test or the reproduction writes over what it reads or has not made itself."""

import os
from pathlib import Path

import pytest

from sonicvacuum import cli
from sonicvacuum_blind import hide, study
from sonicvacuum_blind.hide import Spec

SPEC = Spec("a", "single", "traces", "white", ("sensor-gain",), 10.0, 7, 0)


@pytest.fixture
def refused(monkeypatch, capsys, tmp_path):
    """Call: the message of a command that must end with 2 and leave every file as it was."""
    monkeypatch.chdir(tmp_path)

    def never(*_):
        raise AssertionError("computed")

    monkeypatch.setattr(hide, "write", never)

    def call(*arguments):
        monkeypatch.setattr("sys.argv", ["sonicvacuum", *arguments])
        before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
        with pytest.raises(SystemExit) as end:
            cli.main()
        assert end.value.code == 2
        assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before
        return capsys.readouterr().err

    return call


@pytest.fixture
def cases(tmp_path):
    study.write_cases([SPEC], tmp_path / "cases.csv")
    return "cases.csv"


def test_hide_keeps_off_records_that_it_has_not_made(refused, cases, tmp_path):
    (tmp_path / "mine/a").mkdir(parents=True)
    (tmp_path / "mine/a/record.yaml").write_text("measured")
    call = ("blind", "hide", "--cases", cases, "--truth", "truth", "--records")
    assert "this command has not made" in refused(*call, "mine")
    assert "is the folder of a record" in refused(*call, "mine/a")
    assert "lies in the record" in refused(*call, "mine/a/more")


@pytest.mark.parametrize(("records", "truth"), [("r", "r"), ("r", "r/t"), ("t/r", "t"), ("r", "x/../r")])
def test_truth_stays_away_from_the_records(refused, cases, records, truth):
    call = ("blind", "hide", "--cases", cases, "--records", records, "--truth", truth)
    assert "keep the truth away" in refused(*call)


def test_hide_does_not_write_a_list_over_the_one_it_reads(refused, cases):
    assert "which is read here" in refused("blind", "hide", "--cases", cases, "--list", cases)


@pytest.mark.parametrize("out", ["s.csv", "full/report.csv", "drawn.svg"])
def test_a_page_is_not_written_over_what_it_shows(refused, tmp_path, out):
    (tmp_path / "full").mkdir()
    for name in ("s.csv", "full/report.csv", "drawn.svg"):
        (tmp_path / name).write_text(name)
    shown = ("--small", "s.csv", "--full", "full", "--picture", "drawn.svg")
    assert "which is read here" in refused("blind", "page", *shown, "--out", out)


def test_rivals_are_not_written_over_the_measurement(refused, tmp_path):
    (tmp_path / "rec").mkdir()
    for name in ("rec/record.yaml", "config.yaml"):
        (tmp_path / name).write_text(name)
    tables = ("map", "picture", "experiments", "relaxation", "losses")
    written = [part for name in tables for part in (f"--{name}", name)]
    call = ("paper", "rivals", *written, "--record", "rec/record.yaml", "--explained", "rec/record.yaml")
    assert "which is read here" in refused(*call)


def test_follow_keeps_off_verdicts_and_records(refused, cases, tmp_path):
    (tmp_path / "verdicts").mkdir()
    (tmp_path / "mine/a").mkdir(parents=True)
    (tmp_path / "mine/a/record.yaml").write_text("measured")
    call = ("blind", "follow", "--cases", cases, "--choice", "random", "--verdicts", "verdicts", "--records")
    assert "which is read here" in refused(*call, "verdicts/deep")
    assert "this command has not made" in refused(*call, "mine")


@pytest.mark.parametrize("link", [None, os.symlink, os.link])
def test_score_and_report_keep_off_what_they_read(refused, tmp_path, link):
    for name in ("truth/a/truth.json", "verdicts/a/verdict.json", "ledger.csv", "other.csv"):
        Path(tmp_path, name).parent.mkdir(parents=True, exist_ok=True)
        Path(tmp_path, name).write_text(name)
    target, ledger = "truth/a/truth.json", "ledger.csv"
    if link:
        link(tmp_path / target, tmp_path / "t")
        link(tmp_path / ledger, tmp_path / "l")
        target, ledger = "t", "l"
    folders = ("--truth", "truth", "--verdicts", "verdicts")
    assert "read here" in refused("blind", "score", *folders, "--out", target, "--summary", "s.csv")
    assert "read here" in refused("blind", "calibrate", *folders, "--out", target)
    tables = [f"--{name}=other.csv" for name in ("assumptions", "metrics", "claims")]
    assert "read here" in refused("paper", "report", "--ledger", "ledger.csv", *tables, "--out", ledger)
    kept = ("--claims", "other.csv", "--readme", "other.csv", "--guide", "g.md", "--reference", ledger)
    assert "read here" in refused("paper", "publish", "--ledger", "ledger.csv", *kept)


def test_two_outputs_are_never_one(refused, tmp_path):
    for folder in ("truth", "verdicts"):
        (tmp_path / folder).mkdir()
    call = ("blind", "score", "--truth", "truth", "--verdicts", "verdicts")
    shown = refused(*call, "--out", "s.csv", "--summary", "truth/../s.csv")
    assert "is written there too" in shown
