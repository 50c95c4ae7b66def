"""What a contact on a layer touches: its radius and the pressure at its centre, by the law in force.

Hertz's contact of approach delta has the radius √(R* delta) and a central pressure of 3/2 of the mean. On a
layer it is wider, up to √2 times where the layer is thin and compressible, and wider yet where it is nearly
incompressible; the pressure is steeper. Both are read off the exact solution (`layered`), tabulated once for
each layer at the contacts' chi = √(R* delta)/t; beyond the table's ends Hertz of coating or core is close.
"""

from functools import lru_cache

import numpy as np

from sonicvacuum.physics.bodies import Body
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.layer_law import NAME
from sonicvacuum.physics.layered import Layer, solve

# Contact radii of the table, in thicknesses of the layer.
RADII = np.geomspace(1e-3, 30.0, 56)
HERTZ_CONCENTRATION = 1.5


def touched(chain: Chain, contact: int, depth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Radius in m of what a contact touches, and its central over its mean pressure, both (n, lanes).

    Args:
        chain: whose law is in force; elastic constants are those of its middle lane: 15 % of a modulus move
            the radius by 3e-3 at most where the layer is sixty times softer than its core.
        contact: its number.
        depth: (n, lanes) approach in m.
    """
    hertz = np.sqrt(chain.reduced_radii(contact + 1)[contact] * np.maximum(depth, 0.0))
    law = next((a for a in chain.actions if a.term.name == NAME), None)
    one, other = (chain.solids[k] for k in chain.touching(contact + 1)[:, contact])
    layer = law and _layer(one if chain.beads else chain.first, other)
    if not layer:
        return hertz, np.full_like(hertz, HERTZ_CONCENTRATION)
    wider, concentration = relative(layer, hertz / law.parameters["thickness"])
    return hertz * wider, concentration


def relative(layer: Layer, chi) -> tuple[np.ndarray, np.ndarray]:
    """At chi (any shape) the radius over √(R* delta), and the central over the mean pressure."""
    (least, most), tables = _table(layer)
    at = np.log(np.clip(np.asarray(chi, dtype=float), least, most))
    return tuple(table(at) for table in tables)


def _layer(one: Body, other: Body) -> Layer | None:
    """The layer between two bodies of which one is coated, or both alike; None where neither is."""
    coated, facing = (other, one) if other.core else (one, other)
    if coated.core is None:
        return None
    own, core = coated.surface, coated.core
    mirrored = facing is coated
    other_side = 0.0 if mirrored else _plane(own) / _plane(facing.surface)
    return Layer(own.poisson, _plane(own) / _plane(core), core.poisson, facing=other_side)


def _plane(elastic):
    """Plane-strain modulus of the middle lane in Pa."""
    return float(np.median(elastic.modulus)) / (1.0 - elastic.poisson**2)


@lru_cache(maxsize=64)
def _table(layer):
    """Ends of chi, and interpolations in its logarithm."""
    from scipy.interpolate import PchipInterpolator  # long to load

    exact = solve(layer, RADII)
    chi = exact.width
    columns = (RADII / chi, exact.concentration)
    return (chi[0], chi[-1]), tuple(PchipInterpolator(np.log(chi), column) for column in columns)
