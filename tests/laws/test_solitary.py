"""The long-wave soliton against Eq. (3), and the exact solitary wave against its equation, conservation laws,
limits, and a chain integrated on its own."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from sonicvacuum.physics import theory
from sonicvacuum.physics.solitary import SolitaryWave, soliton_force, soliton_strain, soliton_width

E, NU, A, M = 15e9, 0.388, 4.86e-3, 0.44e-3
K = theory.hertz_stiffness(E, NU, A)
exponents = st.sampled_from([1.05, 1.2, 1.5, 2.0, 2.5, 3.0])


def test_soliton_solves_the_long_wave_equation():
    """Eq. (3) integrated once: V² ξ = c² (ξ^{3/2} + (a²/10) ξ^{1/4} (ξ^{5/4})_xx), in sonic vacuum."""
    peak, c = 1e-3, theory.wave_constant(E, NU, A, M)
    speed = theory.speed_from_strain(peak, E, NU, A, M)
    x, h = np.linspace(-2.2, 2.2, 45) * A, 1e-3 * A
    below, here, above = (soliton_strain(x + shift, 0.0, peak, speed, A) for shift in (-h, 0.0, h))
    curvature = (below**1.25 - 2 * here**1.25 + above**1.25) / h**2
    right = c**2 * (here**1.5 + A**2 / 10 * here**0.25 * curvature)
    # Second difference with h = a/1000: h² of the fourth derivative (2e-6 at most) and rounding/h² (1e-9).
    np.testing.assert_allclose(right, speed**2 * here, rtol=0, atol=5e-6 * speed**2 * peak)


def test_soliton_force_moves_with_its_speed_and_has_the_stated_width():
    speed = theory.speed_from_force(5.0, E, NU, A, M)
    assert soliton_force(speed * 3e-4, 3e-4, 5.0, speed, A) == 5.0
    for level in (0.01, 0.5, 0.9):
        edge = soliton_width(A, level) / 2
        np.testing.assert_allclose(soliton_force([-edge, edge], 0.0, 5.0, speed, A), 5 * level, rtol=1e-12)
    foot = soliton_width(A)
    np.testing.assert_allclose(foot, 5 * np.pi / np.sqrt(10) * A, rtol=1e-14)
    assert not soliton_force(np.array([-0.5, 0.5, 2.0]) * foot * (1 + 1e-12), 0.0, 5.0, speed, A).any()
    strain = soliton_strain(0.3 * A, 0.0, theory.strain_from_force(5.0, E, NU, A), speed, A)
    force = theory.force_from_strain(strain, E, NU, A)
    np.testing.assert_allclose(soliton_force(0.3 * A, 0.0, 5.0, speed, A), force, rtol=1e-13)


@given(exponents, st.floats(-4, 4))
def test_profile_solves_the_advance_delay_equation(exponent, phase):
    """d = s⁻² ∫(1 − |y|) f(φ + y) dy by Gauss quadrature off the grid: no Fourier transform is shared."""
    wave = SolitaryWave.compute(exponent)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    y = (nodes + 1) / 2
    tent = (1 - y) * (wave.force(phase + y) + wave.force(phase - y)) @ weights / 2
    assert abs(tent / wave.speed_constant**2 - wave.compression(phase)) < 1e-12  # interpolation, 1e-13


@given(exponents, st.floats(-4, 4))
def test_beads_obey_newton_under_the_forces_of_their_contacts(exponent, phase):
    """v′ = f(φ + ½) − f(φ − ½) and s² d′ = v(φ + ½) − v(φ − ½): together the advance-delay equation."""
    wave, h = SolitaryWave.compute(exponent), 0.01
    coefficients = np.array([-1, 9, -45, 45, -9, 1]) / 60
    steps = phase + h * np.array([-3, -2, -1, 1, 2, 3])
    acceleration = coefficients @ wave.bead_velocity(steps) / h
    approach_rate = coefficients @ wave.compression(steps) / h * wave.speed_constant**2
    force, velocity = (
        np.subtract(*g(phase + np.array([0.5, -0.5]))) for g in (wave.force, wave.bead_velocity)
    )
    # h⁶/140 of the seventh derivative (below 1e-9 for n = 3, 1e-11 for Hertz), and rounding/h.
    assert abs(acceleration - force) < 2e-9
    assert abs(approach_rate - velocity) < 2e-9


@given(exponents, st.floats(0, 1))
def test_energy_and_momentum_are_those_of_the_beads_at_any_moment(exponent, phase):
    wave, contacts = SolitaryWave.compute(exponent), phase + np.arange(-60, 61)
    force, stiffness = 3.0, 2.0e8
    speed, approach = wave.speed(force, stiffness, A, M), (force / stiffness) ** (1 / exponent)
    velocities = wave.bead_velocity(contacts + 0.5) * force * A / (M * speed)
    stored = stiffness * (approach * wave.compression(contacts)) ** (exponent + 1) / (exponent + 1)
    energy = np.sum(M * velocities**2 / 2) + np.sum(stored)
    np.testing.assert_allclose(wave.energy(force, stiffness), energy, rtol=1e-12)  # interpolation
    np.testing.assert_allclose(wave.momentum(force, stiffness, A, M), M * velocities.sum(), rtol=1e-12)
    peak = wave.peak_bead_velocity(force, stiffness, A, M)
    assert np.all(velocities <= peak * (1 + 1e-13))  # rounding at the peak itself


def test_known_constants_of_the_hertz_wave():
    """V = C [2E/(aρ^{3/2}(1−ν²))]^{1/3} F^{1/6}, ρ of the bead: C = 0.6887, in long-wave theory 0.6802."""
    wave = SolitaryWave.compute()
    density = M / (np.pi * A**3 / 6)
    scale = np.cbrt(2 * E / (A * density**1.5 * (1 - NU**2)))
    assert abs(theory.speed_from_force(1.0, E, NU, A, M) / scale - 0.6802) < 5e-5  # last digit given
    assert abs(wave.speed(1.0, K, A, M) / scale - 0.6887) < 5e-5  # last digit given
    np.testing.assert_allclose(wave.density_prefactor, wave.speed(1.0, K, A, M) / scale, rtol=1e-14)


def test_long_wave_theory_becomes_exact_as_the_exponent_tends_to_one():
    """s → √(2/(n+1)), cos^{2/(n−1)} → exp(−3(n−1)φ²): the wave widens.  Gaussian limit: James and Pelinovsky,
    Proc. R. Soc. A 470, 20130462 (2014)."""
    off, shape = [], []
    for exponent in (1.04, 1.02, 1.01):
        wave = SolitaryWave.compute(exponent)
        off.append(wave.speed_constant / np.sqrt(2 / (exponent + 1)) - 1)
        shape.append(np.max(np.abs(wave.profile - np.exp(-3 * (exponent - 1) * wave.phase**2))))
    np.testing.assert_allclose(np.divide(off[:-1], off[1:]), 4, rtol=0.03)  # ∝ (n−1)², next order 2 % here
    np.testing.assert_allclose(np.divide(shape[:-1], shape[1:]), 2, rtol=0.03)  # ∝ n−1, next order 2 % here


def exact_precompressed_speed(ratio):
    """Speed in units of a √(k δ₀^{1/2}/M) of the exact wave with F_m/F₀ = ratio: the same fixed point for the
    compression y beyond δ₀ in units of its peak, with the force (q + y)^{3/2} − q^{3/2}, q = δ₀/y_m."""
    q, middle = 1 / (ratio ** (2 / 3) - 1), 320
    phase = np.arange(-middle, middle) / 8
    tent = np.sinc(np.fft.rfftfreq(phase.size, 1 / 8)) ** 2
    y = np.exp(-(phase**2) / 4)
    for _ in range(700):  # the slowest, ratio 1.5, comes to rest after about 600
        y = np.fft.irfft(tent * np.fft.rfft((q + y) ** 1.5 - q**1.5), phase.size)
        strength = y[middle]
        y = np.maximum(y / strength, 0)
    return np.sqrt(strength / np.sqrt(q))


def test_eq_7_is_the_long_wave_limit_of_the_exact_precompressed_wave():
    """With F_m the total force Eq. (7) is exact for f_r → 1 and falls short by up to 1.24 %, as Eq. (6)."""
    ratios = np.array([1.5, 4.0, 30.0, 1e6])
    sound = theory.linear_sound_speed(1.0, E, NU, A, M) / np.sqrt(1.5)  # a √(k δ₀^{1/2}/M)
    long_wave = theory.speed_with_precompression(ratios, 1.0, E, NU, A, M) / sound
    shortfall = np.array([exact_precompressed_speed(ratio) for ratio in ratios]) / long_wave - 1
    vacuum = SolitaryWave.compute().speed_constant * np.sqrt(5) / 2 - 1
    assert np.all(np.diff(shortfall) > 0)
    assert 0 < shortfall[0] < 0.02 * vacuum  # second order in f_r − 1: 1.5e-4
    np.testing.assert_allclose(
        shortfall[-1],
        vacuum,
        rtol=2e-3,  # what F₀ adds, 1e-4 of V, differs by a tenth
    )


@given(st.floats(1e-9, 1e6), exponents)
def test_inverses_return_the_amplitude_and_the_stiffness(force, exponent):
    wave = SolitaryWave.compute(exponent)
    speed = wave.speed(force, 3e8, A, M)
    # F_m ∝ V^{2n/(n−1)}: rounding is magnified by that power, 42 for n = 1.05.
    np.testing.assert_allclose(
        wave.peak_force(speed, 3e8, A, M), force, rtol=1e-13 * exponent / (exponent - 1)
    )
    np.testing.assert_allclose(wave.stiffness(speed, force, A, M), 3e8, rtol=1e-13)


@given(exponents, st.floats(0.01, 0.95))
def test_widths_are_where_the_pulses_cross_the_level(exponent, level):
    wave = SolitaryWave.compute(exponent)
    assert abs(wave.force(wave.width(level) / 2) - level) < 1e-12  # root finding
    assert abs(wave.gauge(wave.gauge_width(level) / 2) - level * wave.gauge_ratio) < 1e-12
    phases = np.linspace(-2, 2, 2001)
    assert wave.gauge(phases).max() <= wave.gauge_ratio * (1 + 1e-12)  # rounding


def test_pulses_in_seconds():
    wave = SolitaryWave.compute()
    half = wave.duration(5.0, K, A, M) / 2
    np.testing.assert_allclose(wave.contact_pulse([-half, 0, half], 5.0, K, A, M), [2.5, 5, 2.5], rtol=1e-12)
    np.testing.assert_allclose(wave.gauge_pulse(0.0, 5.0, K, A, M), 5 * wave.gauge_ratio, rtol=1e-14)
    assert wave.contact_pulse(1.0, 5.0, K, A, M) == 0


def test_the_wave_is_computed_once_and_cannot_be_changed():
    wave = SolitaryWave.compute()
    assert SolitaryWave.compute(1.5) is wave
    with pytest.raises(ValueError, match="read-only"):
        wave.profile[0] = 1.0


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda: SolitaryWave.compute(1.0), "exponent"),
        (lambda: SolitaryWave.compute(3.5), "exponent"),
        (lambda: SolitaryWave.compute(2.0).density_prefactor, "exponent"),
        (lambda: SolitaryWave.compute().width(1.0), "level"),
        (lambda: SolitaryWave.compute().speed(-1.0, K, A, M), "peak_force"),
        (lambda: SolitaryWave.compute().momentum(0.0, K, A, M), "peak_force"),
        (lambda: soliton_width(A, 1.0), "level"),
    ],
)
def test_unphysical_input_is_named(call, name):
    with pytest.raises(ValueError, match=f"^{name} must be .*, got "):
        call()


@pytest.fixture(scope="module")
def chain():
    """60 beads, the first thrown at the rest with 0.44 m/s, integrated by DOP853; the wave at contact 45."""
    beads, constant = 60, theory.acceleration_constant(E, NU, A, M)

    def rates(_, y):
        return np.concatenate((y[beads:], theory.chain_accelerations(y[:beads], constant)))

    start = np.zeros(2 * beads)
    start[beads] = 0.44
    atol = np.repeat([1e-18, 1e-13], beads)
    path = solve_ivp(rates, (0, 1.2e-3), start, "DOP853", rtol=1e-11, atol=atol, dense_output=True).sol

    def force(contact, time):
        return theory.contact_force(path(time)[contact] - path(time)[contact + 1], E, NU, A)

    def peak_time(contact):
        """A contact force peaks where its two beads move alike."""
        times = np.linspace(0, 1.2e-3, 1201)
        guess = times[np.argmax(force(contact, times))]
        return brentq(
            lambda t: np.subtract(*path(t)[beads + contact : beads + contact + 2]), guess - 8e-6, guess + 8e-6
        )

    early, late = peak_time(35), peak_time(45)
    return SimpleNamespace(
        force=force,
        path=path,
        beads=beads,
        peak_time=late,
        peak=force(45, late),
        speed=10 * A / (late - early),
    )


INTEGRATION = (
    1e-7  # trailing ripples have left the wave to 1e-9; dense output of DOP853 is good to about 1e-8
)


def test_a_formed_wave_has_the_exact_speed_width_and_shape(chain):
    wave = SolitaryWave.compute()
    np.testing.assert_allclose(chain.speed, wave.speed(chain.peak, K, A, M), rtol=INTEGRATION)
    half = chain.peak / 2
    sides = [(chain.peak_time - 5e-5, chain.peak_time), (chain.peak_time, chain.peak_time + 5e-5)]
    rise, fall = (brentq(lambda t: chain.force(45, t) - half, *side, xtol=1e-16) for side in sides)
    np.testing.assert_allclose(fall - rise, wave.duration(chain.peak, K, A, M), rtol=INTEGRATION)
    times = np.linspace(-5e-5, 5e-5, 101)
    simulated = chain.force(45, chain.peak_time + times)
    expected = wave.contact_pulse(times, chain.peak, K, A, M)
    np.testing.assert_allclose(simulated, expected, rtol=0, atol=INTEGRATION * chain.peak)


def test_a_formed_wave_has_the_exact_gauge_reading_and_bead_velocity(chain):
    wave, between = SolitaryWave.compute(), chain.peak_time - A / chain.speed / 2
    gauge = (chain.force(44, between) + chain.force(45, between)) / 2
    np.testing.assert_allclose(gauge / chain.peak, wave.gauge_ratio, rtol=INTEGRATION)
    velocity = chain.path(between)[chain.beads + 45]
    np.testing.assert_allclose(velocity, wave.peak_bead_velocity(chain.peak, K, A, M), rtol=INTEGRATION)
    assert abs(velocity / 0.44 - 0.682) < 5e-4  # behind an equal striker; last digit given
