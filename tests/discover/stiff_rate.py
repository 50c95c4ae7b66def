"""A law that the catalogue does not hold: contacts that are stiffer the faster they are closed or opened."""

from sonicvacuum.effects.base import Effect, Parameter, add_term
from sonicvacuum.physics.lanes import absolute, power
from sonicvacuum.physics.laws import Term

EXPONENT = 0.4


def stiffer_force(delta, rate, elastic, share):
    """Force share F |v|^0.4 in N, v in m/s."""
    return elastic * share * power(absolute(rate), EXPONENT)


TERM = Term("stiffer", "force", stiffer_force, 1)


def coefficients(chain, stiffness, mass, share):
    """The share, the same in all contacts."""
    return [share]


def change(setup, share):
    """Add the stiffening to all contacts."""
    return add_term(setup, TERM, coefficients, share=share)


EFFECT = Effect(
    id="stiffer",
    title="Stiffer when faster",
    missing="contacts stiffen with the rate",
    equation="F = K delta^{3/2} (1 + b |v|^{0.4})",
    energy="gives back what it takes",
    reference="none: an example of an effect of one's own",
    parameters=(Parameter("share", "1", 0.0, 1e-3, 1.0, "log-uniform", 0.1, "b"),),
    signature="faster pulses, the flanks steeper",
    when_to_use="as an example",
    when_not="elsewhere",
    dissipative=False,
    change=change,
)
