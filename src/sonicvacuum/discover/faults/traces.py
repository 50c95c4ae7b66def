"""Slips that single traces show by themselves, without any model: spikes, drift, pick-up, noise."""

import math

import numpy as np

from sonicvacuum.discover.model.problem import flicker

# A spike stands this many robust standard deviations off the median of its neighbours, and off both of them;
# of a hundred thousand Gaussian samples the largest is below 5.
SPIKE = 8.0
# Samples of a quiet stretch that can be judged.
FEWEST = 40
# Sure deviations of a quiet stretch, in standard errors.
SURE = 6.0
# Noise is misstated where it differs by this factor, and surely.
NOISE_FACTOR = 1.3
# Share of the power of a quiet stretch that a single line must hold to be pick-up, and its p-value.
LINE_P = 1e-6
# Quiet is what precedes the first sample above this share of the peak; the last part of it is left out.
_QUIET_PEAK, _QUIET_SHARE = 0.03, 0.7


def quiet(trace: np.ndarray, sigma: float) -> np.ndarray:
    """(n,) samples before the pulse arrives, counted generously off a baseline."""
    rest = float(np.median(trace[: max(8, len(trace) // 20)]))
    level = max(6.0 * sigma, _QUIET_PEAK * float(np.abs(trace - rest).max()))
    loud = np.abs(trace - rest) > level
    first = int(loud.argmax()) if loud.any() else len(trace)
    return trace[: int(_QUIET_SHARE * first)]


def spikes(trace: np.ndarray, sigma: float) -> np.ndarray:
    """(T,) samples that stand alone: far off the median of two neighbours on either side, and back at once.

    Off by more than the steepest change that two neighbouring samples of the rest show, so that a sharp front
    that is sampled coarsely is none.
    """
    if len(trace) < 8:
        return np.zeros(len(trace), dtype=bool)
    padded = np.pad(trace, 2, mode="reflect")
    near = np.stack([padded[k : k + len(trace)] for k in (0, 1, 3, 4)])
    middle = np.median(near, axis=0)
    spread = near.max(axis=0) - near.min(axis=0)
    scale = max(sigma, flicker(trace))
    return (np.abs(trace - middle) > SPIKE * scale) & (np.abs(trace - middle) > 3.0 * spread)


def without_spikes(trace: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The trace with its spikes drawn over straight."""
    place = np.arange(len(trace))
    return np.interp(place, place[~at], trace[~at])


def noise_ratio(stretch: np.ndarray, sigma: float) -> float | None:
    """Noise of a quiet stretch, its straight line removed, over the stated one; None where they may agree."""
    n = len(stretch)
    if n < FEWEST or not sigma:
        return None
    ratio = float((stretch - line(stretch)).std(ddof=2)) / sigma
    far = abs(math.log(max(ratio, 1e-12))) / (1.0 / math.sqrt(2.0 * n))
    return ratio if far > SURE and not 1.0 / NOISE_FACTOR < ratio < NOISE_FACTOR else None


def line(stretch: np.ndarray, at: np.ndarray | None = None) -> np.ndarray:
    """Straight line through a stretch, at its samples or others (counted from its first)."""
    slope, start = _straight(stretch)
    return start + slope * (np.arange(len(stretch)) if at is None else at)


def _straight(stretch):
    place = np.arange(len(stretch)) - 0.5 * (len(stretch) - 1)
    slope = float(place @ stretch / (place @ place))
    return slope, float(stretch.mean()) + slope * float(place[0])


def drift(stretch: np.ndarray, sigma: float) -> float | None:
    """Slope per sample of a quiet stretch, None where it may be flat."""
    n = len(stretch)
    if n < FEWEST:
        return None
    slope, _ = _straight(stretch)
    noise = max(sigma, float((stretch - line(stretch)).std(ddof=2)))
    return slope if abs(slope) > SURE * noise * math.sqrt(12.0 / n**3) else None


def rest(stretch: np.ndarray, sigma: float) -> tuple[float, float]:
    """Mean of a quiet stretch and its standard error."""
    if len(stretch) < FEWEST:
        return 0.0, math.inf
    return float(stretch.mean()), max(sigma, float(stretch.std())) / math.sqrt(len(stretch))


def pickup(stretch: np.ndarray) -> tuple[float, np.ndarray] | None:
    """Frequency (cycles per sample) of the steady line in a quiet stretch, and its cosine and sine there.

    The largest of m ordinates of a white periodogram exceeds x means with probability 1 − (1 − e^−x)^m
    (Fisher, Proc. R. Soc. A 125, 54, 1929, for many ordinates). The power of the rest is taken from the
    median, which a line hardly moves: the median of an exponential distribution is ln 2 means.
    """
    n = len(stretch)
    if n < FEWEST:
        return None
    power = np.abs(np.fft.rfft(stretch - line(stretch)))[2:] ** 2
    mean = float(np.median(power)) / math.log(2.0)
    best = int(power.argmax())
    if not mean > 0.0 or len(power) * math.exp(-min(power[best] / mean, 700.0)) > LINE_P:
        return None
    # Neighbouring power falls off for a line; a red spectrum has it all at the low end.
    around = power[max(0, best - 4) : best + 5]
    if best < 2 or power[best] < 0.5 * around.sum():
        return None
    return _tuned(stretch, (best + 2) / n)


def _tuned(stretch, frequency):
    """The frequency about a first guess at which a sinusoid explains most, by a fine search."""
    n, place = len(stretch), np.arange(len(stretch))
    flat = stretch - line(stretch)

    def wave(f):
        return np.column_stack([np.cos(2.0 * np.pi * f * place), np.sin(2.0 * np.pi * f * place)])

    tried = frequency + np.linspace(-0.6, 0.6, 121) / n
    left = [float(np.linalg.lstsq(wave(f), flat, rcond=None)[1].sum()) for f in tried]
    f = float(tried[int(np.argmin(left))])
    return f, np.linalg.lstsq(wave(f), flat, rcond=None)[0]
