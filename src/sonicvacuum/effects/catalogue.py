"""A catalogue: effects in a fixed order, each found by its id.

Catalogues are values: a longer one is made from a shorter one and handed to what uses it, so that two records
of one process never share what was added for one of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from sonicvacuum.effects.sized import ratios_of, sized
from sonicvacuum.schema_errors import likely

if TYPE_CHECKING:
    from sonicvacuum.effects.base import Effect, Setup

# Verdicts that are no effects.
VERDICTS = ("none", "unknown")


@dataclass(frozen=True)
class Catalogue:
    """Effects that a model may lack; their order is the order of reports and of ties.

    `besides` are effects that a model may hold and no search tries: they are found by id alone.
    """

    effects: tuple[Effect, ...] = ()
    besides: tuple[Effect, ...] = ()

    def __iter__(self) -> Iterator[Effect]:
        return iter(self.effects)

    def __len__(self) -> int:
        return len(self.effects)

    def __contains__(self, id: str) -> bool:
        return any(e.id == id for e in (*self.effects, *self.besides))

    @property
    def ids(self) -> tuple[str, ...]:
        """Ids in order."""
        return tuple(e.id for e in self.effects)

    def meant(self, id: str, own: bool = True) -> str:
        """What somebody may mean who writes an unknown id, in words: the nearest, or any of all; `own`: or
        one of his own, where these are taken.
        """
        known = f"the catalogue holds {', '.join(self.ids)}"
        file = "; an effect of your own needs its file, --effects FILE" if own else ""
        return likely(id, self.ids) or known + file

    def effect(self, id: str) -> Effect:
        """The effect of that id.

        Raises:
            ValueError: for an id that the catalogue does not hold; the message says which may be meant.
        """
        for one in (*self.effects, *self.besides):
            if one.id == id:
                return one
        raise ValueError(f"no effect is called {id!r}; {self.meant(id)}")

    def extended(self, more: Iterable[Effect]) -> Catalogue:
        """A catalogue with further effects behind these.

        Raises:
            ValueError: where an id is taken, by an effect or by a verdict.
        """
        result = self.effects
        for one in more:
            if one.id in (*VERDICTS, *(e.id for e in (*result, *self.besides))):
                raise ValueError(f"the id {one.id!r} is taken; give your effect another id")
            result = (*result, one)
        return Catalogue(result, self.besides)

    def informed(self, chain, tolerances) -> Catalogue:
        """The catalogue with ranges that suit a record's chains (`sized`), what it states of the effects'
        parameters (`Effect.stated`), and places where these chains leave effects a choice (`Effect.located`).
        """
        ratios = ratios_of(chain)
        own = (sized(e, ratios).informed(chain, tolerances).located(chain) for e in self.effects)
        return Catalogue(tuple(own), self.besides)

    def held(self, ids: Iterable[str]) -> Catalogue:
        """The catalogue of a model that holds some effects already: no search tries them."""
        held = tuple(self.effect(id) for id in ids)
        left = tuple(e for e in self.effects if e not in held)
        return Catalogue(left, (*self.besides, *held)) if held else self

    def candidates(self, setup: Setup, without: Iterable[str] = ()) -> tuple[Effect, ...]:
        """The effects that can act in a setup, but for the ids `without`."""
        left = set(without)
        return tuple(e for e in self.effects if e.id not in left and e.why_not(setup) is None)

    def left_out(self, setup: Setup) -> dict[str, str]:
        """Id → why, of the effects that cannot act in a setup."""
        return {e.id: why for e in self.effects if (why := e.why_not(setup)) is not None}


EMPTY = Catalogue()
