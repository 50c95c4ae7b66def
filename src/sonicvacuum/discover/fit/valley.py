"""Along a valley that bends, where fits creep.

Beside a gross misfit speeds, moduli and a loss make up for each other along a valley: each step of a fit
gains little there, and it is given up (`worth`) far above the lowest point. What some steps have moved
together points along the valley, so that fits begin farther on that way, at growing distances, and the best
one shows the way on: pattern moves (Hooke & Jeeves, J. ACM 8, 212, 1961), with fits in place of exploratory
moves. No farther than where fits begin (`wide`): one valley leads to shots ten times as fast as stated.
"""

import numpy as np

from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.fit.descent import spread
from sonicvacuum.discover.fit.refit import Fit, fit, polish
from sonicvacuum.discover.model.forward import Forward

# Steps that show the way at first; how far fits begin, over what was moved last; how many of these are
# followed, and for how many steps.
SHOWN, FARTHER, FOLLOWED, ITERATIONS = 10, np.array([[1.0], [3.0], [8.0], [20.0]]), 2, 15
# How often, as long as that leaves less than this share of what was left.
ROUNDS, LESS = 8, 0.998


def along(forward: Forward, one: Fit) -> Fit:
    """The lowest fit on the way that a fit creeps; the last steps are left to `refit.finished`."""
    before, one = one, polish(forward, one, SHOWN, finish=False)
    for _ in range(ROUNDS):
        u, nu = one.u + FARTHER * (one.u - before.u), one.nu + FARTHER * (one.nu - before.nu)
        near = [_near(forward, row) for row in nu]
        if not any(near):
            return one
        how = {"keep": FOLLOWED, "iterations": ITERATIONS, "finish": False, "reach": one.objective}
        other = fit(forward, one.hypothesis, one.hypothesis.inside(u[near]), nu[near], **how)
        if not other.objective < LESS * one.objective:
            return min((one, other), key=lambda f: f.objective)
        if not _near(forward, other.nu):
            return one
        before, one = one, other
    return one


def _near(forward, nu) -> bool:
    """Whether speeds, moduli and masses are where fits may begin."""
    return bool(np.abs(nu * spread(forward)).max() <= wide.MOST)
