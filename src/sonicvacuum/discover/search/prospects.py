"""What a set of effects that grows may still come to: where its rival has more, it need not grow.

All is natural logs of evidence; what the effects to come will cost is left aside.
"""

from sonicvacuum.discover.search import planes
from sonicvacuum.discover.search.screen import Screen

# One more effect is hoped to gain so many times the log evidence of the one before it.
HOPED = 2.0
# All effects that may still be added are hoped to gain so many times what slopes promise of them together: in
# sets of three with d' 20 each it took up to 1.7 times to come to their rivals.
FORESEEN = 4.0


def by_last(before: float, after: float, room: int) -> float:
    """What a set may come to with `room` effects more, from what the last one gained."""
    return after + HOPED * max(1, room) * (after - before)


def by_slopes(own: float, scores: Screen, room: int) -> float:
    """The same from what slopes beside the set promise."""
    return own + 0.5 * FORESEEN * planes.foreseen(scores, room)
