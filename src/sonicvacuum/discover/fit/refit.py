"""The best fit of one hypothesis from many starts: the promising ones are followed to their minimum
(`descent`), and at the end all slopes are taken once more, to second order.
"""

from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import broad, strides
from sonicvacuum.discover.fit.descent import SETTLED, descend, differences
from sonicvacuum.discover.fit.normal import Normal, linearised
from sonicvacuum.discover.model import accuracy
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis

ITERATIONS = 30
# Last steps, and how often slopes are taken afresh for some of them, while these still gain more than this in
# χ²: with slopes that were held a fit may come to rest hundreds above its minimum, for they promise nothing.
LAST, AFRESH, GAINED = 2, 4, 0.1
# A fit has settled when an accepted step gains less than this in χ², before slopes are taken to second order,
# where there are any: the last steps gain the rest.
NEARLY = 0.02


@dataclass(frozen=True)
class Fit:
    """The best fit of one hypothesis.

    Attributes:
        hypothesis: with the places found.
        normal: normal equations there, one lane.
        settled: whether the fit converged.
        others: (n,) objectives of the other starts that settled elsewhere, ascending.
        elsewhere: (n, q) their nuisances.
        finished: whether the last steps were taken, with fresh slopes, those of parameters to second order.
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


@dataclass(frozen=True)
class Starts:
    """Where fits of one hypothesis begin.

    Attributes:
        u: (L, p) coordinates.
        nu: (L, q) nuisances.
        places: (L, c) of effects, None where they have none.
        objective: (L,) χ² and penalty, of running integrals of the traces; None where not known.
    """

    u: np.ndarray
    nu: np.ndarray
    places: np.ndarray | None = None
    objective: np.ndarray | None = None

    def take(self, lanes) -> "Starts":
        """The same for some of them."""
        rows = (self.u, self.nu, self.places, self.objective)
        return Starts(*(None if row is None else row[lanes] for row in rows))

    def beside(self, others: "Starts") -> "Starts":
        """These and others, their objectives left aside."""
        rows = zip((self.u, self.nu, self.places), (others.u, others.nu, others.places), strict=True)
        return Starts(*(None if one is None else np.concatenate([one, other]) for one, other in rows))


def _begun(forward, u, nu, places):
    u = np.atleast_2d(np.asarray(u, dtype=float))
    return Starts(u, np.broadcast_to(nu, (len(u), forward.layout.size)).copy(), places)


def roughly(forward: Forward, hypothesis: Hypothesis, begun: Starts, keep: int, steps: int) -> Starts:
    """The `keep` best starts where so many steps lead them that are fitted to running integrals of traces,
    where pulses that miss each other still pull; less those that are not worth following further.
    """
    begun = begun.take(_promising(forward.coarse, hypothesis, begun, keep))
    rough, columns = linearised(forward.coarse, hypothesis, begun.u, begun.nu, begun.places)
    rough, _, left = descend(forward.coarse, hypothesis, rough, begun.places, steps, columns)
    return Starts(rough.u, rough.nu, begun.places, rough.objective).take(~left)


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
    reach: float = np.inf,
) -> Fit:
    """The best fit from (L, p) starts; only the `keep` of lowest χ² are followed, and none for long that does
    not come to an objective of `reach`.

    With `coarse`, starts are judged, and followed for so many steps, on running integrals of the traces
    first. With `halved`, four times as many starts are followed for so many steps before they are judged.
    Without `finish` the last steps, with fresh slopes to second order, are left to `polish`.
    """
    begun = _begun(forward, u, nu, places)
    many = 4 * keep if halved else keep
    if coarse:
        begun = roughly(forward, hypothesis, begun, many, coarse)
    else:
        begun = begun.take(_promising(forward, hypothesis, begun, many))
    if halved and len(begun.u) > keep:
        near, columns = linearised(forward, hypothesis, begun.u, begun.nu, begun.places)
        near, *_ = descend(forward, hypothesis, near, begun.places, halved, columns)
        begun = replace(begun, u=near.u, nu=near.nu)
        begun = begun.take(np.sort(np.argsort(near.objective, kind="stable")[:keep]))
    u, nu, places = begun.u, begun.nu, begun.places
    now, columns = linearised(forward, hypothesis, u, nu, places)
    enough = NEARLY if now.free else SETTLED
    now, settled, _ = descend(
        forward, hypothesis, now, places, iterations, columns, enough=enough, reach=reach
    )
    order = np.argsort(now.objective, kind="stable")
    best = int(order[0])
    found = hypothesis if places is None else hypothesis.with_places(places[best])
    last = now.take([best])
    last = _finished(forward, found, last) if finish else last
    return Fit(found, last, bool(settled[best]), now.objective[order[1:]], now.nu[order[1:]], finish)


def polish(forward: Forward, one: Fit, iterations: int = ITERATIONS, finish: bool = True) -> Fit:
    """The same fit, followed further; without `finish` but for the last steps."""
    enough = NEARLY if one.normal.free else SETTLED
    now, settled, _ = descend(forward, one.hypothesis, one.normal.take([0]), None, iterations, enough=enough)
    came_to_rest = one.finished and not one.settled and one.objective - now.objective[0] < NEARLY
    if finish and came_to_rest:
        # It had run out of steps, and more lead nowhere: the last ones, and their slopes, stand.
        return replace(one, settled=bool(settled[0]))
    last = _finished(forward, one.hypothesis, now) if finish else now
    return Fit(one.hypothesis, last, bool(settled[0]), one.others, one.elsewhere, finish)


def finished(forward: Forward, one: Fit) -> Fit:
    """The same fit with the last steps taken."""
    if one.finished:
        return one
    return replace(one, normal=_finished(forward, one.hypothesis, one.normal), finished=True)


def finely(forward: Forward, one: Fit) -> Fit:
    """The same fit with the last steps taken by, and errors of, slopes over shorter steps, where data bend
    within the usual ones; as it is elsewhere, and without any effect.
    """
    if not one.hypothesis.components or not accuracy.bent(forward.experiment):
        return one
    fine = forward.finely()
    better = finished(fine, replace(one, finished=False))
    forward.simulations += fine.chains
    return better


def _finished(forward, hypothesis, now):
    """The last steps, with slopes taken afresh, those of parameters to second order: to first order they
    point a little beside the minimum.
    """
    if not (np.isfinite(now.objective[0]) and now.has_slopes[0]):
        return now
    now, columns = _rested(forward, hypothesis, now)
    if not broad.asks(hypothesis):
        return now
    wide = broad.sloped(forward, hypothesis, now, columns)
    size = sum(forward.experiment.size(run) for run in range(len(columns)))
    lower = strides.farther(forward, hypothesis, now) if strides.rough(now, wide, size) else now
    if lower is not now:
        now, columns = _rested(forward, hypothesis, lower)
        wide = broad.sloped(forward, hypothesis, now, columns)
    gross = now.objective[0] > policy.GROSS * size
    return broad.broadened(forward, hypothesis, now, wide, columns, gross)


def _rested(forward, hypothesis, now):
    """A fit after its last steps, and columns of a point nearby."""
    for _ in range(AFRESH):
        before = now.objective[0]
        fresh, columns = linearised(forward, hypothesis, now.u, now.nu, None, differences(now), True)
        now = descend(forward, hypothesis, fresh, None, LAST, columns, precise=True)[0]
        if not before - now.objective[0] > GAINED:
            break
    return now, columns


def simulated(forward: Forward, hypothesis: Hypothesis, u, nu, places=None) -> np.ndarray:
    """(L,) χ² that simulations at (L, p) coordinates and (L, q) nuisances leave, without any penalty."""
    found = forward.sampled(hypothesis, u, nu, places)
    return sum(np.square(forward.data(run) - value).sum(axis=1) for run, value in enumerate(found))


def predicted(forward: Forward, one: Fit) -> np.ndarray:
    """(data,) whitened predictions of a fit, with what nuisances take up."""
    found = forward.sampled(one.hypothesis, one.u[None], one.nu[None])
    return np.concatenate([value[0] for value in found])


def _promising(forward, hypothesis, begun, keep):
    """Starts of the lowest χ²."""
    if len(begun.u) <= keep:
        return np.arange(len(begun.u))
    chi2 = simulated(forward, hypothesis, begun.u, begun.nu, begun.places)
    chi2 = np.where(np.isfinite(chi2), chi2, np.inf) + np.square(begun.nu).sum(axis=1)
    return np.sort(np.argsort(chi2, kind="stable")[:keep])
