"""What a terminal is shown while a search runs, and what any verb says where it must compile."""

import click
import numba
import pytest
from click.testing import CliRunner

from sonicvacuum.cli import stage_lines
from sonicvacuum.physics import compiled, dispatchers
from sonicvacuum.stages import compilations_told_to


@pytest.mark.parametrize(
    ("known", "shown"),
    [
        ((0, None, 3.2, None, False), "3 s"),
        ((7, 21, 7.0, 13.0, False), "7 of 21, 7 s, about 13 s left"),
        ((7, 21, 75.0, 130.0, False), "7 of 21, 1 min 15 s, about 2 min 10 s left"),
        ((0, 21, 4.0, None, True), "0 of 21, 4 s, compiling kernels, once on this computer"),
    ],
)
def test_the_state_of_a_stage_in_words(known, shown):
    assert stage_lines.state(*known) == shown


def twice(x):
    return 2.0 * x


def thrice(x):
    return 3.0 * x


@pytest.fixture
def compile_laws(monkeypatch, tmp_path):
    """Function that compiles so many kernels, as an empty folder of kernels makes a verb do."""
    for module in (compiled, dispatchers):
        monkeypatch.setattr(module, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(dispatchers, "_prepared", set())

    def compile_laws(count):
        for law in (twice, thrice)[:count]:
            dispatchers.prepare(dispatchers.cached(numba.njit(law)), law.__name__, (1.0,))

    return compile_laws


def test_a_compilation_is_heard_and_what_is_read_from_the_folder_is_not(compile_laws, monkeypatch):
    heard = []
    with compilations_told_to(heard.append):
        compile_laws(1)
        monkeypatch.setattr(dispatchers, "_prepared", set())
        compile_laws(1)
    assert heard == [1, -1]
    compile_laws(2)
    assert heard == [1, -1]


def said_by_a_verb(work):
    """Standard error of a verb that does some work."""
    name = click.command(name="work")(work)
    with stage_lines.compiling_told():
        return CliRunner().invoke(name, catch_exceptions=False).stderr


def test_a_log_gets_one_plain_line_however_much_is_compiled(compile_laws):
    told = said_by_a_verb(lambda: compile_laws(2))
    assert told == f"work: {stage_lines.COMPILING}: {stage_lines.LENGTH}\n"
    assert said_by_a_verb(lambda: compile_laws(2)) == ""


def test_where_kernels_cannot_be_kept_the_cure_is_told(compile_laws, monkeypatch):
    for module in (compiled, dispatchers):
        monkeypatch.setattr(module, "cache_folder", lambda: None)
    told = said_by_a_verb(lambda: compile_laws(1))
    assert told == f"work: {stage_lines.NOT_KEPT}\n"


@pytest.mark.parametrize("quiet", [True, False])
def test_a_quiet_search_does_not_say_that_it_compiles(compile_laws, quiet):
    def search():
        with stage_lines.stages_shown("record", quiet):
            compile_laws(1)

    assert bool(said_by_a_verb(search)) is not quiet
