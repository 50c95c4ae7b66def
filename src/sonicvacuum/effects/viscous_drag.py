"""Each bead is slowed by the medium or the holder in proportion to its velocity."""

from sonicvacuum.effects.base import Effect, Parameter, Setup, add_term, no_beads
from sonicvacuum.physics.laws import Term


def drag(velocity, rate):
    """Acceleration −rate × velocity in m/s²."""
    return -rate * velocity


TERM = Term("viscous-drag", "body", drag, 1)


def coefficients(chain, stiffness, mass, rate):
    """1/tau, the same for all beads."""
    return [rate]


def change(setup: Setup, rate_per_s) -> Setup:
    """Let the drag act on all beads; the striker is free of it."""
    return add_term(setup, TERM, coefficients, rate=rate_per_s)


EFFECT = Effect(
    id="viscous-drag",
    title="Viscous drag",
    missing="each bead is slowed by the medium or holder in proportion to its velocity",
    equation="m u'' = ... - m u'/tau, rate = 1/tau, on the beads (not the striker)",
    energy="takes m u'^2/tau per time and bead",
    reference="Job, Melo, Sokolow & Sen, Phys. Rev. Lett. 94, 178002 (2005); Rosas & Lindenberg, Phys. "
    "Rev. E 68, 041304 (2003)",
    parameters=(Parameter("rate_per_s", "1/s", 0.0, 1.0, 3e4, "log-uniform", 200.0, "rate of slowing", 0.0),),
    signature="pulses decay in proportion to travel time, so strong (fast) ones less per bead; nothing "
    "changes in the contacts' shape",
    when_to_use="immersed chains, sliding guides",
    when_not="loss that depends on the contact: dashpots; a loss per bead that does not depend on "
    "amplitude: tsuji",
    dissipative=True,
    change=change,
    lacks=no_beads,
)
