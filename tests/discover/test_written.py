"""What stands in the folder of a verdict: all of one search, whatever an earlier one left or drawing does."""

import errno
import itertools
from types import SimpleNamespace

import pytest
from click.testing import CliRunner

from sonicvacuum import drawn, folder, records
from sonicvacuum.cli import discover as verb
from sonicvacuum.discover import session
from sonicvacuum.discover import written as files

ALWAYS = ["where.csv", "candidates.csv", "gap.csv", "limits.csv", "traces.csv"]
ALWAYS += ["given.json", "model.json", "verdict.json"]


@pytest.fixture
def found(empty, nothing, tmp_path, monkeypatch):
    """A call of the verb on records of the given names, whose searches are done already."""
    monkeypatch.setattr(session, "discover", lambda *given, **how: nothing)

    def call(*names, options=()):
        for name in names:
            records.write(empty, tmp_path / name)
        asked = [
            *(str(tmp_path / name) for name in names),
            "--out",
            str(tmp_path / "found"),
            "--threads",
            "1",
        ]
        return CliRunner().invoke(verb.discover, [*asked, *options])

    return call


def written(monkeypatch, place, scalars, posterior, law):
    """Names of all that a verdict with these has; nothing is worked out for them."""
    names = []
    run = SimpleNamespace(scalars=scalars)
    search = SimpleNamespace(
        null=None, forward=SimpleNamespace(experiment=SimpleNamespace(runs=[run], notes=()))
    )
    result = SimpleNamespace(
        places=[], after=[], found=search, limits=[], law=law, posterior=posterior, notes=()
    )
    result.extended = result.given = result.verdict = result.model = None
    with monkeypatch.context() as patch:
        patch.setattr(files.verdict, "write_table", lambda path, *_: names.append(path.name))
        patch.setattr(files.verdict, "write_json", lambda _, path: names.append(path.name))
        patch.setattr(files.draws, "write_csv", lambda path, *_: names.append(path.name))
        patch.setattr(files.draws, "_rows", lambda _: [])
        patch.setattr(files.quantities, "rows", lambda *_: [])
        patch.setattr(files.given, "inputs", lambda *_: None)
        patch.setattr(files.law, "rows", lambda _: ([], []))
        patch.setattr(files, "surface", lambda _: None)
        for name in ("candidates", "gap_rows", "trace_rows"):
            patch.setattr(files, name, lambda _: ([], []))
        files.write(result, place)
    return names


def test_every_file_that_only_some_verdicts_have_is_one_that_an_earlier_one_may_have_left(
    monkeypatch, tmp_path
):
    some = set()
    for scalars, posterior, law in itertools.product(((), (1,)), ((), (1,)), (None, object())):
        names = written(monkeypatch, tmp_path, scalars, posterior, law)
        assert len(names) == len(set(names))
        assert set(ALWAYS) <= set(names)
        some |= set(names) - set(ALWAYS)
    assert some == {"law.csv", "posterior.csv", "quantities.csv"}
    assert some <= set(folder.sometimes())
    assert not set(ALWAYS) & set(folder.sometimes())


def test_nothing_of_an_earlier_verdict_stays_beside_this_one(found, tmp_path):
    (tmp_path / "found").mkdir()
    for name in (*ALWAYS, *folder.sometimes(), "mine.txt"):
        (tmp_path / "found" / name).write_text("of an earlier record\n")
    assert found("empty", options=["--no-figures"]).exit_code == 0
    left = {p.name for p in (tmp_path / "found").iterdir() if p.read_text() == "of an earlier record\n"}
    assert left == {"mine.txt"}


def fails(error):
    def draw(place, known, png=False):
        (place / "where.svg").write_text("<svg>")
        raise error

    return draw


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (IndexError("list index out of range"), "IndexError: list index out of range"),
        (OSError(errno.ENOSPC, "No space left on device", "x"), "No space left on device); make them with"),
        (MemoryError("no 3 GB"), "MemoryError: no 3 GB); make them with sonicvacuum page"),
    ],
)
def test_a_verdict_outlives_the_failure_of_its_pictures_and_the_exit_code_tells(
    found, tmp_path, monkeypatch, error, told
):
    monkeypatch.setattr(drawn, "illustrate", fails(error))
    result = found("empty")
    assert result.exit_code == 1
    assert result.stdout.startswith(f"{tmp_path / 'empty'}: none")
    assert f"{tmp_path / 'found'} holds the verdict without pictures" in result.stderr.splitlines()[-1]
    assert told in result.stderr.splitlines()[-1]
    assert ("Traceback" in result.stderr) == isinstance(error, IndexError)  # a fault of the program is shown
    names = {path.name for path in (tmp_path / "found").iterdir()}
    assert set(ALWAYS) <= names
    assert not names & set(drawn.page_files())


def test_of_several_verdicts_those_without_pictures_are_counted(found, tmp_path, monkeypatch):
    whole, errors = drawn.illustrate, [KeyError("run")]

    def but_for_the_first(*given):
        return fails(errors.pop())(*given) if errors else whole(*given)

    monkeypatch.setattr(drawn, "illustrate", but_for_the_first)
    result = found("one", "two")
    assert result.exit_code == 1
    assert result.stderr.splitlines()[-1] == "Error: 1 of 2 verdicts have no pictures, as told above"
    assert (tmp_path / "found/one/verdict.json").is_file()
    assert not (tmp_path / "found/one/index.html").exists()
    assert (tmp_path / "found/two/index.html").is_file()
