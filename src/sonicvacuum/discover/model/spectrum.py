"""The spectrum of noise, from stretches of it: what remembers more than one sample.

Amplifiers flicker as 1/f, filters take away what is fast, piezo discs ring. The spectrum is that of an
autoregression, whose reflection coefficients are J. P. Burg's (Maximum Entropy Spectral Analysis, Stanford
1975) with sums over all stretches, times that of white noise beside slow noise, 1/f^α (Keshner, Proc. IEEE
70, 212, 1982) or of a relaxation, where stretches wander more slowly than it remembers. Straight lines in
stretches are none of the noise: likelihoods are the restricted ones, of what lines do not change (Patterson
& Thompson, Biometrika 58, 545, 1971).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from sonicvacuum.discover.model.autoregression import Autoregression, from_correlations

# Orders that are tried, alone and beside a law of slow noise, and samples for each of them: of all stretches,
# and of one of middling length, as none may be foretold by what nearly fills its stretch.
_MOST, _BESIDE, _EACH, _IN_ONE = 48, 6, 12, 8
# −2 log likelihood that each number has to bring, and so much over that, which a spectrum brings noise of
# first order with a probability of some 1e-3: one of many orders, and slow noise beside that of first order.
_PRICE = 4.0
_SURE, _SURELY_SLOW = 20.0, 4.0
# Corner f₀, power α and lowest frequency f₁, in cycles per sample, of a law of slow noise beside white noise
# of power 1, whose power is (f₀²/(f² + f₁²))^α/2: those that are tried, every third of them first, and lags
# up to which it is followed.
Law = tuple[float, float, float]
_LAWS = (
    *((f, power, 0.0) for f in np.geomspace(0.2, 0.003, 7) for power in (1.0, 1.5, 2.0)),
    *((ratio * f, 2.0, f) for f in (0.001, 0.003, 0.01, 0.03) for ratio in (2.0, 4.0, 8.0)),
)
_SOME, _FOLLOWED = 3, 256
# Frequencies of a spectrum that is made an autocorrelation.
_GRID = 8192
_FREQUENCIES = np.arange(_GRID // 2 + 1) / _GRID
# Cosines, from the second one on, of which the first ones tell whether stretches wander: so many of them, by
# so many standard deviations of χ².
_SLOW, _FIRST, _WANDERS = np.arange(2, 10), (2, 4, 8), 2.0
# Correlations ρ of neighbours that are tried for noise of first order, and steps about the best in shares of
# 1 − ρ.
_TRIED = (0.0, 0.2, 0.4, 0.55, 0.68, 0.78, 0.86, 0.92, 0.96, 0.98)
_BETWEEN = np.array((-0.6, -0.4, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3))
# Corners of 1/f noise besides, of which −2 log likelihood is higher by no more than this.
_SLOWER, _ALIKE = np.geomspace(0.001, 0.1, 13), 4.0
# Stretches at rest show this share of the noise at least; what is foretold to this share is no noise.
_LEAST, _EXACT = 0.25, 1e-9
# Numbers that a law of slow noise has.
_LAW = 2


@dataclass(frozen=True)
class _Found:
    """A spectrum: the law of its slow part, reflection coefficients of the rest, and −2 log likelihood."""

    law: Law | None
    reflections: tuple[float, ...]
    likelihood: float

    @property
    def doubted(self) -> float:
        """−2 log likelihood, and by how much it has to be lower than that of noise of first order."""
        first = len(self.reflections) < 2
        return self.likelihood + (_SURELY_SLOW if self.law and first else 0.0 if first else _SURE)

    def noise(self, lengths: Sequence[int], corner: float = 0.0) -> Autoregression:
        """The noise, of stretches of such lengths, a standard error louder where it is slow: what wanders
        more than was thought would pass for a misfit. Times that of 1/f noise of a corner besides.
        """
        order, free = len(self.reflections), len(self.reflections) + _LAW * bool(self.law)
        power = _spectrum(_unbiased(Autoregression(self.reflections, free), lengths) if order else None)
        slow = 0.5 / order if self.law is None else self.law[0]
        if self.law is not None:
            power = power * _slow(self.law) * _slow((corner, 1.0, 0.0))
        power = power * (1.0 + math.sqrt(2.0 * free / sum(lengths)) / (1.0 + (_FREQUENCIES / slow) ** 2))
        followed = min(_FOLLOWED, 4 * order + 16) if self.law is None else _FOLLOWED
        return from_correlations(np.fft.irfft(power)[: 1 + followed], free)


def _spectrum(noise):
    """(`_GRID`/2 + 1,) power of an autoregression, up to a factor; of white noise without one."""
    if noise is None:
        return np.ones(len(_FREQUENCIES))
    shape = np.exp(-2j * np.pi * np.outer(_FREQUENCIES, np.arange(1, 1 + noise.order)))
    return 1.0 / np.abs(1.0 - shape @ noise.predictors[-1]) ** 2


def _unbiased(noise, lengths):
    """An autoregression of as many orders whose stretches look like this one's once they are off their lines;
    this one where that is none.
    """
    n = min(int(np.mean(lengths)), _GRID // 16)
    r = noise.correlations(n)
    lines, _ = np.linalg.qr(_line(n).T)
    covariance = r[np.abs(np.subtract.outer(np.arange(n), np.arange(n)))]
    taken = lines @ (lines.T @ covariance)
    left = covariance - taken - taken.T + lines @ (lines.T @ covariance @ lines) @ lines.T
    seen = np.array([np.trace(left, lag) / (n - lag) for lag in range(1 + noise.order)])
    found = from_correlations(2.0 * r[: len(seen)] - seen / (1.0 - 2.0 / n), noise.free)
    return found if np.abs(found.reflections).max() < 1.0 else noise


def _slow(law):
    """(`_GRID`/2 + 1,) power of white noise of power 1 with slow noise beside it, at 0 as at the next."""
    corner, power, lowest = law
    frequencies = np.maximum(_FREQUENCIES, 1.0 / _GRID)
    return 1.0 + (corner / np.hypot(frequencies, lowest)) ** power


@lru_cache(maxsize=64)
def _of_law(law: Law) -> Autoregression:
    return from_correlations(np.fft.irfft(_slow(law))[: 1 + _FOLLOWED], _LAW)


def told(stretches: Sequence[np.ndarray]) -> Autoregression | None:
    """The noise of (n,) stretches; None where it may be white or of first order."""
    return _told(tuple(s.tobytes() for s in stretches if len(s) >= 2 * _EACH))


@lru_cache(maxsize=256)
def _told(samples: tuple[bytes, ...]) -> Autoregression | None:
    """Remembered, as each hypothesis of a slip asks again of gauges that it leaves as they are."""
    stretches = [np.frombuffer(s) for s in samples]
    best = _likeliest(stretches)
    if best is None or not best.doubted < _of_first_order(stretches):
        return None
    # Noise is there from the first sample to the last: what comes at the end is the foot of a pulse.
    begun = [s[: len(s) // 2] for s in stretches]
    noise = _slower(best, stretches)
    return noise if _likelihood(begun, noise) < _of_first_order(begun) + _PRICE else None


def _slower(found, stretches):
    """The noise of a spectrum; of one that wanders with as much 1/f noise besides as stretches allow, which
    hardly tell what wanders more slowly than they last.
    """
    lengths = [len(s) for s in stretches]
    noise = found.noise(lengths)
    most = _likelihood(stretches, noise) + _ALIKE
    for corner in _SLOWER if found.law else ():
        slower = found.noise(lengths, corner)
        if _likelihood(stretches, slower) > most:
            break
        noise = slower
    return noise


def _of_first_order(stretches):
    """The lowest −2 log likelihood of white noise and of the first order, a number more."""

    def of(rho):
        return _likelihood(stretches, Autoregression((float(rho),), 1))

    coarse = [of(rho) for rho in _TRIED]
    best = _TRIED[int(np.argmin(coarse))]
    return min(coarse[0], min(map(of, best + _BETWEEN * (1.0 - best))) + _PRICE)


def together(groups: Sequence[Sequence[np.ndarray]]) -> list[Autoregression | None]:
    """The noise of each of several gauges of which (n,) stretches are given: the same for all but those that
    surely have another one.
    """
    scaled = [_scaled(group) for group in groups]
    shared = told([one for group in scaled for one in group])
    return [_own(group, shared) for group in scaled]


def audible(stretches: Sequence[np.ndarray], sigma: float) -> list[np.ndarray]:
    """(n,) stretches of a gauge, none of those that show far less than its noise of one sample, about lines:
    simulated readings have no noise before the pulse, and what there is of the pulse is none.
    """
    power = sum(float(np.square(off_its_line(s)).sum()) for s in stretches)
    return list(stretches) if power > (_LEAST * sigma) ** 2 * sum(map(len, stretches)) else []


def sized(noise: Autoregression, stretches: Sequence[np.ndarray]) -> Autoregression:
    """Noise of a spectrum as large as (n,) stretches show it, less their lines; as it is without any."""
    power = sum(float(np.square(noise.whitened(off_its_line(s))).sum()) for s in stretches)
    # Numbers that were chosen freely take up as many samples.
    count = max(sum(max(len(s) - 2, 0) for s in stretches) - noise.free, 1)
    return replace(noise, scale=noise.scale * math.sqrt(power / count)) if power > 0.0 else noise


def _scaled(group):
    """Stretches of a gauge over what their lines leave."""
    group = [s for s in group if len(s) >= 2 * _EACH]
    left = [off_its_line(s) for s in group]
    size = math.sqrt(sum(float(s @ s) for s in left) / max(sum(map(len, left)), 1))
    return [s / size for s in group] if size > 0.0 else []


def _own(group, shared):
    if shared is None or not group:
        return told(group) or shared
    left, likelihood = _beside_lines(group, shared)
    # What the noise of all gauges leaves of this one is white, or it has another.
    plain = _orders(left, likelihood, None)
    if min(one.likelihood for one in plain) > plain[0].likelihood - _SURE:
        return shared
    own = told(group)
    if own is None:
        return shared if plain[0].likelihood < _of_first_order(group) + _SURE else None
    return own if plain[0].likelihood - _likelihood(group, own) > _SURE + _PRICE * own.free else shared


def _likeliest(stretches):
    """The likeliest spectrum, doubted; None where it is of first order, or stretches are too short."""
    if sum(map(len, stretches)) < 3 * _EACH:
        return None
    left, likelihood = _beside_lines(stretches, None)
    plain = _orders(left, likelihood, None)
    found = list(plain)
    if _wander(stretches, plain[min(1, len(plain) - 1)]):
        found += _beside_laws(stretches, _LAWS[::_SOME])
        # Where some laws are far off the others are.
        least = min(one.likelihood for one in plain[:2]) + _ALIKE
        if min(one.likelihood for one in found[len(plain) :]) < least:
            found += _beside_laws(stretches, [law for k, law in enumerate(_LAWS) if k % _SOME])
    best = min(found, key=lambda one: one.doubted)
    return None if best in plain[:2] else best


def _beside_laws(stretches, laws):
    """Spectra of rising orders beside each law."""
    return [one for law in laws for one in _orders(*_beside_lines(stretches, _of_law(law)), law)]


def _wander(stretches, first):
    """Whether the lowest cosines but the first hold more than noise of first order would."""
    noise = Autoregression(first.reflections, 0)
    power = np.zeros(len(_SLOW))
    for s in stretches:
        white = noise.whitened(off_its_line(s))
        n = len(white)
        waves = np.cos(np.pi * _SLOW[:, None] * (np.arange(n) + 0.5) / n)
        power += np.square(waves @ white) * 2.0 / max(float(white @ white), 1e-300)
    told = ((float(power[:k].sum()), k * len(stretches)) for k in _FIRST)
    return any(seen > number + _WANDERS * math.sqrt(2.0 * number) for seen, number in told)


def _beside_lines(stretches, noise):
    """(n,) stretches made independent as noise has it, less their lines; and of −2 log likelihood what does
    not depend on their size.
    """
    left, volume = [], 0.0
    for s in stretches:
        n = len(s)
        table = np.stack([*_line(n), s])
        if noise is not None and noise.order:
            table = noise.whitened(table)
            volume += float(np.log(noise.innovations[: min(n, noise.order)]).sum())
            volume += max(n - noise.order, 0) * math.log(noise.innovations[-1])
        lines, own = table[:2], table[2]
        (a, b), (_, d) = products = lines @ lines.T
        left.append(own - np.linalg.solve(products, lines @ own) @ lines)
        volume += math.log(max(a * d - b * b, 1e-300))
    return left, volume


@lru_cache(maxsize=256)
def _line(n):
    """(2, n) a level and a slope."""
    return np.stack([np.ones(n), np.linspace(-1.0, 1.0, n)])


def _orders(left, likelihood, law):
    """Spectra of rising orders, by Burg's recursion, 0 first."""
    forward = backward = left
    count = sum(map(len, left)) - 2 * len(left)
    power = sum(float(s @ s) for s in left)
    likelihood += count * math.log(max(power, 1e-300) / count) + _PRICE * _LAW * bool(law)
    found, reflections, start = [_Found(law, (), likelihood)], (), power
    in_one = int(np.median([len(s) for s in left])) // _IN_ONE
    for lag in range(1, min(_BESIDE if law else _MOST, count // _EACH, in_one) + 1):
        pairs = [(f[1:], b[:-1]) for f, b in zip(forward, backward, strict=True) if len(f) > 1]
        power = sum(float(a @ a + b @ b) for a, b in pairs)
        number = sum(len(a) for a, _ in pairs)
        if not power > _EXACT * start or number < _EACH * lag:
            break
        k = 2.0 * sum(float(a @ b) for a, b in pairs) / power
        forward, backward = [a - k * b for a, b in pairs], [b - k * a for a, b in pairs]
        likelihood += number * math.log1p(-k * k) + _PRICE
        reflections = (*reflections, k)
        found.append(_Found(law, reflections, likelihood))
    return found


def _likelihood(stretches, noise):
    """−2 log likelihood of stretches, of any size, beside their lines."""
    left, volume = _beside_lines(stretches, noise)
    count = max(sum(map(len, left)) - 2 * len(left), 1)
    return count * math.log(max(sum(float(s @ s) for s in left), 1e-300) / count) + volume


def off_its_line(stretch: np.ndarray) -> np.ndarray:
    """(n,) stretch without its straight line."""
    if len(stretch) < 3:
        return np.zeros(len(stretch))
    place = np.arange(len(stretch)) - 0.5 * (len(stretch) - 1)
    return stretch - stretch.mean() - place * (place @ stretch / max(place @ place, 1e-300))
