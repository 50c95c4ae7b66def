"""How probable each explanation is: evidence by Laplace's approximation, relative to the nominal model.

Priors. `none` and `unknown` have the weights below, the effects share the rest alike. The strength of an
effect is given a prior flat in log d′, the same for all effects (d′ its size in the data, in standard
errors): ranges of physical parameters are arbitrary, and would otherwise decide between effects that fit
alike. Parameters that shape an effect, or that the record states, are flat over their bounds, places are
equally likely. Each enters as an Occam factor, never above 1.

Unknown. A model that leaves a residual with p-value p is worth at most 1/(−e p ln p) of what fits
(Sellke, Bayarri & Berger, Am. Stat. 55, 62, 2001); that bound is the weight of `unknown` against the best of
the rest. Last, all are calibrated (`calibration`).
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.fit.calibration import Calibration, of_package
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.effects import IDS

PRIOR_NONE, PRIOR_UNKNOWN = 0.3, 0.1
# Range of d′ of the prior.
WEAK, STRONG = 1.0, 100.0
_UNKNOWN_ODDS = 0.1


@dataclass(frozen=True)
class Candidate:
    """One effect as fitted.

    Attributes:
        effect: id.
        fit: the best of its fits.
        gain: Δχ² (nuisance penalties included) against the nominal model.
        log_bayes: natural log of the Bayes factor against it.
        flags: what to doubt: "bound", "beyond" (the range of the catalogue), "unsettled".
        instead: (log of its weight over that of `fit`, fit) with others of the effect's strengths free.
    """

    effect: str
    fit: Fit
    gain: float
    log_bayes: float
    flags: tuple[str, ...] = ()
    instead: tuple[tuple[float, Fit], ...] = ()

    @property
    def ways(self) -> list[tuple[float, Fit]]:
        """(share, fit) of its fits, the best first: one of an effect's strengths may do what another does."""
        logs = np.array([0.0, *(log for log, _ in self.instead)])
        shares = np.exp(logs - np.logaddexp.reduce(logs))
        return list(zip(shares.tolist(), [self.fit, *(one for _, one in self.instead)], strict=True))


@dataclass(frozen=True)
class Combination:
    """Several effects as fitted together.

    Attributes:
        effects: ids, in the order in which they were added.
        fit: the best of its fits.
        gain: Δχ² (nuisance penalties included) against the nominal model.
        log_bayes: natural log of the Bayes factor against it.
    """

    effects: tuple[str, ...]
    fit: Fit
    gain: float
    log_bayes: float


def occam_strength(gain: float, two_sided: bool) -> float:
    """Log of the Occam factor of a strength whose d′ is √Δχ²: √(2π) σ times the prior density."""
    size = math.sqrt(max(gain, WEAK))
    factor = math.sqrt(2.0 * math.pi) / (size * math.log(STRONG / WEAK) * (2.0 if two_sided else 1.0))
    return math.log(min(1.0, factor))


def occam_shape(fit: Fit, k: int) -> float:
    """Log of the Occam factor of a parameter with a flat prior over its bounds."""
    c = fit.hypothesis.coordinates[k]
    sigma = fit.sigma[k]
    share = math.sqrt(2.0 * math.pi) * sigma / (c.high - c.low) if np.isfinite(sigma) and sigma > 0.0 else 1.0
    return math.log(min(1.0, max(share, 1e-6)))


def occam(fit: Fit, gain: float, shapes: bool = True) -> float:
    """Log of the product of the Occam factors of all parameters of a fit; places aside."""
    total = 0.0
    for k, c in enumerate(fit.hypothesis.coordinates):
        if c.parameter.known:
            total += occam_shape(fit, k)
        elif c.parameter.switches:
            total += occam_strength(gain, c.two_sided)
        elif shapes:
            total += occam_shape(fit, k)
    return total


def log_bayes(fit: Fit, gain: float, alike: np.ndarray | None = None) -> float:
    """Log Bayes factor of a fit against the nominal model.

    Args:
        fit: best fit.
        gain: its Δχ².
        alike: (n,) Δχ² of the effect at each place and shape it may have, the best one's included; their
            likelihoods are averaged. None: a shape has the Occam factor of Laplace's approximation.
    """
    total = 0.5 * (gain if gain < -1.0 else max(gain, 0.0)) + occam(fit, gain, alike is None)
    if alike is not None:
        total += math.log(np.exp(0.5 * (alike - alike.max())).mean())
    return total


def ranked(found: Iterable[Candidate], odds: Mapping[str, float] | None = None) -> list[Candidate]:
    """Candidates by prior times evidence, best first; `odds` as in `log_weights`, none of them 0."""
    return sorted(found, key=lambda c: -c.log_bayes - math.log((odds or {}).get(c.effect, 1.0)))


def unknown_odds(p: float) -> float:
    """Odds of `unknown` against the best named explanation whose residual has p-value p."""
    p = max(p, 1e-300)
    bound = 1.0 / (-math.e * p * math.log(p)) if p < 1.0 / math.e else 0.1
    return _UNKNOWN_ODDS * bound


def log_weights(log_bayes: Mapping[str, float], odds: Mapping[str, float] | None = None) -> dict[str, float]:
    """Log of prior times evidence of none and of every effect in `log_bayes` (natural logs).

    `odds`: id → prior odds against the catalogue's usual prior, 1 where not given; 0 leaves the effect out.
    An effect of the user's own has the usual prior of the project's effects, whatever their number.
    """
    usual = (1.0 - PRIOR_NONE - PRIOR_UNKNOWN) / len(IDS)
    prior = {name: usual * (odds or {}).get(name, 1.0) for name in log_bayes}
    weights = {name: math.log(prior[name]) + value for name, value in log_bayes.items() if prior[name] > 0.0}
    return {"none": math.log(PRIOR_NONE)} | weights


def before_data(effects: Iterable[str], odds: Mapping[str, float] | None = None) -> dict[str, float]:
    """Probability of none, unknown and effects where nothing was measured: the prior."""
    logs = log_weights(dict.fromkeys(effects, 0.0), odds) | {"unknown": math.log(PRIOR_UNKNOWN)}
    total = np.logaddexp.reduce(list(logs.values()))
    return {name: math.exp(log - total) for name, log in logs.items()}


def probabilities(
    candidates: list[Candidate],
    residual_p: float,
    calibration: Calibration | None = None,
    odds: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """Probability of none, unknown and every single effect; they sum to 1.

    `residual_p` is the p-value of the residual of the most probable of them; `calibration` that of the
    package where not given; `odds` those of `log_weights`.
    """
    logs = log_weights({c.effect: c.log_bayes for c in candidates}, odds)
    found = (calibration or of_package()).probabilities(logs, math.log(unknown_odds(residual_p)))
    own = sorted(name for name in found if name not in ("none", "unknown", *IDS))
    return {name: found[name] for name in ("none", "unknown", *IDS, *own) if name in found}
