"""What a set of effects that grows may still come to: where its rival has more, or something will be left
whatever is added, it need not grow.

Evidence is in natural logs; what the effects to come will cost is left aside.
"""

from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import pairs, planes, unknown
from sonicvacuum.discover.search.screen import Screen
from sonicvacuum.effects import Setup

# One more effect is hoped to gain so many times the log evidence of the one before it.
HOPED = 2.0
# All effects that may still be added are hoped to gain so many times what slopes promise of them together: in
# sets of three with d' 20 each it took up to 1.7 times to come to their rivals, and on the way to those that
# leave nothing up to 2.8 times stood out along one group of shapes; beside a chain of graded moduli it was
# 2.6 times at three effects, 5.6 at four and 12 at five, beside a dimer 4.7 and 5.7 at four.
FORESEEN = 4.0


def by_last(before: float, after: float, room: int) -> float:
    """What a set may come to with `room` effects more, from what the last one gained."""
    return after + HOPED * max(1, room) * (after - before)


def by_slopes(own: float, scores: Screen, room: int) -> float:
    """The same from what slopes beside the set promise."""
    return own + 0.5 * FORESEEN * planes.foreseen(scores, room)


def hopeless(forward: Forward, fit: Fit, setup: Setup, room: int, own: float, rival: float) -> bool:
    """Whether a set of evidence `own` stays behind its rival with `room` effects more, or leaves much for all
    these.
    """
    if own < rival and by_slopes(own, pairs.screened(forward, fit, setup), room) < rival:
        return True
    return wide.leaves_much(forward, fit.objective) and remains(forward, fit, setup, room)


def remains(forward: Forward, fit: Fit, setup: Setup, room: int) -> bool:
    """Whether a set is sure to leave a misfit with `room` effects more: along a group of shapes stands out
    more than slopes beside the set let one hope for.
    """
    seen = unknown.shape_test(forward, fit)
    if not seen.failed:
        return False
    along = max(chi2 - freedom for chi2, freedom, _ in seen.groups.values())
    return along > FORESEEN * planes.foreseen(pairs.screened(forward, fit, setup), room)
