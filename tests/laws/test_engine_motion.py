"""Recorded motion of bodies: momentum balance, Newton's second law, and an independent integration."""

import math

import numpy as np
import pytest
from engine_cases import DURATION, coated, motion_reference

from sonicvacuum.effects import Setup, effect
from sonicvacuum.physics.run import simulate

# Accuracy of accelerations in units of their largest: the engine's of forces (see test_engine_exact). Of
# velocities in units of the striker's speed: measured 1.7e-5, once contacts of a short chain have opened.
ACCURACY, SPEED_ACCURACY = 1e-5, 3e-5

CASES = {
    "horizontal": coated(beads=6),
    "vertical, loaded, heavy striker": coated(beads=6, gravity=9.81, static_force=0.5, striker_mass=1.23e-3),
    "gap and light bead": coated(beads=6).with_defect("gap", 3, 1e-6).with_defect("mass", 4, 0.3),
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("symplectic", [True, False])
def test_agrees_with_an_independent_integration(name, symplectic):
    chain = CASES[name]
    bodies = tuple(range(chain.beads + 1))
    # An interval that no step divides: every sample falls between two steps.
    h = simulate(chain, (), DURATION, 0.917e-6, bodies=bodies, symplectic=symplectic)
    velocity, acceleration = motion_reference(chain, h.time)
    off = np.abs(h.velocity[:, :, 0] - velocity).max()
    assert off < SPEED_ACCURACY * chain.speed[0]
    off = np.abs(h.acceleration[:, :, 0] - acceleration).max()
    assert off < ACCURACY * np.abs(acceleration).max()


@pytest.mark.parametrize("lanes", [1, 8])
@pytest.mark.parametrize("name", [None, "plastic-contact", "kuwabara-kono", "relaxing-contact"])
def test_acceleration_is_net_force_over_mass(name, lanes):
    chain = coated(beads=8, gravity=9.81, speed=np.linspace(0.2, 0.9, lanes))
    if name:
        setup = Setup(chain)
        typical = {p.name: p.at(1.0, setup) for p in effect(name).parameters}
        chain = effect(name).apply(setup, **typical).chain
    h = simulate(chain, (), 2e-4, 0.7e-6, bodies=(0, 3, 8))
    for body in (3, 8):
        net = (h.of(body - 1) - h.of(body)) / 0.44e-3
        # The same two numbers; fused multiplications round once less.
        assert np.abs(h.acceleration_of(body) - net).max() <= 1e-12 * np.abs(net).max()
    striker = 9.81 - h.of(0) / 0.47e-3
    assert np.abs(h.acceleration_of(0) - striker).max() <= 1e-12 * np.abs(striker).max()


@pytest.mark.parametrize("id", [None, "viscous-drag", "kuwabara-kono", "plastic-contact"])
def test_velocity_is_the_impulse_over_the_mass(id):
    setup = Setup(coated(beads=8))
    if id:
        setup = effect(id).apply(setup, **{p.name: p.at(1.0, setup) for p in effect(id).parameters})
    h = simulate(setup.chain, (), 3e-4, 0.1e-6, bodies=(0, 1, 5))
    for body in (0, 1, 5):
        a = h.acceleration_of(body)[:, 0]
        # Simpson's rule; the force's slope jumps where a contact opens, which costs (0.1 µs/40 µs)²: 6e-6.
        gained = (a[0:-2:2] + 4 * a[1:-1:2] + a[2::2]).cumsum() * 0.1e-6 / 3
        v = h.velocity_of(body)[:, 0]
        assert np.abs(v[2::2] - v[0] - gained).max() < 1e-5 * 0.44


def test_first_sample_is_the_moment_of_impact():
    h = simulate(coated(gravity=9.81), (), 1e-5, 1e-6, bodies=(2, 0))
    assert h.bodies == (2, 0)
    assert h.velocity[0].ravel().tolist() == [0.0, 0.44]
    assert h.acceleration[0].ravel().tolist() == [0.0, 9.81]


def test_forces_are_the_same_whether_bodies_are_recorded_or_not():
    for lanes in (1, 8):
        chain = coated(speed=np.linspace(0.3, 0.9, lanes))
        alone = simulate(chain, (4, 21), DURATION, 1e-6)
        beside = simulate(chain, (4, 21), DURATION, 1e-6, bodies=(4, 9))
        assert beside.contacts == (4, 21, 3, 8, 9)
        for contact in (4, 21):
            np.testing.assert_array_equal(beside.of(contact), alone.of(contact))
        assert alone.velocity.size == 0


def test_bodies_that_the_wave_never_reaches_rest():
    h = simulate(coated(beads=4000), (), 1e-4, 1e-6, bodies=(1, 3999))
    assert h.velocity_of(1).max() > 0.1
    assert not h.velocity_of(3999).any()
    assert not h.acceleration_of(3999).any()


def test_body_that_does_not_exist_is_refused():
    with pytest.raises(ValueError, match="body 22 does not exist"):
        simulate(coated(), (), 1e-5, 1e-6, bodies=(22,))
    with pytest.raises(ValueError, match="body -1 does not exist"):
        simulate(coated(), (), 1e-5, 1e-6, bodies=(-1,))


def test_one_ball_rebounds_with_the_recorded_velocity():
    h = simulate(coated(beads=0, striker_radius=2e-3), (), 1e-4, 1e-7, bodies=(0,))
    assert h.velocity_of(0)[-1, 0] == pytest.approx(-0.44, rel=1e-6)  # no energy is lost
    assert h.velocity_of(0)[-1, 0] == pytest.approx(h.striker_speed[0], rel=1e-12)  # free flight at the end
    assert math.isclose(h.acceleration_of(0)[-1, 0], 0.0)
