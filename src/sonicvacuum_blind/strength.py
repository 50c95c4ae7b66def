"""Scaling what is hidden to a wanted d′, and what an ideal rule could make of it."""

import itertools
import math
from dataclasses import dataclass

import numpy as np
import scipy

from sonicvacuum_blind.catalogue import BY_ID, STUDIED, Entry, hidden
from sonicvacuum_blind.integrate import NoSolution
from sonicvacuum_blind.signature import Fit, Frame

CLOSE = 0.005  # relative, of the d′ reached to the one wanted
DRAWS = 2000
# Strengths are taken as equally likely up to this d′.
LARGEST = 30.0
# A direction of less than this share of the wanted d′ is beyond what the record can show.
NOTHING = 1e-3
# Where the record's errors explain all but 1/ABSORBED of a change, what they leave is its curvature.
ABSORBED = 8.0
# Probability of a false alarm of the ideal rule on noise alone: what the method itself is allowed.
FALSE_ALARM = 0.01
# Log evidence that differs by less decides nothing: then chance does.
TIE = 0.05


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
    fits: list[Fit] = []

    def at(strength):
        near = fits[-1].vector if fits else None
        fits.append(frame.fit(hidden(entry, sign * strength, shape, place, reference), near=near))
        return Scaled(strength, fits[-1].seen, float(measure(fits[-1].seen)))

    low, high, tried = 0.0, entry.most, []
    now = at(_guess(frame, entry, target, sign, shape, place))
    for _ in range(20):
        if abs(now.d_prime / target - 1.0) < CLOSE or (now.strength >= entry.most and now.d_prime < target):
            return now
        low, high = (now.strength, high) if now.d_prime < target else (low, now.strength)
        tried.append((math.log(now.strength), math.log(max(now.d_prime, 1e-9))))
        guess = math.exp(tried[-1][0] + _power(tried) * (math.log(target) - tried[-1][1]))
        if high < entry.most and not low < guess < high:
            guess = 0.5 * (low + high)
        now = at(min(guess, entry.most))
    return now


def _guess(frame, entry, target, sign, shape, place):
    """Strength whose d′ would be `target` if it grew in proportion, errors acting linearly."""
    first = min(entry.start, entry.most)
    seen = frame.seen(frame.change(hidden(entry, sign * first, shape, place, frame.design.reference)))
    return float(min(first * np.clip(target / max(np.linalg.norm(seen), 1e-9), 1e-3, 1e3), entry.most))


def _power(tried):
    """d ln strength / d ln d′ from the last two tries, kept between a third and three."""
    if len(tried) < 2:
        return 1.0
    (x, y), (a, b) = tried[-1], tried[-2]
    return float(np.clip((x - a) / (y - b), 1.0 / 3.0, 3.0)) if abs(y - b) > 1e-6 else 1.0


@dataclass(frozen=True)
class Rival:
    """A unit vector in data space: what an effect of the catalogue does at one place, shape and sign.

    The two signs are two directions: behind the pulse contacts stand open, and a bead slightly too heavy
    leaves them otherwise than one too light, so that signatures of small deviations are no mirror images.

    Attributes:
        id, place, sign, shape: of the effect.
        direction: (data + errors,), of the effect's signature at a strength, whose d′ is size.
    """

    id: str
    place: str | int | None
    direction: np.ndarray
    sign: int = 1
    shape: float | str | None = None
    strength: float = 1.0
    size: float = 1.0

    @property
    def kind(self) -> tuple:
        """What tells it from other directions of the effect but for strength and a shape that is a number."""
        return self.id, self.place, self.sign, self.shape if isinstance(self.shape, str) else None


def rivals(frame: Frame, size: float = 4.0) -> list[Rival]:
    """Directions of all effects, places, shapes and signs, from steps whose d′ is near `size`."""
    reference, found = frame.design.reference, []
    for entry in map(BY_ID.get, STUDIED):
        if not entry.acts(reference, frame.design.coated):
            continue
        strength = min(entry.start, entry.most)
        for shape, sign in itertools.product(entry.shapes(reference), entry.signs):
            for place in entry.where(reference):

                def change(s, entry=entry, sign=sign, shape=shape, place=place):
                    return hidden(entry, sign * s, shape, place, reference)

                strength, seen = _direction(frame, change, strength, entry.most, size)
                length = np.linalg.norm(seen)
                if length > NOTHING * size:
                    found.append(Rival(entry.id, place, seen / length, sign, shape, strength, length))
    return found


def _direction(frame, change, strength, most, size):
    """Strength and signature with a d′ within a factor of two of `size` where one rescaling finds it."""
    seen = _step(frame, change(strength))
    wanted = size / max(np.linalg.norm(seen), 1e-3 * size)
    better = float(min(strength * wanted, most))
    # So much of an effect may leave no pulse to be measured: half of it then, in the logarithm.
    while np.isfinite(better) and not 0.5 < better / strength < 2.0:
        more = _step(frame, change(better))
        if np.isfinite(more).all():
            return better, more
        better = math.sqrt(better * strength)
    return strength, seen


def _step(frame, change):
    """Signature of a small change: linear in the errors unless these explain nearly all of it.

    Not finite where the change leaves nothing to be measured.
    """
    try:
        with np.errstate(all="ignore"):
            difference = frame.change(change)
    except NoSolution:
        return np.array([np.nan])
    if not np.isfinite(difference).all():
        return difference
    seen = frame.seen(difference)
    return seen if np.linalg.norm(difference) < ABSORBED * np.linalg.norm(seen) else frame.signature(change)


def leftover(directions: list[Rival], seen: np.ndarray) -> float:
    """d′ left when the best single effect of the catalogue has explained what it can."""
    return float(np.sqrt(max(np.dot(seen, seen) - explained(directions, seen).max(), 0.0)))


def explained(directions: list[Rival], seen: np.ndarray) -> np.ndarray:
    """(directions,) d′² that each direction explains."""
    return np.maximum([r.direction @ seen for r in directions], 0.0) ** 2


def nearest(directions: list[Rival], seen: np.ndarray, but: str) -> tuple[str, float]:
    """The other effect that explains a signature best, and the d′ it leaves."""
    others = [r for r in directions if r.id != but]
    gain = explained(others, seen)
    k = int(np.argmax(gain))
    return others[k].id, float(np.sqrt(max(np.dot(seen, seen) - gain[k], 0.0)))


def log_evidence(z: np.ndarray) -> np.ndarray:
    """ln of the mean likelihood ratio to no effect, strengths equally likely from 0 to `LARGEST`.

    ∫ exp(a z − a²/2) da / L = √(2π) exp(z²/2) (Φ(L − z) − Φ(−z)) / L with L = `LARGEST`.

    Args:
        z: data along unit directions, any shape.
    """
    # Φ(L − z) − Φ(−z) = Φ(z) − Φ(z − L): the form whose terms are the smaller keeps the digits.
    small = z < 0.5 * LARGEST
    large = scipy.special.log_ndtr(np.where(small, z, LARGEST - z))
    less = scipy.special.log_ndtr(np.where(small, z - LARGEST, -z))
    inside = large + np.log1p(-np.exp(less - large))
    return 0.5 * math.log(2.0 * math.pi) + 0.5 * z**2 + inside - math.log(LARGEST)


def ceiling(
    directions: list[Rival], seen: np.ndarray, random: np.random.Generator, draws: int = DRAWS
) -> dict[str, float]:
    """How often an ideal rule names each effect when data hold the signature `seen` and noise.

    The rule knows all directions, takes effects as equally likely, shares an effect's probability equally
    among its places, shapes and signs, and names the most probable one, or tosses a coin;
    none unless the evidence passes what noise alone reaches in a share `FALSE_ALARM` of data sets.

    Returns:
        Verdict ("none" or an id) → share of `draws` data sets, in descending order.
    """
    basis = np.stack([r.direction for r in directions])
    # Noise enters only through its components along the directions, whose covariance is the Gram matrix.
    values, vectors = np.linalg.eigh(basis @ basis.T)
    noise = (random.standard_normal((draws, len(basis))) * np.sqrt(np.maximum(values, 0.0))) @ vectors.T
    ids = sorted({d.id for d in directions})
    threshold = np.quantile(_evidence(directions, ids, noise).max(axis=0), 1.0 - FALSE_ALARM)
    total = _evidence(directions, ids, basis @ seen + noise)
    chosen = np.argmax(total + TIE * random.random(total.shape), axis=0)
    winner = np.where(total.max(axis=0) > threshold, chosen, len(ids))
    shares = {name: float(np.mean(winner == k)) for k, name in enumerate([*ids, "none"])}
    return dict(sorted(((k, v) for k, v in shares.items() if v > 0.0), key=lambda kv: (-kv[1], kv[0])))


def _evidence(directions, ids, z):
    """(effects, draws) ln evidence of each effect, from data (draws, directions) along the directions."""
    log, total = log_evidence(z), []
    for id in ids:
        own = [k for k, d in enumerate(directions) if d.id == id]
        total.append(scipy.special.logsumexp(log[:, own], axis=1) - math.log(len(own)))
    return np.stack(total)
