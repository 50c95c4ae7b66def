"""Cards as files: what the verbs that take one read it with."""

import json

import msgspec

from sonicvacuum.card import Card, load
from sonicvacuum.files import InputError, explain


def read_card(path) -> Card:
    """The card in a JSON file; InputError where it is not one."""
    with open(path, "rb") as stream:
        text = stream.read()
    try:
        return load(text)
    except msgspec.ValidationError as error:
        raise InputError(explain(error, json.loads(text), path, kind=Card)) from None
    except msgspec.DecodeError as error:
        raise InputError(f"{path}: not a card ({error}); write one with: sonicvacuum card --out") from None
