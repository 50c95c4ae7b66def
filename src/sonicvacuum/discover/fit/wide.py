"""Starts for fits in which something is hardly known: a wall's modulus, the speed of the shots.

Where an echo of the simulation does not overlap the measured one, χ² has no slope towards it, so that a fit
from the middle of a wide prior ends in the nearest of several minima. Fits start all over the prior instead.
"""

from itertools import product

import numpy as np

from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model.forward import Forward

# Known no better than this, a modulus or a speed may put an echo beside the measured one.
WIDE = 0.1
# Distance of starts in the logarithm; how far they go, in standard errors and at most.
STEP, REACH, MOST = 0.5, 2.0, 1.0
# Starts that are followed to their minimum; steps of all before these are chosen; minima that the fits of
# effects start from.
FOLLOWED, FIRST, MINIMA = 8, 4, 3


def starts(forward: Forward) -> np.ndarray:
    """(L, q) nuisances over the priors of the wide ones, speeds of all runs together; the middle first."""
    layout, sigma = forward.layout, forward.nuisance_sigma
    axes = [(k, _offsets(sigma[k])) for k in layout.simulated if sigma[k] > WIDE]
    speeds = [layout.speed(run) for run in range(layout.runs)]
    fastest = float(np.min(sigma[speeds], initial=np.inf))
    if WIDE < fastest < np.inf:
        axes.append((speeds, [0.0, -fastest, fastest] if fastest < MOST else _offsets(fastest)))
    rows = []
    for offsets in product(*(values for _, values in axes)):
        row = np.zeros(layout.size)
        for (at, _), offset in zip(axes, offsets, strict=True):
            row[at] = offset / sigma[at]
        rows.append(row)
    return np.array(rows)


def _offsets(sigma):
    reach = int(min(REACH * sigma, MOST) / STEP)
    return sorted((STEP * k for k in range(-reach, reach + 1)), key=abs)


def wide(forward: Forward) -> bool:
    """Whether anything is known so roughly that fits need several starts."""
    return len(starts(forward)) > 1


def minima(forward: Forward, null: Fit) -> np.ndarray:
    """(L, q) nuisances of the nominal fit and of its next best minima, where fits need several starts; else
    the middle of their priors.
    """
    if not wide(forward):
        return np.zeros((1, forward.layout.size))
    others = null.elsewhere if null.elsewhere is not None else np.zeros((0, forward.layout.size))
    return np.concatenate([null.nu[None], others[: MINIMA - 1]])


def again(forward: Forward, one: Fit) -> Fit:
    """The better of a fit and of one from all over the priors, with the effects as they are there."""
    rows = starts(forward)
    u = np.repeat(one.u[None], len(rows), axis=0)
    other = fit(forward, one.hypothesis, u, rows, keep=FOLLOWED, halved=FIRST)
    return min((one, other), key=lambda f: f.objective)
