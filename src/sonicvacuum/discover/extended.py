"""The model that `discover` made of a record, put into the cases of the reproduction.

A case of the same chain takes the whole model. Another chain of the same material takes the modulus and what
happens in its contacts; what belongs to that record's chain, gauges and striker stays there.
"""

import math

from msgspec.structs import replace

from sonicvacuum.card import Card, ModelBlock
from sonicvacuum.discover.verdict import Model
from sonicvacuum.effects import effect

# Effects of the contact material, which a bead of another size has too.
OF_MATERIAL = (
    "dynamic-modulus",
    "contact-exponent",
    "coating-thickness",
    "plastic-contact",
    "linear-dashpot",
    "kuwabara-kono",
    "tsuji",
    "hunt-crossley",
    "velocity-power",
    "relaxing-contact",
)


def extended(card: Card, model: Model, wanted: ModelBlock | None = None) -> Card:
    """The card with the model's effects and with its modulus of the beads' contact material.

    A dynamic modulus becomes the card's modulus, which is all that the effect is: theory and audit of the
    assumptions, which know no effects, then speak of the same material.

    Args:
        card: of the nominal model.
        model: as `sonicvacuum.discover.compare.read_model` gives it.
        wanted: what to take of it; by default all.
    """
    wanted = wanted or ModelBlock(record="any")
    effects = dict(card.effects)
    for name, parameters in model.effects.items():
        if wanted.specimen == "other" and name not in OF_MATERIAL:
            continue
        if wanted.losses == "left-out" and effect(name).dissipative:
            continue
        effects[name] = _places_whole(name, parameters)
    ratio = model.modulus_ratio * effects.pop("dynamic-modulus", {}).get("modulus_ratio", 1.0)
    return replace(card, effects=effects).stiffened(card.bead.surface.name, ratio)


def _places_whole(name, parameters):
    """Places as whole numbers; values that JSON cannot hold are left out, and so are off."""
    place = effect(name).places
    kept = {key: value for key, value in parameters.items() if math.isfinite(value)}
    return {key: int(value) if key == place else value for key, value in kept.items()}
