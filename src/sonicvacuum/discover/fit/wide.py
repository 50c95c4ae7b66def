"""Starts for fits in which something is hardly known: a wall's modulus, the speed of the shots.

Where an echo of the simulation does not overlap the measured one, χ² has no slope towards it, so that a fit
from the middle of a wide prior ends in the nearest of several minima. Fits start all over the prior instead.
"""

import math
from dataclasses import replace
from itertools import product

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis

# Known no better than this, a modulus or a speed may put an echo beside the measured one.
WIDE = 0.1
# Distance of starts in the logarithm; how far they go, in standard errors and at most.
STEP, REACH, MOST = 0.5, 2.0, 1.0
# Starts that are followed to their minimum; steps of all before these are chosen; minima that the fits of
# effects start from.
FOLLOWED, FIRST, MINIMA = 8, 4, 3
# Steps on running integrals, where a fit of nuisances alone starts once more from these.
COARSE = 6


def starts(forward: Forward) -> np.ndarray:
    """(L, q) nuisances over the priors of the wide ones, speeds of all runs together; the middle first."""
    layout, sigma = forward.layout, forward.nuisance_sigma
    axes = [(k, _offsets(sigma[k])) for k in layout.simulated if sigma[k] > WIDE]
    speeds = [layout.speed(run) for run in range(layout.runs)]
    fastest = float(np.min(sigma[speeds], initial=np.inf))
    if WIDE < fastest < np.inf:
        several = [0.0, -fastest, fastest, -REACH * fastest, REACH * fastest]
        axes.append((speeds, several if REACH * fastest < MOST else _offsets(fastest)))
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


def nominal(forward: Forward, held: Hypothesis | None = None) -> Fit:
    """The nominal model, or one with effects as they are held, with its nuisances fitted.

    Where much is left, fits start once more from running integrals, and from all over the priors of what is
    hardly known.
    """
    held = held or Hypothesis()
    start = np.zeros((1, forward.layout.size))
    direct = fit(forward, held, np.zeros((1, 0)), start)
    if not leaves_much(forward, direct.objective):
        return direct
    tried = [direct, fit(forward, held, np.zeros((1, 0)), start, coarse=COARSE)]
    if direct.objective > 2.0 * data(forward) and wide(forward):
        rows = starts(forward)
        tried.append(fit(forward, held, np.zeros((len(rows), 0)), rows, keep=FOLLOWED, halved=FIRST))
    best = min(tried, key=lambda f: f.objective)
    best = best if best.objective < direct.objective - policy.SAME_MINIMUM else direct
    return replace(best, elsewhere=tried[-1].elsewhere)


def leaves_much(forward: Forward, objective: float) -> bool:
    """Whether a fit of this objective leaves more than noise does, whatever its shape."""
    size = data(forward)
    return objective - size >= policy.MINIMA * math.sqrt(2.0 * size)


def again(forward: Forward, one: Fit, more: np.ndarray | None = None) -> Fit:
    """The better of a fit and of one from all over the priors, with the effects as they are there; from
    `more` (L, q) nuisances as well.
    """
    rows = starts(forward) if more is None else np.concatenate([starts(forward), more])
    u = np.repeat(one.u[None], len(rows), axis=0)
    other = fit(forward, one.hypothesis, u, rows, keep=FOLLOWED, halved=FIRST)
    return min((one, other), key=lambda f: f.objective)
