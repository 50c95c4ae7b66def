"""What this data cannot tell from what was named, and how large every other effect could be.

Two effects are confusable where their evidences differ by less than a χ² of 9 would make (three standard
deviations). Limits come from the screen at the final model: the largest strength, over places and shapes,
that 95 % confidence leaves; where that lies beyond the bounds of the search the effect is not testable with
this data.
"""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.evidence import Candidate
from sonicvacuum.discover.pairs import Pair
from sonicvacuum.discover.screen import Screen
from sonicvacuum.effects import Setup

# Twice the difference of log evidences, as a χ².
ALIKE = 9.0
_ONE_SIDED, _TWO_SIDED = 1.645, 1.96


@dataclass(frozen=True)
class Limit:
    """95 % limit of one effect.

    Attributes:
        effect, parameter: which.
        value: largest departure that is left, as a value of the parameter, bounds of the search observed.
        estimate: its best value given the final model.
        testable: whether the limit lies within the bounds.
        place: where it is weakest.
    """

    effect: str
    parameter: str
    value: float
    estimate: float
    testable: bool
    place: int | None


def confusable(named: list[str], candidates: list[Candidate], tried: list[Pair]) -> list[list[str]]:
    """Sets of effects, the named one first, between which the data do not decide."""
    if not named or named[-1] == "unknown":
        return []
    if len(named) == 1:
        own = next(c.log_bayes for c in candidates if c.effect == named[0])
        near = [c.effect for c in candidates if c.effect != named[0] and 2.0 * (own - c.log_bayes) < ALIKE]
        return [[named[0], *near]] if near else []
    own = next(p.log_bayes for p in tried if set(p.effects) == set(named))
    sets = {name: [name] for name in named}
    for pair in tried:
        shared, other = set(named) & set(pair.effects), set(pair.effects) - set(named)
        if len(shared) == 1 and 2.0 * (own - pair.log_bayes) < ALIKE:
            (lost,) = set(named) - shared
            sets[lost].extend(other - set(sets[lost]))
    return [members for members in sets.values() if len(members) > 1]


def limits(scores: Screen, setup: Setup) -> list[Limit]:
    """One limit for every strength that was screened."""
    worst: dict[tuple[str, str], tuple[float, float, int]] = {}
    for k, d in enumerate(scores.directions):
        length = scores.length[k]
        error = 1.0 / length if length > 0.0 else np.inf
        estimate = scores.strength[k]
        reach = abs(estimate) + (_TWO_SIDED if d.two_sided else _ONE_SIDED) * error
        key = (d.effect, d.strength)
        if key not in worst or reach > worst[key][0]:
            worst[key] = (reach, estimate, k)
    return [
        _limit(name, reach, estimate, scores.directions[k], setup)
        for (name, _), (reach, estimate, k) in worst.items()
    ]


def _limit(name, reach, estimate, direction, setup):
    p = setup.catalogue.effect(name).parameter(direction.strength)
    off = np.ravel(p.off_in(setup))[0]
    if np.isinf(off):
        value = p.scale / reach if np.isfinite(reach) else 0.0
        testable = value > p.low
        best = p.scale / estimate if estimate > 0.0 else np.inf
    else:
        towards = -1.0 if off + p.scale > p.high else 1.0
        value, best = off + towards * reach * p.scale, off + towards * estimate * p.scale
        testable = p.low <= value <= p.high
    highest = max(p.high, off)
    value = float(np.clip(value, min(p.low, off), highest))
    return Limit(name, p.name, value, float(best), bool(testable), direction.place)
