"""Strides along a valley whose floor is rough, to lower ground than a fit has found.

Where data tell two parameters apart by a hair and are loud, a contact that opens for a moment, and forgets,
makes bumps in χ² that are larger than what its errors allow: a fit comes to rest behind any of them, and its
slopes do not know of the next hollow. So fits begin at growing distances along the longest axis of its
errors, nuisances following as slopes have it, and are followed down; and once more from the lowest.
"""

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import broad, ridge
from sonicvacuum.discover.fit.descent import descend
from sonicvacuum.discover.fit.normal import Normal, linearised
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis

# Bumps show where standard errors by slopes over themselves are longer than by short ones, by this factor;
# errors longer than this, in coordinates, reach over all bumps.
ROUGH, SHARP = 1.15, 0.03
# Strides to each side: the shortest and longest in standard errors, how many; and how often they are made.
NEAR, FAR, MANY, ROUNDS = 4.0, 400.0, 12, 5
# Steps of a fit begun so, settled when one gains less than this in χ²; by what lower ground is lower.
ITERATIONS, ENOUGH, LOWER = 30, 0.02, 0.5


def rough(now: Normal, wide: Normal | None, size: int) -> bool:
    """Whether bumps may hold a fit, one lane, of so many data, by its slopes over short steps and over its
    errors. Where it leaves a gross misfit, bumps are nothing beside that.
    """
    if (
        wide is None
        or not (now.has_slopes[0] and wide.has_slopes[0])
        or now.objective[0] > policy.GROSS * size
    ):
        return False
    short, far = (np.linalg.norm(_longest(one)) for one in (now, wide))
    return bool(short < SHARP and far > ROUGH * short)


def farther(forward: Forward, hypothesis: Hypothesis, now: Normal) -> Normal:
    """The lowest point that strides from a fit, one lane, lead to; the fit itself where none is lower."""
    for _ in range(ROUNDS):
        u, nu = _strides(hypothesis, now)
        begun, columns = linearised(forward, hypothesis, u, nu)
        reach = float(now.objective[0])
        found, *_ = descend(forward, hypothesis, begun, None, ITERATIONS, columns, enough=ENOUGH, reach=reach)
        best = int(np.argmin(found.objective))
        if not (found.has_slopes[best] and found.objective[best] < reach - LOWER):
            break
        now = found.take([best])
    return now


def _strides(hypothesis, now):
    """(L, p) coordinates and (L, q) nuisances at all distances to both sides."""
    one = np.geomspace(NEAR, FAR, MANY)
    size = np.concatenate([-one[::-1], one])[:, None]
    covariance, p = np.linalg.pinv(now.total()[1][0], hermitian=True), now.free
    axis = _longest(now)
    follow = covariance[p:, :p] @ np.linalg.pinv(covariance[:p, :p], hermitian=True) @ axis
    return hypothesis.inside(now.u + size * axis), now.nu + size * follow


def _longest(now):
    """(p,) longest axis of the errors of the coordinates, a standard error long."""
    return ridge.principal_axes(broad.covariance(now))[-1]
