"""What a terminal is shown while a search runs."""

import numba
import pytest

from sonicvacuum.cli import stage_lines


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


def test_a_compilation_is_heard_and_only_within():
    heard = []
    with stage_lines._compilations(heard.append):
        numba.njit(lambda x: x + 1)(1)
    assert heard[:1] == [1]
    assert sum(heard) == 0
    before = len(heard)
    numba.njit(lambda x: x + 2)(1)
    assert len(heard) == before
