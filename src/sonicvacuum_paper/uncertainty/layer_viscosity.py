"""The viscous force of a layer itself, which the paper's loss is held against; no effect of the catalogue.

The damping of a viscoelastic contact is A dF/ddelta v, F its elastic force, when the material's stress is
that of its strain at a time A earlier or later (Brilliantov, Spahn, Hertzsch & Pöschel, Phys. Rev. E 53, 5382
(1996), Eq. 21, for Hertz's contact). `kuwabara-kono` is that of the half-space, (3/2) A K delta^{1/2} v, on a
layer as well, where dF/ddelta is several times larger: its A is no property of the coating there.
"""

import numpy as np

from sonicvacuum.effects import CATALOGUE, Effect, Setup
from sonicvacuum.effects.base import MICRO, Parameter, add_term
from sonicvacuum.effects.coating_thickness import coefficients as layer
from sonicvacuum.effects.coating_thickness import layer_factor
from sonicvacuum.physics.laws import Term

ID = "layer-viscosity"
# Part by which the compression is changed for the slope of the layer's factor: errors of 1e-4 of the damping.
_STEP = 1e-4
# Deep below any compression that matters, so that nothing is divided by zero.
_TOUCH = 1e-15


def viscous_force(delta, rate, elastic, time, *shape):
    """Force A dF/ddelta v in N of F = K delta^{3/2} g(delta): A F (3/2 + d ln g/d ln delta)/delta v."""
    steeper = (layer_factor(delta * (1.0 + _STEP), *shape) / layer_factor(delta, *shape) - 1.0) / _STEP
    return time * elastic * (1.5 + steeper) / (delta + _TOUCH) * rate


def coefficients(chain, stiffness, mass, thickness, time):
    """A, and the layer's own coefficients, of each contact."""
    shape = layer(chain, stiffness, mass, thickness)
    return [time * np.ones_like(shape[0]), *shape]


TERM = Term(ID, "force", viscous_force, 15)


def change(setup: Setup, time_us) -> Setup:
    """Add the viscous force to all contacts, the coating being as thick as the record says."""
    (kind, *_) = setup.chain.bodies.kinds
    time = np.multiply(time_us, MICRO)
    return add_term(setup, TERM, coefficients, thickness=np.multiply(kind.coating, 1.0), time=time)


EFFECT = Effect(
    id=ID,
    title="Viscous layer",
    missing="the coating is viscous as well as elastic, and acts as the layer that it is",
    equation="F + A dF/ddelta v in contact, F the layer's elastic force, cut at zero",
    energy="takes A dF/ddelta v^2 per time and contact",
    reference="Brilliantov, Spahn, Hertzsch & Pöschel, Phys. Rev. E 53, 5382 (1996), Eq. 21",
    parameters=(Parameter("time_us", "us", 0.0, 1e-3, 100.0, "log-uniform", 1.0, "dissipative time A", 0.0),),
    signature="as kuwabara-kono",
    when_to_use="coatings of which contacts are not narrow",
    when_not="solid beads: kuwabara-kono",
    dissipative=True,
    change=change,
    of_material=True,
)
WITH_LAYER = CATALOGUE.extended((EFFECT,))
