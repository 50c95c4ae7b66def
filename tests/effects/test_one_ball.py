"""One ball on a wall: restitution against exact solutions and expansions."""

from dataclasses import replace

import numpy as np
import pytest
from effect_cases import nominal
from scipy.optimize import brentq
from scipy.special import beta

from sonicvacuum.effects import effect
from sonicvacuum.physics.run import simulate

MASS, SPEED = 0.44e-3, 0.44
SPEEDS = np.geomspace(0.05, 2.0, 8)
# What changes an elastic contact of a ball; a load at rest would hold it down.
LOSSLESS = ("dynamic-modulus", "contact-exponent", "coating-thickness", "wall-compliance", "striker-error")


def ball(speed):
    """A coated ball that flies at a steel wall."""
    chain = nominal().chain
    one = chain.first
    solid = {"beads": 0, "striker": one.surface, "striker_radius": one.radius[0], "striker_mass": MASS}
    return replace(nominal(), chain=replace(chain, speed=speed, **solid), sensors=())


def bounce(setup, **options):
    """(lanes,) restitution; the flight is long enough for every contact to end."""
    history = simulate(setup.chain, [0], 8e-4, 1e-6, **{"refine": 4.0, **options})
    assert np.all(history.force[-1] == 0.0)
    return -history.striker_speed / setup.chain.speed


def stiffness():
    """Hertz constant of ball and wall, N/m^{3/2}."""
    return ball(SPEED).chain.striker_stiffness[0]


def damped_oscillator(ratio):
    """Restitution of a linear spring and dashpot whose force is cut at zero.

    Schwager & Pöschel, Granular Matter 9, 465 (2007); `ratio` is damping over critical damping.
    """
    omega = np.sqrt(1 - ratio**2)
    return np.exp(-ratio / omega * (np.pi - np.arctan2(2 * ratio * omega, omega**2 - ratio**2)))


def test_linear_dashpot_on_a_linear_spring_is_the_damped_oscillator():
    damping = np.array([0.1, 0.5, 1.0, 2.0, 4.0])
    setup = effect("contact-exponent").apply(ball(np.full(5, SPEED)), exponent=1.0)
    spring = stiffness() * 1e-6**0.5  # N/m: the power law with n = 1 through the Hertz force at 1 um
    restitution = bounce(effect("linear-dashpot").apply(setup, damping_kg_s=damping))
    expected = damped_oscillator(damping / (2 * np.sqrt(spring * MASS)))
    # The damping force starts with a jump at first touch, which costs the solver its order there.
    np.testing.assert_allclose(restitution, expected, rtol=5e-6)


def test_tsuji_restitution_is_that_of_the_oscillator_at_every_speed():
    # y = (4/5) delta^{5/4} in the time d(tau) = delta^{1/4} dt turns the law into a damped oscillator
    # with the damping ratio alpha/sqrt 5 (Antypov & Elliott, EPL 94, 50004 (2011)), force zero included.
    for alpha in (0.05, 0.3, 0.9):
        restitution = bounce(effect("tsuji").apply(ball(SPEEDS), alpha=alpha))
        # Fourth-order steps on a force with a delta^{1/4} start.
        np.testing.assert_allclose(restitution, damped_oscillator(alpha / np.sqrt(5)), rtol=2e-6)


def test_hunt_crossley_restitution_is_the_exact_root():
    # m v dv = −F (1 + a v) d(delta), a = 3c/2, separates: a v − ln(1 + a v) is the same before and after.
    c = 0.3
    a = 1.5 * c
    restitution = bounce(effect("hunt-crossley").apply(ball(SPEEDS), damping_s_per_m=c))

    def after(v):
        spent = a * v - np.log1p(a * v)
        return brentq(lambda w: -a * w - np.log1p(-a * w) - spent, 0.0, v, xtol=1e-15) / v

    # Smooth force: the solver's fourth order.
    np.testing.assert_allclose(restitution, [after(v) for v in SPEEDS], rtol=1e-7)
    # Hunt & Crossley 1975: e = 1 − c v to first order; the next order is of the size (c v)².
    np.testing.assert_allclose(restitution, 1 - c * SPEEDS, atol=0.7 * (c * SPEEDS.max()) ** 2)


def test_kuwabara_kono_restitution_falls_as_the_fifth_root_of_speed():
    # Ramirez, Pöschel, Brilliantov & Schwager, Phys. Rev. E 60, 4465 (1999): e = 1 − C1 x + C2 x² − …,
    # x = (3/2) A (K/m)^{2/5} v^{1/5}, C1 = 1.15344, C2 = (3/5) C1². C1 from the energy lost in first order:
    c1 = 2 * (5 / 4) ** 0.6 * beta(0.6, 1.5) / 2.5
    assert c1 == pytest.approx(1.15344, abs=1e-5)
    time_us = 0.1
    x = 1.5e-6 * time_us * (stiffness() / MASS) ** 0.4 * SPEEDS**0.2
    restitution = bounce(effect("kuwabara-kono").apply(ball(SPEEDS), time_us=time_us))
    # x is below 0.01, so that the next orders are below 1e-6.
    np.testing.assert_allclose(restitution, 1 - c1 * x + 0.6 * c1**2 * x**2, atol=2e-6)


def test_plastic_restitution_depends_on_the_residual_alone():
    for residual in (0.02, 0.3, 0.8):
        restitution = bounce(effect("plastic-contact").apply(ball(SPEEDS), residual_fraction=residual))
        # Work (2/5) F_max delta_max done, (2/5) F_max (delta_max − delta_res) returned (Walton & Braun 1986).
        # The force changes its branch within a step, which leaves an error of that step's cube.
        np.testing.assert_allclose(restitution, np.sqrt(1 - residual), rtol=3e-8)


def test_a_plastic_contact_unloads_from_where_any_loading_curve_has_led():
    for exponent, residual in ((1.4, 0.1), (1.8, 0.3)):
        loaded = effect("contact-exponent").apply(ball(SPEEDS), exponent=exponent)
        restitution = bounce(effect("plastic-contact").apply(loaded, residual_fraction=residual))
        # Work F_max delta_max/(n + 1) done, (2/5) F_max (delta_max − delta_res) returned.
        left = 0.4 * (exponent + 1.0) * (1.0 - residual)
        np.testing.assert_allclose(restitution, np.sqrt(left), rtol=1e-6)  # a step's cube, as above


def test_relaxing_contact_is_lossless_at_either_end_and_lossy_between():
    tau = np.array([1e5, 3000.0, 300.0, 100.0, 30.0, 10.0, 3.0])
    loss = (
        1 - bounce(effect("relaxing-contact").apply(ball(np.full(7, SPEED)), strength=0.2, tau_us=tau)) ** 2
    )
    largest = loss.argmax()
    assert 0 < largest < len(tau) - 1
    assert np.all(np.diff(loss[: largest + 1]) > 0.0)
    assert np.all(np.diff(loss[largest:]) < 0.0)
    assert loss[0] < 1e-3  # an impact of 0.13 ms against a memory of 100 ms


@pytest.mark.parametrize("id", LOSSLESS)
def test_a_lossless_contact_gives_all_of_it_back(id):
    setup, p = ball(np.full(3, SPEED)), effect(id).parameters[0]
    setup = effect(id).apply(setup, **{p.name: p.at(1.0, setup)})
    # The symplectic scheme's error over one impact.
    np.testing.assert_allclose(bounce(setup), 1.0, rtol=1e-7)


# A weak term g delta^p |v|^{a−1} v takes a fraction of the energy that goes as v^s, s = (4/5)(p + 1) + a − 2.
POWERS = {
    "linear-dashpot": ("damping_kg_s", 0.005, 0.8 * (0 + 1) + 1 - 2),
    "tsuji": ("alpha", 0.002, 0.8 * (0.25 + 1) + 1 - 2),
    "kuwabara-kono": ("time_us", 0.02, 0.8 * (0.5 + 1) + 1 - 2),
    "hunt-crossley": ("damping_s_per_m", 0.002, 0.8 * (1.5 + 1) + 1 - 2),
    "velocity-power": ("gamma", 0.005, 0.8 * (0 + 1) + 1.75 - 2),
}


@pytest.mark.parametrize("id", POWERS)
def test_loss_scales_with_speed_as_the_law_says(id):
    name, value, power = POWERS[id]
    loss = 1 - bounce(effect(id).apply(ball(SPEEDS), **{name: value})) ** 2
    slope, _ = np.polyfit(np.log(SPEEDS), np.log(loss), 1)
    # Losses of 1e-4 to 1e-2, in which the second order is of that size.
    assert slope == pytest.approx(power, abs=0.01)
