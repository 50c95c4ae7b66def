"""Fits that end at a bound of the search: followed beyond it, as far as values have a meaning.

The bounds of the catalogue are those of beads and laboratory strikers. Data of another size may ask for more;
and what stands at a bound fits worse than it could, so that its rivals look surer than they are. The bound of
a strength towards off is none: there the effect is absent.
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.fit.refit import Fit, polish
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.parameters import Coordinate

# A bound is moved by this factor (logarithmic coordinates), or by the whole range (linear ones), so many
# times at most: from beads of some millimetres to balls of half a kilogramme, or to grains, damping constants
# and forces change by four decades.
FACTOR, TURNS = 10.0, 4
# In χ², less is no reason to leave the range.
WORTH = 0.5
_ROOM = 1e-6


def stuck(fit: Fit) -> np.ndarray:
    """(p,) whether a coordinate stands at a bound that is neither its off value nor the end of what it may
    mean.
    """
    return np.array(
        [
            (u >= c.high - _ROOM and c.high < _ends(c)[1] - 2.0 * _ROOM)
            or (u <= c.low + _ROOM and not _off_below(c) and c.low > _ends(c)[0] + 2.0 * _ROOM)
            for u, c in zip(fit.u, fit.hypothesis.coordinates, strict=True)
        ],
        dtype=bool,
    )


def held_back(fit: Fit) -> bool:
    """Whether a strength of an effect is stuck: the effect might do many times what it does there."""
    return any(
        s and c.parameter.switches for s, c in zip(stuck(fit), fit.hypothesis.coordinates, strict=True)
    )


def beyond(forward: Forward, fit: Fit) -> tuple[Fit, bool]:
    """The fit with the coordinates that are stuck let go, again and again while that gains, and whether one
    is stuck even so.

    The same fit where letting go gains nothing: there the bound holds nothing back.
    """
    found, held = fit, False
    for _ in range(TURNS):
        if not stuck(found).any():
            return found, False
        further = _further(forward, found)
        if not further.objective < found.objective - WORTH:
            return found, False
        found, held = further, bool(stuck(further).any())
    return found, held


def _further(forward: Forward, fit: Fit) -> Fit:
    """The fit with its stuck coordinates let go once."""
    at = stuck(fit)
    wider = iter([_wider(c) if s else c for c, s in zip(fit.hypothesis.coordinates, at, strict=True)])
    parts = tuple(replace(c, free=tuple(next(wider) for _ in c.free)) for c in fit.hypothesis.components)
    return polish(forward, Fit(Hypothesis(parts, fit.hypothesis.common), fit.normal, others=fit.others))


def _off_below(c: Coordinate) -> bool:
    """Whether the lower bound of a coordinate leads to off."""
    return (c.parameter.switches and c.endless) or (c.kind == "linear" and c.low == 0.0)


def _wider(c: Coordinate) -> Coordinate:
    """A coordinate with bounds further out, inside what the parameter may mean."""
    more = c.high - c.low if c.kind == "linear" else float(np.log(FACTOR))
    low, high = c.low if _off_below(c) else c.low - more, c.high + more
    least, most = _ends(c)
    return replace(c, low=max(low, least), high=min(high, most))


def _ends(c: Coordinate) -> tuple[float, float]:
    """Coordinates between which a parameter has a meaning, or which the record states."""
    if c.parameter.known:
        return c.low, c.high
    ends = [_place(c, value) for value in (c.parameter.least, c.parameter.most)]
    return min(ends), max(ends)


def _place(c, value):
    """The coordinate of a limit of meaning, infinite where there is none."""
    if not np.isfinite(value) or (c.kind != "linear" and value <= 0.0):
        below = value <= 0.0 or value == -np.inf
        return np.inf if below == (c.kind == "inverse") else -np.inf
    # A limit itself may be singular.
    return c.inverse(value) + (_ROOM if value == c.parameter.least else -_ROOM)
