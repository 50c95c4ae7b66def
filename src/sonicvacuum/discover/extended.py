"""The model that `discover` made of a record, put into the cases of the reproduction.

A case of the same chain takes the whole model. Another chain of the same material takes the modulus and what
happens in its contacts; what belongs to that record's chain, gauges and striker stays there.
"""

import math

from msgspec.structs import replace

from sonicvacuum.card import Card, ModelBlock
from sonicvacuum.discover.verdict import Model
from sonicvacuum.effects import CATALOGUE, Catalogue


def extended(
    card: Card, model: Model, wanted: ModelBlock | None = None, catalogue: Catalogue = CATALOGUE
) -> Card:
    """The card with the model's effects and with its modulus of the beads' contact material.

    A dynamic modulus becomes the card's modulus, which is all that the effect is: theory and audit of the
    assumptions, which know no effects, then speak of the same material.

    Args:
        card: of the nominal model.
        model: as `sonicvacuum.discover.compare.read_model` gives it.
        wanted: what to take of it; by default all.
        catalogue: knows the effects.
    """
    wanted = wanted or ModelBlock(record="any")
    effects, ratio = dict(card.effects), model.modulus_ratio
    for name, parameters in model.effects.items():
        one = catalogue.effect(name)
        if wanted.specimen == "other" and not one.of_material:
            continue
        if wanted.losses == "left-out" and one.dissipative:
            continue
        effects[name] = _places_whole(one, parameters)
    for name in list(effects):
        one = catalogue.effect(name)
        if all(p.acts_like == "modulus" for p in one.parameters):
            given = effects.pop(name)
            ratio *= math.prod(given.get(p.name, 1.0) for p in one.parameters)
    return replace(card, effects=effects).stiffened(card.bead.surface.name, ratio)


def _places_whole(one, parameters):
    """Places as whole numbers; values that JSON cannot hold are left out, and so are off."""
    kept = {key: value for key, value in parameters.items() if math.isfinite(value)}
    return {key: int(value) if key == one.places else value for key, value in kept.items()}
