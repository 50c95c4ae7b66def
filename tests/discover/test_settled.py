"""Runs without traces are simulated until their numbers are settled, which are those of the whole."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.forward import amplitude
from sonicvacuum.physics.scales import impact_forces, impact_scales
from sonicvacuum.records import read

MEASURED = Path(__file__).parents[2] / "workflow/resources/measured"
# The interval of equidistant times is rounded differently where there are more of them.
ROUNDING = 1e-10


@pytest.fixture(scope="module", params=sorted(p.name for p in MEASURED.iterdir() if p.is_dir()))
def begun(request):
    """The data set of a record that has no traces."""
    return experiment(read(MEASURED / request.param))


def whole(data):
    """The same, all of it simulated at once."""
    return replace(data, batches=tuple(replace(b, settled_s=np.inf) for b in data.batches))


def predicted(data, nu):
    """All numbers of all runs (L, M), and the chains simulated for them."""
    forward = Forward(data)
    return np.concatenate(
        forward.sampled(Hypothesis(()), np.zeros((len(nu), 0)), nu), axis=1
    ), forward.simulations


def test_numbers_are_those_of_the_whole(begun, monkeypatch):
    forward = Forward(begun)
    nu = np.zeros((5, forward.layout.size))
    # As stated, stiffer and softer: e³ times as soft, waves take 3^{0.4} times as long.
    nu[:, forward.layout.modulus] = np.array([0.0, 1.0, -1.0, -2.0, -3.0]) / begun.modulus_rel_sigma
    assert any(b.first_s < 0.8 * b.duration for b in begun.batches)
    found, chains = predicted(begun, nu)
    monkeypatch.setattr(amplitude, "CROSSINGS", (10.0 * amplitude.CROSSINGS[-1],))
    expected, once = predicted(whole(begun), nu)
    np.testing.assert_allclose(found, expected, rtol=ROUNDING)
    assert once == nu.shape[0] * len(begun.runs) < chains


def test_what_is_settled_is_not_simulated_again(begun):
    nu = np.zeros((3, Forward(begun).layout.size))
    found, chains = predicted(begun, nu)
    assert chains == found.shape[0] * len(begun.runs)


def test_forces_of_impacts_are_those_of_chains_alone(begun):
    forward = Forward(begun)
    chain = forward.nominal(begun.batches[0], np.zeros((3, forward.layout.size))).chain
    chain = chain.struck_at(chain.speed * np.linspace(0.3, 3.0, chain.lanes))
    alone = [impact_scales(chain.take([k]))[0] for k in range(chain.lanes)]
    np.testing.assert_allclose(impact_forces(chain), alone, rtol=1e-14)  # rounding of the same formula
