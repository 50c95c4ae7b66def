"""Pairs by algebra: what any two effects of the nominal screen should gain together, and where their joint
fit starts, if all acted in proportion.
"""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.search import screen
from sonicvacuum.discover.search.starts import coordinates
from sonicvacuum.effects import Setup

# Signatures closer to parallel than this span no plane.
_PARALLEL = 1e-3


@dataclass(frozen=True)
class Start:
    """Where the joint fit of several effects starts, and the Δχ² that it should gain.

    `u` (L, p), `nu` (L, q) and `places` (L, effects) are L starts.
    """

    gain: float
    hypothesis: Hypothesis
    u: np.ndarray
    nu: np.ndarray
    places: np.ndarray

    @property
    def effects(self) -> frozenset:
        """Ids of all."""
        return frozenset(self.hypothesis.ids)


def promised(scores: screen.Screen) -> float:
    """The Δχ² of the best pair if all effects acted in proportion; −∞ where no two act."""
    gain, _ = _planes(scores, np.flatnonzero(scores.length > 0.0))
    return float(gain[np.triu_indices(len(gain), 1)].max(initial=-np.inf))


def foreseen(scores: screen.Screen, count: int) -> float:
    """The Δχ² of so many effects if all acted in proportion, each chosen for what it gains beside those
    before it.
    """
    score, gram = scores.projected
    able, raw = scores.length > 0.0, np.diag(gram)
    effects = np.array([d.effect for d in scores.directions])
    two_sided = np.array([d.two_sided for d in scores.directions])
    chosen: list[int] = []
    total = 0.0
    for _ in range(min(count, len(score))):
        beside = gram[:, chosen] @ np.linalg.pinv(gram[np.ix_(chosen, chosen)], rcond=1e-9, hermitian=True)
        left = raw - np.einsum("kc,kc->k", beside, gram[:, chosen])
        able &= left > _PARALLEL * raw
        z = (score - beside @ score[chosen]) / np.sqrt(np.where(able, left, np.inf))
        z = np.where(two_sided, np.abs(z), np.maximum(z, 0.0))
        best = int(np.argmax(z))
        total += float(z[best]) ** 2
        chosen.append(best)
        able &= effects != effects[best]
    return total


def linear(scores: screen.Screen, setup: Setup, most: int = 12) -> list[Start]:
    """Pairs by what they should gain beside what is in the screen's model if all effects acted in proportion,
    best first.
    """
    at = np.flatnonzero(scores.length > 0.0)
    gain, strength = _planes(scores, at)
    names = np.array([scores.directions[k].effect for k in at])
    best: dict[tuple[str, str], tuple[int, int]] = {}
    for i, j in zip(*np.nonzero(np.triu(gain > 0.0, 1)), strict=True):
        key = (str(names[i]), str(names[j]))
        if key not in best or gain[i, j] > gain[best[key]]:
            best[key] = (i, j)
    ranked = sorted(best.values(), key=lambda ij: -gain[ij])[:most]
    return [
        _from_plane(scores, setup, (at[i], at[j]), (strength[i, j], strength[j, i]), gain[i, j])
        for i, j in ranked
    ]


def _planes(scores, at):
    """(K, K) joint gain of two directions, −∞ where they span no plane or one would have the wrong sign; and
    the first one's estimate beside the second.
    """
    length = scores.length[at]
    z, rho = scores.projected[0][at] / length, scores.correlation[np.ix_(at, at)]
    effects = np.array([scores.directions[k].effect for k in at])
    one_sided = np.array([not scores.directions[k].two_sided for k in at], dtype=bool)
    plane = 1.0 - np.square(rho)
    with np.errstate(divide="ignore", invalid="ignore"):
        first = (z[:, None] - rho * z[None, :]) / plane
        gain = z[:, None] * first + z[None, :] * first.T
    wrong = (plane < _PARALLEL) | (effects[:, None] == effects[None, :])
    wrong |= (one_sided[:, None] & (first < 0.0)) | (one_sided[None, :] & (first.T < 0.0))
    return np.where(wrong, -np.inf, gain), first / length[:, None]


def _from_plane(scores, setup, ks, strengths, gain):
    """The start at the estimates of two directions, beside the screen's model as it follows."""
    hypothesis, (u, nu) = scores.fit.hypothesis, scores.moved(list(ks), np.array(strengths))
    places = [c.place or 0 for c in hypothesis.components]
    for k, strength in zip(ks, strengths, strict=True):
        d = scores.directions[k]
        free = variant(d, setup)
        hypothesis = hypothesis.with_component(Component(setup.catalogue.effect(d.effect), free))
        u = np.append(u, coordinates(free, d, strength))
        places.append(d.place or 0)
    return Start(float(gain), hypothesis, hypothesis.inside(u[None]), nu[None], np.array([places]))


def variant(direction, setup):
    """The free parameters of an effect whose strength is that of a direction."""
    options = variants(setup.catalogue.effect(direction.effect), setup)
    return next(v for v in options if v[0].parameter.name == direction.strength)
