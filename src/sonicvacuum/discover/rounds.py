"""The order of the steps: nominal model, screen, singles, alarm, pairs, decision."""

import math
from dataclasses import dataclass, field

import numpy as np

from sonicvacuum.discover import directions, evidence, heldout, pairs, places, screen, singles, unknown
from sonicvacuum.discover.evidence import Candidate
from sonicvacuum.discover.experiment import Experiment
from sonicvacuum.discover.forward import Forward
from sonicvacuum.discover.hypothesis import Hypothesis
from sonicvacuum.discover.pairs import Pair
from sonicvacuum.discover.refit import Fit, fit, polish

# Of the largest score of the whole catalogue in pure noise.
FALSE_ALARM = 0.01
LEAST_LOG10_BAYES = 1.0
# Of the alarm at the nominal model: with nothing to name, only a sure misfit is called unknown.
NULL_ALARM = 1e-3
# What is named must gain as much as the simplest shape outside the catalogue, within a χ² of noise and the
# share by which linear predictions err.
MARGIN, SHARE = 6.0, 0.05
# Candidates whose Δχ² is this far behind the best are not followed to their minimum.
NEAR = 15.0
# Those with a place may be the best at a better one, if they are not further behind than this.
ALONG = 60.0
COARSE = 6


@dataclass(frozen=True)
class Investigation:
    """Everything found in one data set.

    Attributes:
        forward: the predictor.
        null: the nominal model, nuisances fitted.
        scores: the catalogue screened at the nominal model.
        threshold: Δχ² that a single effect has to gain.
        candidates: single effects, best first.
        probabilities: over none, unknown and single effects.
        named: ids, `unknown` last where a misfit is left.
        final: the fit that the verdict stands on; the nominal one where no effect is named.
        alarms: step ("none", "single", "pair") → p-value of what it leaves.
        reasons: what decided, one line each.
        pairs: pairs tried, best first.
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
    pairs: list[Pair] = field(default_factory=list)

    @property
    def sizes(self) -> np.ndarray:
        """(R,) number of data of each run."""
        e = self.forward.experiment
        return np.array([e.size(run) for run in range(len(e.runs))])


def nominal(forward: Forward) -> Fit:
    """The nominal model with its nuisances fitted."""
    start = np.zeros((1, forward.layout.size))
    direct = fit(forward, Hypothesis(), np.zeros((1, 0)), start)
    size = sum(forward.experiment.size(r) for r in range(len(forward.experiment.runs)))
    if direct.objective < 2.0 * size:
        return direct
    rough = fit(forward, Hypothesis(), np.zeros((1, 0)), start, coarse=COARSE)
    return min((direct, rough), key=lambda f: f.objective)


def investigate(experiment: Experiment, threads: int = 1) -> Investigation:
    """Find what is missing from the nominal model of a data set."""
    forward = Forward(experiment, threads)
    null = nominal(forward)
    scores = screen.screen(
        forward, null, directions.catalogue(singles.setup_of(forward), experiment.excluded)
    )
    threshold = scores.threshold(FALSE_ALARM)
    found = _polished(forward, null, singles.fit_all(forward, null, scores))
    if found and significant(found[0], threshold) and _likelier_than_none(found):
        # Only now: other places are more tries, for which the threshold does not allow.
        found = _along(forward, null, found)
        case = _Case(forward, null, scores, found)
        decision = case.decide()
    else:
        decision = _nothing(forward, null)
    odds = evidence.probabilities(found, decision.alarms.get("single", decision.alarms.get("none")))
    return Investigation(forward, null, scores, threshold, found, odds, **vars(decision))


@dataclass(frozen=True)
class Decision:
    """What is named, and why; attributes as those of `Investigation`."""

    named: list[str]
    final: Fit
    alarms: dict[str, float]
    reasons: list[str]
    pairs: list[Pair] = field(default_factory=list)


def _nothing(forward, null) -> Decision:
    """No effect can be named: none, or unknown where the nominal model leaves a sure misfit."""
    p = unknown.alarm(forward, null).p
    named = ["unknown"] if p < NULL_ALARM else []
    return Decision(named, null, {"none": p}, ["no single effect passes the threshold"])


@dataclass(frozen=True)
class _Case:
    """A data set in which the best single effect is significant."""

    forward: Forward
    null: Fit
    scores: screen.Screen
    found: list[Candidate]

    def decide(self) -> Decision:
        """Name the best single, a pair, or unknown."""
        best = self.found[0]
        beside = directions.catalogue(
            singles.setup_of(self.forward), (best.effect, *self.forward.experiment.excluded)
        )
        scores = screen.screen(self.forward, best.fit, beside)
        alarm = unknown.alarm(self.forward, best.fit, scores)
        shape, most = unknown.simplest(self.forward, self.null)
        behind = _behind(best.gain, most)
        alarms = {"single": min(alarm.p, math.exp(-0.5 * behind))}
        if alarm.raised:
            return self._pair(scores.threshold(FALSE_ALARM), most, alarms, alarm.group)
        if behind > 0.0:
            return Decision(["unknown"], self.null, alarms, [f"{shape} explains more than {best.effect}"])
        if heldout.better(self.null, best.fit):
            return Decision([best.effect], best.fit, alarms, [f"{best.effect} leaves nothing significant"])
        reason = f"{best.effect} does not predict unseen runs better"
        return Decision([], self.null, alarms, [reason])

    def _pair(self, needed, most, alarms, group) -> Decision:
        """Name the first pair that leaves nothing and gains enough over the best single; else unknown."""
        tried = pairs.search(self.forward, self.null, self.scores, self.found)
        single = max(c.gain for c in self.found)
        for pair in tried[:2]:
            if pair.gain - single <= needed:
                continue
            alarm = unknown.alarm(self.forward, pair.fit)
            alarms["pair"] = alarm.p
            if not alarm.raised and _behind(pair.gain, most) == 0.0:
                reason = "a pair leaves nothing significant"
                return Decision(list(pair.effects), pair.fit, alarms, [reason], tried)
        reason = f"misfit left in {group}: no effect nor pair explains it"
        return Decision(["unknown"], self.null, alarms, [reason], tried)


def _behind(gain: float, most: float) -> float:
    """By how much an explanation's Δχ² falls short of that of the simplest shape outside the catalogue."""
    return max(0.0, most - gain - MARGIN - SHARE * gain)


def _catalogue(forward, *present):
    return directions.catalogue(singles.setup_of(forward), (*present, *forward.experiment.excluded))


def significant(candidate: Candidate, threshold: float) -> bool:
    """Whether one effect passes the noise of the whole catalogue and is ten times likelier than none."""
    return candidate.gain > threshold and candidate.log_bayes / np.log(10.0) >= LEAST_LOG10_BAYES


def _likelier_than_none(found: list[Candidate]) -> bool:
    """Whether the best effect is more probable than none, unknown left aside."""
    odds = evidence.probabilities(found, 1.0)
    return odds[found[0].effect] > odds["none"]


def _polished(forward, null, found):
    """The leading candidates followed to their minimum."""
    result = []
    least = max((c.gain for c in found), default=0.0) - NEAR
    for c in found:
        if c.gain > least and not c.fit.settled:
            better = polish(forward, c.fit)
            flags = tuple(f for f in c.flags if f != "unsettled") + ("unsettled",) * (not better.settled)
            c = _moved(c, null, better, c.places, flags)
        result.append(c)
    return sorted(result, key=lambda c: -c.log_bayes)


def _along(forward, null, found):
    """The leading candidates with a place followed along the chain."""
    result = list(found)
    setup = singles.setup_of(forward)
    least = max(c.gain for c in found) - ALONG
    for k, c in enumerate(found):
        if c.gain > least and places.placed(c.fit):
            better = places.settled(forward, c.fit, setup)
            if better is not c.fit:
                result[k] = _moved(c, null, better, ((better.hypothesis.components[0].place, 1.0),), c.flags)
    return sorted(result, key=lambda c: -c.log_bayes)


def _moved(c, null, better, where, flags):
    """A candidate whose fit has been improved."""
    more = null.objective - better.objective - c.gain
    return Candidate(c.effect, better, c.gain + more, c.log_bayes + 0.5 * more, where, flags)
