"""What this data cannot tell from what was named, and how large every other effect could be.

Two effects are confusable where their evidences, beside something unknown their probabilities, differ by less
than a χ² of 9 would make (three standard deviations). Limits come from the screen at the final model, the
largest strength over places and shapes, and from every other explanation that has the effect, each with its
probability: beyond a limit lie 5 % of all. Where it lies beyond the bounds of the search the effect is not
testable with this data.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import tails
from sonicvacuum.discover.fit.evidence import Candidate, Combination
from sonicvacuum.discover.judge import explanations
from sonicvacuum.discover.search.screen import Screen
from sonicvacuum.effects import Setup

# Twice the difference of log evidences, as a χ².
ALIKE = 9.0
_ONE_SIDED, _TWO_SIDED = policy.NINETY, 1.96
# A limit between two others to a millionth of their distance.
_HALVINGS = 20


@dataclass(frozen=True)
class Limit:
    """95 % limit of one effect.

    Attributes:
        effect, parameter: which.
        value: largest deviation that is left, as a value of the parameter, bounds of the search observed.
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


def confusable(
    named: list[str],
    candidates: list[Candidate],
    tried: list[Combination],
    alike: Sequence[str] = (),
    probabilities: Mapping[str, float] | None = None,
) -> list[list[str]]:
    """Sets of effects, the named one first, between which the data do not decide; `alike` act as one.

    Beside something unknown the `probabilities` of explanations count, where what is named is among them.
    """
    found = [n for n in named if n != explanations.UNKNOWN]
    if not found:
        return []
    if len(found) < len(named) and explanations.key(named) in (probabilities or {}):
        return _instead(named, found, probabilities)
    sets = {name: [name] for name in found}
    if len(found) == 1:
        own = next((c.log_bayes for c in candidates if c.effect == found[0]), math.inf)
        near = [c.effect for c in candidates if 2.0 * (own - c.log_bayes) < ALIKE]
        near += [n for n in alike if n not in near] if found[0] in alike else []
        sets[found[0]] += [n for n in near if n != found[0]]
        return [members for members in sets.values() if len(members) > 1]
    own = next((c.log_bayes for c in tried if set(c.effects) == set(found)), math.inf)
    for one in tried:
        lost, other = set(found) - set(one.effects), set(one.effects) - set(found)
        if len(lost) == len(other) == 1 and 2.0 * (own - one.log_bayes) < ALIKE:
            members = sets[lost.pop()]
            members.extend(other - set(members))
    return [members for members in sets.values() if len(members) > 1]


def _instead(named, found, probabilities):
    """The same by explanations with one effect exchanged for another."""
    sets = {name: [name] for name in found}
    least = math.exp(-0.5 * ALIKE) * probabilities[explanations.key(named)]
    for other, probability in sorted(probabilities.items(), key=lambda x: -x[1]):
        effects = explanations.effects(other)
        lost, more = set(named) - set(effects), set(effects) - set(named)
        if probability > least and len(lost) == len(more) == 1 and lost <= set(found):
            sets[lost.pop()] += more
    return [members for members in sets.values() if len(members) > 1]


@dataclass(frozen=True)
class Elsewhere:
    """What an explanation other than the final model says of a parameter.

    Attributes:
        probability: of the explanation.
        value, sigma: of the parameter, fitted.
    """

    probability: float
    value: float
    sigma: float


def limits(
    scores: Screen,
    setup: Setup,
    wider: float = 1.0,
    elsewhere: Mapping[tuple[str, str], Sequence[Elsewhere]] | None = None,
) -> list[Limit]:
    """One limit for every strength that was screened.

    Args:
        scores: at the final model.
        setup: of the record.
        wider: factor on the errors where a misfit is left that nothing counts as noise.
        elsewhere: (effect, parameter) → what other explanations say of it.
    """
    others = elsewhere or {}
    worst: dict[tuple[str, str], tuple[float, float, int]] = {}
    for k, d in enumerate(scores.directions):
        length = scores.length[k]
        error = wider / length if length > 0.0 else np.inf
        estimate = scores.strength[k]
        key = (d.effect, d.strength)
        reach = _reach(abs(estimate), error, d, others.get(key, ()), setup)
        if key not in worst or reach > worst[key][0]:
            worst[key] = (reach, estimate, k)
    return [
        _limit(name, reach, estimate, scores.directions[k], setup)
        for (name, _), (reach, estimate, k) in worst.items()
    ]


def _reach(strength, error, direction, others, setup):
    """The strength that is exceeded with 5 %, of one sign or of both, over all explanations."""
    times = _TWO_SIDED if direction.two_sided else _ONE_SIDED
    own = strength + times * error
    seen = [(o.probability, *_strength(o, direction, setup)) for o in others]
    if not seen or not np.isfinite(own):
        return own
    rest, tail = max(0.0, 1.0 - sum(w for w, _, _ in seen)), float(tails.normal(times))
    parts = [(rest, strength, error), *((w, s, e) for w, s, e in seen if e > 0.0)]
    w, s, e = np.array(parts).T
    low, high = own, max(own, float((s + times * e).max()))
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        more = float(w @ tails.normal((middle - s) / e)) > tail
        low, high = (middle, high) if more else (low, middle)
    return high


def _strength(other, direction, setup):
    """Strength and its error, in the units of the screen, of a parameter's value and error."""
    p = setup.catalogue.effect(direction.effect).parameter(direction.strength)
    off = np.ravel(p.off_in(setup))[0]
    if np.isinf(off):
        return p.scale / other.value, p.scale * other.sigma / other.value**2
    return abs(other.value - off) / p.scale, other.sigma / p.scale


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
