"""Sinusoids in single traces: is there a steady line, of which frequency, and what is left beside it?"""

import math

import numpy as np

from sonicvacuum.discover.faults.traces import FEWEST, NOISE_FACTOR, line, quiet
from sonicvacuum.discover.model import coloured
from sonicvacuum.discover.model.noise import flicker

# Share of the power of a quiet stretch that a single line must hold to be pick-up, and its p-value.
LINE_P = 1e-6
# Periods of a line that a stretch must hold, for one that is seen as a line in the spectrum, and for one that
# leaves nothing but noise.
_SEEN, _FEWEST_PERIODS = 4, 1.5
# Frequencies tried for one that several stretches share.
TRIED = 401


def quiet_beside(trace: np.ndarray, cycles: float, sigma: float) -> np.ndarray:
    """(n,) samples before the pulse arrives of a trace that may hold a line of so many cycles per sample.

    The line is taken from the first period, off which the pulse is told.
    """
    first = trace[: max(FEWEST, math.ceil(1.0 / cycles))]
    bare = without_wave(trace, wave(first, cycles)[0], cycles)
    return trace[: len(quiet(bare, sigma))]


def pickup(stretch: np.ndarray, sigma: float = 0.0) -> tuple[float, np.ndarray] | None:
    """Frequency (cycles per sample) of the steady line in a quiet stretch, and its cosine and sine there.

    A line of few periods, which no spectrum tells from a slope or a bend, counts where it leaves noise alone
    of what was more than twice as much. Of more periods, the largest of m ordinates of a white periodogram
    exceeds x means with probability 1 − (1 − e^−x)^m (Fisher, Proc. R. Soc. A 125, 54, 1929, for many
    ordinates). The power of the rest is taken from the median, which a line hardly moves: the median of an
    exponential distribution is ln 2 means.
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
    if best + 2 < _SEEN or power[best] < 0.5 * around.sum():
        return _slow_line(stretch, sigma)
    f, found, _ = _tuned(stretch, (best + 2 + np.linspace(-0.6, 0.6, 121)) / n)
    return (f, found) if _more_than_noise(stretch, f) else None


def _slow_line(stretch, sigma):
    """A line of few periods that leaves nothing but noise, None where there is none."""
    f, found, left = _tuned(stretch, np.arange(_FEWEST_PERIODS, _SEEN + 2, 0.05) / len(stretch))
    return (f, found) if _alone(stretch, f, left, sigma) else None


def is_line(stretch: np.ndarray, cycles: float, sigma: float) -> bool:
    """Whether a sinusoid of so many cycles per sample, known from elsewhere, leaves nothing but noise."""
    return len(stretch) >= FEWEST and _alone(stretch, cycles, wave(stretch, cycles)[1], sigma)


def _alone(stretch, cycles, left, sigma):
    noise, whole = math.sqrt(left / (len(stretch) - 5)), float((stretch - line(stretch)).std(ddof=2))
    quiet = noise < NOISE_FACTOR * max(sigma, flicker(stretch)) and whole > 2.0 * noise
    return quiet and _more_than_noise(stretch, cycles)


def _more_than_noise(stretch, cycles):
    """Whether noise that wanders would hardly do as well as a sinusoid: as many frequencies as half of the
    samples could have, each with two amplitudes (χ² of two degrees of freedom exceeds x at e^−x/2).
    """
    table = sinusoid(len(stretch), cycles)
    beside = stretch - table @ np.linalg.lstsq(table, stretch, rcond=None)[0]
    gain = coloured.gain(stretch - line(stretch), beside)
    return gain > 2.0 * math.log(0.5 * len(stretch) / LINE_P)


def wave(stretch: np.ndarray, cycles: float) -> tuple[np.ndarray, float]:
    """Cosine and sine of a sinusoid of so many cycles per sample beside a straight line, and the sum of
    squares left.
    """
    found, left, *_ = np.linalg.lstsq(sinusoid(len(stretch), cycles), stretch, rcond=None)
    return found[:2], float(left.sum())


def without_wave(trace: np.ndarray, found: np.ndarray, cycles: float) -> np.ndarray:
    """A trace less a sinusoid of so many cycles per sample, of which `found` are cosine and sine (`wave`)."""
    angle = 2.0 * np.pi * cycles * np.arange(len(trace))
    return trace - found @ [np.cos(angle), np.sin(angle)]


def sinusoid(n: int, cycles: float) -> np.ndarray:
    """(n, 4): cosine, sine, a level and a slope."""
    place = np.arange(n)
    angle, share = 2.0 * np.pi * cycles * place, place / n - 0.5
    return np.column_stack([np.cos(angle), np.sin(angle), np.ones_like(share), share])


def _tuned(stretch, tried):
    """The frequency, of some, at which a sinusoid explains most; its cosine and sine, and what it leaves."""
    all_of = [(*wave(stretch, f), float(f)) for f in tried]
    found, left, f = min(all_of, key=lambda one: one[1])
    return f, found, left


def shared_line(seen: list[tuple[np.ndarray, float, float]]) -> float:
    """Frequency in Hz that explains several stretches best, of (stretch, interval in s, its own frequency).

    A few periods of one stretch know it to a tenth, all stretches together by far better.
    """
    own = [f for _, _, f in seen]
    tried = np.linspace(0.98 * min(own), 1.02 * max(own), TRIED)
    left = [sum(wave(stretch, f * interval)[1] for stretch, interval, _ in seen) for f in tried]
    return float(tried[int(np.argmin(left))])
