"""Fits that end at a bound of the search: followed beyond it, as far as values have a meaning.

The bounds of the catalogue are those of beads and laboratory strikers. Data of another size may ask for more;
and what stands at a bound fits worse than it could, so that its rivals look surer than they are. The bound of
a strength towards off is none: there the effect is absent. Nor does one hold anything back below which a
contact forgets so soon that sooner makes no difference, and takes long to simulate.
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.fit.refit import Fit, polish
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.parameters import Coordinate
from sonicvacuum.physics.scales import impact_scales

# A bound is moved by this factor (logarithmic coordinates), or by the whole range (linear ones), so many
# times at most: from beads of some millimetres to balls of half a kilogramme, or to grains, damping constants
# and forces change by four decades.
FACTOR, TURNS = 10.0, 4
# A time that only shapes an effect of contacts is as good as none from this share of the impact on: what
# a relaxing contact does then differs by a hundredth from the dashpot that it tends to.
FAST = 1.0 / 300.0
# In χ², less is no reason to leave the range.
WORTH = 0.5
_ROOM = 1e-6
# A turn that takes away less than this share of what is still to go is not taken to its end, and is the last
# one: were the others worth as much, most of it would remain, and laws far beyond their ranges take long to
# simulate. So many steps of it tell.
STILL, BEGUN = 0.1, 5
# Part of a range within which a bound is near, at most.
CLOSE = 0.05


def stuck(fit: Fit, soon: float = 0.0) -> np.ndarray:
    """(p,) whether a coordinate stands at a bound that is neither its off value nor the end of what it may
    mean; `soon`: times of contacts in us are as good as none from there on.
    """

    def held(u, c):
        least, most = _ends(c, soon)
        above = u >= c.high - _ROOM and c.high < most - 2.0 * _ROOM
        return above or (u <= c.low + _ROOM and not _off_below(c) and c.low > least + 2.0 * _ROOM)

    return np.array([held(u, c) for u, c in zip(fit.u, fit.hypothesis.coordinates, strict=True)], dtype=bool)


def near(fit: Fit) -> np.ndarray:
    """(p,) whether a bound that does not lead to off lies within a standard error of a coordinate, or, where
    it is hardly known, within a small part of its range.
    """

    def ends(u, error, c):
        room = min(error, CLOSE * (c.high - c.low))
        return u + room >= c.high or (u - room <= c.low and not _off_below(c))

    every = zip(fit.u, fit.sigma, fit.hypothesis.coordinates, strict=True)
    return np.array([ends(*one) for one in every], dtype=bool)


def held_back(fit: Fit) -> bool:
    """Whether a strength of an effect is stuck: the effect might do many times what it does there."""
    return any(
        s and c.parameter.switches for s, c in zip(stuck(fit), fit.hypothesis.coordinates, strict=True)
    )


def beyond(forward: Forward, fit: Fit, lowest: float = np.inf) -> tuple[Fit, bool]:
    """The fit with the coordinates that are stuck let go, again and again while that gains, and whether one
    is stuck even so.

    The same fit where letting go gains nothing: there the bound holds nothing back. `lowest` is the objective
    of the best explanation so far: what has far to go to it, and hardly comes nearer, is let go no further.
    """
    found, held = fit, False
    if not stuck(fit).any():
        return fit, False
    soon = FAST * 1e6 * min(impact_scales(batch.chain)[1] for batch in forward.experiment.batches)
    for _ in range(TURNS):
        if not stuck(found, soon).any():
            return found, False
        freed = _freed(found, soon)
        begun = polish(forward, freed, BEGUN, finish=False)
        nearer, to_go = found.objective - begun.objective, begun.objective - lowest
        if not nearer > WORTH or nearer < STILL * to_go:
            return found, nearer > WORTH
        further = polish(forward, freed)
        if not further.objective < found.objective - WORTH:
            return found, False
        nearer, to_go = found.objective - further.objective, further.objective - lowest
        found, held = further, bool(stuck(further, soon).any())
        if nearer < STILL * to_go:
            break
    return found, held


def _freed(fit: Fit, soon: float) -> Fit:
    """The fit with wider bounds of its stuck coordinates."""
    at = stuck(fit, soon)
    wider = iter([_wider(c, soon) if s else c for c, s in zip(fit.hypothesis.coordinates, at, strict=True)])
    parts = tuple(replace(c, free=tuple(next(wider) for _ in c.free)) for c in fit.hypothesis.components)
    return Fit(Hypothesis(parts), fit.normal, others=fit.others)


def _off_below(c: Coordinate) -> bool:
    """Whether the lower bound of a coordinate leads to off."""
    return (c.parameter.switches and c.endless) or (c.kind == "linear" and c.low == 0.0)


def _wider(c: Coordinate, soon: float = 0.0) -> Coordinate:
    """A coordinate with bounds further out, inside what the parameter may mean."""
    more = c.high - c.low if c.kind == "linear" else float(np.log(FACTOR))
    low, high = c.low if _off_below(c) else c.low - more, c.high + more
    least, most = _ends(c, soon)
    return replace(c, low=max(low, least), high=min(high, most))


def _ends(c: Coordinate, soon: float) -> tuple[float, float]:
    """Coordinates between which a parameter has a meaning, or which the record states."""
    own = c.parameter
    if own.known:
        return c.low, c.high
    ends = [_place(c, value) for value in own.limits]
    if soon and own.unit == "us" and not own.switches and not own.electronic:
        ends[0] = max(ends[0], min(c.low, c.inverse(soon)))
    return min(ends), max(ends)


def _place(c, value):
    """The coordinate of a limit of meaning, infinite where there is none."""
    if not np.isfinite(value) or (c.kind != "linear" and value <= 0.0):
        below = value <= 0.0 or value == -np.inf
        return np.inf if below == (c.kind == "inverse") else -np.inf
    # A limit itself may be singular, and is not passed: the least value is the largest of some coordinates.
    upwards = (value == c.parameter.limits[0]) != (c.kind == "inverse")
    return c.inverse(value) + (_ROOM if upwards else -_ROOM)
