"""Where an effect sits: moves along the chain from a neighbouring place."""

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover.fit import places, wide
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import singles
from sonicvacuum.effects import effect


def fitted(forward, null, id, place, strength):
    """One effect followed to its minimum at a place."""
    setup = singles.setup_of(forward)
    free = variants(effect(id), setup)[0]
    u = np.array([[free[0].inverse(strength)]])
    hypothesis = Hypothesis((Component(effect(id), free, place=place),))
    return fit(forward, hypothesis, u, null.nu[None])


@pytest.mark.parametrize(
    ("id", "kind", "parameters", "wrong"),
    [
        ("contact-gap", "contact", {"gap_um": 0.15, "contact": 6}, (8, 0.08)),
        ("mass-defect", "bead", {"mass_ratio": 0.95, "bead": 7}, (9, 0.97)),
    ],
)
def test_a_neighbouring_place_leads_to_the_true_one(id, kind, parameters, wrong):
    forward = Forward(experiment(made([(id, parameters)], seed=9)[0]), 1)
    null = wide.nominal(forward)
    start = fitted(forward, null, id, *wrong)
    found = places.settled(forward, start, singles.setup_of(forward))
    assert places.placed(found)
    assert found.hypothesis.components[0].place == parameters[kind]
    assert found.objective < start.objective


def test_what_sits_nowhere_stays():
    forward = Forward(experiment(made([], seed=9)[0]), 1)
    null = wide.nominal(forward)
    assert not places.placed(null)
    assert places.settled(forward, null, singles.setup_of(forward)) is null
