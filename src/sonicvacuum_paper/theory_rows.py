"""Metrics of the pseudo-case `theory`: what Eqs. (1)–(7) say, as printed, for the chains of the paper.

Where identities between the equations are tested, each equation is evaluated here in its printed form;
`physics.theory` holds the same in forms that do not cancel. Definitions in `workflow/resources/claims.md`.
"""

import math

import numpy as np

from sonicvacuum.laboratory.specimen import GRAVITY
from sonicvacuum.materials import MATERIALS
from sonicvacuum.physics import solitary, theory
from sonicvacuum_paper.printed import ASSUMED, PRELOAD_WEIGHTS, PRINTED
from sonicvacuum_paper.rows import Row

FORCES = np.geomspace(1e-3, 10.0, 41)
COATED = {"poisson": PRINTED.poisson, "diameter": PRINTED.bead_diameter, "mass": PRINTED.bead_mass}


def coated_preload(weights: float = PRELOAD_WEIGHTS) -> float:
    """Static force in N between the gauges of the coated chain."""
    return weights * PRINTED.bead_mass * GRAVITY


def rows() -> list[Row]:
    """Metrics that do not depend on the modulus of the coating."""
    metrics = {**_identities(), **_limits(), **_waves()}
    return [Row("theory", name, "", float(value), unit) for name, (value, unit) in metrics.items()]


def column_rows(column: str, modulus: float) -> list[Row]:
    """Metrics that do, at the modulus (Pa) of one column of the ledger."""
    elastic = {"modulus": modulus, "poisson": PRINTED.poisson, "diameter": PRINTED.bead_diameter}
    core = float(theory.contact_force(2.0 * PRINTED.coating, **elastic))
    upper, lower = (
        theory.speed_with_precompression(PRINTED.amplitude_low + f, f, modulus, **COATED)
        for f in (coated_preload(12.5), coated_preload(16.5))
    )
    case = f"theory.{column}"
    steel = MATERIALS["stainless-steel"]
    bare = theory.hertz_stiffness(PRINTED.modulus_steel, steel.poisson, PRINTED.core_diameter)
    coated = theory.hertz_stiffness(modulus, PRINTED.poisson, PRINTED.bead_diameter)
    return [
        # Eq. 6 at given force and mass: V ~ a K^(1/3).
        Row(
            case,
            "core_contact_speedup",
            "",
            float(PRINTED.core_diameter / PRINTED.bead_diameter * (bare / coated) ** (1 / 3)),
            "1",
        ),
        Row(case, "core_contact_force", "", core, "N"),
        Row(case, "preload_gradient_speed", "", float(lower / upper - 1.0), "1"),
    ]


def _identities() -> dict[str, tuple[float, str]]:
    """Ratios of printed equations, each the value farthest from 1."""
    e, nu, a, m = PRINTED.modulus_handbook, PRINTED.poisson, PRINTED.bead_diameter, PRINTED.bead_mass
    depth = theory.contact_approach(FORCES, e, nu, a)
    strain = depth / a
    eq1 = 2 * e / (3 * (1 - nu**2)) * (a / 4) ** 0.5 * depth**1.5
    eq2 = e * a**0.5 / (3 * (1 - nu**2) * m)
    eq4 = 4 * e / (3 * (1 - nu**2)) * (a / 2) ** 2 * strain**1.5
    c = (e * a**3 / (3 * (1 - nu**2) * m)) ** 0.5
    eq5 = 2 / 5**0.5 * c * strain**0.25
    eq6 = printed_eq6(eq4, e, nu, a, m)
    eq7 = printed_eq7(FORCES, 1e-12 * FORCES, e, nu, a, m)
    ratios = {
        "eq2_over_eq1": eq2 * depth**1.5 * m / eq1,
        "eq4_over_eq1": eq4 / eq1,
        "eq6_over_eq45": eq6 / eq5,
        "eq7_over_eq6_limit": eq7 / printed_eq6(FORCES, e, nu, a, m),
        "eq3_over_eq5": _eq3_over_eq5(),
    }
    return {name: (farthest(ratio), "1") for name, ratio in ratios.items()}


def _eq3_over_eq5():
    """Both sides of Eq. (3), integrated twice, for ξ = ξ_m cos⁴ θ, θ = √10 x/(5a), at the speed of Eq. (5).

    V² ξ = c² (ξ^(3/2) + (a²/10) ξ^(1/4) (ξ^(5/4))''), in units of c, a and ξ_m, so that V² is 4/5.
    """
    angle = np.linspace(0.0, 0.45 * math.pi, 41)
    one, square = np.cos(angle), 10.0 / 25.0
    bent = square * (20.0 * one**3 * np.sin(angle) ** 2 - 5.0 * one**5)
    return (one**6 + one * bent / 10.0) / (2 / 5**0.5) ** 2 / one**4


def _over_kdv(f0, modulus, c0):
    """Excess of Eq. (7) over c0 against that of the Korteweg–de Vries soliton, c0 Δξ/(12 ξ_0), at small Δξ.

    A strain ξ_0 + s travels at c0 (1 + s/(4 ξ_0)) without dispersion; a soliton exceeds c0 by a third of it.
    """
    part = 1e-4
    force = (1.0 + part) ** 1.5 * f0
    speed = theory.speed_with_precompression(force, f0, modulus, **COATED)
    return float((speed / c0 - 1.0) / (part / 12.0))


def _limits() -> dict[str, tuple[float, str]]:
    """Limits of small and large amplitude."""
    e, f0 = PRINTED.modulus_handbook, coated_preload()
    strain = theory.strain_from_force(f0, e, PRINTED.poisson, PRINTED.bead_diameter)
    c0 = theory.sound_speed_from_strain(strain, e, **COATED)
    weak = theory.speed_with_precompression((1 + 1e-6) * f0, f0, e, **COATED)
    ratio = np.concatenate([[1.001], np.geomspace(1.01, 1e6, 200)])
    supersonic = theory.speed_with_precompression(ratio * f0, f0, e, **COATED) / c0
    mass, steel = bare_bead_mass(), MATERIALS["stainless-steel"]
    preload = PRELOAD_WEIGHTS * mass * GRAVITY
    bare = (PRINTED.modulus_steel, steel.poisson, PRINTED.core_diameter, mass)
    forces = np.geomspace(2.0 * preload, 50.0, 50)
    above = theory.speed_with_precompression(forces, preload, *bare) > theory.speed_from_force(forces, *bare)
    return {
        "c0_over_linear_chain": (c0 / theory.linear_sound_speed(f0, e, **COATED), "1"),
        "eq7_over_c0_limit": (weak / c0, "1"),
        "eq7_over_kdv": (_over_kdv(f0, e, c0), "1"),
        "mach_number_min": (supersonic.min(), "1"),
        "gravity_above_vacuum": (float(above.all()), "1"),
    }


def _waves() -> dict[str, tuple[float, str]]:
    """Size, speed and exponent of the solitary wave."""
    e, nu, a, m = PRINTED.modulus_handbook, *COATED.values()

    def eq6(force):
        return printed_eq6(force, e, nu, a, m)

    h = 1e-4
    solid = PRINTED.coating_density * math.pi / 6.0 * a**3
    exact = solitary.SolitaryWave.compute().speed(1.0, theory.hertz_stiffness(e, nu, a), a, m)
    return {
        "soliton_width": (solitary.soliton_width(1.0), "diameters"),
        "speed_slope": (math.log(eq6(1 + h) / eq6(1 - h)) / math.log((1 + h) / (1 - h)), "1"),
        "speed_ratio_millionth_force": (eq6(1e-6) / eq6(1.0), "1"),
        "speed_change_narrow": (eq6(1.5) / eq6(1.0) - 1.0, "1"),
        "heavy_core_slowing": (math.sqrt(m / solid), "1"),
        "long_wave_speed_deviation": (abs(eq6(1.0) / exact - 1.0), "1"),
    }


def bare_bead_mass() -> float:
    """Mass in kg of a bare steel bead, by geometry."""
    return math.pi / 6.0 * PRINTED.core_diameter**3 * ASSUMED.steel_density


def printed_eq6(force, e, nu, a, m):
    """Eq. (6) as printed."""
    return 2 / 5**0.5 * (e * a**3.5 / (3 * (1 - nu**2))) ** (1 / 3) * force ** (1 / 6) / m**0.5


def printed_eq7(peak_force, static_force, e, nu, a, m):
    """Eq. (7) as printed."""
    f = peak_force / static_force
    scale = (3 * e**2 * static_force * a**7 / (m**3 * (1 - nu**2) ** 2)) ** (1 / 6)
    return (2 / 15) ** 0.5 * scale / (f ** (2 / 3) - 1) * (3 + 2 * f ** (5 / 3) - 5 * f ** (2 / 3)) ** 0.5


def farthest(ratios) -> float:
    """The ratio that is farthest from 1."""
    ratios = np.atleast_1d(ratios)
    return float(ratios[np.abs(ratios - 1.0).argmax()])
