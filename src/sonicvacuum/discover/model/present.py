"""Effects that a record says act (`priors: {…: present}`): part of the nominal model, and so of every
explanation, with the values that the record states. What of them is open is a nuisance (`nuisances`).
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace

from sonicvacuum.discover.model.experiment import Batch
from sonicvacuum.effects import Catalogue
from sonicvacuum.effects.base import Setup
from sonicvacuum.files import InputError
from sonicvacuum.records.record import Record


def stated(record: Record, chain, catalogue: Catalogue) -> dict[str, dict[str, float]]:
    """Id → parameter → value of the effects that a record says are present.

    Args:
        record: whose priors name them.
        chain: its nominal chains, without these effects.
        catalogue: holds what the record states of their parameters (`Catalogue.informed`).

    Raises:
        InputError: for an effect that cannot act in this chain, or of which the record states no values.
    """
    found = {}
    for name in record.present:
        effect = catalogue.effect(name)
        why = effect.why_not(Setup(chain, record.gauges))
        unknown = [p.name for p in effect.parameters if p.known is None]
        if why or unknown:
            reason = why or f"the record does not say how well {', '.join(unknown)} is known"
            cure = "; give coating_um and tolerances.coating_rel" if effect.stated else ""
            raise InputError(f"{record.name}: priors.{name}: cannot be present: {reason}{cure}")
        found[name] = {p.name: p.known[0] for p in effect.parameters}
    return found


def acting(parts: Iterable[Batch], given: Mapping[str, Mapping[str, float]], catalogue: Catalogue):
    """The batches with these effects in their nominal chains."""
    for name, values in given.items():
        effect = catalogue.effect(name)
        parts = [replace(b, chain=effect.apply(Setup(b.chain), **values).chain) for b in parts]
    return tuple(parts)
