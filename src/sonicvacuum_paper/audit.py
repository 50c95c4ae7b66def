"""Metrics of the pseudo-case `audit`: printed masses against geometry, stiffness of what is not coated.

Definitions in `workflow/resources/claims.md`. Densities are fixed there, not taken from the table of
materials, lest a density fitted to a printed mass confirm that mass; elastic constants come from the table.
"""

import math

from sonicvacuum.materials import MATERIALS
from sonicvacuum.physics.contact import hertz_constant, reduced_modulus, reduced_radius
from sonicvacuum.physics.theory import bead_mass
from sonicvacuum_paper.printed import ASSUMED
from sonicvacuum_paper.printed import PRINTED as P
from sonicvacuum_paper.rows import Row, absent


def rows() -> list[Row]:
    """Metrics that do not depend on the modulus of the coating."""
    metrics = {**_masses(), **_geometry()}
    return [Row("audit", name, "", float(value), unit) for name, (value, unit) in metrics.items()]


def column_rows(column: str, modulus: float, contact_time: Row | None) -> list[Row]:
    """Metrics at the modulus (Pa) of one column of the ledger.

    Args:
        column: its name.
        modulus: of the coating.
        contact_time: that of fig5b between the gauges, in us; None where there is none.
    """
    case = f"audit.{column}"
    values = {
        "striker_compliance_fraction": striker_compliance(modulus),
        "striker_stiffness_fig6b": striker_stiffness(modulus),
        "wall_stiffness_coated": wall_stiffness(modulus, P.poisson),
    }
    found = [Row(case, name, "", float(value), "1") for name, value in values.items()]
    return [*found, _over_striker_transit(case, contact_time)]


def striker_compliance(modulus: float) -> float:
    """Share of the alumina in the compliance of its contact with the coating."""
    alumina, coating = MATERIALS["alumina"], modulus / (1.0 - P.poisson**2)
    soft = (1.0 - alumina.poisson**2) / alumina.modulus
    return soft / (soft + 1.0 / coating)


def striker_stiffness(modulus: float) -> float:
    """Constant K of the PTFE ball on a small coated bead over that of two such beads."""
    ptfe, radius = MATERIALS["ptfe"], P.small_bead_diameter / 2.0
    mixed = reduced_modulus(ptfe.modulus, ptfe.poisson, modulus, P.poisson)
    equal = reduced_modulus(modulus, P.poisson, modulus, P.poisson)
    ball = hertz_constant(mixed, reduced_radius(P.ptfe_ball_diameter / 2.0, radius))
    return ball / hertz_constant(equal, reduced_radius(radius, radius))


def wall_stiffness(modulus: float, poisson: float) -> float:
    """Constant K of a bead on brass over that on steel."""
    steel, brass = MATERIALS["stainless-steel"], MATERIALS["brass"]
    soft = reduced_modulus(modulus, poisson, brass.modulus, brass.poisson)
    return float(soft / reduced_modulus(modulus, poisson, steel.modulus, steel.poisson))


def _masses():
    gram = 1e3
    steel = ASSUMED.steel_density
    large, small = (
        bead_mass(core / 2.0, P.coating, steel, P.coating_density)
        for core in (P.core_diameter, P.small_core_diameter)
    )
    steel_ball = _ball(P.steel_ball_diameter, steel)
    ptfe_ball = _ball(P.ptfe_ball_diameter, ASSUMED.ptfe_density)
    coating = large - _ball(P.core_diameter, steel)
    core_density = (P.bead_mass - coating) / _ball(P.core_diameter, 1.0)
    return {
        "bead_mass_large": (large * gram, "g"),
        "bead_mass_small": (small * gram, "g"),
        "striker_mass_steel_ball": (steel_ball * gram, "g"),
        "striker_mass_ptfe_ball": (ptfe_ball * gram, "g"),
        "mass_over_geometry_large": (P.bead_mass / large, "1"),
        "mass_over_geometry_small": (P.small_bead_mass / small, "1"),
        "mass_over_geometry_steel_ball": (P.steel_ball / steel_ball, "1"),
        "mass_over_geometry_ptfe_ball": (P.ptfe_ball / ptfe_ball, "1"),
        "mass_ratio_fig6a": (steel_ball / small, "1"),
        "mass_ratio_fig6b": (ptfe_ball / small, "1"),
        "core_density_large": (core_density / 1e3, "g/cm3"),
    }


def _geometry():
    steel = MATERIALS["stainless-steel"]
    return {
        "offset_over_radius": (P.gauge_offset / (P.bead_diameter / 2.0), "1"),
        "wall_stiffness_steel": (wall_stiffness(P.modulus_steel, steel.poisson), "1"),
        "lateral_play_angle_large": (play_angle(P.bead_diameter), "deg"),
        "lateral_play_angle_steel": (play_angle(P.core_diameter), "deg"),
    }


def play_angle(diameter: float) -> float:
    """Largest angle in degrees between the axis and the line of two touching beads in the holder."""
    return math.degrees(math.asin((P.holder_diameter - diameter) / diameter))


def _ball(diameter, density):
    return math.pi / 6.0 * diameter**3 * density


def _over_striker_transit(case, contact_time):
    name, alumina = "contact_time_over_striker_transit", MATERIALS["alumina"]
    if contact_time is None or not contact_time.known:
        reason = contact_time.reason if contact_time else "fig5b has not been run"
        return absent(case, name, "", "1", reason)
    # The cylinder fits the holder: it is at least so long.
    length = P.heavy_striker / ASSUMED.alumina_density / (math.pi * (P.holder_diameter / 2.0) ** 2)
    transit = length / math.sqrt(alumina.modulus / ASSUMED.alumina_density) * 1e6
    return Row(case, name, "", contact_time.value / transit, "1", contact_time.numerical_error / transit)
