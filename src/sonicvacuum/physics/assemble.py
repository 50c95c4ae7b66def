"""From a card to the chains that the stepper integrates: one lane for each impact speed."""

import math

import numpy as np

from sonicvacuum.card import Card, CardMaterial
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain


def assemble(card: Card, speeds=None) -> Chain:
    """The chains of a card, without effects; lane k is struck at `speeds[k]` in m/s, default the card's."""
    speeds = np.array(card.striker.speeds_m_s if speeds is None else speeds, dtype=float)
    radius = card.striker.radius_m
    return Chain(
        beads=card.beads,
        bodies=Body(
            surface=_elastic(card.bead.surface),
            mass=card.bead.mass_kg,
            radius=card.bead.diameter_m / 2.0,
            coating=math.inf if card.bead.coating_m is None else card.bead.coating_m,
        ),
        striker=_elastic(card.striker.surface),
        wall=_elastic(card.wall),
        striker_radius=math.inf if radius is None else radius,
        striker_mass=card.striker.mass_kg,
        speed=speeds,
        gravity=card.gravity_m_s2,
        static_force=card.static_force_N,
    )


def _elastic(material: CardMaterial) -> Elastic:
    return Elastic(material.name, material.modulus_Pa, material.poisson)
