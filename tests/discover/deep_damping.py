"""A law that the catalogue does not hold: contacts damped in proportion to their compression."""

from sonicvacuum.effects.base import Effect, Parameter, add_term
from sonicvacuum.physics.laws import Term


def deep_force(delta, rate, elastic, damping):
    """Force b delta v in N."""
    return damping * delta * rate


TERM = Term("deep-damping", "force", deep_force, 1)


def coefficients(chain, stiffness, mass, damping):
    """b, the same in all contacts."""
    return [damping]


def change(setup, damping_kg_s_m):
    """Add the damping to all contacts."""
    return add_term(setup, TERM, coefficients, damping=damping_kg_s_m)


EFFECT = Effect(
    id="deep-damping",
    title="Deep damping",
    missing="contacts are damped in proportion to their compression",
    equation="F = K delta^{3/2} + b delta v",
    energy="takes b delta v^2 per time and contact",
    reference="none: an example of an effect of one's own",
    parameters=(Parameter("damping_kg_s_m", "kg/(s m)", 0.0, 1e2, 1e7, "log-uniform", 1e5, "b"),),
    signature="pulses decay along the chain",
    when_to_use="as an example",
    when_not="elsewhere",
    dissipative=True,
    change=change,
)
