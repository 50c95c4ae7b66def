"""From what stands in the laboratory to the chains that the stepper integrates: one lane for each striker."""

import math
from collections.abc import Sequence

import numpy as np

from sonicvacuum.laboratory.specimen import Bead, Material, Specimen, Striker
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain


def assemble(specimen: Specimen, strikers: Sequence[Striker]) -> Chain:
    """The nominal chains, without effects; lane k is struck by `strikers[k]`.

    Raises:
        ValueError: for strikers that differ in shape, size or material: a batch has one of each.
    """
    alike = {(s.radius_m, s.surface) for s in strikers}
    if len(alike) != 1:
        raise ValueError(f"{len(alike)} kinds of strikers; chains of one batch are struck by one kind")
    radius, surface = alike.pop()
    return Chain(
        beads=specimen.beads,
        bodies=specimen.bodies.replaced(_body),
        striker=_elastic(surface),
        wall=_elastic(specimen.wall),
        striker_radius=radius,
        striker_mass=np.array([s.mass_kg for s in strikers]),
        speed=np.array([s.speed_m_s for s in strikers]),
        gravity=specimen.gravity_m_s2,
        static_force=specimen.static_force_N,
    )


def _body(bead: Bead) -> Body:
    return Body(
        surface=_elastic(bead.surface),
        mass=bead.mass_kg,
        radius=bead.diameter_m / 2.0,
        flat=bead.flat,
        coating=math.inf if bead.coating_m is None else bead.coating_m,
        core=bead.core and _elastic(bead.core),
    )


def _elastic(material: Material) -> Elastic:
    return Elastic(material.name, material.modulus_Pa, material.poisson)
