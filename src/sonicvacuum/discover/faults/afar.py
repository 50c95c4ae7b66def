"""A slip's size where slopes do not lead: trials one and two prior widths off, and a search from the best."""

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.judged import Judged
from sonicvacuum.discover.faults.judging import Judge

# Tries of a search for a size without slopes, and how near it comes, in prior widths.
TRIES, ROUGHLY = 8, 0.02


def from_afar(judge: Judge, judged: Judged) -> Judged:
    """The slip where it fits best one or two prior widths to either side, if that gains more than it does as
    looked at.

    Where a striker comes off, or meets the beads once more, is no smooth matter of masses, so that no slope
    leads across.
    """
    slip, best = judged.slip, judged
    for side in (-1.0, 1.0):
        last = None
        for widths in (1.0, 2.0):
            found = judge.at(slip, slip.start + side * widths * slip.width, last)
            last = found.model.fit
            if found.gain <= best.gain:
                break
            best = found
    promising = judge.least is None or best.gain > policy.FORESEEN * judge.least
    return _around(judge, best) if promising and best is not judged else best


def _around(judge: Judge, best: Judged) -> Judged:
    """The same where it fits best within a prior width, by a search that needs no slopes."""
    from scipy.optimize import minimize_scalar  # takes long to load, and few records need it

    slip, tried = best.slip, [best]

    def loss(size):
        tried.append(judge.at(slip, float(size), max(tried, key=lambda j: j.gain).model.fit))
        return -tried[-1].gain

    near, rough = (best.size - slip.width, best.size + slip.width), ROUGHLY * slip.width
    minimize_scalar(loss, bounds=near, method="bounded", options={"maxiter": TRIES, "xatol": rough})
    return max(tried, key=lambda j: j.gain)
