"""The free-form contact law fitted to what nothing of the catalogue explains.

Its coefficients come in groups: what stores energy, what takes it in proportion to the rate, what stiffens
with the rate either way, and both of the latter as the root of the rate. From none on, the group that is
worth most is added as long as it takes away enough of what is left: no polynomial is the true law, and what
it errs by is no reason for more of it. The width of the prior, which regularises, is the likeliest of a few,
by the evidence of the linearised model (MacKay, Neural Comput. 4, 415, 1992). A law is kept where it is
surely likelier than none and closes, on runs left out of its fit, a good share of what was left.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit.reach import Reach, reach
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.free_law import Scales, of_some, scales_of, with_law
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis
from sonicvacuum.effects.free_form import EFFECT

# Groups of coefficients, see `effects.free_form.SHAPES`.
GROUPS = (
    ("a0", "a3", "a6"),
    ("a1", "a4", "a7", "a9", "a10"),
    ("a2", "a5", "a8"),
    ("a11", "a12"),
    ("a13", "a14"),
)
# Widths of the prior that are compared; the first fit is made with the middle one.
WIDTHS = (0.03, 0.1, 0.3, 1.0)
FIRST = 0.3
# A group more starts where the law without it ended; a fit that ends this much higher (its prior's width is
# another one) has lost its way.
_UPHILL = 10.0


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
        reach: how far contacts went in the data; None until the law is kept.
    """

    forward: Forward
    fit: Fit
    scales: Scales
    names: tuple[str, ...]
    width: float
    log_bayes: float
    held_out: np.ndarray
    held_out_before: np.ndarray
    reach: Reach | None = None

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
        """Parameters of the effect; once kept, it stays what it is at the end of its reach beyond that."""
        own = self.scales.parameters | (self.reach.parameters if self.reach else {})
        return own | dict(zip(self.names, map(float, self.coefficients), strict=True))

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
    for one in reversed(_grown(forward, base, scales_of(e))):
        # Nuisances that are hardly known can carry evidence where nothing is gained.
        worth = one.log_bayes > policy.LAW_LOG_BAYES and one.fit.objective < base.objective
        if worth and _closes(_left(e, one.fit), _left(e, base)):
            one = replace(one, **_unseen(forward, base, one))
            size = sum(e.size(k) for k in range(len(e.runs)))
            after, before = (float(part.sum()) - size for part in (one.held_out, one.held_out_before))
            if len(e.runs) < 2 or _closes(after, before):
                return replace(one, reach=reach(one.forward, one.fit))
    return None


def _closes(after: float, before: float) -> bool:
    """Whether what is left after is a small enough part of what was before."""
    return after < (1.0 - policy.LAW_CLOSES) * before


def _grown(forward: Forward, base: Fit, typical: Scales) -> list[FreeLaw]:
    """Laws of more and more groups, each surely worth it and taking away enough of what is left before."""
    e = forward.experiment
    found, groups, least, left = [], list(GROUPS), policy.LAW_FIRST, _left(e, base)
    while groups and left > 0.0:
        known = found[-1] if found else None

        def with_group(branch, group, known=known):
            return _fitted(branch, base, group, typical, known)

        tried = [one for one in abreast.each(forward, with_group, groups) if one is not None]
        best = max(tried, key=lambda one: one.log_bayes, default=None)
        surer = policy.LEAST_LOG10_BAYES * math.log(10.0) + (known.log_bayes if known else 0.0)
        if best is None or best.log_bayes < surer or left - _left(e, best.fit) < least * left:
            break
        found.append(best)
        least, left = policy.LAW_FURTHER, _left(e, best.fit)
        groups = [group for group in groups if group[0] not in best.names]
    return found


def _left(experiment: Experiment, one: Fit) -> float:
    """χ² beyond the number of data."""
    return float(one.normal.chi2.sum()) - sum(experiment.size(k) for k in range(len(experiment.runs)))


def _fitted(forward, base, group, typical, known: FreeLaw | None) -> FreeLaw | None:
    """The law of one group more than one that is `known`, from where that stands; None where it fails."""
    names = (*(known.names if known else ()), *group)
    law = np.concatenate([known.coefficients if known else np.zeros(0), np.zeros(len(group))])
    near = known.fit if known else base
    highest = near.objective
    nothing = _evidence(base, 1.0, 1.0, 0)
    best, width = None, known.width if known else FIRST
    for _ in range(2):
        one = _at(forward.experiment, near, names, width, typical, forward.threads, law)
        if one is None or not one[0].objective < highest + _UPHILL:
            break
        worth = {w: _evidence(one[0], width, w, len(names)) - nothing for w in WIDTHS}
        if best is None or worth[width] > best.log_bayes:
            own, nan = one[0], np.full(len(forward.experiment.runs), math.nan)
            best = FreeLaw(one[1], own, typical, names, width, worth[width], nan, nan)
            near, law = own, best.coefficients
        likeliest = max(worth, key=worth.get)
        if likeliest == width:
            break
        width = likeliest
        highest = math.inf
    return best


def _at(experiment: Experiment, near: Fit, names, width, typical, threads, law):
    """Fit and forward model with a prior of one width, from a fit and coefficients `law` on.

    None where the chain, or one beside it, cannot be simulated.
    """
    forward = Forward(with_law(experiment, names, width, typical), threads)
    own = near.nu[: forward.layout.size - len(names)]
    found = fit(forward, near.hypothesis, near.u[None], np.concatenate([own, law / width])[None])
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


def _unseen(forward, base, one: FreeLaw):
    """`held_out` and `held_out_before` of a law: χ² of runs left out of a fit of its like, and without."""
    e, names, width, typical = forward.experiment, one.names, one.width, one.scales
    runs = len(e.runs)
    if runs < 2:
        return {}

    def left_out(branch, run):
        others = of_some(e, [k for k in range(runs) if k != run])
        learned = _at(others, one.fit, names, width, typical, branch.threads, one.coefficients)
        alone = Forward(of_some(e, [run]), branch.threads)
        before = _chi2(alone, base.hypothesis, base, base.nu)
        if learned is None:
            return before, before
        values = learned[0].nu[-len(names) :] * width
        given = typical.parameters | dict(zip(names, map(float, values), strict=True))
        whole = base.hypothesis.with_component(Component(EFFECT, (), given))
        return _chi2(alone, whole, base, one.fit.nu[: len(base.nu)]), before

    after, before = np.transpose(abreast.each(forward, left_out, range(runs)))
    return {"held_out": after, "held_out_before": before}


def _chi2(forward, hypothesis: Hypothesis, base, nu):
    """χ² of what counts, the model's effects held as found and the nuisances, which start at `nu`, free."""
    held = Hypothesis(tuple(_held(hypothesis, base)))
    one = fit(forward, held, np.zeros((1, 0)), nu[None])
    return float(one.normal.chi2.sum())


def _held(hypothesis, base):
    """Components with nothing free: those of the base as fitted, others as they are."""
    values = base.hypothesis.values(base.u)
    for c in hypothesis.components:
        fixed = values.get(c.effect.id, c.fixed)
        yield Component(c.effect, (), {k: v for k, v in fixed.items() if k != c.effect.places}, c.place)
