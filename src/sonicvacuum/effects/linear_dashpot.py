"""Kelvin–Voigt damping of the contacts: a force in proportion to the approach rate."""

from sonicvacuum.effects.base import Effect, Parameter, Setup, add_term
from sonicvacuum.physics.laws import Term


def dashpot_force(delta, rate, elastic, damping):
    """Force damping × rate in N."""
    return damping * rate


TERM = Term("linear-dashpot", "force", dashpot_force, 1)


def coefficients(chain, stiffness, mass, damping):
    """The damping constant in kg/s, the same in all contacts."""
    return [damping]


def change(setup: Setup, damping_kg_s) -> Setup:
    """Add the dashpot to all contacts."""
    return add_term(setup, TERM, coefficients, damping=damping_kg_s)


EFFECT = Effect(
    id="linear-dashpot",
    title="Linear dashpot",
    missing="Kelvin-Voigt contact damping",
    equation="F = K delta^{3/2} + c v in contact, cut at zero",
    energy="takes c v^2 per time and contact",
    reference="Herbold & Nesterenko, Phys. Rev. E 75, 021304 (2007); Rosas, Romero, Nesterenko & "
    "Lindenberg, Phys. Rev. Lett. 98, 164301 (2007)",
    parameters=(
        Parameter(
            "damping_kg_s", "kg/s", 0.0, 1e-3, 50.0, "log-uniform", 0.5, "damping constant of a contact", 0.0
        ),
    ),
    signature="pulses decay and widen along the chain; the lost fraction grows as u^{-1/5} towards "
    "small amplitudes; at the struck contact the force starts with a jump",
    when_to_use="immersed or greased contacts; loss that is strongest for weak strikers",
    when_not="loss per bead that grows with amplitude: kuwabara-kono, hunt-crossley, velocity-power",
    dissipative=True,
    change=change,
    of_material=True,
)
