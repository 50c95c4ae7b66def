"""The integrator and laws of hidden-effect data against exact results."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import RK45
from scipy.optimize import brentq
from scipy.special import beta, gamma

from sonicvacuum.laboratory.specimen import GRAVITY
from sonicvacuum_blind import stepper
from sonicvacuum_blind.gauges import bounce
from sonicvacuum_blind.integrate import Problem, integrate
from sonicvacuum_blind.laws import B, hertz_rows
from sonicvacuum_blind.plan import Gauge, Plan, Solid, problem

STEEL = Solid("steel", 193e9, 0.3)
POLYMER = Solid("polymer", 15e9, 0.388)


def chain(beads=12, **changes):
    plan = Plan(beads, POLYMER, STEEL, STEEL, 2.4e-3, 2.4e-3, 0.44e-3, 0.47e-3, 0.4)
    return replace(plan, **changes)


def ball(speed=1.0, **law):
    return replace(chain(0, speed=speed), law=law)


def test_the_tableau_is_that_of_scipy_to_the_bit():
    assert (stepper._A[:6, :5] == RK45.A).all() and not stepper._A[:6, 5].any()
    assert (stepper._A[6, :6] == RK45.B).all()
    assert (stepper._C[:6] == RK45.C).all() and stepper._C[6] == 1.0
    assert (stepper._E == RK45.E).all()


def energy(plan, setting, motion, contacts):
    """Kinetic and elastic energy and that of the loads, (samples,) J, of Hertz contacts."""
    kinetic = 0.5 * motion.velocity**2 @ setting.mass
    ahead = np.hstack([motion.displacement[:, 1:], np.zeros((len(motion.force), 1))])
    delta = np.maximum(setting.rest + motion.displacement - ahead, 0.0)
    elastic = 0.4 * delta**2.5 @ plan.stiffness()
    return kinetic + elastic - motion.displacement @ setting.load


@pytest.mark.parametrize("gravity, static_force", [(0.0, 0.0), (GRAVITY, 0.0), (GRAVITY, 2.0)])
def test_elastic_chain_keeps_its_energy(gravity, static_force):
    plan = chain(gravity=gravity, static_force=static_force)
    setting = problem(plan)
    times = np.linspace(0.0, 1e-3, 400)
    motion = integrate(setting, times, range(13), states=True, tolerance=1e-10)
    total = energy(plan, setting, motion, range(13))
    impact = 0.5 * plan.striker_mass * plan.speed**2
    assert np.ptp(total) < 1e-7 * impact  # 1000 steps of 1e-10, adding up at worst


def test_chain_at_rest_stays_at_rest():
    plan = chain(gravity=GRAVITY, static_force=1.0, striker_mass=1e-12, speed=1e-9)
    setting = problem(plan)
    motion = integrate(setting, np.linspace(0.0, 5e-4, 50), range(1, 13))
    static = 1.0 + 0.44e-3 * GRAVITY * np.arange(1, 13)
    assert np.abs(motion.force / static - 1.0).max() < 1e-5  # what the feather of a striker does


def test_momentum_is_shared_in_a_collision_of_two_bodies():
    """An elastic central collision: v₁ = (m₁ − m₂)/(m₁ + m₂) v, v₂ = 2 m₁/(m₁ + m₂) v."""
    first, second, speed = 2e-3, 0.5e-3, 0.7
    mass, rest = np.array([first, second]), np.array([0.0, -1.0])
    setting = Problem(mass, np.zeros(2), rest, hertz_rows(np.array([1e9, 1e9])), np.zeros((2, len(B))), speed)
    end = integrate(setting, np.array([1e-3]), [0], states=True, tolerance=1e-11).velocity[-1]
    exact = np.array([first - second, 2.0 * first]) / (first + second) * speed
    assert end == pytest.approx(exact, rel=1e-8)  # tolerance of a step times some hundred steps


def test_contact_of_a_ball_lasts_as_hertz_says():
    """2 δ/v ∫₀¹ dx/√(1 − x^{5/2}) = 2.943 δ/v, δ = (5 m v²/(4 K))^{2/5} (Johnson 1985, Sec. 11.4)."""
    plan = ball(0.5)
    deepest = (1.25 * plan.striker_mass * plan.speed**2 / plan.stiffness()[0]) ** 0.4
    lasts = 2.0 * math.sqrt(math.pi) * gamma(1.4) / gamma(0.9) * deepest / plan.speed
    found = bounce(plan)
    assert found["contact_duration"] == pytest.approx(
        lasts, rel=1e-6
    )  # straight line over 1/4000 of the record
    assert found["restitution"] == pytest.approx(1.0, abs=5e-6)  # 1e-8 a step, two hundred steps


def test_plastic_ball_loses_the_residual_share_of_its_energy():
    """Unloading returns 1 − ε of the work: e = √(1 − ε) at any speed."""
    for speed in (0.1, 2.0):
        assert bounce(ball(speed, residual=0.3))["restitution"] == pytest.approx(math.sqrt(0.7), abs=2e-5)


def test_tsuji_restitution_does_not_depend_on_speed():
    slow, fast = (bounce(ball(v, tsuji=0.01))["restitution"] for v in (0.05, 3.0))
    assert slow == pytest.approx(fast, abs=5e-6)  # errors of the integration
    # Antypov & Elliott, EPL 94, 50004 (2011): α = −√5 ln e/√(ln² e + π²), for a contact that may pull.
    log = math.log(slow)
    found = -math.sqrt(5.0) * log / math.hypot(log, math.pi)
    assert found == pytest.approx(0.01, rel=5e-3)  # the cut at zero force saves a share of the order of α


def test_viscoelastic_restitution_falls_with_the_fifth_root_of_speed():
    """1 − e = 1.15344 (3A/2) (K/m)^{2/5} v^{1/5} (Ramírez et al., Phys. Rev. E 60, 4465, 1999), small A."""
    plan, time = ball(0.3), 2e-8
    ratio = plan.stiffness()[0] / plan.striker_mass
    expected = 1.15344 * 1.5 * time * ratio**0.4 * 0.3**0.2
    loss = 1.0 - bounce(ball(0.3, viscous_time=time))["restitution"]
    assert loss == pytest.approx(expected, rel=2.0 * expected)  # the next order is as small as the loss


def test_hunt_crossley_restitution_falls_in_proportion_to_speed():
    """1 − e = c v for small c v (Hunt & Crossley 1975)."""
    loss = 1.0 - bounce(ball(0.5, hunt_crossley=4e-3))["restitution"]
    assert loss == pytest.approx(2e-3, rel=5e-3)  # next order c² v²


def test_damping_in_proportion_to_depth_and_rate_loses_its_work():
    """1 − e = 2 β δ_m² ∫ x √(1 − x^{5/2}) dx / (m v), the work along the elastic path, for small β."""
    plan, damping = ball(0.3), 1e5
    depth = (1.25 * plan.striker_mass / plan.stiffness()[0] * 0.3**2) ** 0.4
    expected = 2.0 * damping * depth**2 * 0.4 * beta(0.8, 1.5) / (plan.striker_mass * 0.3)
    loss = 1.0 - bounce(ball(0.3, mixed=damping, mixed_depth=1.0, mixed_rate=1.0))["restitution"]
    assert loss == pytest.approx(expected, rel=2.0 * expected)  # the next order is as small as the loss


def test_a_contact_that_hardens_stores_the_striker_s_energy():
    """½ m v² = K (2/5 δ^{5/2} + 2/7 h δ^{7/2}) at the turning point, and nothing is lost."""
    plan = ball(0.3, hardening=2e5)
    setting, energy = problem(plan), 0.5 * plan.striker_mass * 0.3**2
    stiffness = setting.rows[0, 0]
    deepest = brentq(lambda d: stiffness * (0.4 * d**2.5 + 2.0 / 7.0 * 2e5 * d**3.5) - energy, 0.0, 1e-3)
    peak = integrate(setting, np.linspace(0.0, 3e-4, 20000), [0]).force.max()
    assert peak == pytest.approx(stiffness * deepest**1.5 * (1.0 + 2e5 * deepest), rel=1e-5)  # samples
    assert bounce(plan)["restitution"] == pytest.approx(1.0, abs=1e-6)


def test_relaxing_contact_between_its_limits_is_neither():
    """Slow relaxation is a modulus larger by 1 + g; fast relaxation loses nothing."""
    frozen = bounce(ball(1.0, relaxing=0.3, relaxation_rate=1.0))
    relaxed = bounce(ball(1.0, relaxing=0.3, relaxation_rate=1e9))
    elastic = bounce(ball(1.0))
    assert frozen["contact_duration"] == pytest.approx(elastic["contact_duration"] / 1.3**0.4, rel=1e-4)
    assert relaxed["contact_duration"] == pytest.approx(elastic["contact_duration"], rel=1e-3)
    assert bounce(ball(1.0, relaxing=0.3, relaxation_rate=1e5))["restitution"] < 0.99


def test_adhesive_contact_pulls_before_it_opens():
    plan = chain(2).with_law(adhesion=3e4)
    setting = problem(plan)
    force = integrate(setting, np.linspace(0.0, 4e-4, 2000), [0]).force
    assert force.min() < 0.0
    # Deepest pull of K δ^{3/2} − k δ^{3/4}: −k²/(4 K).
    assert force.min() == pytest.approx(-(3e4**2) / (4.0 * setting.rows[0, 0]), rel=1e-2)  # between samples


def test_error_falls_with_the_tolerance():
    plan = chain(gauges=(Gauge("g", "embedded", 6),))
    setting, times = problem(plan), np.linspace(0.0, 4e-4, 300)
    exact = integrate(setting, times, [6], tolerance=1e-12).force
    errors = [
        np.abs(integrate(setting, times, [6], tolerance=t).force - exact).max() / exact.max()
        for t in (1e-5, 1e-7, 1e-9)
    ]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 1e-6  # 1e-9 a step, a thousand steps


def test_laws_that_no_step_can_follow_are_refused():
    setting = problem(chain(2))
    broken = replace(setting, rows=np.full_like(setting.rows, np.nan))
    with pytest.raises(ValueError, match="too stiff"):
        integrate(broken, np.array([1e-4]), [1])
