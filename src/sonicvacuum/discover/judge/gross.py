"""What stands out of a gross misfit: where even the best explanation leaves far more than the noise.

The noise then says nothing of how sure an effect is, for what is left is many times larger; nor does a smooth
discrepancy that is free in every run, for it takes up any slow effect. What can still be said is which effect
every explanation needs that explains much. Explanations are weighed as if what is left were noise of unknown
size: with n independent pieces of it, exp(−½ n ln χ²) (the likelihood of Gaussian noise at its best standard
deviation). n counts samples by their correlation for an estimate of a variance (Bayley & Hammersley, J. R.
Stat. Soc. Suppl. 8, 184, 1946), and runs by how much of a systematic error they share. What a fit strains of
what the record states counts besides, as it is: one that takes a modulus known to 5 % to half of it explains
nothing, however little that is beside χ². Only where walls or speeds are hardly known it counts as χ² does:
there moduli and speeds make up for each other and for all that is missing. An effect is named where the
explanations that have it are together clearly the likelier. Laws that take energy do much the same beside so
much that is not understood: where one of them is surely there, the likeliest is named, with its own
probability.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import discrepancy, enough, evidence, places, smooth, wide
from sonicvacuum.discover.fit.evidence import Combination
from sonicvacuum.discover.fit.normal import linearise
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.judge import explanations
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import pairs, profiles, screen, several, singles, unknown
from sonicvacuum.effects import Setup

# Third effects, and further ones, that are fitted beside what stands out.
TRIED = 3
# Explanations, by what they leave, that are fitted once more from all over what is hardly known, so many
# times unless little changes: effects that have grown find other minima.
LEADING, TIMES, STAYS = 6, 3, 0.98
_PROFILES = {effect.id for effect in profiles.effects()}


def gross(forward: Forward, fit: Fit, known: discrepancy.Shapes | None = None) -> bool:
    """Whether a fit leaves so much that the noise no longer counts, nor does it with something smooth.

    `known` are the shapes of a smooth discrepancy, where one may be inferred. Where speeds or walls are
    hardly known these would take up what a discrepancy does, so that none is asked for.
    """
    if not float(fit.normal.chi2.sum()) > policy.GROSS * enough.data(forward):
        return False
    return known is None or wide.wide(forward) or smooth.infer(forward, fit, known).rest > policy.GROSS


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


@dataclass(frozen=True)
class Standing:
    """What stands out.

    Attributes:
        fit: with the effects that do, None where none does.
        shares: effect → probability that it is there.
        loss: probability that one at least takes energy.
        weights: log weights of explanations, those that have all that stands out as one.
        found: all explanations, each fitted as well as it was.
        instead: what probable rivals of the best one make of what they share with it, and of what is hardly
            known, in words.
    """

    fit: Fit | None
    shares: dict[str, float]
    loss: float
    weights: dict[str, float]
    found: list[Combination] = field(default_factory=list)
    instead: list[str] = field(default_factory=list)


def standing_out(
    forward: Forward, null: Fit, found: Iterable[Combination], setup: Setup, prior: Mapping[str, float]
) -> Standing:
    """What stands out of all explanations `found`.

    To the best of them effects are added as long as all of its own stand out. Where that ends still far from
    the data, what stood out at first is kept: one effect more would only stand for what is left.
    """
    found = [*found, *_crossed(forward, null, found, setup), *_profiles(forward, null, setup)]
    found = _at_their_best(forward, null, found)
    first = None
    while True:
        ranked = sorted(weighed(forward, null, found), key=lambda c: -c.log_bayes)
        weights = explanations.log_weights((), ranked, prior)
        odds, loss = shares(weights), loss_share(weights, setup)
        if set(ranked[0].effects) & _PROFILES:
            return first or Standing(None, odds, loss, {})
        fit = _told_apart(forward, null, ranked, odds, loss, setup)
        if fit is None:
            return first or Standing(None, odds, loss, weights)
        rivals = _instead(forward, ranked, weights)
        now = Standing(fit, odds, loss, merged(weights, fit.hypothesis.ids), found, rivals)
        if not gross(forward, fit):
            return now
        first = first or now
        best = ranked[0].effects
        grown = set(fit.hypothesis.ids) == set(best) and 1 < len(best) < policy.MOST_EFFECTS
        more = _more(forward, null, fit, setup, found) if grown else []
        if not more:
            return first
        found = [*found, *_at_their_best(forward, null, more)]


def _instead(forward, ranked: list[Combination], weights: Mapping[str, float]) -> list[str]:
    """What probable rivals of the best explanation say: an error of what is told does not contain it."""
    total, best = np.logaddexp.reduce(list(weights.values())), ranked[0].effects
    said = []
    for c in ranked[1:]:
        p = float(np.exp(weights.get(explanations.key(c.effects), -np.inf) - total))
        values = c.fit.hypothesis.values(c.fit.u)
        own = {name: values[name] for name in best if name in values}
        shared = [(f"{e} {n}", v) for e, given in own.items() for n, v in given.items() if v is not None]
        told = ", ".join(f"{name} {value:.3g}" for name, value in [*shared, *wide.values(forward, c.fit)])
        if p > policy.TOLD and told:
            said.append(f"were it {' + '.join(c.effects)} (probability {p:.2f}): {told}")
    return said


def _at_their_best(forward, null, found: list[Combination]) -> list[Combination]:
    """The same with the leading ones fitted from all over the priors, and from where the others ended: with
    walls and speeds hardly known, one explanation misses the minimum that another finds.
    """
    if not wide.wide(forward):
        return found
    ranked = sorted(found, key=lambda c: c.fit.objective)
    nu = np.array([c.fit.nu for c in ranked[:LEADING]])
    again = partial(_again, null=null, nu=nu)
    return abreast.each(forward, again, ranked[:LEADING]) + ranked[LEADING:]


def _again(forward, c: Combination, null: Fit, nu: np.ndarray) -> Combination:
    one = c.fit
    for _ in range(TIMES):
        before, one = one, wide.again(forward, one, nu)
        if one.objective > STAYS * before.objective:
            break
    gain = null.objective - one.objective
    worth = c.log_bayes - evidence.log_bayes(c.fit, c.gain) + evidence.log_bayes(one, gain)
    return Combination(c.effects, one, gain, worth)


def _crossed(forward, null, found: list[Combination], setup: Setup) -> list[Combination]:
    """The best effect with each of those that explain much alone, if that was not tried: so far from the
    data slopes do not tell which second effect is asked for.
    """
    known = {frozenset(c.effects) for c in found}
    alone = sorted((c for c in found if len(c.effects) == 1), key=lambda c: c.fit.objective)[:LEADING]
    asked = [other for other in alone[1:] if frozenset((*alone[0].effects, *other.effects)) not in known]

    def crossed(branch, other):
        best = alone[0].fit
        hypothesis = pairs.joined(best.hypothesis, other.fit.hypothesis.components[0], setup)
        u = np.concatenate([best.u, other.fit.u])
        nu = np.array([best.nu, other.fit.nu])
        one = fit(branch, hypothesis, np.array([u, u]), nu, iterations=pairs.ITERATIONS)
        return pairs.combination(null, one, setup)

    found = abreast.each(forward, crossed, asked)
    return [c for c in found if np.isfinite(c.fit.objective)]


def _profiles(forward, null, setup) -> list[Combination]:
    """Deviations along the chain as explanations, fitted where slopes promise that they explain much."""
    if forward.experiment.beads < 2:
        return []
    seen = screen.screen(forward, null, [profiles.family()])
    effort = singles.Effort(True, singles.ITERATIONS, 0, wide.FIRST)

    def follow(branch, effect):
        return singles.candidate(branch, null, seen, effect, effort)

    fits = abreast.each(forward, follow, profiles.effects())
    return [Combination((c.effect,), c.fit, c.gain, c.log_bayes) for c in fits if c is not None]


def _more(forward, null, fit: Fit, setup: Setup, found) -> list[Combination]:
    """Explanations with one effect more than a fit, if that was not tried yet."""
    known = {frozenset(c.effects) for c in found}
    starts = sorted(pairs.beside(forward, null, fit, setup), key=lambda s: -s.gain)

    def follow(branch, start):
        one = pairs.fitted(branch, start)
        return places.settled(branch, one, setup) if places.placed(one) else one

    fits = abreast.each(forward, follow, [s for s in starts[:TRIED] if s.effects not in known])
    return [pairs.combination(null, one, setup) for one in fits if np.isfinite(one.objective)]


def _told_apart(forward, null, ranked, odds, loss, setup) -> Fit | None:
    """The best explanation without the effects that do not stand out, are hardly seen, or gain no more than
    one shape outside the catalogue would in their place, unless to do without strains what is stated.
    """
    fit = ranked[0].fit
    prior = _prior(forward, _wider(fit, pieces(forward, fit)))
    seen = [z > policy.SEEN for z in fit.hypothesis.strengths(fit.u, prior.sigma(fit))]
    for k in reversed(range(len(ranked[0].effects))):
        less = _less(forward, null, fit, k, ranked, setup)
        likely = _surely_there(fit.hypothesis, k, odds, loss)
        if not (seen[k] and likely) or not (prior.strains(less, fit) or _ahead(forward, less, fit)):
            fit = less
    return fit if fit.hypothesis.components else None


def _surely_there(hypothesis, k: int, odds: Mapping[str, float], loss: float) -> bool:
    """Whether effect k of the best explanation stands out, or is a loss, of which one does, beside another
    effect that stands out.
    """
    own = hypothesis.ids[k]
    beside = any(odds[name] > policy.STANDS_OUT for name in hypothesis.ids if name != own)
    one_of = hypothesis.components[k].effect.dissipative and beside
    return max(odds[own], loss if one_of else 0.0) > policy.STANDS_OUT


def _less(forward, null, fit: Fit, k: int, ranked, setup) -> Fit:
    """The best fit known without effect k."""
    here = several.less(forward, null, fit, k, setup)
    same = [c.fit for c in ranked if set(c.effects) == set(here.hypothesis.ids)]
    return min([here, *same], key=lambda f: f.objective)


def _ahead(forward, less: Fit, fit: Fit) -> bool:
    """Whether an effect more gains more than one shape outside the catalogue would, and beside others takes
    away much of what they leave.
    """
    gain = less.objective - fit.objective
    others = len(less.hypothesis.components)
    if others and gain < policy.TAKES_AWAY[min(others, 2) - 1] * less.objective:
        return False
    return gain > (1.0 + policy.SHARE) * unknown.simplest(forward, less)[1] + policy.MARGIN


def widened(forward: Forward, null: Fit, fit: Fit) -> tuple[Forward, Fit, Fit]:
    """The predictor, the nominal fit and a fit with errors as what is left makes them: its χ² spread over its
    independent pieces.
    """
    e = forward.experiment
    wider = _wider(fit, pieces(forward, fit))
    view = Forward(replace(e, sigma=wider**0.5 * e.sigma), forward.threads)
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
