"""The contact is wide against a soft layer bonded to a hard core, so that it stiffens with load.

Where the pair of contacts comes from. Two equal coated spheres of radius R pressed together by delta mirror
each other in the contact plane: each is a sphere of radius R whose layer is indented by delta/2 by a rigid
flat. A rigid flat on a coated sphere and a rigid sphere on a flat layer have the same gap r²/2R, so that
Dimitriadis' solution holds with chi = sqrt(R delta/2)/h. A bead on a much stiffer flat wall or striker has
one layer indented by delta, chi = sqrt(R delta)/h. In terms of the contact's own effective radius R* (R/2
for two beads, R on a flat) both read chi = sqrt(R* delta)/h, and the Hertz factor is that of the contact.
(The few per cent of the compliance that a steel wall or an alumina striker contributes are stiffened along.)

Range. The quartic of Dimitriadis is an expansion in small chi, used up to chi about 1; for nu < 1/2 its last
coefficient is negative and it turns over (nu = 0.388: at chi = 2.0). It is therefore used up to its
inflection (chi = 1.13 at nu = 0.388) and continued along its tangent there, as the bonded Winkler layer
(Johnson, Contact Mechanics, Sec. 5.8) is linear in chi too: F/F_Hertz = (3 pi/4) (1−nu)²/(1−2nu) chi. Twice
continuously differentiable, and rising for all loads. Against the exact solution for the layer (in the
tests) the factor at nu = 0.388 is 1.5 % low at chi = 0.3, 10 % at 0.8, 20 % at 2; with a layer thinner by
15 % it follows the exact curve to 5 % up to there. At nu = 1/2 the general formula gives the last
coefficient −0.097 where the paper's special case prints +0.0975.
"""

import numpy as np

from sonicvacuum.effects.base import MICRO, Effect, Parameter, Setup, add_term
from sonicvacuum.physics.lanes import positive, root
from sonicvacuum.physics.laws import Term


def layer_series(poisson: float) -> tuple[float, float, float, float]:
    """Coefficients of chi, chi², chi³, chi⁴ for a bonded layer (Dimitriadis et al. 2002, Eqs. 12 and 13)."""
    a = -(1.2876 - 1.4678 * poisson + 1.3442 * poisson**2) / (1.0 - poisson)
    b = (0.6387 - 1.0277 * poisson + 1.5164 * poisson**2) / (1.0 - poisson)
    return (
        -2.0 * a / np.pi,
        4.0 * a**2 / np.pi**2,
        -8.0 / np.pi**3 * (a**3 + 4.0 * np.pi**2 / 15.0 * b),
        16.0 * a / np.pi**4 * (a**3 + 3.0 * np.pi**2 / 5.0 * b),
    )


def tangent_point(series) -> tuple[float, float]:
    """chi of the inflection of the quartic, and the slope there."""
    c1, c2, c3, c4 = series
    chi = (-3.0 * c3 - np.sqrt(9.0 * c3**2 - 24.0 * c2 * c4)) / (12.0 * c4)
    return chi, c1 + chi * (2.0 * c2 + chi * (3.0 * c3 + chi * 4.0 * c4))


def layer_factor(delta, c1, c2, c3, c4, slope, limit):
    """Force over Hertz force: a quartic in sqrt(delta) up to `limit`, then a straight line."""
    r = root(delta)
    beyond = positive(r - limit)
    x = r - beyond
    return 1.0 + x * (c1 + x * (c2 + x * (c3 + x * c4))) + slope * beyond


TERM = Term("bonded-layer", "factor", layer_factor, 6)


def coefficients(chain, stiffness, mass, thickness):
    """The series in powers of sqrt(delta): chi = width × sqrt(delta), width = sqrt(R*)/h."""
    width = np.sqrt(chain.reduced_radii(len(stiffness))) / thickness
    series = layer_series(chain.first.surface.poisson)
    chi, slope = tangent_point(series)
    with np.errstate(divide="ignore"):
        limit = chi / width
    return [*(c * width ** (k + 1) for k, c in enumerate(series)), slope * width, limit]


def change(setup: Setup, layer_thickness_um) -> Setup:
    """Multiply the elastic force of all contacts by the layer's factor."""
    return add_term(setup, TERM, coefficients, thickness=np.multiply(layer_thickness_um, MICRO))


EFFECT = Effect(
    id="coating-thickness",
    title="Thin bonded coating",
    missing="the contact radius is not small against a soft bonded layer on a hard core; the contact "
    "stiffens with load",
    equation="F = F_Hertz g(chi), chi = sqrt(R* delta)/h, g = 1 + c1 chi + c2 chi^2 + c3 chi^3 + c4 "
    "chi^4 up to its inflection, then its tangent; c1..c4 from the layer's nu",
    energy="stores the integral of F over delta per contact",
    reference="Dimitriadis et al., Biophys. J. 82, 2798 (2002), Eqs. 12-13; limits: Johnson, Contact "
    "Mechanics (1985), Sec. 5.8; Perriot & Barthel, J. Mater. Res. 19, 600 (2004). Chosen "
    "here: the tangent beyond the inflection",
    parameters=(
        Parameter(
            "layer_thickness_um",
            "um",
            float("inf"),
            3.0,
            3000.0,
            "log-uniform",
            100.0,
            "layer on a rigid core",
            1e-3,
        ),
    ),
    signature="speed rises faster than F^{1/6}, up to F^{1/4}; pulses narrower and earlier for strong "
    "strikers, nominal for weak ones",
    when_to_use="coated beads whose contact radius sqrt(R* delta) is a third of the coating or more",
    when_not="solid beads; stiffening that does not depend on load: dynamic-modulus",
    dissipative=False,
    change=change,
)
