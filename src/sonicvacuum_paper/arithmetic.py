"""Metrics of the pseudo-case `paper`: arithmetic on the numbers that the paper prints.

Definitions in `workflow/resources/claims.md`. They have one value for all columns of the ledger.
"""

from sonicvacuum.materials import MATERIALS
from sonicvacuum.physics import theory
from sonicvacuum_paper.printed import PRINTED as P
from sonicvacuum_paper.rows import Row
from sonicvacuum_paper.theory_rows import COATED, coated_preload


def rows() -> list[Row]:
    """All of them."""
    metrics = {**_geometry(), **_masses(), **_moduli(), **_low_speed()}
    return [Row("paper", name, "", float(value), unit) for name, (value, unit) in metrics.items()]


def _geometry():
    apart = (P.gauge_upper - P.gauge_lower) * P.bead_diameter
    return {
        "coated_diameter_large": ((P.core_diameter + 2 * P.coating) * 1e3, "mm"),
        "coated_diameter_small": ((P.small_core_diameter + 2 * P.coating) * 1e3, "mm"),
        "small_core_diameter": ((P.small_bead_diameter - 2 * P.coating) * 1e3, "mm"),
        "speed_error_alignment": (2 * P.gauge_offset / apart, "1"),
        "width_from_duration": (P.speed_coated * P.duration_coated / P.bead_diameter, "diameters"),
    }


def _masses():
    return {
        "mass_ratio_light": (P.light_striker / P.bead_mass, "1"),
        "mass_ratio_heavy": (P.heavy_striker / P.bead_mass, "1"),
        "mass_ratio_fig6a": (P.steel_ball / P.small_bead_mass, "1"),
        "mass_ratio_fig6b": (P.ptfe_ball / P.small_bead_mass, "1"),
    }


def _moduli():
    ratio = P.modulus_matched / P.modulus_handbook
    return {
        "modulus_ratio": (ratio, "1"),
        "membrane_over_handbook": (P.modulus_membrane / P.modulus_handbook, "1"),
        "stiffening_factor_ratio": (ratio / P.ptfe_stiffening, "1"),
        "matched_over_nylon_modulus": (ratio / P.nylon_over_coating, "1"),
        "adjusted_parameters_fig4a": (float(P.modulus_matched != P.modulus_handbook), "1"),
    }


def _low_speed():
    """The one point of Fig. 4(a) whose two coordinates the text gives."""
    static = coated_preload()

    def over_eq7(modulus):
        peak = P.amplitude_low + static
        return P.speed_low / theory.speed_with_precompression(peak, static, modulus, **COATED)

    matched = over_eq7(P.modulus_matched)
    ptfe = P.ptfe_stiffening * P.modulus_handbook / P.coating_over_ptfe
    ptfe_speed = theory.speed_from_force(
        P.amplitude_low, ptfe, MATERIALS["ptfe"].poisson, P.ptfe_ball_diameter, P.ptfe_ball
    )
    return {
        "speed_over_eq7_handbook": (over_eq7(P.modulus_handbook), "1"),
        "speed_over_eq7_matched": (matched, "1"),
        "mach_low_speed_matched": (
            P.speed_low / theory.linear_sound_speed(static, P.modulus_matched, **COATED),
            "1",
        ),
        "modulus_from_low_speed": (P.modulus_matched / 1e9 * matched**3, "GPa"),
        "ptfe_speed_low_amplitude": (ptfe_speed, "m/s"),
    }
