"""Scaling what is hidden to a wanted d′, and what an ideal rule could make of it."""

import math
from dataclasses import dataclass

import numpy as np
from scipy import special

from sonicvacuum.blind.catalogue import ENTRIES, Entry, hidden
from sonicvacuum.blind.signature import Frame

CLOSE = 0.005  # relative, of the d′ reached to the one wanted
DRAWS = 2000
# Strengths are taken as equally likely up to this d′.
LARGEST = 30.0


@dataclass(frozen=True)
class Scaled:
    """An effect at a strength: its parameters' strength, what is seen of it, and the d′ reached."""

    strength: float
    seen: np.ndarray
    d_prime: float


def scale(frame: Frame, entry: Entry, target: float, sign: int, shape, place, measure=None) -> Scaled:
    """Strength at which an effect's d′ is `target`, or the largest allowed one where it cannot be.

    Args:
        frame: the record.
        entry: the effect, with its sign, shape and place.
        target: wanted d′.
        measure: signature → d′; its norm by default.

    Returns:
        The last strength tried; d′ within 0.5 % of the target unless capped.
    """
    measure = measure or np.linalg.norm
    reference = frame.design.reference

    def at(strength):
        seen = frame.signature(hidden(entry, sign * strength, shape, place, reference))
        return Scaled(strength, seen, float(measure(seen)))

    low, high = 0.0, entry.most
    now = at(min(entry.start, entry.most))
    for _ in range(20):
        if abs(now.d_prime / target - 1.0) < CLOSE or (now.strength >= entry.most and now.d_prime < target):
            return now
        low, high = (now.strength, high) if now.d_prime < target else (low, now.strength)
        guess = now.strength * np.clip(target / max(now.d_prime, 1e-9), 1e-3, 1e3)
        if high < entry.most and not low < guess < high:
            guess = 0.5 * (low + high)
        now = at(min(guess, entry.most))
    return now


@dataclass(frozen=True)
class Rival:
    """A unit vector in data space that a catalogue effect could cause, and whether with both signs."""

    id: str
    place: str | int | None
    direction: np.ndarray
    two_sided: bool


def rivals(frame: Frame, change: float = 5e-3) -> list[Rival]:
    """Directions of all effects, places and shapes, from steps that change the readings by about `change`.

    Args:
        frame: the record.
        change: largest difference over the largest reading (or scalar, relatively), after one rescaling.
    """
    found = []
    for entry in ENTRIES:
        if not entry.fits(frame.design.reference):
            continue
        for shape in entry.shapes(frame.design.reference):
            size = None
            for place in entry.where(frame.design.reference):
                size, seen = _direction(frame, entry, shape, place, change, size)
                length = np.linalg.norm(seen)
                if length > 1e-6:
                    found.append(Rival(entry.id, place, seen / length, len(entry.signs) == 2))
    return found


def _direction(frame, entry, shape, place, change, size):
    """(strength, signature) near a given relative change; places share the strength found first."""
    reference = frame.design.reference
    sized = size is not None
    size = size or min(entry.start, entry.most)
    difference = frame.change(hidden(entry, size, shape, place, reference))
    if not sized:
        share = np.max(np.abs(difference)) / np.max(np.abs(frame.base))
        better = min(size * np.clip(change / max(share, 1e-12), 1e-3, 1e3), entry.most)
        if not 0.3 < better / size < 3.0:
            size = better
            difference = frame.change(hidden(entry, size, shape, place, reference))
    return size, frame.seen(difference)


def leftover(directions: list[Rival], seen: np.ndarray) -> float:
    """d′ left when the best single effect of the catalogue has explained what it can."""
    return float(np.sqrt(max(np.dot(seen, seen) - _explained(directions, seen).max(), 0.0)))


def _explained(directions, seen):
    z = np.array([r.direction @ seen for r in directions])
    both = np.array([r.two_sided for r in directions])
    return np.where(both, z, np.maximum(z, 0.0)) ** 2


def nearest(directions: list[Rival], seen: np.ndarray, but: str) -> tuple[str, float]:
    """The other effect that explains a signature best, and the d′ it leaves."""
    others = [r for r in directions if r.id != but]
    gain = _explained(others, seen)
    k = int(np.argmax(gain))
    return others[k].id, float(np.sqrt(max(np.dot(seen, seen) - gain[k], 0.0)))


def log_evidence(z: np.ndarray, two_sided: np.ndarray) -> np.ndarray:
    """ln of the mean likelihood ratio to no effect, strengths equally likely from 0 to `LARGEST`.

    ∫ exp(a z − a²/2) da / LARGEST = √(2π) exp(z²/2) (Φ(L − z) − Φ(−z)) / L; two-sided: half of it for each
    sign.

    Args:
        z: (…, directions) data along unit directions.
        two_sided: (directions,) whether both signs are possible.
    """
    one = _half(z)
    both = np.logaddexp(one, _half(-z)) - math.log(2.0)
    return np.where(two_sided, both, one)


def _half(z):
    # Φ(L − z) − Φ(−z) = Φ(z) − Φ(z − L): the form whose terms are the smaller keeps the digits.
    small = z < 0.5 * LARGEST
    large = special.log_ndtr(np.where(small, z, LARGEST - z))
    less = special.log_ndtr(np.where(small, z - LARGEST, -z))
    inside = large + np.log1p(-np.exp(less - large))
    return 0.5 * math.log(2.0 * math.pi) + 0.5 * z**2 + inside - math.log(LARGEST)


def ceiling(
    directions: list[Rival], seen: np.ndarray, random: np.random.Generator, draws: int = DRAWS
) -> dict[str, float]:
    """How often an ideal rule names each effect when data hold the signature `seen` and noise.

    The rule knows all directions, takes effects (and none) as equally likely, shares an effect's probability
    equally among its places and shapes, and names the most probable.

    Returns:
        Verdict ("none" or an id) → share of `draws` data sets, in descending order.
    """
    directions = [*directions, Rival("", None, seen / max(np.linalg.norm(seen), 1e-12), False)]
    basis = np.stack([r.direction for r in directions])
    # Noise enters only through its components along the directions.
    q, r = np.linalg.qr(basis.T)
    z = basis @ seen + random.standard_normal((draws, q.shape[1])) @ r
    log = log_evidence(z[:, :-1], np.array([d.two_sided for d in directions[:-1]]))
    ids = sorted({d.id for d in directions[:-1]})
    total = [np.zeros(draws)]
    for id in ids:
        own = [k for k, d in enumerate(directions[:-1]) if d.id == id]
        total.append(special.logsumexp(log[:, own], axis=1) - math.log(len(own)))
    winner = np.argmax(np.stack(total), axis=0)
    shares = {name: float(np.mean(winner == k)) for k, name in enumerate(["none", *ids])}
    return dict(sorted(((k, v) for k, v in shares.items() if v > 0.0), key=lambda kv: (-kv[1], kv[0])))
