"""Chains of unlike bodies against an independent integration of the same bodies (scipy's DOP853)."""

import math
from dataclasses import replace

import numpy as np
import pytest
from plain_chain import FOAM, POLYMER, STEEL, G, Plain, ball, engine, reference

from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.physics.run import simulate

WALL = Plain(math.inf, math.inf)
LARGE, SMALL = ball(9.52e-3), ball(4.76e-3)
BALL = ball(19.05e-3)
# 8 balls of 19.05 mm with a sensor body of flat faces in place of the fourth, on a soft wall.
SENSOR = Plain(29.85e-3, math.inf)
CASES = {
    "dimer": ([LARGE, *[SMALL, LARGE] * 5, WALL], 0.5, {}),
    "two materials": ([LARGE, *[LARGE, replace(LARGE, mass=1e-3, material=POLYMER)] * 4, WALL], 0.5, {}),
    "tapered": ([LARGE, *(ball(9.52e-3 * 0.92**k) for k in range(10)), WALL], 0.5, {"push": 0.5}),
    "impurity": ([LARGE, *[LARGE] * 4, SMALL, *[LARGE] * 4, WALL], 0.5, {"gravity": G}),
    "sensor on a soft wall": (
        [BALL, *[BALL] * 3, SENSOR, *[BALL] * 4, replace(WALL, material=FOAM)],
        0.6,
        {"gravity": G},
    ),
}
# Of the peak, at a quarter of the engine's step: contacts that close and open cost it order; 1.4e-7 is seen.
AGREEMENT = 1e-6


@pytest.mark.parametrize("name", CASES)
def test_the_engine_agrees_with_an_independent_integrator(name):
    bodies, speed, loads = CASES[name]
    interval = 2e-6
    times = np.arange(251) * interval
    expected = reference(bodies, speed, times, **loads)
    contacts = range(len(bodies) - 1)
    found = simulate(engine(bodies, speed, **loads), contacts, times[-1], interval, refine=4.0)
    peak = np.abs(expected).max()
    np.testing.assert_allclose(found.force[:, :, 0], expected, rtol=0.0, atol=AGREEMENT * peak)
    assert np.all(expected.max(axis=0)[:3] > 0.0)  # the wave has been there


def test_a_pattern_and_exceptions_are_the_same_chain_written_out():
    dimer, odd = [LARGE, SMALL], ball(6e-3)
    written = [LARGE, *dimer * 6, WALL]
    written[7] = odd
    short = engine([LARGE, *dimer, WALL], 0.5, length=12)
    kinds = short.bodies
    made = replace(
        short, bodies=Bodies(kinds.pattern, {7: engine([LARGE, odd, WALL], 0.5).bodies.pattern[0]})
    )
    one, other = (simulate(c, range(13), 2e-4, 1e-6).force for c in (made, engine(written, 0.5)))
    assert np.array_equal(one, other)


def test_a_chain_alone_and_among_others_is_the_same_chain():
    chain = engine([LARGE, *[SMALL, LARGE] * 5, WALL], np.array([0.3, 0.5, 0.7]))
    together = simulate(chain, [5], 3e-4, 1e-6).force
    alone = simulate(chain.take(np.array([1])), [5], 3e-4, 1e-6).force
    # Lanes change rounding only.
    np.testing.assert_allclose(together[:, :, 1:2], alone, rtol=0.0, atol=1e-9 * alone.max())


def test_flat_faces_that_touch_are_refused():
    flat = Plain(5e-3, math.inf)
    for bodies in ([flat, flat, LARGE, WALL], [LARGE, LARGE, flat, WALL], [LARGE, flat, flat, LARGE, WALL]):
        with pytest.raises(ValueError, match="two flats"):
            simulate(engine(bodies, 0.5), [0], 1e-4, 1e-6)


def test_a_material_is_stiffened_in_every_contact_of_it():
    bodies = [LARGE, *[SMALL, replace(SMALL, material=POLYMER)] * 2, WALL]
    plain = engine(bodies, 0.5)
    stiff = plain.stiffened("steel", 1e6).stiffnesses(5)[:, 0] / plain.stiffnesses(5)[:, 0]
    # Steel on steel: by the ratio; steel on a polymer: as against a rigid body.
    share = (1 - STEEL[2] ** 2) / STEEL[1] / ((1 - POLYMER[2] ** 2) / POLYMER[1])
    np.testing.assert_allclose(stiff, [1e6, *[1 + share] * 4], rtol=1e-5)  # the ratio is not infinite
