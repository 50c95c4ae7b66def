"""A term whose strengths are zero is passed over: a kernel of many laws gives what one without it gives."""

import numpy as np
import pytest

from sonicvacuum.effects import CATALOGUE, Setup
from sonicvacuum.physics.chain import Body, Chain, Elastic
from sonicvacuum.physics.run import simulate

STEEL = Elastic("steel", 193e9, 0.3)


def forces(dashpot, drag, viscous=0.5):
    """(T, contacts, lanes) forces of a chain with three laws, lane by lane."""
    lanes = len(dashpot)
    chain = Chain(
        5, Body(STEEL, 0.45e-3, 2.38e-3), STEEL, STEEL, 2.38e-3, 0.45e-3, np.full(lanes, 0.4), np.zeros(lanes)
    )
    setup = Setup(chain, (), CATALOGUE)
    given = {
        "kuwabara-kono": {"time_us": np.full(lanes, viscous)},
        "hunt-crossley": {"damping_s_per_m": np.array(dashpot)},
        "viscous-drag": {"rate_per_s": np.array(drag)},
    }
    for name, parameters in given.items():
        setup = CATALOGUE.effect(name).change(setup, **parameters)
    return simulate(setup.chain, [1, 5], 1e-4, 1e-6).force


def test_a_lane_does_not_care_whether_a_term_acts_in_its_neighbours():
    alone = forces([0.0] * 3, [0.0] * 3)
    beside = forces([0.0, 0.2, 0.0], [0.0, 0.0, 3000.0])
    assert np.array_equal(beside[..., 0], alone[..., 0])
    for lane in (1, 2):
        assert np.abs(beside[..., lane] - alone[..., lane]).max() > 1e-3 * np.abs(alone).max()


def test_terms_that_are_passed_over_leave_the_law_alone():
    """The same chain without them; other code, so that rounding may differ."""
    chain = Chain(
        5, Body(STEEL, 0.45e-3, 2.38e-3), STEEL, STEEL, 2.38e-3, 0.45e-3, np.full(3, 0.4), np.zeros(3)
    )
    own = CATALOGUE.effect("kuwabara-kono").change(Setup(chain, (), CATALOGUE), time_us=np.full(3, 0.5))
    expected = simulate(own.chain, [1, 5], 1e-4, 1e-6).force
    assert forces([0.0] * 3, [0.0] * 3) == pytest.approx(expected, rel=1e-9, abs=1e-9 * expected.max())
