"""One effect with a place, tried at many strengths around the place where it was found.

In a chain without preload a gap or a lighter bead tells by which contacts it keeps open, and how far: χ² has
narrow minima along the strength, a few per cent wide where the data are precise, and other ones at the next
places. Slopes and a few trials all over the range may meet the wrong one.
"""

import numpy as np

from sonicvacuum.discover.fit import places
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import secants
from sonicvacuum.effects import Setup

# Strengths over the one found, and how many places to either side.
FACTORS, REACH = np.geomspace(1.0 / 6.0, 6.0, 27), 4
# Of so many trials the best one of each place is followed, of so many places at most, for so many steps, if
# it promises this share of what the best of all does; as often as that leads elsewhere.
TRIALS, ITERATIONS, FOLLOWED, PROMISE, ROUNDS = 60, 10, 4, 0.5, 4


def refined(forward: Forward, null: Fit, one: Fit, setup: Setup) -> Fit:
    """The fit of one effect, or a better one from trials around its place, to either side of its off value.

    Args:
        forward: the predictor.
        null: the nominal model, fitted.
        one: of one effect with one parameter, at a bead or contact; returned as it is if it is not.
        setup: which knows the places.
    """
    (component,) = one.hypothesis.components
    if component.effect.places not in places.ALONG or len(component.free) != 1:
        return one
    for _ in range(ROUNDS):
        trials = _trials(forward, null, one, setup)
        if not trials:
            break
        u, nu = np.array([t.u for t in trials]), np.array([t.nu for t in trials])
        where = np.array([[t.place] for t in trials])
        better = fit(forward, one.hypothesis, u, nu, where, FOLLOWED, ITERATIONS)
        if not better.objective < one.objective - places.WORTH:
            break
        one = places.settled(forward, better, setup)
    return one


def _trials(forward, null, one, setup):
    """The best trial of each place near that of a fit, best first."""
    (component,) = one.hypothesis.components
    possible = component.effect.candidates(setup)
    at = possible.index(component.place)
    near = possible[max(0, at - REACH) : at + REACH + 1]
    strength = component.free[0]
    signs = (1.0, -1.0) if strength.two_sided else (1.0,)
    sizes = np.concatenate([places.stronger(strength, one.u[0], sign * FACTORS) for sign in signs])
    # At its own minimum the nominal model makes up for the effect, and the true place may look the worse.
    bare = fit(forward, null.hypothesis, np.zeros((1, 0)), one.nu[None], iterations=0, finish=False)
    tried = secants.tried(forward, bare, component, setup, TRIALS, np.unique(sizes), near)
    best = {t.place: t for t in reversed(tried) if t.gain > PROMISE * tried[0].gain}
    return sorted(best.values(), key=lambda t: -t.gain)[:FOLLOWED]
