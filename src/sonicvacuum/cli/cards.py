"""Cards as files: what the verbs that take one read it with."""

from typing import TYPE_CHECKING

import msgspec

from sonicvacuum.files import InputError, check_values, read_text
from sonicvacuum.schema_errors import explain

if TYPE_CHECKING:
    from sonicvacuum.card import Card


def read_card(path) -> "Card":
    """The card in a JSON file; InputError where it is not one."""
    # Here: a verb that only explains itself does not wait for numpy.
    from sonicvacuum.card import Card, check, load
    from sonicvacuum.laboratory.ranges import LaboratoryError

    text = read_text(path).encode()
    try:
        found = load(text)
        check_values(_plain(text), path)
        check(found)
        return found
    except msgspec.ValidationError as error:
        raise InputError(explain(error, _plain(text), path, kind=Card)) from None
    except LaboratoryError as error:
        raise InputError(f"{path}: {error}") from None
    except msgspec.DecodeError as error:
        raise InputError(f"{path}: not a card ({error}); write one with: sonicvacuum card --out") from None


def _plain(text):
    """What the text says as far as it can be read at all: the fault may stand before worse ones."""
    try:
        return msgspec.json.decode(text)
    except (msgspec.DecodeError, RecursionError):
        return None
