"""The model that `discover` made of a record, put into the cases of the reproduction.

A case of the same chain takes the whole model. Another chain of the same material takes the modulus and what
happens in its contacts; what belongs to that record's chain, gauges and striker stays there.
"""

import math

from msgspec.structs import replace

from sonicvacuum.card import Card, ModelBlock
from sonicvacuum.discover.verdict import Model
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.effects.whereabouts import materials_of


def extended(
    card: Card, model: Model, wanted: ModelBlock | None = None, catalogue: Catalogue = CATALOGUE
) -> Card:
    """The card with the model's effects and with its modulus of the beads' contact material.

    A dynamic modulus becomes the modulus of the card's material, which is all that the effect is: theory and
    audit of the assumptions, which know no effects, then speak of the same material.

    Args:
        card: of the nominal model.
        model: as `sonicvacuum.discover.compare.read_model` gives it.
        wanted: what to take of it; by default all.
        catalogue: knows the effects.
    """
    wanted = wanted or ModelBlock(record="any")
    first, beads = card.bead.surface.name, materials_of(card.specimen)
    effects, ratios = dict(card.effects), {first: model.modulus_ratio}
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
            given = effects[name]
            material = given.get(one.sits, first)
            if material not in (first, *beads) and wanted.specimen != "other":
                continue  # a number, or refused where the card is set up
            del effects[name]
            ratio = math.prod(given.get(p.name, 1.0) for p in one.parameters)
            ratios[material] = ratios.get(material, 1.0) * ratio
    for material, ratio in ratios.items():
        card = card.stiffened(material, ratio)
    return replace(card, effects=effects)


def _places_whole(one, parameters):
    """Places as whole numbers, or names; values that JSON cannot hold are left out, and so are off."""
    kept = {key: v for key, v in parameters.items() if isinstance(v, str) or math.isfinite(v)}
    whole = {key for key, v in kept.items() if key == one.sits and not isinstance(v, str)}
    return {key: int(value) if key in whole else value for key, value in kept.items()}
