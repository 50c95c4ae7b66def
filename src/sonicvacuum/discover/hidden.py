"""What may hide behind the named effects: its share of the probability, and a name where it is the likeliest.

Two effects of which either nearly makes up for the other leave nothing when one is named, so that no search
asks for the pair (`judge.behind`). It is fitted where it is likelier than what was named.
"""

from dataclasses import replace

from sonicvacuum.discover import policy, upper
from sonicvacuum.discover.judge import behind, explanations, rivals
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.search import pairs, singles
from sonicvacuum.discover.search.screen import Screen


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
    likeliest = max(odds, key=odds.get)
    fitted = found.probabilities.keys()
    found = replace(found, probabilities=odds)
    if likeliest in fitted or len(found.named) >= policy.MOST_EFFECTS:
        return found, scores
    (effect,) = set(explanations.effects(likeliest)) - set(found.named)
    more = _with(found, effect, scores)
    return more, scores if more is found else upper.screened(more)


def _with(found: Investigation, effect: str, scores: Screen) -> Investigation:
    """The same with one more effect named, fitted beside the others; as it is where that gains nothing."""
    forward, null, setup = found.forward, found.null, singles.setup_of(found.forward)
    starts = pairs.beside(forward, null, found.final, setup, only=effect)
    fits = [pairs.fitted(forward, start) for start in starts]
    best = min(fits, key=lambda one: one.objective, default=found.final)
    if not best.objective < found.final.objective:
        return found
    own = pairs.combination(null, best, setup)
    sets = explanations.together(found.combinations, (), own)
    alone = " + ".join(found.named)
    reason = f"both together are likelier than {alone} alone"
    if behind.hides(scores, effect):
        reason = f"{effect} does nearly what {alone} does, and {reason}"
    else:
        reason = f"what {effect} explains beside {alone} might be noise, but {reason}"
    return replace(
        found,
        named=list(own.effects),
        final=best,
        reasons=[reason, *found.reasons],
        combinations=sets,
        rivals=rivals.of_odds(found.probabilities, null, found.candidates, sets),
    )
