"""What rival explanations make of what they share: errors of one explanation alone do not contain it.

Whatever is not the effect itself, a wall's modulus, a gain, is there under every explanation; a parameter of
an effect is there under all that have the effect. What the data say of either is the mixture of what they say
under each, by the probabilities (Hoeting, Madigan, Raftery & Volinsky, Statist. Sci. 14, 382, 1999). Each is
taken as wide as under the explanation that is told, and lies where its own fit does.
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
    fits = {explanations.key(c.effects): c.fit for c in found}
    return _probable({name: float(np.exp(w - total)) for name, w in weights.items()}, fits)


def of_odds(
    odds: Mapping[str, float], null: Fit, singles: Iterable[Candidate], sets: Iterable[Combination]
) -> list[Rival]:
    """Rivals of explanations with probabilities; those with something unknown are left aside."""
    fits = {explanations.NONE: null, **{c.effect: c.fit for c in singles}}
    return _probable(odds, fits | {explanations.key(c.effects): c.fit for c in sets})


def _probable(odds, fits):
    return [Rival(p, fits[name]) for name, p in odds.items() if p > LEAST and name in fits]


def nuisances(fit: Fit, found: Sequence[Rival]) -> np.ndarray:
    """(q,) mean square by which nuisances of the rivals lie off those of a fit."""
    total = sum(one.probability for one in found)
    off = sum((one.probability * np.square(one.fit.nu - fit.nu) for one in found), np.zeros(len(fit.nu)))
    return off / total if total else off


def shifts(fit: Fit, found: Sequence[Rival]) -> list[tuple[np.ndarray, np.ndarray]]:
    """For each coordinate of a fit (n,) probabilities of the rivals that have it, which sum to 1, and (n,) by
    how much theirs lies off it; ([1], [0]) where none has.
    """
    others = [(one.probability, _coordinates(one.fit)) for one in found]
    result = []
    for name, value in _coordinates(fit).items():
        there = [(p, own[name] - value) for p, own in others if name in own]
        share, off = np.array(there or [(1.0, 0.0)]).T
        result.append((share / share.sum(), off))
    return result


def _coordinates(fit):
    """(effect, its place, parameter) → coordinate."""
    components = fit.hypothesis.components
    names = [(c.effect.id, c.place, free.parameter.name) for c in components for free in c.free]
    return dict(zip(names, fit.u, strict=True))
