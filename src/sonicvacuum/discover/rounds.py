"""The order of the steps: nominal model, screen, singles, what is left, pairs, more effects, decision."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from sonicvacuum import stages
from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import bounds, discrepancy, enough, evidence, places, smooth, wide
from sonicvacuum.discover.fit.evidence import Candidate, Combination
from sonicvacuum.discover.fit.refit import Fit, finely, fit, polish
from sonicvacuum.discover.judge import explanations, gross
from sonicvacuum.discover.judge.decided import Decision, View
from sonicvacuum.discover.judge.decision import Case
from sonicvacuum.discover.judge.rivals import Rival, of_odds
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import around, directions, restart, screen, singles

# Candidates whose Δχ² is this far behind the best are not followed to their minimum.
NEAR = 15.0
FAR = 0.5
# Share of the Δχ² that a name takes from which on the last steps of fits matter: they gain some hundredths.
HOPEFUL = 0.7
# Those with a place may be the best at a better one, if they are not further behind than this.
ALONG = 60.0


@dataclass(frozen=True)
class Investigation:
    """Everything found in one data set.

    Attributes:
        forward: the predictor.
        null: the nominal model, nuisances fitted.
        scores: the catalogue screened at the nominal model.
        threshold: Δχ² that a single effect has to gain.
        candidates: single effects, best first.
        probabilities: over explanations.
        named: ids, `unknown` last where a misfit is left.
        final: the fit that the verdict stands on; the nominal one where no effect is named.
        alarms: step ("none", "single", "pair", "set") → p-value of what it leaves.
        reasons: what decided, one line each.
        combinations: sets of effects tried, best first.
        alike: effects that change these data as the best one does, it included.
        smooth: size of the smooth discrepancy that is left, as a share of the peak.
        counted: the same models with that discrepancy counted as noise.
        rivals: probable explanations, as they are fitted where the errors of `counted` hold.
    """

    forward: Forward
    null: Fit
    scores: screen.Screen
    threshold: float
    candidates: list[Candidate]
    probabilities: dict[str, float]
    named: list[str]
    final: Fit
    alarms: dict[str, float]
    reasons: list[str] = field(default_factory=list)
    combinations: list[Combination] = field(default_factory=list)
    alike: list[str] = field(default_factory=list)
    smooth: float = 0.0
    counted: View | None = None
    rivals: list[Rival] = field(default_factory=list)

    @property
    def sizes(self) -> np.ndarray:
        """(R,) number of data of each run."""
        e = self.forward.experiment
        return np.array([e.size(run) for run in range(len(e.runs))])

    @property
    def pairs(self) -> list[Combination]:
        """The combinations of two."""
        return [c for c in self.combinations if len(c.effects) == 2]


def investigate(
    experiment: Experiment,
    threads: int = 1,
    null: Fit | None = None,
    alone: list[Candidate] | None = None,
) -> Investigation:
    """Find what is missing from the nominal model of a data set; `null` is its fit and `alone` the single
    effects beside that, where at hand.
    """
    given, known = experiment, discrepancy.Shapes(experiment)
    if experiment.model_floor_rel:
        experiment = smooth.with_size(experiment, experiment.model_floor_rel, known)
    if experiment.model_floor_rel is not None:
        known = None  # stated, so that nothing is to be inferred
    forward = Forward(experiment, threads)
    stages.begin("nominal model")
    null = null or wide.nominal(forward)
    setup = singles.setup_of(forward)
    families = directions.catalogue(setup, experiment.excluded)
    scores = screen.screen(forward, null, families)
    if not enough.data(forward):
        return _unmeasured(forward, null, scores)
    threshold = scores.threshold(policy.FALSE_ALARM)
    fitted = singles.fit_all(forward, null, scores) if alone is None else alone
    found = _polished(forward, null, fitted, threshold)
    prior = experiment.prior_odds
    lower = _lower(forward, null, found, threshold)
    if lower is not None:
        missed = null.objective - lower.objective
        if missed > policy.STOPPED_SHORT * found[0].gain:
            return investigate(given, threads, lower)
        found, null = [_moved(c, lower, c.fit, c.flags) for c in found], lower
        scores = screen.screen(forward, null, families)
    few = enough.told(forward, (c for c in found if significant(c, threshold, prior)))
    passes = (
        bool(found)
        and enough.suffice(forward, found[0].fit)
        and significant(found[0], threshold, prior)
        and _likelier_than_none(found, prior)
    )
    if passes:
        # Only now: other places are more tries, for which the threshold does not allow.
        found = _beside_leading(forward, null, _along(forward, null, found))
    stages.begin("sets of effects" if passes else "verdict")
    case = Case(forward, null, scores, found, known, setup)
    decision = case.decide() if passes else case.nothing(few)
    found = decision.singles or found
    alike = explanations.aliases(forward, null, found) if passes else []
    odds, more = _odds(found, decision, alike, prior, tuple(experiment.present))
    if not gross.gross(forward, decision.final, known):
        odds, held = explanations.no_surer(odds, decision.named, decision.smooth_only)
        more += held
    reasons = [*decision.reasons, *(few if passes else ()), *more, *experiment.notes]
    rivals = decision.rivals
    if rivals is None:
        rivals = of_odds(odds, null, found, decision.combinations)
    final = finely(forward, decision.final)
    rivals = [replace(r, fit=final) if r.fit is decision.final else r for r in rivals]
    given = {**vars(decision), "final": final, "reasons": reasons, "rivals": rivals}
    for own in ("beside", "left", "singles", "smooth_only"):
        del given[own]
    return Investigation(forward, null, scores, threshold, found, odds, alike=alike, **given)


def _unmeasured(forward: Forward, null: Fit, scores: screen.Screen) -> Investigation:
    """What is found where no datum counts, as no shot has struck: all is as probable as before."""
    e = forward.experiment
    effects = dict.fromkeys(d.effect for d in scores.directions)
    odds = evidence.before_data(effects, e.prior_odds)
    reasons = ["nothing was measured: no sample counts, and all is as probable as before", *e.notes]
    return Investigation(forward, null, scores, 0.0, [], odds, [], null, {}, reasons)


def _odds(found, decision: Decision, alike, prior, present) -> tuple[dict[str, float], list[str]]:
    """Probabilities and what has to be said of them."""
    logs = explanations.log_weights(found, decision.combinations, prior)
    plain = explanations.probabilities(logs, decision.left, decision.beside)
    odds, likelier = explanations.consistent(plain, decision.named)
    reasons = []
    stuck = _stuck(found, decision.named)
    if stuck:
        odds = explanations.doubted(odds, decision.named, policy.AT_BOUND)
        reasons.append(
            f"{', '.join(stuck)} ended at a bound, even beyond the catalogue's range, and might fit better"
        )
    reasons += _said(prior, present) + _losses(found, odds, present)
    sure = odds.get(explanations.key(decision.named), 0.0) > 0.5
    other = _with_less(found, decision, prior) if sure or present else ""
    if other:
        reasons.append(f"were its prior ten times smaller, {other} would be the likeliest")
    elif present:
        reasons.append("were its prior ten times smaller, no other name would be the likeliest")
    if likelier:
        reasons.append(f"{likelier} has the larger evidence, and did not pass every test")
    if len(alike) > 1 and alike[0] in decision.named:
        reasons.append(
            f"{', '.join(alike)} act alike on these data: one explanation with {len(alike)} names, of which "
            f"{alike[0]} has the most evidence, by a little"
        )
    return odds, reasons


def _said(prior, present) -> list[str]:
    """What a record states before the data, in words: prior odds, and effects that are known to act."""
    excluded = [name for name, odds in prior.items() if odds == 0.0]
    changed = [f"{name} {odds:g} times as likely" for name, odds in prior.items() if odds not in (0.0, 1.0)]
    told = [f"{', '.join(present)} present, part of every explanation"] * bool(present)
    told += changed + [f"{', '.join(excluded)} excluded"] * bool(excluded)
    return [f"before the data, as the record states: {'; '.join(told)}"] if told else []


def _losses(found, odds, present) -> list[str]:
    """Where effects are known to act, how probable it is that one besides takes energy, whatever its law."""
    losses = {c.effect for c in found if c.fit.hypothesis.components[0].effect.dissipative}
    whole = sum(p for name, p in odds.items() if losses & set(explanations.effects(name)))
    if not present or whole < 0.5:
        return []
    return [f"{' + '.join(present)} with a loss, of whatever law: probability {whole:.4g}"]


def _with_less(found, decision: Decision, prior) -> str:
    """The likeliest explanation if what is named had a tenth of its prior; "" where that changes nothing."""
    named = [name for name in decision.named if name != explanations.UNKNOWN]
    less = {**prior, **{name: 0.1 * prior.get(name, 1.0) for name in named}}
    logs = explanations.log_weights(found, decision.combinations, less)
    odds = explanations.probabilities(logs, decision.left, decision.beside)
    best = max(odds, key=odds.get)
    return "" if set(explanations.effects(best)) == set(decision.named) else best


def _stuck(found: list[Candidate], named: list[str]) -> list[str]:
    """The named effect and its rivals as far as their fits ended at a bound."""
    if len(named) != 1 or named[0] == explanations.UNKNOWN:
        return []
    own = next(c.gain for c in found if c.effect == named[0])
    return [c.effect for c in found if c.gain > own - policy.RIVAL and "bound" in c.flags]


def significant(candidate: Candidate, threshold: float, prior: Mapping[str, float]) -> bool:
    """Whether one effect passes the noise of the whole catalogue and is ten times likelier than none.

    `prior`: odds of effects against their usual prior, which count as much as evidence does.
    """
    log_odds = candidate.log_bayes + np.log(prior.get(candidate.effect, 1.0))
    return candidate.gain > threshold and log_odds / np.log(10.0) >= policy.LEAST_LOG10_BAYES


def _likelier_than_none(found: list[Candidate], prior) -> bool:
    """Whether the best effect is more probable than none, unknown left aside."""
    odds = evidence.probabilities(found, 1.0, odds=prior)
    return odds[found[0].effect] > odds["none"]


def _polished(forward, null, found, threshold):
    """The leading candidates followed to their minimum, to the last step where one may be named."""
    most = max((c.gain for c in found), default=0.0)
    # Where something is hardly known, fits that have not settled may be far from their minima.
    least = most - (max(NEAR, FAR * most) if wide.wide(forward) else NEAR)

    def polished(branch, c):
        hopeful = most > HOPEFUL * threshold and not c.fit.finished
        if c.gain > least and (hopeful or not c.fit.settled):
            better = polish(branch, c.fit)
            flags = tuple(f for f in c.flags if f != "unsettled") + ("unsettled",) * (not better.settled)
            c = _moved(c, null, better, flags)
        if c.gain > least and wide.wide(branch):
            c = _moved(c, null, wide.again(branch, c.fit), c.flags)
        # What a bound holds back may be far behind for that alone.
        further = c.gain > least or (c.gain > 0.0 and bounds.held_back(c.fit))
        return _beyond(branch, null, c, null.objective - most) if further else c

    result = abreast.each(forward, polished, found, "leading effects")
    return enough.first(forward, evidence.ranked(result, forward.experiment.prior_odds))


def _lower(forward, null, found, threshold) -> Fit | None:
    """A lower nominal minimum from where the leading effect has left the nuisances; None where there is none.

    A nominal fit that has stopped short of its minimum by less than the scatter of χ² looks like noise, and
    any effect, however weak, seems to gain what it has missed. One that leaves more may have ended where
    nuisances make up for each other; beside beads of one material it counts where the other leaves noise.
    """
    if not found or found[0].gain <= threshold:
        return None
    alike = len({bead.surface.name for bead in forward.experiment.batches[0].chain.bodies.kinds}) == 1
    one = fit(forward, null.hypothesis, np.zeros((1, 0)), found[0].fit.nu[None])
    if alike and wide.leaves_much(forward, null.objective) and wide.leaves_much(forward, one.objective):
        return None
    return one if one.objective < null.objective - policy.SAME_MINIMUM else None


def _beyond(forward, null, c, lowest):
    """A candidate followed beyond the bounds that its fit stands at, towards the lowest objective so far."""
    better, held = bounds.beyond(forward, c.fit, lowest)
    flags = (*(f for f in c.flags if f != "bound"), *("beyond",) * (better is not c.fit), *("bound",) * held)
    return _moved(c, null, better, flags)


def _along(forward, null, found):
    """Candidates with a place followed along the chain, where one of them is among the leading."""
    result = list(found)
    setup = singles.setup_of(forward)
    least = max(c.gain for c in found) - ALONG
    # A gap is much like a lighter bead: where one of the two leads, the other is looked for as well.
    placed = [k for k, c in enumerate(found) if c.gain > 0.0 and places.placed(c.fit)]
    if not any(found[k].gain > least for k in placed):
        placed = []

    def refined(forward, start):
        better = around.refined(forward, places.settled(forward, start, setup), setup)
        return None if better is start else better

    def moved(k, better):
        result[k] = _moved(result[k], null, better, result[k].flags)

    around_each = abreast.each(forward, lambda branch, k: refined(branch, found[k].fit), placed)
    for k, better in zip(placed, around_each, strict=True):
        if better is not None:
            moved(k, better)
    first = max((result[k] for k in placed), key=lambda c: c.gain, default=None)
    for k in placed:
        if result[k] is not first:
            start = around.beside(forward, null, result[k].fit, first.fit, setup)
            if start is not result[k].fit:
                moved(k, refined(forward, start) or start)
    return enough.first(forward, evidence.ranked(result, forward.experiment.prior_odds))


def _beside_leading(forward, null, found):
    """Candidates of one strength followed from where the leading one has left the nuisances."""
    better = restart.beside_leading(forward, null, found)
    return enough.first(forward, evidence.ranked(better, forward.experiment.prior_odds))


def _moved(c, null, better, flags):
    """A candidate whose fit has been improved, or that is held against another nominal fit."""
    more, lower = null.objective - better.objective - c.gain, c.fit.objective - better.objective
    instead = tuple((log - 0.5 * lower, way) for log, way in c.instead)
    gain, log_bayes = c.gain + more, c.log_bayes + 0.5 * more
    return Candidate(c.effect, better, gain, log_bayes, flags, instead)
