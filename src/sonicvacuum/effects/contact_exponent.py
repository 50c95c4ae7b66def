"""The contact law is a power other than 3/2: roughness, flats, cones, layers."""

from sonicvacuum.effects.base import Effect, Parameter, Setup, add_term
from sonicvacuum.physics.lanes import power
from sonicvacuum.physics.laws import Term

REFERENCE_COMPRESSION = 1e-6  # m; the compression at which all powers give the Hertz force


def power_force(delta, constant, exponent):
    """Force constant × delta^exponent in N."""
    return constant * power(delta, exponent)


def power_energy(delta, constant, exponent):
    """Energy in J of that force."""
    return constant * delta * power(delta, exponent) / (exponent + 1.0)


TERM = Term("power-contact", "elastic", power_force, 2, energy=power_energy)


def coefficients(chain, stiffness, mass, exponent):
    """The constant K delta0^{3/2 − n} and the exponent n."""
    return [stiffness * REFERENCE_COMPRESSION ** (1.5 - exponent), exponent]


def change(setup: Setup, exponent) -> Setup:
    """Replace the Hertz law in all contacts."""
    return add_term(setup, TERM, coefficients, exponent=exponent)


EFFECT = Effect(
    id="contact-exponent",
    title="Contact exponent",
    missing="the contact law is a power other than 3/2 (roughness, flats, cones, layers)",
    equation="F = K delta_0^{3/2} (delta/delta_0)^n, delta_0 = 1 um, in every contact",
    energy="stores K delta_0^{3/2-n} delta^{n+1}/(n+1) per contact",
    reference="Sen, Hong, Bang, Avalos & Doney, Phys. Rep. 462, 21 (2008), Sec. 2; chosen here: the "
    "force at 1 um is held, so that the exponent does not act as a modulus",
    parameters=(
        Parameter("exponent", "1", 1.5, 1.1, 3.0, "uniform", 0.1, "power n of the contact law", 1.0, 6.0),
    ),
    signature="speed as F^{(n-1)/(2n)}; pulses narrower for larger n; several striker speeds needed to "
    "tell it from a modulus",
    when_to_use="the slope of log speed on log force is not 1/6",
    when_not="one striker speed only: dynamic-modulus explains the same data; stiffening that fades at "
    "small load: coating-thickness",
    dissipative=False,
    change=change,
    of_material=True,
)
