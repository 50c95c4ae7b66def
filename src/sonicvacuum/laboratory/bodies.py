"""The beads of a chain one by one, without writing each one down: a pattern that repeats, and exceptions.

A uniform chain is a pattern of one, a dimer a pattern of two, a tapered or random chain a pattern as long as
the chain; an impurity or a heavier gauge body is an exception. Nothing here grows with the number of beads
but what is asked for.
"""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Bodies:
    """What stands at each bead; bead 1 is the one that the striker hits.

    Attributes:
        pattern: what stands at beads 1, 2, … and then again from the start.
        exceptions: bead → what stands there instead.

    Raises:
        ValueError: for an empty pattern, or an exception before bead 1.
    """

    pattern: tuple[Any, ...]
    exceptions: Mapping[int, Any] = field(default_factory=dict)

    def __post_init__(self):
        if not self.pattern:
            raise ValueError("pattern is empty; name at least one bead")
        if any(bead < 1 for bead in self.exceptions):
            raise ValueError(f"bead {min(self.exceptions)} does not exist; beads are counted from 1")

    @cached_property
    def kinds(self) -> tuple[Any, ...]:
        """The pattern, then the exceptions in the order of their beads."""
        return (*self.pattern, *(self.exceptions[b] for b in self._exceptional))

    @cached_property
    def _exceptional(self):
        """Bead → which of `kinds`, for the exceptions."""
        return {bead: len(self.pattern) + k for k, bead in enumerate(sorted(self.exceptions))}

    @property
    def uniform(self) -> bool:
        """Whether one kind is all there is."""
        return len(self.kinds) == 1

    def kind(self, bead: int) -> int:
        """Which of `kinds` stands at a bead."""
        return self._exceptional.get(bead, (bead - 1) % len(self.pattern))

    def kinds_of(self, beads: int) -> np.ndarray:
        """(beads,) which of `kinds` stands at each of the first beads."""
        kinds = np.arange(beads) % len(self.pattern)
        for bead, kind in self._exceptional.items():
            if bead <= beads:
                kinds[bead - 1] = kind
        return kinds

    def __getitem__(self, bead: int):
        """What stands at a bead."""
        return self.kinds[self.kind(bead)]

    def replaced(self, change: Callable) -> "Bodies":
        """The same order of change(one) for each kind."""
        return Bodies(tuple(map(change, self.pattern)), {b: change(e) for b, e in self.exceptions.items()})

    def counts(self, first: int, last: int) -> Counter:
        """Which of `kinds` → how many of the beads `first` to `last`, without counting them one by one."""
        found = Counter()
        if last < first:
            return found
        length = len(self.pattern)
        for k in range(min(length, last - first + 1)):
            found[(first - 1 + k) % length] = (last - first - k) // length + 1
        for bead, kind in self._exceptional.items():
            if first <= bead <= last:
                found[(bead - 1) % length] -= 1
                found[kind] += 1
        return +found

    def neighbours(self, beads: int) -> tuple[tuple[int, int], ...]:
        """Pairs of `kinds` that touch somewhere in a chain; a single bead counts as its own neighbour."""
        if beads < 2 or self.uniform:
            return ((self.kind(1), self.kind(1)),)
        length = len(self.pattern)
        starts = set(range(1, min(length, beads - 1) + 1))
        for bead in self._exceptional:
            # Beyond the exceptions' own contacts the pattern goes on, a whole period of it or to the end.
            starts.update(b for b in range(bead - 1, bead + length + 1) if 1 <= b < beads)
        return tuple(sorted({(self.kind(b), self.kind(b + 1)) for b in starts}))


def to_wall(diameters: Bodies | float, bead: int, beads: int) -> float:
    """Distance in m from a bead's centre to the wall: half of it and all of those behind.

    Args:
        diameters: m, of each bead or of all of them.
        bead: its number; 1 is the struck one.
        beads: number of beads.
    """
    if not isinstance(diameters, Bodies):
        diameters = Bodies((diameters,))
    counts = diameters.counts(bead + 1, beads)
    counts[diameters.kind(bead)] += 0.5
    return float(sum(n * diameters.kinds[kind] for kind, n in sorted(counts.items())))
