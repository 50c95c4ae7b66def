"""Standard linear solid in the contact: stiffer when loaded fast, with one relaxation time."""

import numpy as np

from sonicvacuum.effects.base import MICRO, Effect, Parameter, Setup, add_term
from sonicvacuum.physics.laws import Term


def relaxing_force(elastic, state, strength, rate):
    """The extra force q = s + g F in N."""
    return state + strength * elastic


def relaxation(elastic, state, strength, rate):
    """ds/dt = −q/tau in N/s, which is dq/dt + q/tau = g dF/dt without the derivative of F."""
    return -(state + strength * elastic) * rate


def relaxed(delta, elastic, strength, rate):
    """s of a contact that has borne its load for long: q = 0."""
    return -strength * elastic


TERM = Term("relaxing-contact", "memory", relaxing_force, 2, growth=relaxation, start=relaxed)


def coefficients(chain, stiffness, mass, strength, tau):
    """g and 1/tau."""
    return [strength, 1.0 / tau]


def change(setup: Setup, strength, tau_us) -> Setup:
    """Add the relaxing force to all contacts."""
    return add_term(setup, TERM, coefficients, strength=strength, tau=np.multiply(tau_us, MICRO))


EFFECT = Effect(
    id="relaxing-contact",
    title="Relaxing contact",
    missing="standard-linear-solid contact: rate stiffening with one relaxation time",
    equation="F = K delta^{3/2} + q in contact, cut at zero; dq/dt + q/tau = g d(K delta^{3/2})/dt; q "
    "= 0 out of contact and at rest",
    energy="q v per time and contact is stored while loading and given back in part; never more than "
    "was taken since rest",
    reference="Flügge, Viscoelasticity (Springer, 1975), ch. 1 (Zener's three-parameter solid); chosen "
    "here: the Maxwell branch relaxes the elastic contact force, as in the linear theory of "
    "equal histories",
    parameters=(
        Parameter(
            "strength",
            "1",
            0.0,
            1e-3,
            10.0,
            "log-uniform",
            0.2,
            "g, instantaneous over relaxed stiffness less 1",
            0.0,
        ),
        Parameter("tau_us", "us", None, 0.3, 3000.0, "log-uniform", 30.0, "relaxation time", 1e-3),
    ),
    signature="tau well above the pulse length: a modulus larger by 1+g; well below: kuwabara-kono "
    "with A = g tau; between: fast pulses and strongest decay",
    when_to_use="polymers; stiffening and dissipation seen together",
    when_not="stiffening without decay: dynamic-modulus; decay without stiffening: kuwabara-kono",
    dissipative=True,
    change=change,
    of_material=True,
)
