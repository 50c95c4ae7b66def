"""Where effects sit that sit somewhere: what places are called, and which materials a chain's beads have.

Beads and contacts are numbers of the chain. Gauges and materials are counted from 0, and have names.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from sonicvacuum.numerals import number_cure

if TYPE_CHECKING:
    from sonicvacuum.effects.base import Setup
    from sonicvacuum.physics.chain import Chain


def materials_of(chain: Chain) -> tuple[str, ...]:
    """Contact materials of the beads, each once, the first bead's first; of one ball on a wall its own."""
    kinds = chain.bodies.kinds
    used = sorted(chain.bodies.counts(1, chain.beads))
    return tuple(dict.fromkeys([chain.first.surface.name, *(kinds[k].surface.name for k in used)]))


def materials(setup: Setup) -> tuple[int, ...]:
    """Places of effects of one material: numbers of `materials_of`, from 0."""
    return tuple(range(len(materials_of(setup.chain))))


_NAMES = {
    "sensor": lambda setup: [sensor.id for sensor in setup.sensors],
    "material": lambda setup: materials_of(setup.chain),
}


def names(kind: str | None, setup: Setup) -> Sequence[str]:
    """Names of all places of a kind in their order; none of beads and contacts, which are counted."""
    return _NAMES[kind](setup) if kind in _NAMES else ()


def place(kind: str, given, possible: Sequence[int], setup: Setup):
    """The number of a place that is given by its name, or numbers (lanes,) as they are.

    Raises:
        ValueError: for one that is not possible, or a name where places have none; the message lists those
            that there are.
    """
    number, known = given, names(kind, setup)
    if isinstance(given, str):
        if kind not in _NAMES:
            raise ValueError(f"{kind} is {given!r}, not a number{number_cure(given)}")
        number = known.index(given) if given in known else -1
    if not np.all(np.isin(number, possible)):
        told = [known[k] for k in possible] if known else possible
        raise ValueError(f"{kind} is {given}; possible here: {', '.join(map(str, told)) or 'none'}")
    return number
