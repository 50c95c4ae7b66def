"""Leave one run out: what a model fitted to the other runs leaves of the one it has not seen.

In the linearised model at the fit to all runs this is algebra: the run's share is taken out of the normal
equations, the parameters move, and on the run left out only the nuisances may follow, held by what the other
runs say of them. Where the others alone do not show an effect, nothing has been learned from them: there the
nominal model predicts.
"""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.fit.normal import Normal
from sonicvacuum.discover.fit.refit import Fit

# Share of the log likelihood that an effect gains on all runs which it may lose on runs left out.
SMALL = 0.05


@dataclass(frozen=True)
class HeldOut:
    """(R,) χ² of each run when it was left out, and the number of its data."""

    chi2: np.ndarray
    size: np.ndarray

    @property
    def mean(self) -> float:
        """χ² per datum over all runs."""
        return per_datum(self.chi2.sum(), self.size.sum())


def per_datum(chi2: float, size: int) -> float:
    """χ² per datum; that of noise, 1, where there are no data, as of runs that were never struck."""
    return float(chi2) / float(size) if size else 1.0


def held_out(fit: Fit, sizes: np.ndarray, nominal: HeldOut | None = None) -> HeldOut:
    """Every run of a fit left out once; `sizes` (R,) are numbers of data, `nominal` what the nominal model
    leaves, for runs without which no effect is seen.

    All that a model without effects has may follow on the run left out, so that it leaves what its fit left.
    (Algebra says so only of a fit that has settled: one far from the data is held to what the record states.)
    """
    if not fit.normal.free:
        return HeldOut(fit.normal.chi2[:, 0], np.asarray(sizes))
    chi2 = np.array([_without(fit.normal, run) for run in range(len(sizes))])
    if nominal is not None:
        chi2 = np.where([_seen_without(fit, run) for run in range(len(sizes))], chi2, nominal.chi2)
    return HeldOut(chi2, np.asarray(sizes))


def _seen_without(fit: Fit, run: int) -> bool:
    """Whether the other runs show every effect of a fit, by a deviation above its standard error."""
    _, hessian = fit.normal.total()
    free = fit.normal.free
    others = hessian[0] - fit.normal.hessian[run, 0]
    cross, rest = others[:free, free:], others[free:, free:]
    # What the others say of the parameters, nuisances fitted (the complement of Schur).
    known = np.diag(others[:free, :free] - cross @ np.linalg.solve(rest, cross.T)) if free else np.zeros(0)
    error = np.maximum(known, 1e-300) ** -0.5
    return all(strength >= 1.0 for strength in fit.hypothesis.strengths(fit.u, error))


def _without(normal: Normal, run: int) -> float:
    gradient, hessian = (part[0] for part in normal.total())
    own_gradient, own = normal.gradient[run, 0], normal.hessian[run, 0]
    others, slope = hessian - own, gradient - own_gradient
    moved = np.linalg.lstsq(others, slope, rcond=1e-12)[0]
    free = normal.free
    # On the run itself: minimise χ²_run + (δ − moved)ᵀ others (δ − moved) over the nuisances, parameters at
    # `moved`.
    rest = slice(free, None)
    matrix = own[rest, rest] + others[rest, rest]
    right = own_gradient[rest] - own[rest, :free] @ moved[:free] + others[rest, rest] @ moved[rest]
    moved[rest] = np.linalg.lstsq(matrix, right, rcond=1e-12)[0]
    value = normal.chi2[run, 0] - 2.0 * own_gradient @ moved + moved @ own @ moved
    return float(max(value, 0.0))


def predictive(fit: Fit) -> np.ndarray:
    """(R,) log predictive density of each run given the others, up to a constant of the data.

    Unlike the χ² left, it allows for what the other runs leave open: log p(y_r | y_-r) in the linearised
    model, parameters having a wide Gaussian prior (`_width`).
    """
    normal = fit.normal
    gradient, hessian = (part[0] for part in normal.total())
    hessian = hessian + np.diag([*(1.0 / np.square(_width(fit))), *np.zeros(len(fit.nu))])
    whole = np.linalg.slogdet(hessian)[1]
    result = []
    for run in range(len(normal.chi2)):
        others, slope = hessian - normal.hessian[run, 0], gradient - normal.gradient[run, 0]
        drop = slope @ np.linalg.solve(others, slope)
        result.append(-0.5 * (normal.chi2[run, 0] + drop + whole - np.linalg.slogdet(others)[1]))
    return np.array(result)


def _width(fit):
    """(p,) width of the prior of each coordinate."""
    return np.array(
        [
            2.0 if c.endless else 2.0 * abs(u) + 1e-3
            for c, u in zip(fit.hypothesis.coordinates, fit.u, strict=True)
        ]
    )


def better(before: Fit, after: Fit, room: float = 6.0, even: float = 2.0, share: float = 0.0) -> bool:
    """Whether a model predicts unseen runs better, in sum and none of them much worse.

    `room` is the log density by which one run may be worse, or a `share` of what all gain together: while
    other effects are still missing, one that is there makes up for them in each run by another size. An
    effect that does what a nuisance does, beyond that one's stated error (a modulus, a gain), predicts as the
    nuisance let loose does: in sum `even` may be lost, or a small share of what all runs together gain by it.
    With a single run there is nothing to hold out.
    """
    gain = predictive(after) - predictive(before)
    room = max(room, share * float(gain.sum()))
    even = max(even, SMALL * 0.5 * (before.objective - after.objective))
    return len(gain) < 2 or bool(gain.sum() > -even and gain.min() > -room)
