"""Compiled functions whose code, once kept, is loaded without the compiler."""

import pytest

from sonicvacuum.forward import discharge, together
from sonicvacuum.physics import resample
from sonicvacuum.physics.skeleton import alone


@pytest.mark.parametrize(
    ("function", "kinds"),
    [
        (together._find_tops, ("d3", "q", "d1", "q2")),
        (together._find_crossings, ("d3", "q", "q1", "d1", "q", "d1")),
        (together._climb_all, ("d2", "d2", "d1")),
        (discharge._compiled, ("d2", "d1", "d1", "d1", "d2")),
        (resample._compiled, ("d3", "q1", "q1", "d2", "d2", "q", "d3")),
    ],
)
def test_nothing_of_numba_is_called(function, kinds):
    """What may raise an error of Python's asks for Numba, a quarter of a second of every process."""
    assert b"numba_" not in alone(*function._make(), kinds, f"{function._name}_by_itself")
