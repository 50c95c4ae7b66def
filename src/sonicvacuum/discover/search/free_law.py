"""The free-form contact law fitted to what nothing of the catalogue explains.

Sets of coefficients are tried: what stores energy, what takes it in proportion to the rate, both, and all.
The width of the prior, which regularises, is the likeliest of a few, by the evidence of the linearised model
(MacKay, Neural Comput. 4, 415, 1992). Of the sets, the smallest is taken that does nearly as much as the
likeliest: no polynomial is the true law, and what it errs by is no reason for more of it. A law is kept where
it is surely likelier than none and closes, on runs left out of its fit, a good share of what was left.
"""

import math
from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.free_law import Scales, of_some, scales_of, with_law
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis
from sonicvacuum.effects.free_form import COEFFICIENTS, EFFECT

# Sets of coefficients in the order in which they are tried, see `effects.free_form.SHAPES`.
_ELASTIC, _LOSSY = ("a0", "a3", "a6"), ("a1", "a4", "a7", "a9", "a10")
SETS = (_ELASTIC, _LOSSY, (*_ELASTIC, *_LOSSY), COEFFICIENTS)
# Widths of the prior that are compared; the first fit is made with the middle one.
WIDTHS = (0.03, 0.1, 0.3, 1.0)
FIRST = 0.3


@dataclass(frozen=True)
class FreeLaw:
    """A free-form law as fitted, beside the named effects.

    Attributes:
        forward: with the law among the nuisances.
        fit: there.
        scales: of the law's arguments.
        names: of the coefficients that are free.
        width: of their prior.
        log_bayes: log evidence against the model without the law.
        held_out: (R,) χ² of every run, the law fitted to the others; NaN where there is only one run.
        held_out_before: (R,) the same without the law.
    """

    forward: Forward
    fit: Fit
    scales: Scales
    names: tuple[str, ...]
    width: float
    log_bayes: float
    held_out: np.ndarray
    held_out_before: np.ndarray

    @property
    def coefficients(self) -> np.ndarray:
        """(n,) values of the free coefficients."""
        return self.fit.nu[self.places] * self.width

    @property
    def covariance(self) -> np.ndarray:
        """(n, n) of them."""
        at = len(self.fit.u) + self.places
        return self.fit.covariance[np.ix_(at, at)] * self.width**2

    @property
    def places(self) -> np.ndarray:
        """(n,) where they stand among the nuisances."""
        return np.array(self.forward.layout.other("law"))

    @property
    def parameters(self) -> dict[str, float]:
        """Parameters of the effect."""
        return self.scales.parameters | dict(zip(self.names, map(float, self.coefficients), strict=True))

    @property
    def component(self) -> Component:
        """The law as an effect with nothing free."""
        return Component(EFFECT, (), self.parameters)


def free_law(forward: Forward, base: Fit) -> FreeLaw | None:
    """The free-form law beside the effects of a fit; None where it does not earn its place.

    Args:
        forward: of the experiment, without a law of this kind.
        base: the fit that leaves something.
    """
    e = forward.experiment
    if not any(run.has_signals for run in e.runs):
        return None
    typical = scales_of(e)
    best, tried = None, []
    for names in SETS:
        one = _fitted(forward, base, names, typical, best)
        if one is not None:
            tried.append(one)
            best = max(tried, key=lambda t: t[0])
    if best is None or best[0] < policy.LAW_LOG_BAYES:
        return None
    most = base.objective - best[2].objective
    if most <= 0.0:  # nuisances that are hardly known can carry evidence where nothing is gained
        return None
    evidence_, width, found, model = next(
        t for t in tried if base.objective - t[2].objective >= policy.LAW_SHARE * most
    )
    size = sum(e.size(k) for k in range(len(e.runs)))
    left, before = float(found.normal.chi2.sum()) - size, float(base.normal.chi2.sum()) - size
    if left > (1.0 - policy.LAW_CLOSES) * before:
        return None
    names = _names(model)
    unseen = _unseen(forward, base, names, width, typical, found.nu[-len(names) :] * width)
    result = FreeLaw(model, found, typical, names, width, evidence_, *unseen)
    size = np.array([e.size(k) for k in range(len(e.runs))])
    if len(e.runs) > 1:
        after, before = float((unseen[0] - size).sum()), float((unseen[1] - size).sum())
        if not after < (1.0 - policy.LAW_CLOSES) * before:
            return None
    return result


def _fitted(forward, base, names, typical, known):
    """(log evidence against none, width, fit, forward) of one set of coefficients.

    It starts where the best set `known` before it ended, of those coefficients that both have.
    """
    e, threads = forward.experiment, forward.threads
    start = np.zeros(len(names))
    if known is not None:
        _, scale, one, model = known
        values = dict(zip(_names(model), scale * one.nu[model.layout.other("law")], strict=True))
        start = np.array([values.get(name, 0.0) for name in names])
    first = _at(e, base, names, FIRST, typical, threads, start)
    if first is None:
        return None
    values = {w: _evidence(first[0], FIRST, w, len(names)) for w in WIDTHS}
    width = max(values, key=values.get)
    found = first
    if width != FIRST:
        found = _at(e, base, names, width, typical, threads, first[0].nu[-len(names) :] * FIRST)
    if found is None:
        return None
    own = _evidence(found[0], width, width, len(names)) - _evidence(base, 1.0, 1.0, 0)
    return own, width, *found


def _names(forward):
    """Coefficients that are free in a forward model."""
    return tuple(one.of for one in forward.experiment.shared if one.kind == "law")


def _at(experiment: Experiment, base: Fit, names, width, typical, threads, law):
    """Fit and forward model with a prior of one width, from coefficients `law` on.

    None where the chain, or one beside it, cannot be simulated.
    """
    forward = Forward(with_law(experiment, names, width, typical), threads)
    found = fit(forward, base.hypothesis, base.u[None], np.concatenate([base.nu, law / width])[None])
    known = math.isfinite(found.objective) and found.normal.has_slopes[0]
    return (found, forward) if known else None


def _evidence(one: Fit, fitted: float, width: float, count: int) -> float:
    """Log evidence of a fit whose last `count` nuisances have the prior `width`, fitted at another one.

    Quadratic around the fit; up to a constant of the data and of what both models share.
    """
    gradient, hessian = (part[0].copy() for part in one.normal.total())
    n = len(gradient)
    law = np.arange(n - count, n)
    more = (fitted / width) ** 2 - 1.0
    law_nu = one.nu[len(one.nu) - count :] if count else np.zeros(0)
    hessian[law, law] += more
    gradient[law] -= more * law_nu
    drop = gradient @ np.linalg.solve(hessian + 1e-9 * np.diag(np.diag(hessian)), gradient)
    objective = one.objective + more * float(law_nu @ law_nu) - drop
    return -0.5 * objective - 0.5 * np.linalg.slogdet(hessian)[1] + count * math.log(fitted / width)


def _unseen(forward, base, names, width, typical, law):
    """(R,) χ² of runs left out of the law's fit, which starts at `law`, and of the same without the law."""
    e = forward.experiment
    runs = len(e.runs)
    if runs < 2:
        return np.full(runs, math.nan), np.full(runs, math.nan)
    after, before = [], []
    for run in range(runs):
        others = of_some(e, [k for k in range(runs) if k != run])
        learned = _at(others, base, names, width, typical, forward.threads, law)
        alone = Forward(of_some(e, [run]), forward.threads)
        before.append(_chi2(alone, base.hypothesis, base))
        if learned is None:
            after.append(before[-1])
            continue
        values = learned[0].nu[-len(names) :] * width
        given = typical.parameters | dict(zip(names, map(float, values), strict=True))
        after.append(_chi2(alone, base.hypothesis.with_component(Component(EFFECT, (), given)), base))
    return np.array(after), np.array(before)


def _chi2(forward, hypothesis: Hypothesis, base):
    """χ² of what counts, the model's effects held as found and the nuisances free."""
    held = Hypothesis(tuple(_held(hypothesis, base)))
    one = fit(forward, held, np.zeros((1, 0)), base.nu[None])
    return float(one.normal.chi2.sum())


def _held(hypothesis, base):
    """Components with nothing free: those of the base as fitted, others as they are."""
    values = base.hypothesis.values(base.u)
    for c in hypothesis.components:
        fixed = values.get(c.effect.id, c.fixed)
        yield Component(c.effect, (), {k: v for k, v in fixed.items() if k != c.effect.places}, c.place)
