"""The numbers that the paper prints and the metrics use, in SI units, and the few that it lacks.

C. Daraio, V. F. Nesterenko, "Strongly nonlinear wave dynamics in a chain of polymer coated beads" (2006). The
section in which a number stands follows it. The points and traces of its figures are not available; no value
is read off or guessed. Nowhere else does the package repeat these numbers, but for the cases of `config.yaml`
and the table of materials.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Printed:
    """Numbers of the paper; the comment names the section ("Exp.": Experiments and discussion)."""

    core_diameter: float = 4.76e-3  # Exp., first paragraph
    small_core_diameter: float = 2.38e-3  # Exp., Fig. 6 (2.48 mm in the first paragraph)
    coating: float = 50e-6  # Exp., first paragraph
    bead_diameter: float = 4.86e-3  # Exp., set-up
    small_bead_diameter: float = 2.48e-3  # Exp., Fig. 6
    bead_mass: float = 0.44e-3  # Exp., set-up
    small_bead_mass: float = 0.04e-3  # Fig. 6
    coating_density: float = 1289.0  # Exp., first paragraph
    poisson: float = 0.388  # Exp., first paragraph
    yield_strength: float = 59e6  # Exp., first paragraph
    modulus_handbook: float = 2.76e9  # Exp., first paragraph
    modulus_membrane: float = 4.75e9  # Exp., Fig. 4
    modulus_matched: float = 15e9  # Exp., Fig. 4
    modulus_steel: float = 193e9  # Fig. 4
    nylon_over_coating: float = 1.23  # Exp., second paragraph
    coating_over_ptfe: float = 5.0  # Exp., second paragraph
    ptfe_stiffening: float = 3.0  # Exp., Fig. 4
    holder_diameter: float = 5e-3  # Exp., set-up
    light_striker: float = 0.47e-3  # Exp., set-up
    heavy_striker: float = 1.23e-3  # Exp., set-up
    steel_ball: float = 0.036e-3  # Fig. 6
    steel_ball_diameter: float = 2e-3  # Fig. 6
    ptfe_ball: float = 0.123e-3  # Fig. 6
    ptfe_ball_diameter: float = 4.76e-3  # Fig. 6
    gauge_rc: float = 1e-3  # Exp., set-up
    gauge_offset: float = 1e-3  # Exp., Fig. 3
    gauge_upper: int = 9  # Fig. 3, bead from the bottom
    gauge_lower: int = 5  # Fig. 3, bead from the bottom
    speed_coated: float = 197.0  # Exp., Fig. 3
    speed_steel: float = 578.0  # Fig. 3b
    speed_error: float = 0.10  # relative, of every measured speed; Fig. 3
    coated_bar: float = 1.0  # N, length of the force bars; captions of Figs. 3 and 5
    steel_bar: float = 5.0  # N, likewise
    speed_low: float = 130.0  # Exp., Fig. 3
    amplitude_low: float = 0.25  # Exp., Fig. 3
    duration_coated: float = 130e-6  # Exp., Fig. 3


@dataclass(frozen=True)
class Assumed:
    """Numbers that the paper lacks; reasons in `workflow/resources/claims.md`."""

    steel_density: float = 7800.0  # middle of ball steels
    ptfe_density: float = 2170.0
    alumina_density: float = 3900.0
    wave_speed_steel: float = 5900.0  # longitudinal
    yield_onset: float = 1.6  # peak pressure over yield strength, Johnson, Contact Mechanics (1985), 6.1


PRINTED = Printed()
ASSUMED = Assumed()
# Static force on the contacts between the gauges, in weights of a bead: they bear 13 to 16 beads each.
PRELOAD_WEIGHTS = 14.5
