"""What nested sampling is given of a fit: the prior of the search, from the unit cube."""

import importlib.util
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from sonicvacuum.discover.model.parameters import Coordinate
from sonicvacuum.effects import Parameter

SCRIPT = Path(__file__).parents[2] / "workflow/bench/nested.py"
SIZE = 20.0


@pytest.fixture(scope="module")
def nested():
    found = importlib.util.spec_from_file_location("nested", SCRIPT)
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


def prior(nested, kind, u, two_sided):
    strength = Parameter("x", "1", 0.0, 1e-3, 1e3, "log-uniform", 1.0, "a strength", 0.0)
    one = Coordinate(strength, kind, 1.0, 0.0, -50.0, 50.0, two_sided)
    fit = SimpleNamespace(u=np.array([u]), hypothesis=SimpleNamespace(coordinates=(one,)))
    return one, nested.Prior(fit, SIZE**2)


@pytest.mark.parametrize(("kind", "u"), [("log", -1.5), ("linear", 0.4)])
def test_the_prior_is_flat_in_the_logarithm_of_the_size_in_the_data(nested, kind, u):
    coordinate, cube = prior(nested, kind, u, False)
    fitted = coordinate.value(u)
    # Strengths are proportional to their size in the data, which goes from 1 to 100.
    for share, size in ((0.0, 1.0), (0.5, 10.0), (1.0, 100.0)):
        value = coordinate.value(cube(np.array([share])))[0]
        assert value / fitted == pytest.approx(size / SIZE, rel=1e-12)  # rounding


def test_strengths_of_both_signs_are_equally_likely(nested):
    _, cube = prior(nested, "ratio", -0.2, True)
    down, up = (cube(np.array([x]))[0] for x in (0.5 - 0.25, 0.5 + 0.25))
    assert down == pytest.approx(-up, rel=1e-12)  # rounding
    assert up == pytest.approx(0.2 * 10.0 / SIZE, rel=1e-12)  # rounding
    assert math.copysign(1.0, cube(np.array([0.9]))[0]) == 1.0
