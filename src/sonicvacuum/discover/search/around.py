"""Effects with a place, tried at many strengths around the places where they were found.

In a chain without preload a gap or a lighter bead tells by which contacts it keeps open, and how far: χ² has
narrow minima along the strength, a few per cent wide where the data are precise, and other ones at the next
places. Slopes and a few trials all over the range may meet the wrong one.
"""

import numpy as np

from sonicvacuum.discover.fit import places
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import restart, secants
from sonicvacuum.effects import Setup

# Strengths over the one found, and how many places to either side.
FACTORS, REACH = np.geomspace(1.0 / 6.0, 6.0, 27), 4
# How many places to either side of a bead or contact where another effect leads, over the whole range.
BESIDE = 2
# Of so many trials the best one of each place is followed, of so many places at most, for so many steps, if
# it promises this share of what the best of all does; as often as that leads elsewhere.
TRIALS, ITERATIONS, FOLLOWED, PROMISE, ROUNDS = 60, 10, 4, 0.5, 4


def refined(forward: Forward, one: Fit, setup: Setup) -> Fit:
    """The fit, or a better one from trials around its places, to either side of off values.

    Args:
        forward: the predictor.
        one: of one effect or several, of which those with one parameter and at a bead or contact are tried.
        setup: which knows the places.
    """
    for k, component in enumerate(one.hypothesis.components):
        if component.effect.places in places.ALONG and len(component.free) == 1:
            one = _refined(forward, one, k, setup)
    return one


def beside(forward: Forward, null: Fit, one: Fit, other: Fit, setup: Setup) -> Fit:
    """The fit of one effect, or a better one from trials of any strength where another effect was found: a
    large gap passes for a lighter bead there, and for a small gap elsewhere.

    Args:
        forward: the predictor.
        null: the model without either.
        one: of the effect alone, at a bead or contact.
        other: of the other effect alone, at a bead or contact.
        setup: which knows the places.
    """
    component, place = one.hypothesis.components[0], other.hypothesis.components[0].place
    if len(component.free) > 1:
        return one
    near = [p for p in component.effect.candidates(setup) if abs(p - place) <= BESIDE]
    sizes = secants.finely(component.free[0])
    trials = secants.one_a_place(secants.tried(forward, null, component, setup, TRIALS, sizes, near))
    if not trials:
        return one
    better = fit(
        forward, one.hypothesis, *restart.put(one.hypothesis, 0, trials[:FOLLOWED]), FOLLOWED, ITERATIONS
    )
    return better if better.objective < one.objective - places.WORTH else one


def _refined(forward, one, k, setup):
    """The same from trials of effect k."""
    for _ in range(ROUNDS):
        trials = _trials(forward, one, k, setup)
        if not trials:
            break
        better = fit(forward, one.hypothesis, *restart.put(one.hypothesis, k, trials), FOLLOWED, ITERATIONS)
        if not better.objective < one.objective - places.WORTH:
            break
        one = places.settled(forward, better, setup)
    return one


def _trials(forward, one, k, setup):
    """The best trial of each place near that of effect k, best first."""
    component = one.hypothesis.components[k]
    possible = component.effect.candidates(setup)
    at = possible.index(component.place)
    near = possible[max(0, at - REACH) : at + REACH + 1]
    strength, own = component.free[0], one.u[one.hypothesis.columns[k].start]
    signs = (1.0, -1.0) if strength.two_sided else (1.0,)
    sizes = np.concatenate([places.stronger(strength, own, sign * FACTORS) for sign in signs])
    # At its own minimum the model without the effect makes up for it, and the true place may look the worse.
    bare = restart.less(forward, one, k)
    if not np.isfinite(bare.objective):
        return []
    tried = secants.tried(forward, bare, component, setup, TRIALS, np.unique(sizes), near)
    return secants.one_a_place([t for t in tried if t.gain > PROMISE * tried[0].gain])[:FOLLOWED]
