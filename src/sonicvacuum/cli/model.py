"""A card with a model of `discover` put into it, for the option --model of several verbs."""

from sonicvacuum.card import Card
from sonicvacuum.discover.compare import read_model
from sonicvacuum.discover.extended import extended
from sonicvacuum.effects import Catalogue


def with_model(card: Card, path, known: Catalogue, wanted=None) -> Card:
    """The card with the model in a file put into it, whose effects the catalogue `known` holds."""
    return extended(card, read_model(path, known), wanted, known)
