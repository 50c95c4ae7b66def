"""The order of the steps: nominal model, screen, singles, alarm, pairs, decision."""

from dataclasses import dataclass, field

import numpy as np

from sonicvacuum.discover import directions, evidence, heldout, pairs, screen, singles, unknown
from sonicvacuum.discover.evidence import Candidate
from sonicvacuum.discover.experiment import Experiment
from sonicvacuum.discover.forward import Forward
from sonicvacuum.discover.hypothesis import Hypothesis
from sonicvacuum.discover.refit import Fit, fit, polish

# Of the largest score of the whole catalogue in pure noise.
FALSE_ALARM = 0.01
LEAST_LOG10_BAYES = 1.0
# Of the alarm at the nominal model: with nothing to name, only a sure misfit is called unknown.
NULL_ALARM = 1e-3
# Candidates followed to their minimum after the first search.
POLISHED = 4
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
        alarms: step → alarm raised on its residual ("none", "single", "pair").
        pairs: pairs tried, best first.
        named: ids, `unknown` last where a misfit is left.
        final: the fit that the verdict stands on.
        reasons: what decided, one line each.
    """

    forward: Forward
    null: Fit
    scores: screen.Screen
    threshold: float
    candidates: list[Candidate]
    probabilities: dict[str, float]
    alarms: dict[str, unknown.Alarm]
    pairs: list[pairs.Pair]
    named: list[str]
    final: Fit
    reasons: list[str] = field(default_factory=list)

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
    setup = singles.setup_of(forward)
    scores = screen.screen(forward, null, directions.catalogue(setup))
    threshold = scores.threshold(FALSE_ALARM)
    found = _polished(forward, null, singles.fit_all(forward, null, scores))
    best = found[0] if found and significant(found[0], threshold) else None
    alarms, tried = {}, []
    if best is None:
        alarms["none"] = unknown.alarm(forward, null)
        named, final = (["unknown"] if alarms["none"].p < NULL_ALARM else []), null
        reasons = ["no single effect passes the threshold"]
        p = alarms["none"].p
    else:
        named, final, alarms, tried, reasons = _decide(forward, null, best, found, setup, scores)
        p = alarms["single"].p
    odds = evidence.probabilities(found, p)
    return Investigation(forward, null, scores, threshold, found, odds, alarms, tried, named, final, reasons)


def significant(candidate: Candidate, threshold: float) -> bool:
    """Whether one effect passes the noise of the whole catalogue and is ten times likelier than none."""
    return candidate.gain > threshold and candidate.log_bayes / np.log(10.0) >= LEAST_LOG10_BAYES


def _polished(forward, null, found):
    """The leading candidates followed to their minimum."""
    result = []
    for k, c in enumerate(found):
        if k < POLISHED and not c.fit.settled:
            better = polish(forward, c.fit)
            more = null.objective - better.objective - c.gain
            flags = tuple(f for f in c.flags if f != "unsettled") + ("unsettled",) * (not better.settled)
            c = Candidate(c.effect, better, c.gain + more, c.log_bayes + 0.5 * more, c.places, flags)
        result.append(c)
    return sorted(result, key=lambda c: -c.log_bayes)


def _decide(forward, null, best: Candidate, found, setup, nominal_scores):
    """Name the best single, a pair, or unknown."""
    scores = screen.screen(forward, best.fit, directions.catalogue(setup, (best.effect,)))
    alarms = {"single": unknown.alarm(forward, best.fit, scores)}
    if not alarms["single"].raised:
        if heldout.better(null, best.fit):
            return [best.effect], best.fit, alarms, [], [f"{best.effect} leaves nothing significant"]
        return [], null, alarms, [], [f"{best.effect} does not predict unseen runs better"]
    needed = scores.threshold(FALSE_ALARM)
    tried = pairs.search(forward, null, nominal_scores, found)
    for pair in tried[:2]:
        alarm = unknown.alarm(forward, pair.fit)
        alarms.setdefault("pair", alarm)
        gained = pair.gain - max(c.gain for c in found)
        if gained > needed and not alarm.raised:
            alarms["pair"] = alarm
            return list(pair.effects), pair.fit, alarms, tried, ["a pair leaves nothing significant"]
    reason = f"misfit left in {alarms['single'].group}: no effect nor pair explains it"
    return ["unknown"], null, alarms, tried, [reason]
