"""Explanations weighed beside a misfit that is large beside the noise.

What is left is taken as noise of unknown size: with n independent pieces of it, an explanation has the
likelihood exp(−½ n ln χ²), that of Gaussian noise at its best standard deviation. n counts samples by their
correlation for an estimate of a variance (Bayley & Hammersley, J. R. Stat. Soc. Suppl. 8, 184, 1946), and
runs by how much of a systematic error they share. What a fit strains of what the record states counts
besides, as it is: one that takes a modulus known to 5 % to half of it explains nothing, however little that
is beside χ². Only where walls or speeds are hardly known it counts as χ² does: there moduli and speeds make
up for each other and for all that is missing.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import evidence, wide
from sonicvacuum.discover.fit.evidence import Combination
from sonicvacuum.discover.fit.normal import linearise
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import explanations
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import singles
from sonicvacuum.effects import Setup


def pieces(forward: Forward, fit: Fit) -> float:
    """Number of independent pieces of what a fit leaves, over all gauges of all runs; 1 at least."""
    e, total = forward.experiment, 0.0
    found = forward.sampled(fit.hypothesis, fit.u[None], fit.nu[None])
    for run, value in enumerate(found):
        left, samples = forward.data(run) - value[0], len(e.runs[run].time)
        total += sum(_pieces(left[s * samples : (s + 1) * samples]) for s in range(len(e.gauges)))
        total += len(e.runs[run].scalars)
    runs = sum(r.has_signals for r in e.runs)
    return max(1.0, total / (1.0 + policy.SMOOTH_SHARED * max(0, runs - 1)))


def _pieces(left: np.ndarray) -> float:
    """Number of independent values in one trace (T,), for an estimate of its variance."""
    samples, power = len(left), float(left @ left)
    if not power > 0.0:
        return 0.0
    padded = np.fft.rfft(left, 2 * samples)
    correlation = np.fft.irfft(np.abs(padded) ** 2)[:samples] / power
    return samples / (1.0 + 2.0 * float(np.square(correlation[1:]).sum()))


def widened(forward: Forward, null: Fit, fit: Fit) -> tuple[Forward, Fit, Fit]:
    """The predictor, the nominal fit and a fit with errors as what is left makes them: its χ² spread over its
    independent pieces.
    """
    e = forward.experiment
    wider = _wider(fit, pieces(forward, fit))
    view = forward.of(replace(e, sigma=wider**0.5 * e.sigma))
    there = Fit(fit.hypothesis, linearise(view, fit.hypothesis, fit.u[None], fit.nu[None]))
    return view, Fit(null.hypothesis, linearise(view, null.hypothesis, null.u[None], null.nu[None])), there


def _wider(fit: Fit, count: float) -> float:
    """Variance over that of the noise alone, as what a fit leaves in so many `pieces` makes it."""
    return max(1.0, float(fit.normal.chi2.sum()) / count)


def weighed(forward: Forward, null: Fit, found: Iterable[Combination]) -> list[Combination]:
    """Explanations with the evidence that they have where what is left is noise of unknown size."""
    found = list(found)
    best = min((c.fit for c in found), key=lambda f: f.objective)
    count = pieces(forward, best)
    prior = _prior(forward, _wider(best, count))
    nothing = prior.misfit(null, count)
    return [_weighed(c, nothing - prior.misfit(c.fit, count)) for c in found]


def prior_beside(forward: Forward, fit: Fit) -> "Prior":
    """The prior beside what a fit leaves, taken as noise."""
    return _prior(forward, _wider(fit, pieces(forward, fit)))


def _prior(forward: Forward, wider: float) -> "Prior":
    """The prior beside noise of `wider` times the variance; where much is hardly known it widens alike."""
    return Prior(wider, 1.0 / wider if wide.wide(forward) else 1.0)


@dataclass(frozen=True)
class Prior:
    """The nuisances' prior beside what is left taken as noise.

    Attributes:
        wider: variance of that noise over the stated one.
        weight: of the nuisances' squares.
    """

    wider: float
    weight: float

    def misfit(self, fit: Fit, count: float) -> float:
        """n ln χ² and the penalty, see `relaxed`."""
        chi2, penalty = self.relaxed(fit)
        return count * float(np.log(max(chi2, 1e-300))) + penalty

    def relaxed(self, fit: Fit) -> tuple[float, float]:
        """χ² and the penalty of the nuisances where they are best for that noise: in the linearised model,
        coordinates at their bounds held.
        """
        p = fit.normal.free
        gradient = fit.normal.gradient.sum(axis=0)[0]
        slope = gradient / self.wider
        slope[p:] -= self.weight * fit.nu
        free = np.flatnonzero(np.concatenate([~fit.at_bound(), np.ones(len(fit.nu), dtype=bool)]))
        step = np.zeros(len(slope))
        step[free] = np.linalg.lstsq(self.hessian(fit)[np.ix_(free, free)], slope[free], rcond=1e-12)[0]
        curved = step @ fit.normal.hessian.sum(axis=0)[0] @ step
        chi2 = float(fit.normal.chi2.sum() - 2.0 * gradient @ step + curved)
        return chi2, self.weight * float(np.square(fit.nu + step[p:]).sum())

    def hessian(self, fit: Fit) -> np.ndarray:
        """(n, n) of half the objective."""
        own = np.concatenate([np.zeros(fit.normal.free), np.ones(len(fit.nu))])
        return fit.normal.hessian.sum(axis=0)[0] / self.wider + np.diag(self.weight * own)

    def sigma(self, fit: Fit) -> np.ndarray:
        """(p,) standard errors of the coordinates."""
        covariance = np.linalg.pinv(self.hessian(fit), hermitian=True)
        return np.sqrt(np.maximum(np.diag(covariance)[: fit.normal.free], 1e-300))

    def strains(self, less: Fit, fit: Fit) -> bool:
        """Whether to do with less strains what is well known far more than a fit does."""
        return self.relaxed(less)[1] - self.relaxed(fit)[1] > singles.STRAINED**2


def _weighed(c: Combination, gain: float) -> Combination:
    # Each switch is worth what its effect gains on the average; places have their price already.
    places = c.log_bayes - evidence.log_bayes(c.fit, c.gain) if len(c.effects) > 1 else 0.0
    worth = 0.5 * gain + evidence.occam(c.fit, max(gain, 0.0), False) + min(places, 0.0)
    return Combination(c.effects, c.fit, c.gain, worth)


def shares(weights: dict[str, float]) -> dict[str, float]:
    """Effect → probability that it is there, by the log weights of all explanations."""
    logs = np.array(list(weights.values()))
    odds = np.exp(logs - logs.max())
    odds /= odds.sum()
    names = dict.fromkeys(n for key in weights for n in explanations.effects(key))
    return {
        name: float(sum(p for key, p in zip(weights, odds, strict=True) if name in explanations.effects(key)))
        for name in names
    }


def loss_share(weights: Mapping[str, float], setup: Setup) -> float:
    """Probability that one effect at least takes energy, by the log weights of all explanations."""
    known = setup.catalogue

    def loses(key):
        return any(name in known and known.effect(name).dissipative for name in explanations.effects(key))

    total = np.logaddexp.reduce(list(weights.values()))
    return float(sum(np.exp(value - total) for key, value in weights.items() if loses(key)))


def merged(weights: dict[str, float], named: Iterable[str]) -> dict[str, float]:
    """Log weights in which explanations that have all that is named, and more, count as that with something
    unknown; the others as they are.
    """
    own = set(named)
    within = [key for key in weights if own <= set(explanations.effects(key))]
    whole = float(np.logaddexp.reduce([weights[key] for key in within]))
    return {key: value for key, value in weights.items() if key not in within} | {
        explanations.key(own): whole
    }
