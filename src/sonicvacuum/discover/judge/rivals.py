"""What rival explanations make of what they share: errors of one explanation alone do not contain it.

Whatever is not the effect itself, a wall's modulus, a gain, is there under every explanation; a parameter of
an effect is there under all that have the effect. What the data say of either is the mixture of what they say
under each, by the probabilities (Hoeting, Madigan, Raftery & Volinsky, Statist. Sci. 14, 382, 1999). Each is
taken as wide as under the explanation that is told, and lies where its own fit does; at nothing where the
effect has several strengths, and another does it all.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.fit.evidence import Candidate, Combination
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import explanations

# Explanations less probable than this are left aside.
LEAST = 1e-3


@dataclass(frozen=True)
class Rival:
    """One explanation, the told one among them: its probability, of those that are compared, and its fit."""

    probability: float
    fit: Fit


def of_weights(weights: Mapping[str, float], found: Iterable[Combination]) -> list[Rival]:
    """Rivals of explanations with log weights."""
    total = np.logaddexp.reduce(list(weights.values()))
    fits = {explanations.key(c.effects): [(1.0, c.fit)] for c in found}
    return _probable({name: float(np.exp(w - total)) for name, w in weights.items()}, fits)


def of_odds(
    odds: Mapping[str, float], null: Fit, singles: Iterable[Candidate], sets: Iterable[Combination]
) -> list[Rival]:
    """Rivals of explanations with probabilities; effects with something unknown beside them are as they are
    fitted without it, `unknown` alone is left aside.
    """
    fits = {explanations.NONE: [(1.0, null)], **{c.effect: c.ways for c in singles}}
    fits |= {explanations.key(c.effects): [(1.0, c.fit)] for c in sets}
    whole: dict[str, float] = {}
    for name, p in odds.items():
        if name != explanations.UNKNOWN:
            known = explanations.key(e for e in explanations.effects(name) if e != explanations.UNKNOWN)
            whole[known] = whole.get(known, 0.0) + p
    return _probable(whole, fits)


def _probable(odds, fits):
    every = [(p * share, one) for name, p in odds.items() if name in fits for share, one in fits[name]]
    return [Rival(p, one) for p, one in every if p > LEAST]


def nuisances(fit: Fit, found: Sequence[Rival]) -> np.ndarray:
    """(q,) mean square by which nuisances of the rivals lie off those of a fit."""
    total = sum(one.probability for one in found)
    off = sum((one.probability * np.square(one.fit.nu - fit.nu) for one in found), np.zeros(len(fit.nu)))
    return off / total if total else off


def shifts(fit: Fit, found: Sequence[Rival]) -> list[tuple[np.ndarray, np.ndarray]]:
    """For each coordinate of a fit (n,) probabilities of the rivals that have it, which sum to 1, and (n,) by
    how much theirs lies off it; ([1], [0]) where none has.
    """
    result = []
    for name, (coordinate, value) in _coordinates(fit).items():
        others = [(one.probability, _coordinate(one.fit, name, coordinate)) for one in found]
        there = [(p, other - value) for p, other in others if other is not None]
        share, off = np.array(there or [(1.0, 0.0)]).T
        result.append((share / share.sum(), off))
    return result


def _coordinates(fit):
    """(effect, parameter) → coordinate and its value, wherever the effect sits."""
    components = fit.hypothesis.components
    names = [(c.effect.id, free.parameter.name) for c in components for free in c.free]
    return dict(zip(names, zip(fit.hypothesis.coordinates, fit.u, strict=True), strict=True))


def _coordinate(fit, name, coordinate):
    """A coordinate of another fit, 0 where its parameter is off there; None where the effect is not there, or
    off is not a number.
    """
    free = _coordinates(fit)
    if name in free:
        return free[name][1]
    there = name[0] in fit.hypothesis.ids
    return 0.0 if there and not coordinate.endless else None
