"""The engine against exact solutions and against an independent integration."""

import math

import numpy as np
import pytest
from engine_cases import DURATION, coated, peak, reference
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh
from scipy.special import gamma

from sonicvacuum.physics.laws import Term
from sonicvacuum.physics.run import simulate
from sonicvacuum.physics.solitary import SolitaryWave

# Default accuracy of forces, in units of the peak; measured: 2e-6 at the first passage of the wave, and up to
# 6e-6 at any time after many reflections in a short chain.
ACCURACY = 1e-5


def test_one_ball_on_the_wall():
    # Johnson, Contact Mechanics (1985), Eqs. (11.22)–(11.25), with the exact integral for the duration.
    ball = coated(beads=0, striker_radius=2e-3)
    h = simulate(ball, [0], 1e-4, 1e-8)
    m, k, v = ball.striker_mass[0], ball.striker_stiffness[0], ball.speed[0]
    deepest = (5 * m * v**2 / (4 * k)) ** 0.4
    assert h.of(0).max() == pytest.approx(
        k * deepest**1.5, rel=1e-6
    )  # as `ACCURACY`, no contact opens before
    duration = 4 * math.sqrt(math.pi) * gamma(0.4) / (5 * gamma(0.9)) * deepest / v
    touching = h.time[np.flatnonzero(h.of(0)[:, 0] > 0.0)[-1]]
    assert touching == pytest.approx(duration, abs=2e-8)  # two samples
    assert h.striker_speed[0] == pytest.approx(-v, rel=1e-6)  # the error of one opening at the fine steps


@pytest.mark.parametrize("ratio", [0.1, 1.0, 5.0])
def test_two_bodies_exchange_momentum(ratio):
    # The bead is free to fly: its next contact is 1 m away.
    pair = coated(beads=1, striker_mass=ratio * 0.44e-3).with_defect("gap", 1, 1.0)
    h = simulate(pair, [0, 1], 3e-4, 1e-7)
    m, v, k = ratio * 0.44e-3, 0.44, pair.striker_stiffness[0]
    reduced = m * 0.44e-3 / (m + 0.44e-3)
    deepest = (5 * reduced * v**2 / (4 * k)) ** 0.4
    # Samples lie 0.1 µs apart, which misses the peak by 1e-5 at most; the speed errs as above.
    assert h.of(0).max() == pytest.approx(k * deepest**1.5, rel=1e-5)
    assert h.striker_speed[0] == pytest.approx(v * (ratio - 1) / (ratio + 1), abs=1e-6 * v)
    assert not h.of(1).any()


CASES = {
    "horizontal": coated(beads=6),
    "vertical, loaded, heavy striker": coated(beads=6, gravity=9.81, static_force=0.5, striker_mass=1.23e-3),
    "light striker": coated(beads=6, striker_mass=0.088e-3),
    "gap and light bead": coated(beads=6).with_defect("gap", 3, 1e-6).with_defect("mass", 4, 0.3),
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("symplectic", [True, False])
def test_independent_integration(name, symplectic):
    chain, contacts = CASES[name], range(7)
    h = simulate(chain, contacts, 0.3e-3, 1e-6, symplectic=symplectic)
    expected = reference(chain, contacts, h.time)
    error = np.abs(h.force[..., 0] - expected).max(axis=0) / expected.max(axis=0)
    assert error.max() < ACCURACY


def test_published_reference_of_the_long_chain():
    # Two integrators at relative tolerance 1e-12 agree on contact 12/13 to the digits given.
    h = simulate(coated(), [12], DURATION, 1e-6)
    force, moment = peak(h.time, h.of(12)[:, 0])
    assert force == pytest.approx(6.7228375, rel=ACCURACY)
    assert moment == pytest.approx(295.95806e-6, abs=1e-10)  # a tenth of a nanosecond; measured: half of it


def test_leading_wave_far_from_the_striker_is_the_solitary_wave():
    chain = coated(beads=400)
    contacts = (60, 61)
    h = simulate(chain, contacts, 1.8e-3, 1e-6)
    peaks, moments = zip(*(peak(h.time, h.of(c)[:, 0]) for c in contacts), strict=True)
    speed = 2 * chain.first.radius[0] / (moments[1] - moments[0])
    exact = SolitaryWave.compute().speed(peaks[0], chain.stiffness[0], 2 * chain.first.radius[0], 0.44e-3)
    assert speed == pytest.approx(exact, rel=1e-4)  # the pulse still sheds its tail at 60 beads
    assert peaks[1] == pytest.approx(peaks[0], rel=1e-4)


BASE = simulate(coated(beads=8), [0, 4, 8], 2e-4, 2e-6)


@settings(max_examples=20)
@given(st.floats(0.05, 20.0), st.floats(0.01, 100.0), st.floats(0.05, 20.0))
def test_scaling_laws_of_sonic_vacuum(speed, modulus, mass):
    # F/(K² m³ v⁶)^{1/5} as a function of t/(m²/(K² v))^{1/5} is one and the same (Nesterenko 2001, ch. 1).
    time = (mass**2 / (modulus**2 * speed)) ** 0.2
    force = (modulus**2 * mass**3 * speed**6) ** 0.2
    chain = coated(
        modulus * 15e9, beads=8, speed=0.44 * speed, bead_mass=mass * 0.44e-3, striker_mass=mass * 0.47e-3
    )
    h = simulate(chain, [0, 4, 8], 2e-4 * time, 2e-6 * time)
    # Steps scale along, so that only rounding is left, which grows at each opening of a contact.
    assert np.abs(h.force / force - BASE.force).max() < 1e-9 * BASE.force.max()


def _spring(delta, stiffness):
    return stiffness * delta


def _spring_energy(delta, stiffness):
    return 0.5 * stiffness * delta * delta


SPRING = Term("spring", "elastic", _spring, 1, energy=_spring_energy)
SPRING_CONSTANT = 1e6


def linear_chain(beads=5):
    """Beads joined by springs that also pull: a smooth problem with an exact solution."""
    return coated(beads=beads).with_action(SPRING, lambda chain, stiffness, mass, k: [k], k=SPRING_CONSTANT)


def exact_linear(chain, times):
    """(times, contacts) forces of `linear_chain` by its normal modes."""
    n = chain.beads + 1
    mass = np.diag(chain.masses(n)[:, 0])
    stiffness = SPRING_CONSTANT * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    stiffness[0, 0] = SPRING_CONSTANT
    square, modes = eigh(stiffness, mass)
    omega = np.sqrt(square)
    amplitude = modes.T @ mass @ np.eye(n)[0] * 0.44 / omega
    u = (amplitude * np.sin(np.outer(times, omega))) @ modes.T
    return SPRING_CONSTANT * (u - np.roll(u, -1, axis=1) * (np.arange(n) < n - 1))


@pytest.mark.parametrize(
    ("options", "order"),
    [({"method": "verlet"}, 2), ({"method": "blanes-moan"}, 4), ({"symplectic": False}, 4)],
)
def test_order_of_convergence_on_a_smooth_problem(options, order):
    chain = linear_chain()
    errors = []
    for step in (2e-6, 1e-6):
        # Samples at the ends of steps: what lies between is interpolated to the third order only.
        h = simulate(chain, range(6), 2e-4, 2e-6, step=step, **options)
        errors.append(np.abs(h.force[..., 0] - exact_linear(chain, h.time)).max())
    # Measured orders lie within 0.15 of the order of the method at these steps.
    assert math.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.3)
