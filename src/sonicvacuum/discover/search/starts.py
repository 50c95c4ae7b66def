"""Where fits of one effect begin: as far as the screen promises, at trials of finite strength, and far from
the data all over its range.
"""

import numpy as np

from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import secants
from sonicvacuum.discover.search.screen import Screen
from sonicvacuum.effects import Effect, Setup

# Below this largest z² nothing can be named, and slopes suffice.
CLEAR = 9.0
PLACES_TRIED = 5
# Beads that the nominal model makes lighter or heavier than stated: so many, by so many standard errors.
STRAYS, STRAYED = 2, 3.0


def setup_of(forward: Forward) -> Setup:
    """The nominal setup of the first batch, which knows places and off values."""
    return forward.nominal(forward.experiment.batches[0], np.zeros((1, forward.layout.size)))


def starts_of(forward, null: Fit, scores: Screen, effect: Effect, free, grid: bool, finite=None):
    """Coordinates (L, p), places (L, 1) or None and nuisances (L, q) from which one effect is fitted.

    `finite` are trials of finite strength, searched where not given.
    """
    rows = _from_screen(scores, effect, free)
    if finite is None and _tried(effect, free) and float(np.square(scores.z).max()) > CLEAR:
        finite = secants.search(forward, null, effect, setup_of(forward))
    names = tuple(c.parameter.name for c in free)
    rows += [(list(one.u), one.place, one.nu) for one in finite or () if one.free == names]
    if len(free) == 1 and free[0].parameter.scatters:
        rows += [([free[0].inverse(ratio)], bead, nu) for ratio, bead, nu in strayed(forward, null)]
    if grid:
        nuisances = wide.minima(forward, null)
        rows += [(*row, nu) for row in _grid(scores, effect, free) for nu in nuisances]
    u = within(free, [r[0] for r in rows])
    places = np.array([[r[1] or 0] for r in rows]) if effect.places else None
    return u, places, np.array([r[2] for r in rows]).reshape(len(rows), forward.layout.size)


def strayed(forward: Forward, null: Fit) -> list[tuple[float, int, np.ndarray]]:
    """Beads that the nominal model has to make lighter or heavier than stated: the mass of each over that,
    its number, and the (q,) nuisances without it. That one bead is so may be no misfit any more.
    """
    layout = forward.layout
    at = np.array(layout.scattered, dtype=int)
    if not len(at):
        return []
    weights = np.array([layout.others[k - layout.modulus - 1].weights for k in at])
    score = null.nu[at] @ weights
    rows = []
    for bead in np.argsort(-np.abs(score), kind="stable")[:STRAYS]:
        if abs(score[bead]) > STRAYED:
            nu = null.nu.copy()
            nu[at] -= weights[:, bead] * score[bead]
            # Of one bead's mass a part is what all have in common, which no direction has.
            nu[layout.other("bead-mass")] -= score[bead] / weights.shape[1]
            ratio = float(np.exp(score[bead] * forward.nuisance_sigma[at[0]]))
            rows.append((ratio, int(bead) + 1, nu))
    return rows


def within(free, rows) -> np.ndarray:
    """(L, p) coordinates, moved to within their bounds."""
    low, high = (np.array([getattr(c, side) for c in free]) for side in ("low", "high"))
    return np.reshape(rows, (len(rows), len(free))).astype(float).clip(low + 1e-9, high - 1e-9)


def kept(effect: Effect, free, grid: bool) -> int:
    """How many starts are followed: all of the striker's mass, which nuisances hide at first."""
    if _tried(effect, free) and not secants.local(effect):
        return 8
    return 5 if grid else 3


def _tried(effect, free):
    """Whether trials of finite strength are starts of this set of parameters."""
    return len(free) == 1 and (effect.places in secants.PLACES or free[0].parameter.tried_at_once)


def along(scores: Screen, effect: Effect, free) -> list[int]:
    """Places in the screen of an effect's directions along some of its strengths, the most telling first."""
    strengths = [c.parameter.name for c in free if c.parameter.switches]
    at = [k for k, d in enumerate(scores.directions) if d.effect == effect.id and d.strength in strengths]
    return sorted(at, key=lambda k: -abs(scores.z[k]))


def _from_screen(scores, effect, free):
    rows = []
    for k in along(scores, effect, free)[:PLACES_TRIED]:
        d = scores.directions[k]
        size = scores.strength[k] if scores.z[k] else 1.0 / max(scores.length[k], 1e-9)
        rows.append((coordinates(free, d, size), d.place, scores.moved(k)[1]))
    return rows


def coordinates(free, direction, size: float) -> list[float]:
    """Coordinates of an effect's parameters for a direction taken `size` typical deviations far."""
    shape = dict(direction.shape)
    return [_start(c, direction, shape, size) for c in free]


def _start(c, direction, shape, size):
    """Coordinate of one parameter for a direction taken `size` typical deviations far."""
    p = c.parameter
    if p.name in shape:
        return c.inverse(shape[p.name])
    if p.name != direction.strength:
        return 1e-3 if c.kind in ("ratio", "linear") else c.low
    if c.endless:
        return float(np.log(max(abs(size), 1e-12)))
    if p.acts_like == "modulus":
        # Its slope is that of the modulus as a nuisance, which is log-normal.
        return float(size * p.scale / c.unit)
    if c.kind == "ratio":
        # As far down as up: a straight line would soon meet a ratio of nothing.
        relative = size * p.scale / c.unit
        return float(np.copysign(np.log1p(abs(relative)), relative))
    return size if c.two_sided or c.high > 0.0 else -abs(size)


def _grid(scores, effect, free):
    """All strengths, coarse in whatever else is free, at all places."""
    axes = [c.starts() if k == 0 else c.starts()[1::4] for k, c in enumerate(free)]
    points = np.array(np.meshgrid(*axes, indexing="ij")).reshape(len(free), -1).T
    if not effect.places:
        return [(list(p), None) for p in points]
    places = dict.fromkeys(d.place for d in scores.directions if d.effect == effect.id)
    return [(list(p), place) for place in places for p in points[:: 2 if len(places) > 3 else 1]]
