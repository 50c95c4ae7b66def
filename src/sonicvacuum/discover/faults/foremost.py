"""Which of many slips of a table's values are worth a look: those that explain most with all else held.

There are as many values by themselves as a table has, and as many exchanges as it has pairs of rows: in sixty
runs thousands, each of which would take a solution of the whole system. What they gain with the model held is
two numbers apart, and tells the few that may be right from all others.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.judged import Model

Item = TypeVar("Item")
# Place of a value: its run, and where it stands there.
Place = tuple[int, int]


@dataclass(frozen=True)
class Held:
    """A table beside a model that is held, at its fit and where all is as stated.

    Attributes:
        place: place of a value → where it stands in the arrays.
        value, error: (n,) measured values and their standard errors in SI.
        expected: (2, n) what the model has for them, at the fit and as stated.
    """

    place: dict[Place, int]
    value: np.ndarray
    error: np.ndarray
    expected: np.ndarray

    def alone(self, places: Sequence[Place]) -> np.ndarray:
        """(2, m) Δχ² of each of some values, were it none."""
        at = np.array([self.place[p] for p in places], dtype=int)
        return self._squares(at, at)

    def exchanged(self, pairs: Sequence[tuple[Place, Place]]) -> np.ndarray:
        """(2, m) Δχ² of each of some pairs of values with their errors, were each in the other's place."""
        a, b = (np.array([self.place[pair[side]] for pair in pairs], dtype=int) for side in (0, 1))
        return sum(self._squares(x, x) - self._squares(x, y) for x, y in ((a, b), (b, a)))

    def _squares(self, here, there):
        """(2, m) squares of what values leave, with their errors, in places that may be others' own."""
        return np.square((self.value[there] - self.expected[:, here]) / self.error[there])


def held(places: Sequence[Place], model: Model, stated: Sequence[np.ndarray]) -> Held:
    """Some values of a table beside a model; `stated` are its (1, ..., M) columns of every run with all as
    stated, predictions first.
    """
    one, runs = model.fit, model.forward.experiment.runs
    fitted = model.forward.sampled(one.hypothesis, one.u[None], one.nu[None])
    scalars = [runs[k].scalars[j] for k, j in places]
    error = np.array([s.sigma for s in scalars])
    whitened = [(float(fitted[k][0, j]), float(stated[k][0, 0, j])) for k, j in places]
    return Held(
        {place: n for n, place in enumerate(places)},
        np.array([s.value for s in scalars]),
        error,
        np.array(whitened).reshape(-1, 2).T * error,
    )


def foremost(items: Sequence[Item], gains: np.ndarray) -> list[Item]:
    """Those of some items, in their order, that gain most: all of a few, else at most `policy.LOOKED_AT`.

    Args:
        items: what is chosen from.
        gains: (2, m) what each gains at the fit and as stated: what is fitted follows a slip, and what is
            stated is far from the data where an effect acts, so that the first of both are taken.
    """
    if len(items) <= policy.LOOKED_AT:
        return list(items)
    first = np.argsort(-gains, axis=1, kind="stable")[:, : policy.LOOKED_AT // 2]
    return [items[n] for n in sorted(set(first.ravel().tolist()))]
