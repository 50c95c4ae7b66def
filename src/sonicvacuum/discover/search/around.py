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
# Trials that are followed, and for how many steps.
FOLLOWED, ITERATIONS = 4, 10


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
    possible = component.effect.candidates(setup)
    at = possible.index(component.place)
    near = possible[max(0, at - REACH) : at + REACH + 1]
    strength = component.free[0]
    signs = (1.0, -1.0) if strength.two_sided else (1.0,)
    sizes = np.concatenate([places.stronger(strength, one.u[0], sign * FACTORS) for sign in signs])
    trials = secants.tried(forward, null, component, setup, FOLLOWED, np.unique(sizes), near)
    if not trials or trials[0].gain < null.objective - one.objective - places.WORTH:
        return one
    u, nu = np.array([t.u for t in trials]), np.array([t.nu for t in trials])
    where = np.array([[t.place] for t in trials])
    better = fit(forward, one.hypothesis, u, nu, where, FOLLOWED, ITERATIONS)
    return places.settled(forward, better, setup) if better.objective < one.objective - places.WORTH else one
