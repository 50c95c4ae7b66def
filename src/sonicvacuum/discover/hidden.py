"""What may hide behind the named effects: its share of the probability, and a name where it is the likeliest.

Two effects of which either nearly makes up for the other leave nothing when one is named, so that no search
asks for the pair (`judge.behind`). Slopes tell how probable it is beside the named ones. Where that is not
faint it is fitted: the named effects may stand in a minimum of their own, from which no slope leads to the
lower one that they share with what hides; and where time zeros take up nearly all of a small change, as they
do of a low-pass, slopes tell little of what a larger one leaves. Two laws of damping may hide behind one
that is neither of them, too (`mixtures`).
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover import policy, upper
from sonicvacuum.discover.fit.calibration import of_package
from sonicvacuum.discover.fit.evidence import Combination
from sonicvacuum.discover.judge import behind, explanations, rivals
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.search import mixtures, pairs, restart, singles
from sonicvacuum.discover.search.screen import Screen

# A set that hides is fitted where slopes make it as probable as this. Of pairs in place of one law so many
# are, where algebra promises at most so much less in χ² than that law gains, if that is large: one law leaves
# some hundredth of what two like it change, and a second one has to earn ten.
FITTED, INSTEAD, LESS, LARGE = 0.05, 4, 20.0, 1000.0


@dataclass(frozen=True)
class Hiding:
    """One effect beside the named ones, or two in place of a law of damping, as they are fitted together.

    Attributes:
        effect: which one, or both.
        together: the set.
        more: Δχ² that it gains beyond what slopes promise; negative where it is less.
    """

    effect: str
    together: Combination
    more: float


def told(found: Investigation, scores: Screen) -> tuple[Investigation, Screen]:
    """The same with the sets that hide behind what is named, one of them named where it is the likeliest.

    Args:
        found: the search.
        scores: of `upper.screened`; returned for what is named then.
    """
    if not found.named or explanations.UNKNOWN in found.named or found.counted:
        return found, scores
    gain = found.null.objective - found.final.objective
    beside = behind.odds(scores, gain, found.threshold, found.forward.experiment.prior_odds)
    odds = behind.told(found.probabilities, found.named, beside)
    if len(found.named) >= policy.MOST_EFFECTS:
        return replace(found, probabilities=odds), scores
    hiding = _fitted(found, [n for n, p in odds.items() if p > FITTED and n not in found.probabilities])
    instead = _instead(found)
    otherwise = [one for one in hiding.values() if abs(one.more) > restart.LOWER] + list(instead.values())
    odds, sets = _weighed(found, odds, otherwise), found.combinations
    for one in otherwise:
        sets = explanations.together(sets, (), one.together)
    found = replace(found, probabilities=odds, combinations=sets)
    likeliest = (hiding | instead).get(max(odds, key=odds.get))
    if likeliest is None or not likeliest.together.fit.objective < found.final.objective:
        return found, scores
    found = _with(found, likeliest, scores)
    return found, upper.screened(found)


def _fitted(found: Investigation, names: list[str]) -> dict[str, Hiding]:
    """Some sets of the named effects and one more, each fitted."""
    if not names:
        return {}
    forward, null, setup = found.forward, found.null, singles.setup_of(found.forward)
    asked = {effect for name in names for effect in explanations.effects(name)} - set(found.named)
    starts = pairs.beside(forward, null, found.final, setup, asked)
    fits = pairs.followed(forward, starts, found.final.objective)
    hiding = {}
    for start, one in zip(starts, fits, strict=True):
        (effect,) = start.effects - set(found.named)
        more = null.objective - start.gain - one.objective
        if np.isfinite(one.objective):
            together = pairs.combination(null, one, setup)
            hiding[explanations.key(together.effects)] = Hiding(effect, together, more)
    return hiding


def _instead(found: Investigation) -> dict[str, Hiding]:
    """Pairs of laws in place of the one that is named, each fitted."""
    forward, null = found.forward, found.null
    gained = null.objective - found.final.objective
    if len(found.named) != 1 or found.named[0] != found.candidates[0].effect or gained < LARGE:
        return {}
    least = gained - LESS
    known = {frozenset(c.effects) for c in found.combinations}
    asked = [s for s in mixtures.starts(forward, null, found.candidates) if s.gain > least]
    asked = [s for s in asked if s.effects not in known][:INSTEAD]
    hiding = {}
    for one in pairs.followed(forward, asked, found.final.objective):
        if np.isfinite(one.objective):
            together = pairs.combination(null, one, singles.setup_of(forward))
            more = found.final.objective - one.objective
            hiding[explanations.key(together.effects)] = Hiding(" + ".join(together.effects), together, more)
    return hiding


def _weighed(found: Investigation, odds: dict[str, float], otherwise: list[Hiding]) -> dict[str, float]:
    """Probabilities with the sets that slopes promised too little or too much of by their own evidence."""
    sets, prior = [one.together for one in otherwise], found.forward.experiment.prior_odds
    logs = explanations.log_weights(found.candidates, [*found.combinations, *sets], prior)
    own = explanations.key(found.named)
    if not otherwise or own not in logs:
        return odds
    odds, temper = dict(odds), of_package().temper
    for name in (explanations.key(one.effects) for one in sets):
        odds[name] = odds[own] * math.exp(min(temper * (logs[name] - logs[own]), 700.0))
    total = sum(odds.values())
    return {name: p / total for name, p in odds.items()}


def _with(found: Investigation, one: Hiding, scores: Screen) -> Investigation:
    """The same with one more effect named beside the others, or two in place of one."""
    alone = " + ".join(found.named)
    reason = f"both together are likelier than {alone} alone"
    if not set(found.named) <= set(one.together.effects):
        reason = f"{one.effect} do nearly what {alone} does, and {reason}"
    elif one.more > restart.LOWER or behind.hides(scores, one.effect):
        reason = f"{one.effect} does nearly what {alone} does, and {reason}"
    else:
        reason = f"what {one.effect} explains beside {alone} might be noise, but {reason}"
    sets = explanations.together(found.combinations, (), one.together)
    return replace(
        found,
        named=list(one.together.effects),
        final=one.together.fit,
        reasons=[reason, *found.reasons],
        combinations=sets,
        rivals=rivals.of_odds(found.probabilities, found.null, found.candidates, sets),
    )
