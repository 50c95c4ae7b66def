"""The last step of finding where an effect sits: from bead to bead, or contact to contact, while χ² falls.

A screen of slopes ranks places by what a small deviation would do. Behind the pulse contacts stand open, so
that a deviation large enough to be seen acts a little otherwise: the best place may be the next but one, with
another strength.
"""

import itertools

import numpy as np

from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.effects import Setup

# Places along the chain; a gauge is next to nothing.
ALONG = ("bead", "contact")
REACH = (-2, -1, 1, 2)
# Strengths tried there, over the fitted one: alike, or the other way round (a bead too heavy is much like the
# next one too light). Of each kind so many starts are followed, as the second look bad at first.
FACTORS = ((0.6, 1.0, 1.6), (-1.0,))
KEEP = 4
MOVES, ITERATIONS = 8, 6
# In χ², less is no reason to move.
WORTH = 0.5


def placed(one: Fit) -> bool:
    """Whether some effect of a fit sits somewhere along the chain."""
    return any(c.effect.places in ALONG for c in one.hypothesis.components)


def settled(forward: Forward, one: Fit, setup: Setup) -> Fit:
    """The fit with each of its effects at the best place that moves of up to two beads lead to.

    Args:
        forward: the predictor.
        one: a fit, followed to its minimum at its places.
        setup: which knows the places.
    """

    def followed(branch, starts):
        u, at = starts
        return fit(branch, one.hypothesis, u, one.nu[None], at, KEEP, ITERATIONS, reach=one.objective)

    for _ in range(MOVES):
        around = [_around(one, setup, factors) for factors in FACTORS]
        near = abreast.each(forward, followed, [starts for starts in around if len(starts[1])])
        best = min(near, key=lambda f: f.objective, default=None)
        if best is None or not best.objective < one.objective - WORTH:
            break
        one = best
    return one


def _around(one, setup, factors):
    """(L, p) coordinates and (L, effects) places with one effect moved along the chain."""
    components = one.hypothesis.components
    now = [c.place or 0 for c in components]
    columns = one.hypothesis.columns
    rows, coordinates = [], []
    for k, c in enumerate(components):
        if c.effect.places not in ALONG:
            continue
        possible = c.effect.candidates(setup)
        at = possible.index(c.place)
        for step, factor in itertools.product(REACH, factors):
            if 0 <= at + step < len(possible) and (factor > 0.0 or c.free[0].two_sided):
                rows.append([*now[:k], possible[at + step], *now[k + 1 :]])
                u = one.u.copy()
                strength = columns[k].start
                u[strength] = stronger(c.free[0], u[strength], factor)
                coordinates.append(u)
    shape = (len(rows), len(components))
    return np.array(coordinates).reshape(len(rows), len(one.u)), np.array(rows, dtype=int).reshape(shape)


def stronger(coordinate, u, factor):
    """The coordinate of a deviation multiplied by a factor (any shape), within the bounds of the search."""
    moved = u + np.log(factor) if coordinate.kind == "log" else u * factor
    return np.clip(moved, coordinate.low, coordinate.high)
