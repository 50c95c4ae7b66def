"""Which starts of a fit are worth following further.

Far from the data most starts of one hypothesis come to the same minimum, or creep where no pulse meets its
own: both cost as much as the one that counts.
"""

import numpy as np

from sonicvacuum.discover.fit.normal import Normal

# Starts are given up that would not reach the best one, nor what has to be reached, by so many more steps
# like the better of the last two.
PATIENCE = 15.0
# What one of the last two steps has to gain, as a share of what is left beyond the noise; or the last that
# led down, so many times as much: two that led up do not tell how far it is.
LEAST, BEFORE = 1e-4, 30.0
# Two starts are one if what parts them changes χ² by less than this share of what the better one leaves
# beyond the noise, or by this much.
SAME, NEARER = 1e-3, 0.02


class Progress:
    """What each of some starts has gained by its last two steps.

    Args:
        lanes: number of starts.
        size: number of data.
        reach: objective above which a fit is of no use, where there is such a one.
    """

    def __init__(self, lanes: int, size: int, reach: float = np.inf):
        self.size, self.reach = size, reach
        self._tried, self._down = np.full((2, lanes), np.inf), np.full(lanes, np.inf)

    def noted(self, lanes: np.ndarray, gained: np.ndarray) -> None:
        """Take note of what (l,) starts have gained by a step; none that led up is taken."""
        down = gained > 0.0
        self._tried[:, lanes] = self._tried[1, lanes], np.maximum(gained, 0.0)
        self._down[lanes[down]] = gained[down]

    def creeping(self, objective: np.ndarray) -> np.ndarray:
        """(L,) whether starts at these (L,) objectives gain hardly anything of what they leave."""
        least = LEAST * (objective - self.size)
        return (self._tried.max(axis=0) < least) & (self._down < BEFORE * least)

    def hopeless(self, objective: np.ndarray) -> np.ndarray:
        """(L,) whether starts are so far behind that they would not get where they should."""
        best = min(objective.min(), self.reach)
        if not np.isfinite(best):
            return np.zeros(len(objective), dtype=bool)
        behind = objective - best
        return PATIENCE * self._tried.max(axis=0) < behind


def doubled(now: Normal, size: int, places: np.ndarray | None) -> np.ndarray:
    """(L,) whether a start has come to where a better one is.

    Args:
        now: normal equations of L starts.
        size: number of data.
        places: (L, c) of effects, where they have any.
    """
    objective, (_, hessian) = now.objective, now.total()
    at = np.concatenate([now.u, now.nu], axis=1)
    double = np.zeros(len(at), dtype=bool)
    order = np.argsort(objective, kind="stable")
    for k, better in enumerate(order[:-1]):
        if double[better] or not np.isfinite(objective[better]):
            continue
        others, enough = order[k + 1 :], max(SAME * (objective[better] - size), NEARER)
        apart = at[others] - at[better]
        # By the slopes of either: where an effect hardly acts, its strength seems not to matter.
        ways = (hessian[better][None], hessian[others])
        distance = np.max([np.einsum("ln,lnm,lm->l", apart, way, apart) for way in ways], axis=0)
        near = (distance < enough) & (objective[others] - objective[better] < enough)
        if places is not None:
            near &= (places[others] == places[better]).all(axis=1)
        double[others[near]] = True
    return double
