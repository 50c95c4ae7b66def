"""Levenberg–Marquardt for many starts of one hypothesis at once, one lane for each start.

Marquardt, J. SIAM 11, 431 (1963). Slopes to the parameters are taken afresh at each step; those to the
nuisances that cost a simulation each hardly change on the way, and are held until a parameter has moved far.
Bounds are kept by clipping; a coordinate at its bound that is pushed outward is held there. Lanes that are
not worth it are not followed further (`worth`). `scipy.optimize.least_squares` is the reference that the
tests hold this against.
"""

import numpy as np

from sonicvacuum.discover.fit import worth
from sonicvacuum.discover.fit.normal import Normal, linearised
from sonicvacuum.discover.model.forward import Forward

# A fit has settled when an accepted step gains less than this in χ².
SETTLED = 1e-3
# A start is given up once so many times what its next step promises leaves it behind the best of those that
# have settled, after so many steps: it could only settle elsewhere.
BEHIND, TRIED = 10.0, 3
# Longest step: in a coordinate of an effect, in a nuisance (standard errors).
LONGEST_U, LONGEST_NU = 1.2, 6.0
# In coordinates and in standard errors, how far a fit may move before slopes that were held are taken anew.
FAR_U, FAR_NU = 0.5, 3.0
# Neither step nor distance is longer in the logarithm of a nuisance that is hardly known: slopes bend there.
LONGEST_LOG, FAR_LOG = 0.5, 0.15
_HELD = 1e12
# Steps of finite differences change the data by so many standard errors, and a coordinate by no more than
# this. Slopes to second order take steps twice as long, over which a duration at 2 % of the peak was no
# parabola any more with 0.05: its slope came out with the wrong sign.
_AIM, _LONGEST = 4.0, 0.02


def descend(
    forward,
    hypothesis,
    now: Normal,
    places,
    iterations,
    columns=None,
    precise=False,
    enough=SETTLED,
    reach=np.inf,
):
    """Follow all lanes to their minimum; the normal equations there, which have settled, and which were left.

    While a lane is far from the data, its nuisances are held by as much more as its χ² per datum exceeds 1:
    they must not do the work of the effect. `columns` are those of `now`, where at hand; a lane has settled
    once a step gains less than `enough`. Lanes that are not worth following are left where they are, see
    `worth`; so are all that do not come to `reach`.
    """
    lanes = len(now.u)
    now = now.take(np.arange(lanes))
    size = max(1, sum(forward.experiment.size(run) for run in range(len(now.chi2))))
    damping = np.full(lanes, 1e-3)
    settled, left = ~np.isfinite(now.objective), np.zeros(lanes, dtype=bool)
    progress = worth.Progress(lanes, size, reach)
    held = _Held(columns, lanes, np.minimum(FAR_NU, FAR_LOG / spread(forward)))
    longest = np.minimum(LONGEST_NU, LONGEST_LOG / spread(forward))
    for turn in range(iterations):
        left |= progress.hopeless(now.objective) | worth.doubled(now, size, places)
        following = np.flatnonzero(~(settled | left | progress.creeping(now.objective)))
        if not len(following):
            break
        part = now.take(following)
        weight = np.maximum(1.0, part.chi2.sum(axis=0) / (2.0 * size))
        gradient, hessian = part.total(weight)
        step = _step(part, hypothesis, gradient, hessian, damping[following], longest)
        # Where a step promises nothing, or slopes are missing, it need not be tried.
        promise = _promise(gradient, hessian, step)
        goes_on = (promise >= enough) | ((weight > 1.0) & np.isfinite(promise))
        if turn >= TRIED and settled.any():
            least = now.objective[settled].min()
            goes_on &= (part.objective - BEHIND * promise <= least) | (weight > 1.0)
        at = following[goes_on]
        settled[following] = ~goes_on
        if not len(at):
            break
        part, weight, step = part.take(goes_on), weight[goes_on], step[goes_on]
        gradient, hessian = gradient[goes_on], hessian[goes_on]
        u, nu = _moved(part, hypothesis, step)
        here = None if places is None else places[at]
        steps, known = differences(part), held.near(at)
        new, columns = linearised(forward, hypothesis, u, nu, here, steps, precise, known)
        gained = part.weighted(weight) - new.weighted(weight)
        better = gained > 0.0
        held.noted(at, better, columns, known, np.abs(u - part.u), np.abs(nu - part.nu))
        progress.noted(at, np.where(better, part.objective - new.objective, 0.0))
        now.replaced(at[better], new.take(better))
        done = (better & (gained < enough)) | (damping[at] > 1e7)
        done |= ~better & (promise[goes_on] < enough)
        settled[at] = done & ((weight == 1.0) | ~better)
        damping[at] = np.where(better, damping[at] * 0.1, damping[at] * 8.0).clip(1e-9, 1e9)
    # A lane whose nuisances were held may have gone up after others were left for its sake.
    left[np.argmin(now.objective)] = False
    return now, settled, left


class _Held:
    """Columns of all lanes, of which slopes are held, and how far each lane has moved since they were taken;
    in units of what is too far.
    """

    def __init__(self, columns, lanes, far):
        self.far = far
        self.columns = None if columns is None else [c.copy() for c in columns]
        self.moved = np.zeros(lanes)

    def near(self, at) -> list[np.ndarray] | None:
        """Columns to be held by some lanes; None where there are none, or one lane has moved too far."""
        if self.columns is None or self.moved[at].max() > 1.0:
            return None
        return [c[at] for c in self.columns]

    def noted(self, at, better, columns, known, du, dnu):
        """Keep columns that were taken afresh, and count what lanes moved with those that were held."""
        if known is not None:
            far = np.maximum(du.max(axis=1, initial=0.0) / FAR_U, (dnu / self.far).max(axis=1, initial=0.0))
            self.moved[at] += np.where(better, far, 0.0)
            return
        if self.columns is None:
            self.columns = [np.zeros((len(self.moved), *c.shape[1:])) for c in columns]
        for kept, new in zip(self.columns, columns, strict=True):
            kept[at] = new
        self.moved[at] = 0.0


def differences(part):
    """(L, p) steps of finite differences that change all data together by a few standard errors."""
    slopes = np.sqrt(np.einsum("lnn->ln", part.hessian.sum(axis=0))[:, : part.free])
    return np.clip(_AIM / np.maximum(slopes, 1e-9), 1e-5, _LONGEST)


def _promise(gradient, hessian, step):
    return 2.0 * np.einsum("ln,ln->l", gradient, step) - np.einsum("ln,lnm,lm->l", step, hessian, step)


def spread(forward: Forward) -> np.ndarray:
    """(q,) standard errors of the logarithms of speeds, moduli, masses and sizes; nearly 0 of all others."""
    layout = forward.layout
    law = layout.other("law")
    own = [*range(layout.runs), *(k for k in layout.simulated if k not in law)]
    sigma = np.full(layout.size, 1e-12)
    sigma[own] = np.maximum(forward.nuisance_sigma[own], 1e-12)
    return sigma


def _step(now, hypothesis, gradient, hessian, damping, longest_nu):
    """(L, n) Marquardt's step, coordinates at their bounds held."""
    free, diagonal = now.free, np.einsum("lnn->ln", hessian)
    matrix = hessian.copy()
    places = np.arange(matrix.shape[1])
    matrix[:, places, places] += damping[:, None] * np.maximum(diagonal, 1e-9)
    for k, c in enumerate(hypothesis.coordinates):
        held = ((now.u[:, k] <= c.low) & (gradient[:, k] < 0.0)) | (
            (now.u[:, k] >= c.high) & (gradient[:, k] > 0.0)
        )
        matrix[held, k, k] += _HELD
        matrix[:, k, k] += 1e-9
    step = np.linalg.solve(matrix, gradient[..., None])[..., 0]
    longest = np.concatenate([np.full(free, LONGEST_U), longest_nu])
    over = np.abs(step / longest).max(axis=1)
    return step / np.maximum(over, 1.0)[:, None]


def _moved(now, hypothesis, step):
    u, nu = now.u + step[:, : now.free], now.nu + step[:, now.free :]
    for k, c in enumerate(hypothesis.coordinates):
        u[:, k] = u[:, k].clip(c.low, c.high)
    return u, nu
