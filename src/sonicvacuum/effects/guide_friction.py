"""Dry friction of the beads on their holder."""

from sonicvacuum.effects.base import Effect, Parameter, Setup, add_term, no_beads
from sonicvacuum.physics.lanes import absolute, select
from sonicvacuum.physics.laws import Term

SLOW = 1e-3  # m/s; slower beads feel less than the full friction


def friction(velocity, deceleration):
    """Acceleration −deceleration × sgn(velocity) in m/s², a cubic through zero below 1 mm/s."""
    s = velocity / SLOW
    size = absolute(s)
    s = s / select(size - 1.0, size, 1.0)
    return -deceleration * s * (1.5 - 0.5 * s * s)


TERM = Term("guide-friction", "body", friction, 1)


def coefficients(chain, stiffness, mass, force):
    """f/m of each bead."""
    return [force / mass]


def change(setup: Setup, force_N) -> Setup:
    """Let the friction act on all beads; the striker is free of it."""
    return add_term(setup, TERM, coefficients, force=force_N)


EFFECT = Effect(
    id="guide-friction",
    title="Guide friction",
    missing="dry friction on the holder",
    equation="m u'' = ... - f sgn(u') on the beads (not the striker); for |u'| below 1 mm/s sgn -> s "
    "(3 - s^2)/2, s = u'/(1 mm/s)",
    energy="takes f |u'| per time and bead",
    reference="Coulomb friction; of beads in a chain: Santibanez, Munoz, Caussarieu, Job & Melo, Phys. Rev. "
    "E 84, 026604 (2011), who name rolling friction; chosen here: the cubic below 1 mm/s",
    parameters=(
        Parameter("force_N", "N", 0.0, 1e-4, 0.1, "log-uniform", 0.01, "friction force on a bead", 0.0),
    ),
    signature="weak pulses decay faster than strong ones and come to a halt; tails are cut",
    when_to_use="tight holders; losses that matter at small amplitude only",
    when_not="losses that grow with amplitude; loss in proportion to velocity: viscous-drag",
    dissipative=True,
    change=change,
    lacks=no_beads,
)
