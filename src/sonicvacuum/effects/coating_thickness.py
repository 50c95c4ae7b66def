"""The coating acts as the layer it is: contacts wider than it is thick feel the core and stiffen with load.

Where the pair of contacts comes from. Two equal coated spheres of radius R pressed together by delta mirror
each other in the contact plane: each is a sphere of radius R whose layer is indented by delta/2 by a rigid
flat. A rigid flat on a coated sphere and a rigid sphere on a flat layer have the same gap r²/2R, so that the
solution for a flat layer holds with chi = sqrt(R delta/2)/t. A bead on a flat wall or striker has one layer,
indented by all of delta but for the other body's share, chi = sqrt(R delta)/t. In terms of the contact's own
effective radius R* (R/2 for two beads, R on a flat) both read chi = sqrt(R* delta)/t, and the Hertz factor is
that of the contact. The elasticity of wall or striker is in series with the layer's, see `physics.layer_law`,
which also says how exact the formula is. A sphere's layer is taken as flat: the contact is much narrower than
the bead. A core that nobody stated is rigid.
"""

import numpy as np

from sonicvacuum.effects.base import MICRO, Effect, Parameter, Setup, add_term
from sonicvacuum.physics import layer_law
from sonicvacuum.physics.lanes import root
from sonicvacuum.physics.laws import Term


def layer_factor(delta, width, deep, a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12):
    """Force over Hertz force: y^12/(deep y^12 + a1 y^11 + … + a12), y = 1 + width sqrt(delta).

    Summed in pairs and fours (Estrin), which do not wait for each other as Horner's steps do.
    """
    y = 1.0 + width * root(delta)
    y2 = y * y
    y4 = y2 * y2
    high = (a1 * y + a2) * y2 + (a3 * y + a4)
    middle = (a5 * y + a6) * y2 + (a7 * y + a8)
    low = (a9 * y + a10) * y2 + (a11 * y + a12)
    return y4 * y4 * y4 / (((deep * y4 + high) * y4 + middle) * y4 + low)


# Least relative error with which a thickness is known.
EXACT = 1e-3
TERM = Term(layer_law.NAME, "factor", layer_factor, 2 + layer_law.POWERS)


def coefficients(chain, stiffness, mass, thickness):
    """Columns of `layer_factor`: the width per root of compression, the limit and the powers.

    Bodies that touch share the approach as their compliances: 1/g is the mean of both, weighted by these.
    """
    bodies, solids = len(stiffness), len(chain.solids)
    # Few kinds of pairs touch, however many contacts there are.
    one, other = chain.touching(bodies)
    pairs, kind = np.unique(solids * one + other, return_inverse=True)
    one, other = np.divmod(pairs, solids)
    yields = np.array([1.0 / _plane(solid.surface) for solid in chain.solids])
    limit, powers = _layers(chain)
    share = yields[one] / (yields[one] + yields[other])
    limit = share * limit[one] + (1.0 - share) * limit[other]
    powers = share[..., None] * powers[one] + (1.0 - share[..., None]) * powers[other]
    acts = np.isfinite(thickness)
    width = np.sqrt(chain.reduced_radii(bodies)) / (thickness * layer_law.SCALE)
    # Where there is none the factor is 1/1, to the bit.
    powers = np.where(acts[:, None], powers, np.eye(layer_law.POWERS)[-1])
    return [width, np.where(acts, limit, 0.0)[kind], *np.moveaxis(powers, -1, 0)[:, kind]]


def _layers(chain):
    """Limit (solids, lanes) and powers (solids, lanes, POWERS) of 1/g of each; 1 and 0 if not coated."""
    solids = len(chain.solids)
    limit, powers = np.ones((solids, chain.lanes)), np.zeros((solids, chain.lanes, layer_law.POWERS))
    for place, core in _coated(chain).items():
        surface = chain.solids[place].surface
        ratio = _plane(surface) / _plane(core) if core else np.zeros(chain.lanes)
        poisson = core.poisson if core else surface.poisson
        limit[place], powers[place] = layer_law.coefficients(surface.poisson, ratio, poisson)
    return limit, powers


def _coated(chain):
    """Place in `chain.solids` → elastic constants of the core of each coated body.

    Beads without a core are solid where others have one; where none has, all are coated on rigid cores. A
    ball on the wall is the bead.
    """
    if chain.beads == 0:
        return {0: chain.first.core}
    cores = {place + 1: body.core for place, body in enumerate(chain.bodies.kinds)}
    named = {place: core for place, core in cores.items() if core is not None}
    return named or cores


def _plane(elastic):
    """(lanes,) plane-strain modulus E/(1 − nu²) in Pa."""
    return elastic.modulus / (1.0 - elastic.poisson**2)


def change(setup: Setup, layer_thickness_um) -> Setup:
    """Multiply the elastic force of all contacts by the layer's factor."""
    return add_term(setup, TERM, coefficients, thickness=np.multiply(layer_thickness_um, MICRO))


def no_coating(setup: Setup) -> str | None:
    """What solid beads lack."""
    coated = any(np.isfinite(body.coating) for body in setup.chain.bodies.kinds)
    return None if coated else "no coating is stated"


def printed(chain, tolerances) -> dict[str, tuple[float, float]]:
    """The thickness that the record gives the coating, where it says how well that is known."""
    coatings = {float(t) for body in chain.solids for t in np.ravel(body.coating) if np.isfinite(t)}
    if tolerances.coating_rel is None or len(coatings) != 1:
        return {}
    return {"layer_thickness_um": (coatings.pop() / MICRO, max(tolerances.coating_rel, EXACT))}


EFFECT = Effect(
    id="coating-thickness",
    title="Bonded coating on its core",
    missing="the contact radius is not small against a soft bonded layer on a hard core; the contact "
    "stiffens with load",
    equation="F = F_Hertz g(chi), chi = sqrt(R* delta)/t, 1/g = c + a1 u + ... + a12 u^12, "
    "u = 1/(1 + 1.25 chi), c = E1'/E0': exact axisymmetric frictionless contact of a bonded layer on its "
    "core, solved for the constants of both; wall or striker in series, 1/g -> (1/g + e)/(1 + e), e = E1'/E'",
    energy="stores the integral of F over delta per contact",
    reference="Integral equation: Lebedev & Ufliand, J. Appl. Math. Mech. 22, 442 (1958); Perriot & Barthel, "
    "J. Mater. Res. 19, 600 (2004); limits: Johnson, Contact Mechanics (1985), Sec. 5.8; Dimitriadis et al., "
    "Biophys. J. 82, 2798 (2002). Chosen here: the rational form, least squares to contact radii of 12 t",
    parameters=(
        Parameter(
            "layer_thickness_um",
            "um",
            float("inf"),
            3.0,
            3000.0,
            "log-uniform",
            100.0,
            "thickness of the layer on its core",
            1e-3,
        ),
    ),
    signature="speed rises faster than F^{1/6}, up to F^{1/4}; pulses narrower and earlier for strong "
    "strikers, nominal for weak ones",
    when_to_use="coated beads whose contact radius sqrt(R* delta) is a third of the coating or more",
    when_not="solid beads; stiffening that does not depend on load: dynamic-modulus",
    dissipative=False,
    change=change,
    lacks=no_coating,
    stated=printed,
    of_material=True,
)
