"""Pairs of finite strength, as if what each of two effects changes in the data added up.

Where one takes back most of what another does, neither is asked for alone, and slopes at off mislead of both:
a slow gauge in a chain of coated beads, a weight along the chain that closes a gap. So every effect is tried
all over its range, and any two of these trials are judged together, each taken a little more or less than as
tried.
"""

from itertools import combinations

import numpy as np

from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.search import screen, secants
from sonicvacuum.discover.search.planes import Start
from sonicvacuum.effects import Setup

# Trials of which less than this is left beside each other are one.
PARALLEL = 1e-3


def summed(forward: Forward, null: Fit, setup: Setup) -> list[Start]:
    """The most promising start of each pair of effects that gains anything, the best first."""
    able = secants.components(setup, forward.experiment.excluded)
    sizes = [secants.places_and_sizes(c, setup, secants.coarsely(c.free[0])) for c in able]
    tried = [(c, *row) for c, rows in zip(able, sizes, strict=True) for row in rows]
    seen = _screened(forward, null, [(c, rows) for c, rows in zip(able, sizes, strict=True) if rows])
    gain, share = _together(*seen.projected)
    names = np.array([c.effect.id for c, _, _ in tried])
    found = []
    for pair in combinations(dict.fromkeys(names), 2):
        first, second = (np.flatnonzero(names == name) for name in pair)
        best = np.unravel_index(np.argmax(gain[np.ix_(first, second)]), (len(first), len(second)))
        i, j = first[best[0]], second[best[1]]
        if gain[i, j] > 0.0:
            found.append(_start(seen, tried, (i, j), (share[i, j], share[j, i]), gain[i, j]))
    return sorted(found, key=lambda s: -s.gain)


def _screened(forward, null, able) -> screen.Screen:
    """The screen whose directions are the trials of all effects."""

    def changed(branch, asked):
        return secants.changes(branch, null, *asked)

    parts = abreast.each(forward, changed, able, calls=abreast.SLOPES)
    directions = tuple(d for some, _ in parts for d in some)
    columns = [np.concatenate(run) for run in zip(*(c for _, c in parts), strict=True)]
    base = forward.columns(null.hypothesis, null.u[None], null.nu[None], precise=True)
    return screen.from_columns(forward, null, directions, base, columns)


def _together(score: np.ndarray, gram: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(K, K) gain of any two of K trials, and what the first is taken times for it, no farther than halfway
    to the next strength; −∞ where the two are one, or one of them shows no number.
    """
    own = np.diag(gram)
    plane = own[:, None] * own[None, :] - np.square(gram)
    apart = plane > PARALLEL * own[:, None] * own[None, :]
    best = score[:, None] * own[None, :] - score[None, :] * gram
    first = np.divide(best, plane, where=apart, out=np.ones_like(gram))
    first = first.clip(1.0 / secants.HALFWAY, secants.HALFWAY)
    alone = first * (2.0 * score[:, None] - first * own[:, None])
    gain = alone + alone.T - 2.0 * first * first.T * gram
    return np.where(apart, gain, -np.inf), first


def _start(seen, tried, pair, shares, gain) -> Start:
    """The start at two trials, each taken so many times, and the nuisances as they follow."""
    parts = [tried[k][0] for k in pair]
    hypothesis = Hypothesis(tuple(parts))
    u = [secants.scaled(c.free[0], tried[k][2], s) for c, k, s in zip(parts, pair, shares, strict=True)]
    places = np.array([[tried[k][1] or 0 for k in pair]])
    _, nu = seen.moved(list(pair), np.array(shares))
    return Start(float(gain), hypothesis, hypothesis.inside(np.concatenate(u)[None]), nu[None], places)
