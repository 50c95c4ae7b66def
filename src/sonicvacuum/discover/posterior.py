"""The posterior of what was named, not as a Gaussian but as it is: weighted draws.

Draws come from the Gaussian of the fit, its tails widened (Student's t), and every one of them is simulated,
all in one batch. At each the nuisances take their best values (a quadratic of the parameters, then a step of
Gauss and Newton with the slopes of the fit, more where these promise much), and are integrated over as if
they were Gaussian there (Tierney & Kadane, J. Am. Stat. Assoc. 81, 82, 1986). The weight of a draw is what
the data make of it, over the chance to draw it; its prior is flat in the coordinates of the search. An effect
of several parameters, of which one may nearly replace the other, leaves a valley that no Gaussian fills:
draws come from along it (`fit.ridge`, `proposals`). Where few draws carry the weight (`draws.pareto_k`), what
the points of the valley weigh is told instead, or without one the profile of each parameter: all else at its
best, with slopes of its own there (`ridge.profiles`). Far from the data that best may be missed: a step that
promises less than the fit leaves is not believed, nor is a profile whose 90 % do not hold the fit itself;
there the Gaussian is told.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

import numpy as np
import scipy

from sonicvacuum.discover import proposals
from sonicvacuum.discover.draws import (
    AVERAGED,
    LINEAR,
    PLACES,
    PROFILE,
    SAMPLED,
    TRUSTED,
    VALLEY,
    Draws,
    pareto_k,
)
from sonicvacuum.discover.fit import broad, ridge
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import rivals, whereabouts
from sonicvacuum.discover.judge.rivals import Rival
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import CHUNK, Forward
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.verdict import named_effects

# Draws of several coordinates, those of one, which lie evenly, and their seed; SPARE times as many are
# proposed, for those that lie beyond the bounds.
DRAWS, OF_ONE, SEED, SPARE = 200, 96, 20061017, 16
# A profile is told by so many values; that of a Gaussian reaches so many standard errors to either side.
REACH, VALUES = 5.0, 61
# A batch of draws takes as long as so many calls of the predictor, about.
BATCH = 10
# What of a profile lies to one side of a fit that its 90 % do not hold.
TAIL = 0.05
# In χ², what a step may promise below the fit: that has settled no better.
SETTLED = 1.0
# What a step may promise, in χ², and be believed without being taken.
NEAR = 0.2
# So many of the draws for each coordinate are followed by so many steps.
FEW, STEPS = 12, 3
# What rivals make of a parameter is told where it adds such a share of its error.
NOTABLE = 0.3
# A valley is drawn from where it has so many points.
SHORTEST = 5
# What nuisances cost by themselves, in χ² above the whole of the fit, from which a point weighs nothing in
# any arithmetic and is not simulated: its chain may be one without end.
NOTHING = 1500.0
# The widest proposal, as a share of the range that is searched.
WIDEST = 0.5


def of_named(found: Investigation) -> tuple[list[Rival], list[Draws]]:
    """Rivals of what is named, which stands once for each place where its effects may sit, and what the data
    say of its parameters and places; the rivals as they are, and [], where no effect is named.
    """
    if not named_effects(found):
        return found.rivals, []
    one = found.counted or found
    every = whereabouts.among(found.rivals, one.forward, one.final)
    return every, posterior(one.forward, one.final, every)


def posterior(forward: Forward, fit: Fit, found: Sequence[Rival] = ()) -> list[Draws]:
    """Draws of every free parameter of a fit, or its profile where they are not to be trusted; [] for a fit
    without any.

    Where rivals that have a parameter make notably more of its error, its draws stand once for each of them.
    Effects that sit somewhere have their places, too, which are among the rivals (`whereabouts`).
    """
    sits = [Draws(e.id, e.places, PLACES, at, share) for e, at, share in whereabouts.of_each(found, fit)]
    return [*_parameters(forward, fit, found), *sits]


def _parameters(forward, fit, found):
    if not len(fit.u):
        return []
    bent = broad.asks(fit.hypothesis) and not fit.at_bound().any()
    around = Around(forward, fit)
    valley = _valley(around) if bent else None
    u, log_weight = _along(around, valley) if valley else _straight(around)
    weight = _normalised(log_weight)
    if pareto_k(weight) <= TRUSTED:
        drawn = [(SAMPLED, u[:, k], weight) for k in range(len(fit.u))]
    elif valley:
        drawn = [_marginal(fit, valley, k) for k in range(len(fit.u))]
    else:
        drawn = _profiles(around)
    return _told(fit, _averaged(fit, drawn, found))


def proposed(fit: Fit, count: int | None = None, seed: int = SEED) -> tuple[np.ndarray, np.ndarray]:
    """(n, p) draws within the bounds of the search, and (n,) logarithms of their density, up to a constant.

    At most `count` (None: fewer for one coordinate than for several), fewer only where nearly all of the
    Gaussian lies beyond the bounds.
    """
    p = len(fit.u)
    count = count or (OF_ONE if p == 1 else DRAWS)
    root = np.linalg.cholesky(_covariance(fit))
    if p == 1:
        scaled, log_density = proposals.student(proposals.even(SPARE * count, 1, seed))
    else:
        scaled, log_density = proposals.students(proposals.even(SPARE * count, p + 1, seed))
    u = fit.u + scaled @ root.T
    inside = _inside(fit, u, count)
    return u[inside], log_density[inside]


def _inside(fit, u, count=DRAWS):
    """Places of the first draws within the bounds."""
    low, high = _bounds(fit)
    return np.flatnonzero(((u >= low) & (u <= high)).all(axis=1))[:count]


def _straight(around):
    """(n, p) draws from the Gaussian of a fit, and (n,) logarithms of their weights."""
    u, log_proposal = proposed(around.fit)
    return u, around.log_posterior(u) - log_proposal


def _valley(around):
    """The valley of a fit; None where that is too short to draw from."""
    fit = around.fit
    covariance = broad.covariance(fit.normal)
    found = ridge.valley(around.forward, fit.hypothesis, fit.normal, covariance, around.columns)
    return found if found and len(found.t) >= SHORTEST else None


def _along(around, found):
    """The same from along its valley."""
    fit = around.fit
    u, nu, log_proposal = proposals.along(found, _covariance(fit), SPARE * DRAWS, SEED)
    inside = _inside(fit, u)
    floor = min(fit.objective, float(found.objective.min()))
    value = around.at_best(np.concatenate([u, nu], axis=1)[inside], floor)
    return u[inside], value - log_proposal[inside]


def _bounds(fit):
    """Lowest and highest coordinates, the fit's own among them."""
    low, high = np.array([(c.low, c.high) for c in fit.hypothesis.coordinates]).T
    return np.minimum(low, fit.u), np.maximum(high, fit.u)


def _covariance(fit):
    """(p, p) of the coordinates, nuisances fitted; none wider than a share of its range."""
    p = len(fit.u)
    low, high = _bounds(fit)
    own = fit.covariance[:p, :p]
    sigma = np.sqrt(np.maximum(np.diag(own), 1e-16))
    less = np.minimum(1.0, WIDEST * (high - low) / sigma)
    return own * np.outer(less, less) + 1e-12 * np.diag(np.square(less * sigma)) + 1e-24 * np.eye(p)


@dataclass(frozen=True)
class Around:
    """The misfit around a fit, and its nuisances at their best, with the slopes of the fit."""

    forward: Forward
    fit: Fit

    @cached_property
    def columns(self):
        """Of the fit, for each run (`Forward.columns`)."""
        return self.forward.columns(self.fit.hypothesis, self.fit.u[None], self.fit.nu[None])

    @cached_property
    def inner(self):
        """(q, q) covariance of the nuisances, coordinates held."""
        p = len(self.fit.u)
        return np.linalg.pinv(self.fit.normal.total()[1][0][p:, p:], hermitian=True)

    def log_posterior(self, u: np.ndarray) -> np.ndarray:
        """(n,) logarithm, up to a constant, at (n, p) coordinates; nuisances at their best.

        −inf where nothing can be simulated.
        """
        fit, p = self.fit, len(self.fit.u)
        away = u - fit.u
        hessian = fit.normal.total()[1][0]
        point = np.concatenate([u, fit.nu - away @ (self.inner @ hessian[p:, :p]).T], axis=1)
        return self.at_best(self.bent(point, away), fit.objective)

    def at_best(self, point, floor):
        """(n,) logarithm of the posterior at (n, p + q) points, nuisances at their best: steps are taken from
        those that promise much, and what is promised at the last is believed, unless it has been tried.

        Nothing is better than `floor`: steps that promise so overreach, and what they start from is counted.
        """
        point, p = point.copy(), len(self.fit.u)
        objective, gradient = self.misfit(point)
        promise = self._promise(gradient)
        going = np.flatnonzero(np.isfinite(objective) & (promise > NEAR))
        for _ in range(STEPS):
            if not len(going):
                break
            further = point[going]
            further[:, p:] += gradient[going, p:] @ self.inner
            there, slopes = self.misfit(further)
            lower = there < objective[going]
            promise[going[~lower]] = 0.0
            going = going[lower]
            point[going], objective[going], gradient[going] = further[lower], there[lower], slopes[lower]
            promise[going] = self._promise(gradient[going])
            going = going[promise[going] > NEAR]
        left = np.where(objective - promise < floor - SETTLED, objective, objective - promise)
        value = -0.5 * np.maximum(left, floor)
        return np.where(np.isfinite(value), value, -np.inf)

    def _promise(self, gradient):
        """(n,) by how much a step of Gauss and Newton lowers χ², by its own account."""
        own = gradient[:, len(self.fit.u) :]
        return np.einsum("ln,nm,lm->l", own, self.inner, own)

    def bent(self, point, away):
        """Points with nuisances off the linearised ones by a quadratic of (n, p) `away`, which is nothing at
        the fit, through a few points that are followed to their minima.
        """
        p = len(self.fit.u)
        few = np.unique(np.linspace(0, len(point) - 1, FEW * p).astype(int))
        best, sound = point[few], np.ones(len(few), dtype=bool)
        for _ in range(STEPS):
            step = self.misfit(best)[1][:, p:] @ self.inner
            sound &= np.isfinite(step).all(axis=1)
            best[sound, p:] += step[sound]
        away = away / np.maximum(np.abs(away).max(axis=0), 1e-300)
        basis = np.concatenate([away, np.square(away)], axis=1)
        off = basis @ np.linalg.lstsq(basis[few[sound]], (best - point[few])[sound, p:], rcond=1e-9)[0]
        return np.concatenate([point[:, :p], point[:, p:] + off], axis=1)

    def misfit(self, point):
        """(n,) χ² and the penalty of the nuisances, and (n, p + q) minus half its slopes at (n, p + q)
        points, a batch at a time; infinite and no numbers where the penalty alone excludes it.
        """
        p, fit, forward, columns = len(self.fit.u), self.fit, self.forward, self.columns
        low, high = _bounds(fit)
        u, nu = point[:, :p].clip(low, high), point[:, p:]
        objective, gradient = np.square(nu).sum(axis=1), np.concatenate([np.zeros_like(u), -nu], axis=1)
        possible = np.flatnonzero(objective < fit.objective + NOTHING)
        objective[np.setdiff1d(np.arange(len(u)), possible)] = np.inf
        gradient[~np.isfinite(objective)] = np.nan

        def seen(branch, part):
            misfit, slopes = np.zeros(len(part)), np.zeros((len(part), gradient.shape[1]))
            for run, value in enumerate(branch.sampled(fit.hypothesis, u[part], nu[part])):
                left = branch.data(run) - value
                misfit += np.square(left).sum(axis=1)
                own = np.concatenate([np.arange(p), p + branch.local(run)])
                slopes[:, own] += left @ columns[run][0, 1:].T
            return misfit, slopes

        # Of a record of very many runs one draw at a time.
        batches = min(len(possible), -(-len(possible) * forward.layout.runs // CHUNK))
        parts = np.array_split(possible, batches) if batches else []
        for part, (misfit, slopes) in zip(
            parts, abreast.each(forward, seen, parts, calls=BATCH), strict=True
        ):
            objective[part] += misfit
            gradient[part] += slopes
        return objective, gradient


def _marginal(fit, valley, k):
    """How one coordinate is told, its values within bounds and their weights, by its valley alone."""
    low, high = _bounds(fit)
    u, weight = proposals.marginal(valley, _covariance(fit), k, VALUES)
    weight = np.where((u >= low[k]) & (u <= high[k]), weight, 0.0)
    return VALLEY, u, weight / weight.sum()


def _profiles(around):
    """How each coordinate is told, its values and their weights."""
    fit = around.fit
    sigma = np.sqrt(np.diag(_covariance(fit)))
    found = ridge.profiles(around.forward, fit.hypothesis, fit.normal, sigma, around.columns)
    return [_profile(fit, k, sigma[k], *one) for k, one in enumerate(found)]


def _profile(fit, k, sigma, at, objective):
    """The same of one, from places along its profile and χ² there."""
    low, high = _bounds(fit)
    if len(at) > 1:
        u = np.linspace(at[0], at[-1], VALUES)
        weight = _normalised(-0.5 * scipy.interpolate.PchipInterpolator(at, objective)(u))
        below = float(weight[u < fit.u[k]].sum())
        if TAIL < below < 1.0 - TAIL or fit.at_bound()[k]:
            return PROFILE, u, weight
    u = np.linspace(max(low[k], fit.u[k] - REACH * sigma), min(high[k], fit.u[k] + REACH * sigma), VALUES)
    return LINEAR, u, _normalised(-0.5 * np.square((u - fit.u[k]) / sigma))


def _averaged(fit, drawn, found):
    """How coordinates are told, values and weights, with what rivals make of them."""
    low, high = _bounds(fit)
    result = []
    for k, ((how, u, weight), (share, off)) in enumerate(zip(drawn, rivals.shifts(fit, found), strict=True)):
        if share @ np.square(off) > (NOTABLE * fit.sigma[k]) ** 2:
            u = (u + off[:, None]).clip(low[k], high[k]).ravel()
            how, weight = AVERAGED, np.outer(share, weight).ravel()
        result.append((how, u, weight))
    return result


def _normalised(log_weight):
    """Weights that sum to 1; all alike where none is possible."""
    most = log_weight.max()
    weight = np.exp(log_weight - most) if np.isfinite(most) else np.ones_like(log_weight)
    return weight / weight.sum()


def _told(fit, found):
    """The draws of all coordinates in the units of their parameters."""
    owners = chain.from_iterable([c.effect.id] * len(c.free) for c in fit.hypothesis.components)
    return [
        Draws(effect, c.parameter.name, how, c.value(u), weight)
        for effect, c, (how, u, weight) in zip(owners, fit.hypothesis.coordinates, found, strict=True)
    ]
