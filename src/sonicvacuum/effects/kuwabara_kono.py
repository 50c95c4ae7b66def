"""Viscoelastic Hertz contact: the damping follows from the bulk viscosity of the material."""

import numpy as np

from sonicvacuum.effects.base import MICRO, Effect, Parameter, Setup, add_term
from sonicvacuum.physics.lanes import root
from sonicvacuum.physics.laws import Term


def viscoelastic_force(delta, rate, elastic, damping):
    """Force damping × delta^{1/2} × rate in N."""
    return damping * root(delta) * rate


TERM = Term("kuwabara-kono", "force", viscoelastic_force, 1)


def coefficients(chain, stiffness, mass, time):
    """(3/2) A K of each contact."""
    return [1.5 * time * stiffness]


def change(setup: Setup, time_us) -> Setup:
    """Add the viscous force to all contacts."""
    return add_term(setup, TERM, coefficients, time=np.multiply(time_us, MICRO))


EFFECT = Effect(
    id="kuwabara-kono",
    title="Viscoelastic Hertz contact",
    missing="the beads' material is viscous as well as elastic",
    equation="F = K delta^{3/2} + (3/2) A K delta^{1/2} v in contact, cut at zero",
    energy="takes (3/2) A K delta^{1/2} v^2 per time and contact",
    reference="Kuwabara & Kono, Jpn. J. Appl. Phys. 26, 1230 (1987); Brilliantov, Spahn, Hertzsch & "
    "Pöschel, Phys. Rev. E 53, 5382 (1996), Eq. 21",
    parameters=(Parameter("time_us", "us", 0.0, 1e-3, 100.0, "log-uniform", 1.0, "dissipative time A", 0.0),),
    signature="pulses decay and widen along the chain, strong ones a little faster (lost fraction as "
    "u^{1/5}); restitution 1 - 1.15 (3A/2) (K/m)^{2/5} v^{1/5}",
    when_to_use="polymers, ice, rubber; restitution that falls slowly with impact speed",
    when_not="loss independent of amplitude: tsuji, viscous-drag; delayed stiffness: relaxing-contact; on a "
    "layer (coating-thickness) K is still the half-space's, and A no time of the material",
    dissipative=True,
    change=change,
    of_material=True,
)
