"""Eqs. (1)–(7): mutual limits, scaling laws, inverses, and the linear waves of the precompressed chain."""

import subprocess
import sys
from decimal import Decimal, localcontext

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from sonicvacuum.physics import theory

E, NU, A, M = 15e9, 0.388, 4.86e-3, 0.44e-3
CHAIN = (E, NU, A, M)
ROUNDING = 1e-13  # a few hundred units in the last place: powers and roots of powers

amplitudes = st.floats(1e-9, 1e3)
chains = st.tuples(st.floats(1e6, 1e12), st.floats(-0.9, 0.5), st.floats(1e-5, 1.0), st.floats(1e-9, 10.0))


def equal(left, right, rtol=ROUNDING):
    np.testing.assert_allclose(left, right, rtol=rtol, atol=0)


def test_contact_force_is_the_printed_equation():
    approach = np.array([0.0, 1e-9, 5e-6])
    printed = 2 * E / (3 * (1 - NU**2)) * np.sqrt(A / 4) * approach**1.5
    equal(theory.contact_force(approach, E, NU, A), printed)
    assert theory.contact_force(-1e-6, E, NU, A) == 0


@given(st.floats(1e-12, 1e-4), chains)
def test_acceleration_constant_is_the_slope_of_the_contact_force(approach, chain):
    modulus, nu, diameter, mass = chain
    step = 1e-4 * approach
    rise = np.subtract(*theory.contact_force([approach + step, approach - step], modulus, nu, diameter))
    slope = 1.5 * theory.acceleration_constant(*chain) * mass * np.sqrt(approach)
    equal(rise / (2 * step), slope, 1e-8)  # central difference: step² /24 of the value, and rounding/1e-4
    force = theory.contact_force(approach, modulus, nu, diameter)
    equal(theory.contact_stiffness(force, modulus, nu, diameter), slope)
    equal(theory.contact_approach(force, modulus, nu, diameter), approach)


def test_bead_mass_of_bare_and_of_uniform_beads():
    equal(theory.bead_mass(2e-3, 0.0, 7800.0, 1289.0), 7800 * 4 / 3 * np.pi * 2e-3**3)
    equal(theory.bead_mass(2e-3, 5e-5, 1289.0, 1289.0), 1289 * 4 / 3 * np.pi * 2.05e-3**3)


def test_equation_of_motion_keeps_momentum_and_never_pulls():
    constant, rng = theory.acceleration_constant(*CHAIN), np.random.default_rng(1)
    u = rng.normal(scale=1e-6, size=(5, 20))
    a = theory.chain_accelerations(u, constant)
    assert a.shape == u.shape
    assert np.all(np.abs(a.sum(axis=1)) <= 1e-13 * np.abs(a).sum(axis=1))  # rounding of the sum
    assert not theory.chain_accelerations(np.arange(20.0), constant).any()  # all contacts open
    assert not theory.chain_accelerations(np.full(20, 0.5), constant, 2e-6).any()  # moved as one
    pushed = theory.chain_accelerations([1e-6, 0.0], constant) * M
    equal(pushed, theory.contact_force(1e-6, E, NU, A) * np.array([-1, 1]))


@given(amplitudes, chains)
def test_eqs_4_and_5_make_eq_6(peak, chain):
    strain = theory.strain_from_force(peak, *chain[:3])
    equal(theory.force_from_strain(strain, *chain[:3]), peak)
    equal(theory.speed_from_strain(strain, *chain), theory.speed_from_force(peak, *chain))


def printed_eq_7(ratio: Decimal) -> Decimal:
    """V/c₀ of Eq. (7) as printed, whose front factor with the material constants is √(4/15) c₀."""
    root = ratio ** (Decimal(2) / 3)
    return (Decimal(4) / 15 * (3 + 2 * root ** Decimal("2.5") - 5 * root)).sqrt() / (root - 1)


@pytest.mark.parametrize("excess", ["1e-12", "1e-6", "1e-3", "0.1", "1", "10", "1e4", "1e9"])
def test_eq_7_keeps_all_digits_where_the_printed_form_loses_them(excess):
    static = 2.0**-7  # a power of two, so that the ratio of forces is exactly the number meant
    total = static * (1 + float(excess))
    with localcontext(prec=60):  # 60 digits: the cancellation costs 24 of them at an excess of 1e-12
        reference = float(printed_eq_7(Decimal(total) / Decimal(static)))
    speed = theory.speed_with_precompression(total, static, *CHAIN)
    equal(speed / theory.linear_sound_speed(static, *CHAIN), reference, 1e-14)


def test_eq_7_is_the_printed_formula_with_its_constants():
    total, static = np.array([2.0, 5.0, 40.0]), 0.3
    ratio = total / static
    front = np.sqrt(2 / 15) * (3 * E**2 * static * A**7 / (M**3 * (1 - NU**2) ** 2)) ** (1 / 6)
    printed = front / (ratio ** (2 / 3) - 1) * np.sqrt(3 + 2 * ratio ** (5 / 3) - 5 * ratio ** (2 / 3))
    equal(theory.speed_with_precompression(total, static, *CHAIN), printed)


@given(amplitudes, chains)
def test_eq_7_ends_in_eq_6_and_in_the_sound_speed(force, chain):
    equal(theory.speed_with_precompression(force, 0.0, *chain), theory.speed_from_force(force, *chain))
    slow = theory.speed_with_precompression(force, 1e-9 * force, *chain)
    excess = slow / theory.speed_from_force(force, *chain) - 1
    equal(excess, 1e-6, 1e-2)  # leading term (F₀/F_m)^{2/3}; the next is 1e-3 of it
    strain = theory.strain_from_force(force, *chain[:3])
    sound = theory.sound_speed_from_strain(strain, *chain)
    equal(theory.speed_with_precompression(force, force, *chain), sound)
    equal(theory.linear_sound_speed(force, *chain), sound)


@pytest.mark.parametrize("ratio", [1.01, 1.5, 4.0, 100.0])
def test_eq_7_is_the_solitary_wave_of_eq_3_with_the_total_force(ratio):
    """First integral of Eq. (3) by quadrature: in y = ξ^{5/4} no net work is done between rest and ξ_m.

    With ξ in units of ξ₀ and w = V²/c² ξ₀^{-1/2}, (a²/10) y″ = w (y^{3/5} − y^{-1/5}) − y + y^{-1/5}.
    """
    speed = theory.speed_with_precompression(ratio, 1.0, *CHAIN)
    w = 1.5 * (speed / theory.linear_sound_speed(1.0, *CHAIN)) ** 2
    peak = ratio ** (5 / 6)

    def push(y):
        return w * (y**0.6 - y**-0.2) - y + y**-0.2

    size, _ = quad(lambda y: abs(push(y)), 1, peak, epsrel=1e-3)
    work, _ = quad(push, 1, peak, epsabs=1e-11 * size, epsrel=0)
    assert abs(work) < 1e-9 * size  # its two lobes cancel; rounding of y^0.6 − y^−0.2 near rest is 1e-14/0.01


@given(amplitudes, st.floats(0, 1), chains, st.floats(0.1, 10))
def test_speed_scales_as_modulus_to_one_third_and_force_to_one_sixth(peak, share, chain, factor):
    modulus, *rest = chain
    speed = theory.speed_with_precompression(peak, share * peak, *chain)
    stiffer = theory.speed_with_precompression(peak, share * peak, factor * modulus, *rest)
    stronger = theory.speed_with_precompression(factor * peak, share * peak * factor, *chain)
    equal(stiffer, speed * factor ** (1 / 3))
    equal(stronger, speed * factor ** (1 / 6))


@given(amplitudes, st.floats(0, 0.999), st.floats(1e-3, 1))
def test_speed_grows_with_precompression_and_with_amplitude(peak, share, more):
    static, other = share * peak, (share + (1 - share) * more) * peak
    speed = theory.speed_with_precompression(peak, static, *CHAIN)
    assert theory.speed_with_precompression(peak, other, *CHAIN) > speed
    assert theory.speed_with_precompression(peak * (1 + more), static, *CHAIN) > speed


@given(amplitudes, st.floats(0, 1), chains)
def test_inverses_return_the_amplitude_and_the_modulus(peak, share, chain):
    static = share * peak
    equal(theory.force_from_speed(theory.speed_from_force(peak, *chain), *chain), peak, 1e-12)  # power 6
    speed = theory.speed_with_precompression(peak, static, *chain)
    # Near F_m = F₀ the speed depends on F_m by 1/18 only: rounding is magnified 18 times.
    equal(theory.force_from_speed_with_precompression(speed, static, *chain), peak, 1e-12)
    equal(theory.modulus_from_speed(speed, peak, *chain[1:], static), chain[0], 1e-12)  # power 3


def test_inverse_of_eq_7_takes_arrays_and_rest():
    speeds = theory.speed_with_precompression([[1.0], [4.0]], [0.0, 0.1, 1.0], *CHAIN)
    force = theory.force_from_speed_with_precompression(speeds, [0.0, 0.1, 1.0], *CHAIN)
    equal(force, np.broadcast_to([[1.0], [4.0]], (2, 3)), 1e-12)
    assert theory.force_from_speed_with_precompression(0.0, 0.0, *CHAIN) == 0
    assert theory.speed_with_precompression(0.0, 0.0, *CHAIN) == 0


def test_linear_frequencies_are_the_normal_modes_of_the_equation_of_motion():
    """Free chain of N beads under constant end forces: modes at κ a = m π/N, m = 0 … N − 1."""
    beads, static = 12, 0.5
    rest, constant = theory.contact_approach(static, E, NU, A), theory.acceleration_constant(*CHAIN)
    step = 1e-5 * rest
    shifted = theory.chain_accelerations(step * np.vstack((np.eye(beads), -np.eye(beads))), constant, rest)
    jacobian = (shifted[:beads] - shifted[beads:]) / (2 * step)
    simulated = np.sqrt(np.sort(np.abs(np.linalg.eigvalsh(jacobian)))) / (2 * np.pi)
    wavenumber = np.arange(beads) * np.pi / (beads * A)
    expected = theory.linear_frequency(wavenumber, static, *CHAIN)
    highest = theory.cutoff_frequency(static, *CHAIN)
    # Central difference 1e-10 and rounding 1e-11 of ω², whose root at the zero mode is of order 1e-5.
    np.testing.assert_allclose(simulated[1:], expected[1:], rtol=1e-8)
    assert simulated[0] < 1e-4 * highest
    equal(theory.linear_frequency(np.pi / A, static, *CHAIN), highest)
    tiny = 1e-4 / A  # sin x / x = 1 − x²/6: 4e-10 short of the long-wave limit
    phase_speed = 2 * np.pi * theory.linear_frequency(tiny, static, *CHAIN) / tiny
    equal(phase_speed, theory.linear_sound_speed(static, *CHAIN), 1e-9)


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda: theory.contact_force(1e-6, -1.0, NU, A), "modulus"),
        (lambda: theory.contact_force(1e-6, E, 0.6, A), "poisson"),
        (lambda: theory.contact_force(1e-6, E, NU, [A, 0.0]), "diameter"),
        (lambda: theory.bead_mass(1e-3, -1e-6, 7800.0, 1289.0), "coating"),
        (lambda: theory.chain_accelerations([0.0, 0.0], 1.0, -1e-6), "precompression"),
        (lambda: theory.speed_from_force(-1.0, *CHAIN), "peak_force"),
        (lambda: theory.speed_from_force(np.nan, *CHAIN), "peak_force"),
        (lambda: theory.speed_from_strain(-0.1, *CHAIN), "peak_strain"),
        (lambda: theory.speed_from_force(1.0, E, NU, A, 0.0), "mass"),
        (lambda: theory.speed_with_precompression([2.0, 0.5], 1.0, *CHAIN), "peak_force"),
        (lambda: theory.speed_with_precompression(2.0, -1.0, *CHAIN), "static_force"),
        (lambda: theory.force_from_speed_with_precompression(1.0, 1.0, *CHAIN), "speed"),
        (lambda: theory.modulus_from_speed(0.0, 1.0, NU, A, M), "speed"),
    ],
)
def test_unphysical_input_is_named(call, name):
    with pytest.raises(ValueError, match=f"^{name} must be .*, got "):
        call()


def test_import_does_not_load_scipy():
    code = "import sys, sonicvacuum.physics.solitary; sys.exit('scipy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
