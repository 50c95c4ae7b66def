"""Unloading follows a different path than loading: a residual compression is left."""

from sonicvacuum.effects.base import Effect, Parameter, Setup, add_term
from sonicvacuum.physics.lanes import positive, power_3_2, select
from sonicvacuum.physics.laws import Term


def plastic_force(delta, loading, largest, top, residual):
    """Force in N: the loading curve at the largest compression so far, below it the unloading curve.

    F_max ((delta − delta_res)/(delta_max − delta_res))^{3/2} with delta_res = residual × delta_max, F_max
    (`top`) by whatever loading curve is in force. Where nothing stays behind, that curve is the way back too,
    of whatever shape it is.
    """
    share = positive(delta - residual * largest) / ((1.0 - residual) * select(largest, largest, 1.0))
    return select(residual * (largest - delta), top * power_3_2(share), loading)


TERM = Term("plastic-contact", "path", plastic_force, 1)


def coefficients(chain, stiffness, mass, residual):
    """The residual fraction."""
    return [residual]


def change(setup: Setup, residual_fraction) -> Setup:
    """Let all contacts remember their largest compression."""
    return add_term(setup, TERM, coefficients, residual=residual_fraction)


EFFECT = Effect(
    id="plastic-contact",
    title="Plastic contact",
    missing="unloading follows another path than loading",
    equation="delta_res = e delta_max; unloading and reloading F = F_max ((delta - "
    "delta_res)/(delta_max - delta_res))^{3/2} up to delta_max, the loading curve (Hertz unless another "
    "effect changes it) beyond",
    energy="takes the fraction e of the loading work (2/5) K delta_max^{5/2}; nothing while reloading "
    "below delta_max. Beside a loading curve F ~ delta^n it leaves (2/5)(n + 1)(1 - e) of the loading work: "
    "with n > 3/2 and a small e more than was put in",
    reference="Walton & Braun, J. Rheol. 30, 949 (1986); Thornton, J. Appl. Mech. 64, 383 (1997). "
    "Chosen here: Hertzian shape of both branches and a residual in proportion to the "
    "largest compression",
    parameters=(
        Parameter(
            "residual_fraction",
            "1",
            0.0,
            0.0,
            0.9,
            "uniform",
            0.05,
            "residual over largest compression",
            0.0,
            0.99,
        ),
    ),
    signature="loses the fraction e of the contact energy per impact at any speed (restitution "
    "sqrt(1-e) on a wall); amplitudes decay along the chain, the pulse's tail is shorter "
    "than its front",
    when_to_use="contact pressure above yield; a chain that shows a different response to its second impact",
    when_not="losses that depend on speed: dashpots. In a first impact tsuji loses the same fraction "
    "at every speed",
    dissipative=True,
    change=change,
    of_material=True,
)
