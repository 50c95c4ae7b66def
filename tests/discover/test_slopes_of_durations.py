"""Slopes of a duration near the base of a pulse, which bends over a few per cent of a loss."""

from pathlib import Path

import numpy as np
import pytest

from sonicvacuum.discover.fit.descent import differences
from sonicvacuum.discover.fit.normal import linearise
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search.singles import setup_of
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.records import read

COATED = Path(__file__).parents[2] / "workflow/resources/measured/daraio-nesterenko-2006-coated"
DURATION = 1  # the second number of the first run


@pytest.fixture(scope="module")
def coated():
    """The paper's table of coated beads, and its nominal fit."""
    forward = Forward(experiment(read(COATED)))
    return forward, nominal(forward)


@pytest.mark.parametrize(("name", "value"), [("hunt-crossley", 0.3848), ("linear-dashpot", 1.0888)])
def test_steps_of_a_fit_do_not_reach_where_a_duration_bends(coated, name, value):
    """Durations at 2 % of the peak grow with damping; slopes over steps of 0.05 had −52 and −3."""
    forward, null = coated
    effect = CATALOGUE.effect(name)
    hypothesis = Hypothesis((Component(effect, variants(effect, setup_of(forward))[0]),))
    u = np.array([[c.inverse(value) for c in hypothesis.coordinates]])
    steps = differences(linearise(forward, hypothesis, u, null.nu[None]))

    def slope(steps):
        columns = forward.columns(hypothesis, u, null.nu[None], precise=True, steps=steps)
        return columns[0][0, 1, DURATION]

    fine = slope(np.full((1, 1), 0.005))
    assert fine > 0.0
    assert slope(steps) == pytest.approx(fine, rel=0.1)  # of a fit, which looks again where it has gone
