"""Effects that a record says act (`priors: {…: present}`): part of the nominal model, and so of every
explanation, with the values that the record states. What of them is open is a nuisance (`nuisances`).
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from sonicvacuum.discover.model.experiment import Batch
from sonicvacuum.effects import Catalogue
from sonicvacuum.effects.base import Setup
from sonicvacuum.files import InputError
from sonicvacuum.records.assemble import chain_of
from sonicvacuum.records.blocks import PRESENT
from sonicvacuum.records.reader import FILE
from sonicvacuum.records.record import Record


def stated(record: Record, chain, catalogue: Catalogue) -> dict[str, dict[str, float]]:
    """Id → parameter → value of the effects that a record says are present.

    Args:
        record: whose priors name them, and have none of those that are `refused`.
        chain: its nominal chains, without these effects.
        catalogue: holds what the record states of their parameters (`Catalogue.informed`).

    Raises:
        InputError: for an effect that cannot act in this chain, or of which the record states no values.
    """
    for told in _impossible(record, chain, catalogue):
        raise InputError(f"{record.name}/{FILE}: {told}")
    return {name: {p.name: p.known[0] for p in catalogue.effect(name).parameters} for name in record.present}


def refused(record: Record, catalogue: Catalogue) -> Iterator[str]:
    """What is wrong with a record's priors, key, value and cure of each that the search refuses: an effect
    that the catalogue does not hold, or one that cannot be present.
    """
    unknown = list(_unknown(record, catalogue))
    yield from unknown
    if record.present and not unknown:
        chain = chain_of(record, record.runs[:1])
        yield from _impossible(record, chain, catalogue.informed(chain, record.tolerances))


def check_priors(record: Record, catalogue: Catalogue, path) -> None:
    """InputError for the first prior of a record, read from a path, that the search refuses."""
    file = Path(path) if Path(path).name == FILE else Path(path) / FILE
    for told in refused(record, catalogue):
        raise InputError(f"{file}: {told}")


def check_known(record: Record, catalogue: Catalogue) -> None:
    """InputError for the first prior of an effect that the catalogue does not hold."""
    for told in _unknown(record, catalogue):
        raise InputError(f"{record.name}/{FILE}: {told}")


def _unknown(record, catalogue):
    for name, odds in record.block.priors.items():
        if name not in catalogue:
            given = odds if isinstance(odds, str) else f"{odds:g}"
            yield f"priors.{name}: is {given}: no such effect; {catalogue.meant(name)}"


def _impossible(record, chain, catalogue):
    for name in record.present:
        effect = catalogue.effect(name)
        why = effect.why_not(Setup(chain, record.gauges))
        unknown = [p.name for p in effect.parameters if p.known is None]
        if why or unknown:
            reason = why or f"the record does not say how well {', '.join(unknown)} is known"
            cure = "give coating_um and tolerances.coating_rel" if effect.stated else "give odds, a number"
            yield f"priors.{name}: cannot be {PRESENT}: {reason}; {cure}"


def acting(parts: Iterable[Batch], given: Mapping[str, Mapping[str, float]], catalogue: Catalogue):
    """The batches with these effects in their nominal chains."""
    for name, values in given.items():
        effect = catalogue.effect(name)
        parts = [replace(b, chain=effect.apply(Setup(b.chain), **values).chain) for b in parts]
    return tuple(parts)
