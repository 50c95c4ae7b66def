"""What was worked out at the points that were asked for last: several tests look at the same fitted model."""

from collections import OrderedDict
from collections.abc import Callable, Hashable

from sonicvacuum.discover.model.hypothesis import Hypothesis

POINTS = 4


class Memory:
    """Results at the last few points: hypothesis, coordinates and nuisances.

    Results are shared, and must not be changed by those who get them.
    """

    def __init__(self, points: int = POINTS):
        self._points: OrderedDict[Hashable, dict] = OrderedDict()
        self._most = points

    def recalled(self, hypothesis: Hypothesis, u, nu, what: Hashable, work: Callable):
        """The result of `work()` at (p,) coordinates and (q,) nuisances, which goes by the name `what`."""
        point = (hypothesis.key, u.tobytes(), nu.tobytes())
        found = self._points.setdefault(point, {})
        self._points.move_to_end(point)
        if len(self._points) > self._most:
            self._points.popitem(last=False)
        if what not in found:
            found[what] = work()
        return found[what]
