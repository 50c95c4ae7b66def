"""What was worked out at the points that were asked for last: several tests look at the same fitted model."""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.model.hypothesis import Hypothesis

POINTS = 4
Known = list[tuple[Hashable, dict]]


class Memory:
    """Results at the last few points: hypothesis, coordinates and nuisances.

    Results are shared, and must not be changed by those who get them.
    """

    def __init__(self, points: int = POINTS):
        self._points: OrderedDict[Hashable, dict] = OrderedDict()
        self._most = points

    def copy(self) -> "Memory":
        """What is known so far, to which more may be added apart."""
        other = Memory(self._most)
        other._points.update((point, dict(found)) for point, found in self._points.items())
        return other

    def since(self, before: "Memory") -> Known:
        """The points asked for last, in their order, with what `before` does not know of them."""
        return [
            (point, {what: one for what, one in found.items() if what not in before._points.get(point, {})})
            for point, found in self._points.items()
        ]

    def add(self, learned: Known, before: "Memory") -> None:
        """Take over what another one, which began as `before`, has learned since."""
        for point, found in learned:
            known = {**before._points.get(point, {}), **self._points.get(point, {})}
            self._keep(point, {**found, **known})

    def recalled(self, hypothesis: Hypothesis, u, nu, what: Hashable, work: Callable):
        """The result of `work()` at (p,) coordinates and (q,) nuisances, which goes by the name `what`."""
        point = (hypothesis.key, u.tobytes(), nu.tobytes())
        found = self._keep(point, self._points.get(point, {}))
        if what not in found:
            found[what] = work()
        return found[what]

    def _keep(self, point, found):
        """The results at a point, which is now the last one that was asked for."""
        self._points[point] = found
        self._points.move_to_end(point)
        if len(self._points) > self._most:
            self._points.popitem(last=False)
        return found


@dataclass(frozen=True)
class Learned:
    """What a branch of a predictor brings back: what it counted, and what it came to know; see `Forward`."""

    simulations: int
    calls: int
    seconds: float
    strengths: dict[tuple, np.ndarray]
    memory: Known
    coarse: "Learned | None" = None
