"""A verdict written from Python: the files of the command, by its code, whole or not at all."""

import json

import pytest
from ball import RECORD
from click.testing import CliRunner

import sonicvacuum as sv
from sonicvacuum import drawn
from sonicvacuum.cli import cli


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ball")
    (folder / "record.yaml").write_text(RECORD)
    return folder


@pytest.fixture(scope="module")
def found(record):
    return sv.discover(sv.read(record), threads=1)


def files(folder):
    """Name → content of the files in a folder, but for what took how long."""
    kept = {p.name: p.read_bytes() for p in folder.iterdir()}
    verdict = json.loads(kept.pop("verdict.json"))
    page = kept.pop("index.html", None)
    return kept, {k: v for k, v in verdict.items() if k != "timing_s"}, page is None


def test_the_folder_is_that_of_the_command(record, found, tmp_path):
    asked = ["discover", str(record), "--out", str(tmp_path / "typed"), "--threads", "1", "--quiet"]
    assert CliRunner().invoke(cli, asked).exit_code == 0
    assert sv.write_verdict(found, tmp_path / "made") == tmp_path / "made"
    typed, made = files(tmp_path / "typed"), files(tmp_path / "made")
    assert sorted(typed[0]) == sorted(made[0])
    assert typed == made


def test_pictures_may_be_left_out_and_those_of_an_earlier_verdict_go(found, tmp_path):
    sv.write_verdict(found, tmp_path / "made")
    (tmp_path / "made/mine.txt").write_text("kept")
    sv.write_verdict(found, str(tmp_path / "made"), figures=False)
    assert not {p.name for p in (tmp_path / "made").iterdir()} & set(drawn.page_files())
    assert (tmp_path / "made/mine.txt").read_text() == "kept"
    score = sv.compare(tmp_path / "made/model.json", found.given[0], threads=1)
    assert score.gap.after == pytest.approx(found.verdict.gap.fitted.after, rel=1e-3)


def test_nothing_is_written_into_a_record(record, found):
    before = sorted(record.iterdir())
    with pytest.raises(sv.InputError, match=r"is the folder of a record; give a folder outside"):
        sv.write_verdict(found, record)
    with pytest.raises(sv.InputError, match=r"lies in the record .*; give a folder outside"):
        sv.write_verdict(found, record / "found")
    assert sorted(record.iterdir()) == before


def test_a_file_in_the_way_and_what_is_no_result_are_refused(found, tmp_path):
    (tmp_path / "taken").write_text("mine")
    with pytest.raises(sv.InputError, match=r"taken.* is a file; give another folder"):
        sv.write_verdict(found, tmp_path / "taken")
    with pytest.raises(sv.InputError, match=r"^write_verdict: is given .* as a result; give what disc"):
        sv.write_verdict(found.verdict, tmp_path / "made")
    with pytest.raises(sv.InputError, match=r"^write_verdict: is given None; give the path of a folder"):
        sv.write_verdict(found, None)
    assert [p.name for p in tmp_path.iterdir()] == ["taken"]


def test_a_verdict_outlives_its_pictures_and_the_error_says_so(found, tmp_path, monkeypatch):
    def fails(place, known, png=False):
        (place / "where.svg").write_text("<svg>")
        raise IndexError("list index out of range")

    monkeypatch.setattr(drawn, "illustrate", fails)
    with pytest.raises(IndexError, match="out of range") as told:
        sv.write_verdict(found, tmp_path / "made")
    assert told.value.__notes__ == [
        f"{tmp_path / 'made'} holds the verdict without pictures and page, which failed"
    ]
    assert (tmp_path / "made/verdict.json").is_file()
    assert not (tmp_path / "made/where.svg").exists()
