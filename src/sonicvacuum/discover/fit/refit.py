"""Non-linear least squares for many starts at once: Levenberg–Marquardt, one lane for each start.

Marquardt, J. SIAM 11, 431 (1963). Slopes to the parameters are taken afresh at each step; those to the
nuisances that cost a simulation each hardly change on the way, and are held until a parameter has moved far.
At the end all are taken once more, to second order. Bounds are kept by clipping; a
coordinate at its bound that is pushed outward is held there. `scipy.optimize.least_squares` is the reference
that the tests hold this against.
"""

from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover.fit import broad
from sonicvacuum.discover.fit.normal import Normal, linearised
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis

ITERATIONS = 30
LAST = 2
# A fit has settled when an accepted step gains less than this in χ².
SETTLED = 1e-3
# The same before slopes are taken to second order, where there are any: the last steps gain the rest.
NEARLY = 0.02
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


@dataclass(frozen=True)
class Fit:
    """The best fit of one hypothesis.

    Attributes:
        hypothesis: with the places found.
        normal: normal equations there, one lane.
        settled: whether the fit converged.
        others: (n,) objectives of the other starts that settled elsewhere, ascending.
        elsewhere: (n, q) their nuisances.
        finished: whether the last steps were taken with slopes to second order.
    """

    hypothesis: Hypothesis
    normal: Normal
    settled: bool = True
    others: np.ndarray = None
    elsewhere: np.ndarray = None
    finished: bool = True

    @property
    def u(self) -> np.ndarray:
        """(p,) coordinates."""
        return self.normal.u[0]

    @property
    def nu(self) -> np.ndarray:
        """(q,) nuisances."""
        return self.normal.nu[0]

    @property
    def objective(self) -> float:
        """χ² and the penalty of the nuisances."""
        return float(self.normal.objective[0])

    @property
    def covariance(self) -> np.ndarray:
        """(n, n) covariance of coordinates and nuisances in the linearised model; bounds left aside."""
        _, hessian = self.normal.total()
        return np.linalg.pinv(hessian[0], hermitian=True)

    @property
    def sigma(self) -> np.ndarray:
        """(p,) standard errors of the coordinates."""
        return np.sqrt(np.diag(self.covariance)[: self.normal.free])

    def at_bound(self) -> np.ndarray:
        """(p,) whether a coordinate stands at a bound of its search."""
        room = 1e-6
        return np.array(
            [
                u <= c.low + room or u >= c.high - room
                for u, c in zip(self.u, self.hypothesis.coordinates, strict=True)
            ],
            dtype=bool,
        )


def fit(
    forward: Forward,
    hypothesis: Hypothesis,
    u: np.ndarray,
    nu: np.ndarray,
    places: np.ndarray | None = None,
    keep: int = 4,
    iterations: int = ITERATIONS,
    coarse: int = 0,
    halved: int = 0,
    finish: bool = True,
) -> Fit:
    """The best fit from (L, p) starts; only the `keep` of lowest χ² are followed.

    With `coarse`, starts are judged, and followed for so many steps, on running integrals of the traces
    first. With `halved`, four times as many starts are followed for so many steps before they are judged.
    Without `finish` the last steps, with slopes to second order, are left to `polish`.
    """
    u = np.atleast_2d(np.asarray(u, dtype=float))
    nu = np.broadcast_to(nu, (len(u), forward.layout.size)).copy()
    many = 4 * keep if halved else keep
    chosen = _promising(forward.coarse if coarse else forward, hypothesis, u, nu, places, many)
    u, nu, places = u[chosen], nu[chosen], None if places is None else places[chosen]
    if halved and len(u) > keep:
        near, columns = linearised(forward, hypothesis, u, nu, places)
        near, _ = descend(forward, hypothesis, near, places, halved, columns)
        chosen = np.sort(np.argsort(near.objective, kind="stable")[:keep])
        u, nu, places = near.u[chosen], near.nu[chosen], None if places is None else places[chosen]
    if coarse:
        rough, columns = linearised(forward.coarse, hypothesis, u, nu, places)
        rough, _ = descend(forward.coarse, hypothesis, rough, places, coarse, columns)
        u, nu = rough.u, rough.nu
    now, columns = linearised(forward, hypothesis, u, nu, places)
    enough = NEARLY if now.free else SETTLED
    now, settled = descend(forward, hypothesis, now, places, iterations, columns, enough=enough)
    order = np.argsort(now.objective, kind="stable")
    best = int(order[0])
    found = hypothesis if places is None else hypothesis.with_places(places[best])
    last = now.take([best])
    last = _finished(forward, found, last) if finish else last
    return Fit(found, last, bool(settled[best]), now.objective[order[1:]], now.nu[order[1:]], finish)


def polish(forward: Forward, one: Fit, iterations: int = ITERATIONS, finish: bool = True) -> Fit:
    """The same fit, followed further; without `finish` but for the last steps."""
    enough = NEARLY if one.normal.free else SETTLED
    now, settled = descend(forward, one.hypothesis, one.normal.take([0]), None, iterations, enough=enough)
    last = _finished(forward, one.hypothesis, now) if finish else now
    return Fit(one.hypothesis, last, bool(settled[0]), one.others, one.elsewhere, finish)


def finished(forward: Forward, one: Fit) -> Fit:
    """The same fit with the last steps taken."""
    if one.finished:
        return one
    return replace(one, normal=_finished(forward, one.hypothesis, one.normal), finished=True)


def _finished(forward, hypothesis, now):
    """The last steps with slopes to second order: those to first order point a little beside the minimum."""
    if not (np.isfinite(now.objective[0]) and now.has_slopes[0]) or now.free == 0:
        return now
    steps = _differences(now)
    precise, columns = linearised(forward, hypothesis, now.u, now.nu, None, steps, True)
    last = descend(forward, hypothesis, precise, None, LAST, columns, precise=True)[0]
    return broad.broadened(forward, hypothesis, last, columns) if broad.asks(hypothesis) else last


def simulated(forward: Forward, hypothesis: Hypothesis, u, nu, places=None) -> np.ndarray:
    """(L,) χ² that simulations at (L, p) coordinates and (L, q) nuisances leave, without any penalty."""
    found = forward.sampled(hypothesis, u, nu, places)
    return sum(np.square(forward.data(run) - value).sum(axis=1) for run, value in enumerate(found))


def _promising(forward, hypothesis, u, nu, places, keep):
    """Starts of the lowest χ²."""
    if len(u) <= keep:
        return np.arange(len(u))
    chi2 = simulated(forward, hypothesis, u, nu, places)
    chi2 = np.where(np.isfinite(chi2), chi2, np.inf) + np.square(nu).sum(axis=1)
    return np.sort(np.argsort(chi2, kind="stable")[:keep])


def descend(
    forward, hypothesis, now: Normal, places, iterations, columns=None, precise=False, enough=SETTLED
):
    """Follow all lanes to their minimum; the normal equations there and which have settled.

    While a lane is far from the data, its nuisances are held by as much more as its χ² per datum exceeds 1:
    they must not do the work of the effect. `columns` are those of `now`, where at hand; a lane has settled
    once a step gains less than `enough`.
    """
    lanes = len(now.u)
    now = now.take(np.arange(lanes))
    size = sum(forward.experiment.size(run) for run in range(len(now.chi2)))
    damping = np.full(lanes, 1e-3)
    settled = ~np.isfinite(now.objective)
    held = _Held(columns, lanes, np.minimum(FAR_NU, FAR_LOG / spread(forward)))
    longest = np.minimum(LONGEST_NU, LONGEST_LOG / spread(forward))
    for turn in range(iterations):
        part = now.take(~settled)
        weight = np.maximum(1.0, part.chi2.sum(axis=0) / (2.0 * size))
        gradient, hessian = part.total(weight)
        step = _step(part, hypothesis, gradient, hessian, damping[~settled], longest)
        # Where a step promises nothing, or slopes are missing, it need not be tried.
        promise = _promise(gradient, hessian, step)
        goes_on = (promise >= enough) | ((weight > 1.0) & np.isfinite(promise))
        if turn >= TRIED and settled.any():
            least = now.objective[settled].min()
            goes_on &= (part.objective - BEHIND * promise <= least) | (weight > 1.0)
        at = np.flatnonzero(~settled)[goes_on]
        settled[~settled] = ~goes_on
        if not len(at):
            break
        part, weight, step = part.take(goes_on), weight[goes_on], step[goes_on]
        gradient, hessian = gradient[goes_on], hessian[goes_on]
        u, nu = _moved(part, hypothesis, step)
        here = None if places is None else places[at]
        steps, known = _differences(part), held.near(at)
        new, columns = linearised(forward, hypothesis, u, nu, here, steps, precise, known)
        gained = part.weighted(weight) - new.weighted(weight)
        better = gained > 0.0
        held.noted(at, better, columns, known, np.abs(u - part.u), np.abs(nu - part.nu))
        now.replaced(at[better], new.take(better))
        done = (better & (gained < enough)) | (damping[at] > 1e7)
        done |= ~better & (promise[goes_on] < enough)
        settled[at] = done & ((weight == 1.0) | ~better)
        damping[at] = np.where(better, damping[at] * 0.1, damping[at] * 8.0).clip(1e-9, 1e9)
    return now, settled


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


def _differences(part):
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
