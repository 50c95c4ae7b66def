"""The contact material is stiffer (or softer) at impact rates than its handbook modulus says.

Beads of several materials have as many that may be so: the effect sits in one of them then.
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.effects.base import Effect, Parameter, Setup
from sonicvacuum.effects.whereabouts import materials, materials_of


def change(setup: Setup, modulus_ratio, material=0) -> Setup:
    """Scale the modulus of every body that is made of one contact material of the beads."""
    chain, names = setup.chain, materials_of(setup.chain)
    if np.ndim(material) == 0:
        return replace(setup, chain=chain.stiffened(names[int(material)], modulus_ratio))
    for k in np.unique(material):
        chain = chain.stiffened(names[k], np.where(np.asarray(material) == k, modulus_ratio, 1.0))
    return replace(setup, chain=chain)


EFFECT = Effect(
    id="dynamic-modulus",
    title="Dynamic modulus",
    missing="the beads' contact material is stiffer (softer) at impact rates than the handbook says",
    equation="E -> s E in every contact of that material",
    energy="stores (2/5) s K delta^{5/2} per contact",
    reference="Daraio & Nesterenko, Phys. Rev. E 73, 026612 (2006), Experiments; Nesterenko, Dynamics of "
    "Heterogeneous Materials (Springer, 2001), ch. 1",
    parameters=(
        Parameter(
            "modulus_ratio",
            "1",
            1.0,
            0.1,
            30.0,
            "log-uniform",
            0.5,
            "modulus over handbook value",
            1e-6,
            acts_like="modulus",
        ),
    ),
    of_several="material",
    choices=materials,
    signature="speed as s^{1/3} at given force, forces as s^{2/5} at given striker; no decay, 1/6 "
    "power law kept",
    when_to_use="polymers and coatings loaded at 10^2 to 10^3 per second against moduli from slow tests",
    when_not="metals and ceramics; where speed depends on force otherwise than F^{1/6} see "
    "contact-exponent, coating-thickness, relaxing-contact",
    dissipative=False,
    change=change,
    of_material=True,
)
