"""A contact law of no particular form, as it is fitted to data that no effect of the catalogue explains.

It is no candidate of a search: with fifteen coefficients it would explain everything a little. `discover`
fits it where something is left that has no name, and a model that holds it is read, compared and simulated
like any other.
"""

import math

import numpy as np

from sonicvacuum.effects.base import MICRO, Effect, Parameter, Setup, add_term
from sonicvacuum.physics.lanes import absolute, root, select
from sonicvacuum.physics.laws import Term

# What each coefficient multiplies; r = √(δ/depth), w = rate/speed. The first nine times the Hertz force.
SHAPES = ("1", "w", "|w|", "r", "r w", "r |w|", "r²", "r² w", "r² |w|", "force w", "force r w")
SHAPES += ("|w|½", "r |w|½", "|w|½ sgn w", "r |w|½ sgn w")
COEFFICIENTS = tuple(f"a{k}" for k in range(len(SHAPES)))


def free_force(delta, rate, elastic, depth, pace, load, a, b, c, d, e, f, g, h, i, j, k, m, n, o, p):
    """Force in N beside the elastic one; depth (1/m), pace (s/m), load (N) scale its arguments to order 1."""
    r = root(delta * depth)
    w = rate * pace
    # |w| and its root, rounded off.
    far = root(w * w + SOFT * SOFT)
    s = w * w / far
    bent = 1.0 / root(far)
    shape = a + b * w + c * s + r * (d + e * w + f * s) + r * r * (g + h * w + i * s)
    concave = bent * (s * (m + n * r) + w * (o + p * r))
    return elastic * (shape + concave) + load * w * (j + k * r)


# Rates below this, relative, are small: a law with a corner at rest would be integrated less accurately than
# noise asks for.
SOFT = 0.05

TERM = Term("free-form", "force", free_force, 3 + len(COEFFICIENTS), stores=True)


def held_force(
    delta, rate, elastic, deepest, fastest, depth, pace, load, a, b, c, d, e, f, g, h, i, j, k, m, n, o, p
):
    """The same, but from the compression `deepest` in m and the rate `fastest` in m/s on its share of the
    elastic force stays what it is there: a polynomial means nothing outside the data it was fitted to.
    """
    near = select(deepest - delta, delta, deepest)
    slow = select(fastest - absolute(rate), rate, select(rate, fastest, -fastest))
    return free_force(near, slow, elastic, depth, pace, load, a, b, c, d, e, f, g, h, i, j, k, m, n, o, p)


HELD = Term("free-form", "force", held_force, 5 + len(COEFFICIENTS), stores=True)


def coefficients(chain, stiffness, mass, depth, speed, force, **a):
    """Scales of the arguments, then the coefficients."""
    return [1.0 / depth, 1.0 / speed, force, *(a[name] for name in COEFFICIENTS)]


def held_coefficients(chain, stiffness, mass, deepest, fastest, **others):
    """How far the data reach, then as of the law that is not held."""
    return [deepest, fastest, *coefficients(chain, stiffness, mass, **others)]


def change(
    setup: Setup, depth_um, speed_m_s, force_N, deepest_um=math.inf, fastest_m_s=math.inf, **a
) -> Setup:
    """Add the force to all contacts."""
    given = {"depth": depth_um * MICRO, "speed": speed_m_s, "force": force_N, **a}
    if np.all(np.isinf(deepest_um) & np.isinf(fastest_m_s)):
        return add_term(setup, TERM, coefficients, **given)
    reach = {"deepest": deepest_um * MICRO, "fastest": fastest_m_s}
    return add_term(setup, HELD, held_coefficients, **reach, **given)


def _scale(name, unit, typical, help):
    return Parameter(name, unit, None, 1e-9, 1e12, "log-uniform", typical, help, least=1e-12)


def _reach(name, unit, help):
    return Parameter(name, unit, math.inf, 1e-9, 1e12, "log-uniform", 1.0, help, least=1e-12)


EFFECT = Effect(
    id="free-form",
    title="Free-form contact law",
    missing="a contact law that no effect of the catalogue describes",
    equation="F = K delta^{3/2} (1 + sum_ij a_ij r^i {1, w, |w|}_j + sum_ij b_ij r^i {|w|^{1/2}, "
    "|w|^{1/2} sgn w}_j) + force w (a9 + a10 r), r = (delta/depth)^{1/2}, w = v/speed, cut at zero, "
    "|w| rounded off below 0.05; beyond deepest and fastest the braces stay what they are there",
    energy="stores and takes what its coefficients say",
    reference="Chosen here: a polynomial in the roots of compression and rate, up to the first power of the "
    "latter",
    parameters=(
        _scale("depth_um", "um", 1.0, "compression at which r is 1"),
        _scale("speed_m_s", "m/s", 1.0, "rate at which w is 1"),
        _scale("force_N", "N", 1.0, "scale of the forces that do not vanish with compression"),
        _reach("deepest_um", "um", "compression beyond which the shape stays what it is there"),
        _reach("fastest_m_s", "m/s", "rate beyond which the shape stays what it is there"),
        *(
            Parameter(name, "1", 0.0, -5.0, 5.0, "uniform", 0.1, f"coefficient of {shape}")
            for name, shape in zip(COEFFICIENTS, SHAPES, strict=True)
        ),
    ),
    signature="whatever a contact law moves, in every contact and run alike",
    when_to_use="something is left that no effect of the catalogue explains",
    when_not="as a name: it says how the contacts push, not why",
    dissipative=True,
    change=change,
    of_material=True,
)
