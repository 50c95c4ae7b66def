"""What stands out of a gross misfit: where even the best explanation leaves far more than the noise.

The noise then says nothing of how sure an effect is, for what is left is many times larger; nor does a smooth
discrepancy that is free in every run, for it takes up any slow effect. What can still be said is which effect
every explanation needs that explains much: explanations are weighed as if what is left were noise of unknown
size (`weighing`). An effect is named where the explanations that have it are together clearly the likelier.
Laws that take energy do much the same beside so much that is not understood: where one of them is surely
there, the likeliest is named, with its own probability. A bead's mass or a gap, which can sit at any of tens
of places, comes nearest to what is not understood far more often than others do: it has smaller odds.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import discrepancy, enough, places, smooth, wide
from sonicvacuum.discover.fit.evidence import Combination
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.judge import explanations, leading, rivals, weighing
from sonicvacuum.discover.judge.rivals import Rival
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import candidates, pairs, profiles, restart, screen, unknown
from sonicvacuum.effects import Setup

# Third effects, and further ones, that are fitted beside what stands out.
TRIED = 3
# Single effects, by what they leave, that are tried beside the best one.
LEADING = 6
# A third effect is fitted beside a pair where slopes promise that it takes away this share of what the pair
# leaves beyond noise.
THIRD = 0.5
_PROFILES = {effect.id for effect in profiles.effects()}


def gross(forward: Forward, fit: Fit, known: discrepancy.Shapes | None = None) -> bool:
    """Whether a fit leaves so much that the noise no longer counts, nor does it with something smooth.

    `known` are the shapes of a smooth discrepancy, where one may be inferred. Where speeds or walls are
    hardly known these would take up what a discrepancy does, so that none is asked for.
    """
    if not float(fit.normal.chi2.sum()) > policy.GROSS * enough.data(forward):
        return False
    return known is None or wide.wide(forward) or smooth.infer(forward, fit, known).rest > policy.GROSS


@dataclass(frozen=True)
class Standing:
    """What stands out.

    Attributes:
        fit: with the effects that do, None where none does.
        shares: effect → probability that it is there.
        loss: probability that one at least takes energy.
        weights: log weights of explanations, those that have all that stands out as one.
        found: all explanations, each fitted as well as it was.
        rivals: those that are probable.
        instead: what probable rivals of the best one make of what they share with it, and of what is hardly
            known, in words.
    """

    fit: Fit | None
    shares: dict[str, float]
    loss: float
    weights: dict[str, float]
    found: list[Combination] = field(default_factory=list)
    rivals: list[Rival] = field(default_factory=list)
    instead: list[str] = field(default_factory=list)


def standing_out(
    forward: Forward, null: Fit, found: Iterable[Combination], setup: Setup, prior: Mapping[str, float]
) -> Standing:
    """What stands out of all explanations `found`.

    To the best of them effects are added as long as all of its own stand out. Where that ends still far from
    the data, what stood out at first is kept: one effect more would only stand for what is left.
    """
    prior = _beside_much(prior, setup)
    found = [*found, *_crossed(forward, null, found, setup), *_profiles(forward, null)]
    found = leading.at_their_best(forward, null, found)
    first = None
    while True:
        ranked = sorted(weighing.weighed(forward, null, found), key=lambda c: -c.log_bayes)
        weights = explanations.log_weights((), ranked, prior)
        odds, loss = weighing.shares(weights), weighing.loss_share(weights, setup)
        probable = rivals.of_weights(weights, found)
        if set(ranked[0].effects) & _PROFILES:
            return first or Standing(None, odds, loss, {}, rivals=probable)
        fit = _told_apart(forward, null, ranked, odds, loss)
        if fit is None:
            return first or Standing(None, odds, loss, weights, rivals=probable)
        merged, said = weighing.merged(weights, fit.hypothesis.ids), _instead(forward, ranked, weights)
        now = Standing(fit, odds, loss, merged, found, probable, said)
        if not gross(forward, fit):
            return now
        first = first or now
        best = ranked[0].effects
        grown = set(fit.hypothesis.ids) == set(best) and 1 < len(best) < policy.MOST_EFFECTS
        more = _more(forward, null, fit, setup, found) if grown else []
        if not more:
            return first
        # They begin where the best explanation has come to already.
        found = [*found, *leading.at_their_best(forward, null, more, leaders=1)]


def of_three(forward: Forward, null: Fit, found: Iterable[Combination], setup: Setup) -> Fit | None:
    """The best fit of one of the leading pairs and a third effect, if it leaves no gross misfit; None where
    it does, slopes promise nothing of the kind, or what is hardly known may do what an effect does.

    Which two of three strong effects go together best while the third is missing is chance, so that often
    none of the two stands out.
    """
    if wide.wide(forward):
        return None
    of_two = sorted((c for c in found if len(c.effects) == 2), key=lambda c: c.fit.objective)[:LEADING]

    def promising(branch, pair):
        least = pair.gain + THIRD * (pair.fit.objective - enough.data(forward))
        return [s for s in pairs.beside(branch, null, pair.fit, setup) if s.gain > least]

    starts = [s for own in abreast.each(forward, promising, of_two) for s in own]
    best = {s.effects: s for s in sorted(starts, key=lambda s: s.gain)}
    chosen = sorted(best.values(), key=lambda s: -s.gain)[:TRIED]
    one = min(pairs.followed(forward, chosen), key=lambda f: f.objective, default=None)
    return None if one is None or gross(forward, one) else one


def _beside_much(prior: Mapping[str, float], setup: Setup) -> dict[str, float]:
    """Odds of effects beside what is not understood."""
    inside = [e.id for e in setup.catalogue if e.places in places.ALONG]
    return {**prior, **{name: policy.NEAREST * prior.get(name, 1.0) for name in inside}}


def _instead(forward, ranked: list[Combination], weights: Mapping[str, float]) -> list[str]:
    """What probable rivals of the best explanation say of what they share with it."""
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


def _crossed(forward, null, found: list[Combination], setup: Setup) -> list[Combination]:
    """The best effect with each of those that explain much alone, if that was not tried: so far from the
    data slopes do not tell which second effect is asked for. Where walls or speeds are hardly known, from all
    over their priors: what two effects leave is elsewhere than what one does.
    """
    known = {frozenset(c.effects) for c in found}
    alone = sorted((c for c in found if len(c.effects) == 1), key=lambda c: c.fit.objective)[:LEADING]
    asked = [other for other in alone[1:] if frozenset((*alone[0].effects, *other.effects)) not in known]

    def crossed(branch, other):
        best = alone[0].fit
        hypothesis = best.hypothesis.with_component(other.fit.hypothesis.components[0])
        u = np.concatenate([best.u, other.fit.u])
        nu = np.array([best.nu, other.fit.nu])
        one = fit(branch, hypothesis, np.array([u, u]), nu, iterations=pairs.ITERATIONS)
        one = wide.again(branch, one, nu) if wide.wide(branch) else one
        return pairs.combination(null, one, setup)

    found = abreast.each(forward, crossed, asked)
    return [c for c in found if np.isfinite(c.fit.objective)]


def _profiles(forward, null) -> list[Combination]:
    """Deviations along the chain as explanations, fitted where slopes promise that they explain much."""
    if forward.experiment.beads < 2:
        return []
    seen = screen.screen(forward, null, [profiles.family()])
    effort = candidates.Effort(True, candidates.ITERATIONS, 0, wide.FIRST)

    def follow(branch, effect):
        return candidates.candidate(branch, null, seen, effect, effort)

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


def _told_apart(forward, null, ranked, odds, loss) -> Fit | None:
    """The best explanation without the effects that do not stand out, are hardly seen, or gain no more than
    one shape outside the catalogue would in their place, unless to do without strains what is stated.
    """
    fit = ranked[0].fit
    prior = weighing.prior_beside(forward, fit)
    seen = [z > policy.SEEN for z in fit.hypothesis.strengths(fit.u, prior.sigma(fit))]
    for k in reversed(range(len(ranked[0].effects))):
        less = _less(forward, null, fit, k, ranked)
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


def _less(forward, null, fit: Fit, k: int, ranked) -> Fit:
    """The best fit known without effect k."""
    here = restart.fewer(forward, null, fit, k)
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
