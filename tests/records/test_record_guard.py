"""A record is never written over, and a new result replaces an old one whole or not at all."""

import itertools
import os
import re
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
import yaml
from record_cases import BALL

from sonicvacuum import cli, outputs
from sonicvacuum.discover import session
from sonicvacuum.files import InputError
from sonicvacuum.records import reader
from sonicvacuum.records.guard import check_out


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A working folder with the record rec, another called other, and nothing that may be computed."""
    monkeypatch.chdir(tmp_path)
    for name in ("rec", "other"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "record.yaml").write_text(yaml.safe_dump(BALL))
        (tmp_path / name / "model.json").write_text("{}")

    def never(*records, threads):
        raise AssertionError("computed")

    monkeypatch.setattr(session, "discover", never)
    return tmp_path


def refused(monkeypatch, capsys, *arguments):
    """The message of a call that must end with 2, having written nothing."""
    monkeypatch.setattr("sys.argv", ["sonicvacuum", *arguments])
    before = snapshot(".")
    with pytest.raises(SystemExit) as end:
        cli.main()
    assert end.value.code == 2
    assert snapshot(".") == before
    return capsys.readouterr().err


def snapshot(folder):
    return {
        os.path.join(top, name): open(os.path.join(top, name), "rb").read()
        for top, _, names in os.walk(folder)
        for name in names
    } | {top: b"" for top, _, _ in os.walk(folder)}


def test_the_path_of_an_unset_variable_is_refused(place, monkeypatch, capsys):
    assert "is empty" in refused(monkeypatch, capsys, "discover", "rec", "--out", "")
    assert "record is empty" in refused(monkeypatch, capsys, "discover", "", "--out", "found")


def test_a_link_to_itself_is_no_place_for_results(place):
    (place / "loop").symlink_to("loop")
    with pytest.raises(InputError, match="loop is a file"):
        check_out("loop")


def test_a_link_to_itself_beside_the_results_stops_nothing(place):
    (place / "out").mkdir()
    (place / "out/loop").symlink_to("loop")
    check_out("out", ["rec"])


@pytest.mark.parametrize(
    "arguments",
    [
        ["rec", "--out", "rec"],
        ["rec", "--out", "other/../rec"],
        ["rec", "--out", "rec/found/deep"],
        ["rec", "--out", "other"],
        ["rec", "--out", "link"],
        ["rec/record.yaml", "--out", "link/found"],
        ["rec", "other", "--out", "."],
        ["rec", "other", "--together", "--out", "other"],
    ],
)
def test_a_folder_in_a_record_is_refused_before_anything_is_computed(place, monkeypatch, capsys, arguments):
    (place / "link").symlink_to("rec")
    shown = refused(monkeypatch, capsys, "discover", *arguments)
    assert "give a folder outside of it" in shown


@pytest.mark.parametrize("link", [os.symlink, os.link])
def test_a_folder_that_holds_a_file_of_a_record_through_a_link_is_refused(place, monkeypatch, capsys, link):
    (place / "out").mkdir()
    link(place / "rec/model.json", place / "out/model.json")
    assert "which is read here" in refused(monkeypatch, capsys, "discover", "rec", "--out", "out")


def test_a_record_whose_file_is_a_link_into_the_folder_is_refused(place, monkeypatch, capsys):
    (place / "raw").mkdir()
    (place / "raw/traces.csv").write_text("measured")
    (place / "rec/traces.csv").symlink_to("../raw/traces.csv")
    assert "which is read here" in refused(monkeypatch, capsys, "discover", "rec", "--out", "raw")


@pytest.mark.parametrize("out", ["taken", "taken/deep", "/proc/nowhere/found"])
def test_a_folder_that_cannot_be_written_is_told_first(place, monkeypatch, capsys, out):
    (place / "taken").write_text("a file")
    shown = refused(monkeypatch, capsys, "discover", "rec", "--out", out)
    assert out in shown
    assert "Traceback" not in shown


@pytest.mark.parametrize("target", ["rec/record.yaml", "rec/../rec/model.json", "score.json"])
def test_a_score_is_not_written_over_what_is_read(place, monkeypatch, capsys, target):
    (place / "score.json").symlink_to("rec/record.yaml")
    call = ("compare", "rec", "--model", "other/model.json", "--json", target)
    assert "which is read here; give another place" in refused(monkeypatch, capsys, *call)


@pytest.mark.parametrize("name", ["model.json", "verdict.json"])
def test_an_export_is_not_written_over_what_discover_wrote(place, monkeypatch, capsys, name):
    (place / "other/verdict.json").write_text("{}")
    call = ("export", "other/model.json", "--record", "rec", "--out", f"other/{name}")
    assert "which is read here" in refused(monkeypatch, capsys, *call)


def test_a_page_is_not_written_into_a_record(place, monkeypatch, capsys):
    (place / "rec/verdict.json").write_text("{}")
    assert "is the folder of a record" in refused(monkeypatch, capsys, "page", "rec")


def test_a_page_of_no_verdict_is_refused(place, monkeypatch, capsys):
    (place / "out").mkdir()
    told = "has no verdict.json; give a folder that sonicvacuum discover wrote"
    for folder in ("out", "rec"):
        assert f"{folder}: {told}" in refused(monkeypatch, capsys, "page", folder)


def test_a_record_that_is_given_twice_need_not_be_renamed(place, monkeypatch, capsys):
    told = "rec: is given twice; give it once"
    assert told in refused(monkeypatch, capsys, "discover", "./rec", "rec", "--out", "out")


def test_a_card_is_not_written_over_what_it_is_made_of(place, monkeypatch, capsys):
    (place / "card.json").write_text("{}")
    assert "which is read here" in refused(
        monkeypatch, capsys, "simulate", "card.json", "--out", "./card.json"
    )


def test_a_new_folder_beside_a_record_is_free(place):
    check_out("found", ["rec"])
    check_out(".", ["rec"])
    assert not (place / "found").exists()


def test_a_failure_leaves_the_old_result_whole(tmp_path):
    (tmp_path / "verdict.json").write_text("old")
    (tmp_path / "gap.csv").write_text("old")
    before = snapshot(tmp_path)
    with pytest.raises(InputError), outputs.renewed(tmp_path, last="verdict.json") as fresh:
        (fresh / "gap.csv").write_text("new")
        raise InputError
    assert snapshot(tmp_path) == before


def test_a_failure_leaves_no_empty_folder(tmp_path):
    with pytest.raises(InputError), outputs.renewed(tmp_path / "new", last="verdict.json"):
        raise InputError
    assert not (tmp_path / "new").exists()


def test_a_new_result_replaces_what_an_earlier_one_left_and_nothing_else(tmp_path):
    for name in ("verdict.json", "gap.csv", "index.html", "notes.txt"):
        (tmp_path / name).write_text("old")
    with outputs.renewed(tmp_path, last="verdict.json", stale=["index.html"]) as fresh:
        for name in ("verdict.json", "gap.csv"):
            (fresh / name).write_text("new")
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {
        "verdict.json": "new", "gap.csv": "new", "notes.txt": "old"
    }  # fmt: skip


OLD = ("gap.csv", "index.html", "verdict.json", "where.csv")
NEW = ("gap.csv", "new.csv", "verdict.json", "where.csv")


# A result of three files that stand there and one that does not, in place of one of four.
EXCHANGE = f"""
from sonicvacuum import outputs
def exchange(folder):
    with outputs.renewed(folder, last="verdict.json", stale=["index.html"]) as fresh:
        for name in {NEW}:
            (fresh / name).write_text("new")
"""
KILLED = f"""{EXCHANGE}
import itertools, os, pathlib, signal, sys
replace, moves = os.replace, itertools.count()
def moved(source, target):
    if next(moves) == int(sys.argv[1]):
        os.kill(os.getpid(), signal.SIGKILL)
    replace(source, target)
os.replace = moved
exchange(pathlib.Path(sys.argv[2]))
"""


def exchange(folder):
    """That result, in this process."""
    names = {}
    exec(EXCHANGE, names)
    names["exchange"](folder)


@pytest.mark.parametrize("at", range(9))
def test_an_interruption_while_files_change_places_leaves_the_old_result_whole(tmp_path, monkeypatch, at):
    """Four files go and four come; the ninth move is none."""
    for name in OLD:
        (tmp_path / name).write_text("old")
    before = snapshot(tmp_path)

    replace, moves = os.replace, itertools.count()

    def interrupted(source, target):
        if next(moves) == at:
            raise KeyboardInterrupt
        replace(source, target)

    monkeypatch.setattr(os, "replace", interrupted)
    if at == 8:
        exchange(tmp_path)
        assert {path.name: path.read_text() for path in tmp_path.iterdir()} == dict.fromkeys(NEW, "new")
        return
    with pytest.raises(KeyboardInterrupt):
        exchange(tmp_path)
    assert snapshot(tmp_path) == before


@pytest.mark.parametrize("at", range(9))
def test_a_kill_while_files_change_places_loses_nothing_and_mixes_nothing(tmp_path, at):
    """A folder with a verdict holds the files of one run, and both runs stand somewhere."""
    for name in OLD:
        (tmp_path / name).write_text("old")
    ended = subprocess.run([sys.executable, "-c", KILLED, str(at), str(tmp_path)], check=False)
    assert ended.returncode == (-signal.SIGKILL if at < 8 else 0)
    shown = {path.name: path.read_text() for path in tmp_path.iterdir() if path.is_file()}
    if "verdict.json" in shown:
        assert shown == (dict.fromkeys(OLD, "old") if at == 0 else dict.fromkeys(NEW, "new"))
    else:
        # Who reads such a folder is told where its files are.
        (earlier,) = [path.name for path in tmp_path.iterdir() if path.name.endswith(".earlier")]
        with pytest.raises(InputError, match=re.escape(earlier)):
            reader.read(tmp_path)
    kept = sorted((path.name, path.read_text()) for path in tmp_path.rglob("*") if path.is_file())
    assert at == 8 or kept == sorted([*((n, "old") for n in OLD), *((n, "new") for n in NEW)])


def test_two_results_that_come_at_a_time_are_not_mixed(tmp_path, monkeypatch):
    replace = os.replace

    def slow(source, target):
        time.sleep(0.01)
        replace(source, target)

    monkeypatch.setattr(os, "replace", slow)

    def one(content):
        with outputs.renewed(tmp_path, last="verdict.json", stale=["index.html"]) as fresh:
            for name in NEW:
                (fresh / name).write_text(content)

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(one, "abcd"))
    left = {path.name: path.read_text() for path in tmp_path.iterdir()}
    assert left in [dict.fromkeys(NEW, content) for content in "abcd"]


def test_a_folder_where_a_file_is_to_stand_stays(tmp_path):
    (tmp_path / "gap.csv").mkdir()
    (tmp_path / "verdict.json").write_text("old")
    with pytest.raises(InputError, match=r"gap\.csv: is a folder"):
        exchange(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["gap.csv", "verdict.json"]
