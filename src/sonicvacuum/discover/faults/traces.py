"""Slips that single traces show by themselves, without any model: drift, pick-up, noise.

Spikes and cut samples are found by `model.masks`, for every record alike.
"""

import math

import numpy as np

from sonicvacuum.discover.model import coloured
from sonicvacuum.discover.model.noise import QUIET_PEAK, QUIET_SIGMAS, before, flicker
from sonicvacuum.discover.model.weak import wanders, weak

# Samples of a quiet stretch that can be judged.
FEWEST = 40
# Samples that suffice for a level, of all runs together and of each.
LEVEL_FEWEST, _LEVEL_EACH = 40, 12
# Sure deviations of a quiet stretch, in standard errors.
SURE = 6.0
# Noise is misstated where it differs by this factor, and surely.
NOISE_FACTOR = 1.3
# In short stretches noise of the stated size, however correlated, does worse than one of another size by so
# many standard errors: of five stretches of 12 to 35 samples of noise that is stated rightly, its neighbours
# correlated by 0.8 to 0.96, 0.4 % pass, where 1 to 97 % pass all else.
_COLOURED = 3.0
# Share of the power of a quiet stretch that a single line must hold to be pick-up, and its p-value.
LINE_P = 1e-6
# What swings from the first tenth on is no pulse up to so many times that swing, unless it is this high.
_SWING, _PULSE = 1.5, 0.35
# Periods of a line that a stretch must hold, for one that is seen as a line in the spectrum, and for one that
# leaves nothing but noise.
_SEEN, _FEWEST_PERIODS = 4, 1.5
# Where in a stretch a pulse may begin, as shares of its length.
_ONSETS = np.linspace(0.0, 0.9, 19)
# Standard errors by which a line starts off rest.
_OFF = 3.0
# Frequencies tried for one that several stretches share.
TRIED = 401


def quiet(trace: np.ndarray, sigma: float, swinging: bool = False) -> np.ndarray:
    """(n,) samples before the pulse arrives, counted generously off a baseline; with `swinging` also where
    the trace swings from its beginning on.
    """
    rest = _beginning(trace)
    peak = float(np.abs(trace - rest).max())
    level = max(QUIET_SIGMAS * sigma, QUIET_PEAK * peak)
    if swinging:
        swing = float(np.abs(trace[: max(8, len(trace) // 10)] - rest).max())
        level = max(level, _SWING * swing) if swing < _PULSE * peak else level
    return trace[: before(trace - rest, level)]


def faint(trace: np.ndarray, sigma: float) -> bool:
    """Whether a pulse, counted as in `quiet`, is a weak one."""
    return weak(trace - _beginning(trace), QUIET_SIGMAS * sigma)


def _beginning(trace):
    """Where a trace rests, by its first samples."""
    return float(np.median(trace[: max(8, len(trace) // 20)]))


def quiet_beside(trace: np.ndarray, cycles: float, sigma: float) -> np.ndarray:
    """(n,) samples before the pulse arrives of a trace that may hold a line of so many cycles per sample.

    The line is taken from the first period, off which the pulse is told.
    """
    first = trace[: max(FEWEST, math.ceil(1.0 / cycles))]
    bare = without_wave(trace, wave(first, cycles)[0], cycles)
    return trace[: len(quiet(bare, sigma))]


def without_spikes(trace: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The trace with its spikes drawn over straight."""
    place = np.arange(len(trace))
    return np.interp(place, place[~at], trace[~at])


def misstated(stretches: dict[str, np.ndarray], sigma: float, rounded: float = 0.0) -> dict[str, float]:
    """Run → noise over the stated one where it surely is another, of a gauge's quiet stretches by run.

    Stretches too short to be judged are as the others where these agree, unless they say the contrary; where
    all are too short, or none shows it surely by itself, they are judged together.
    """
    long = {run: s for run, s in stretches.items() if len(s) >= FEWEST}
    found = {run: noise_ratio(s, sigma, rounded) for run, s in long.items()}
    if not long:
        found = {
            None: _ratio_together([s for s in stretches.values() if len(s) >= _LEVEL_EACH], sigma, rounded)
        }
    surely = {run: ratio for run, ratio in found.items() if ratio is not None}
    if long and not surely:
        ratio = _ratio_together(list(long.values()), sigma, rounded)
        may_be = ratio is not None and all(_may_be(s, sigma, ratio) for s in stretches.values())
        return dict.fromkeys(stretches, ratio) if may_be else {}
    if len(surely) < len(found):
        return surely
    common = float(np.median(list(surely.values())))
    alike = {run: common for run, s in stretches.items() if run not in long and _may_be(s, sigma, common)}
    if not long:
        return alike if len(alike) == len(stretches) else {}
    return surely | alike


def _ratio_together(stretches, sigma, rounded):
    """`noise_ratio` of stretches without their lines, all of their first halves ahead of all of their second
    ones; None where noise of the stated size, of which lines leave so little, remembers more than a stretch.
    """
    halves = [np.array_split(s - line(s), 2) for s in stretches]
    joined = np.concatenate([[], *(pair[k] for k in range(2) for pair in halves)])
    ratio = noise_ratio(joined, sigma, rounded)
    sure = ratio is not None and coloured.misfit_of_size(stretches, sigma) > _COLOURED**2
    return ratio if sure else None


def _may_be(stretch, sigma, ratio):
    """Whether a short stretch does not contradict that its noise is so many times the stated one: it shows
    half of that (in logarithms), or is too short to show anything.
    """
    return len(stretch) < _LEVEL_EACH or _log_ratio(stretch, sigma) / math.log(ratio) > 0.5


def noise_ratio(stretch: np.ndarray, sigma: float, rounded: float = 0.0) -> float | None:
    """Noise of a quiet stretch, its straight line removed, over the stated one; None where they may agree.

    Noise is there from the first sample to the last: what one half shows less than half of (in logarithms)
    began within the stretch, and is none. A stretch that rests on one step of its recorder, or few, does not
    tell how much less than a step its noise is.

    Args:
        stretch: (n,) quiet samples.
        sigma: stated noise of one sample, the recorder's rounding included.
        rounded: standard deviation of that rounding, a step over √12; 0 where it is below the noise.
    """
    n = len(stretch)
    if n < FEWEST or not sigma or not np.ptp(stretch) > 0.0:
        return None
    whole, *halves = (_log_ratio(part, sigma) for part in (stretch, *np.array_split(stretch, 2)))
    bare = stretch - line(stretch)
    least = max(SURE * coloured.error_of_size(bare), math.log(NOISE_FACTOR))
    if whole < 0.0 and sigma < math.sqrt(12.0) * rounded:
        return None
    sure = abs(whole + coloured.loss_of_size(bare)) > least
    return math.exp(whole) if sure and min(h / whole for h in halves) > 0.5 else None


def _log_ratio(part, sigma):
    """Natural logarithm of the standard deviation about a line over the stated one."""
    return math.log(max(float((part - line(part)).std(ddof=2)) / sigma, 1e-12))


def line(stretch: np.ndarray, at: np.ndarray | None = None) -> np.ndarray:
    """Straight line through a stretch, at its samples or others (counted from its first)."""
    slope, start = _straight(stretch)
    return start + slope * (np.arange(len(stretch)) if at is None else at)


def _straight(stretch):
    place = np.arange(len(stretch)) - 0.5 * (len(stretch) - 1)
    slope = float(place @ stretch / (place @ place))
    return slope, float(stretch.mean()) + slope * float(place[0])


def drift(stretch: np.ndarray, sigma: float) -> tuple[float, float] | None:
    """Slope per sample of a quiet stretch and its standard error, None where it may be flat or is no line.

    Of a line only the noise is left once it is taken off; of a pulse that began early, or of a bend, more, or
    as much as a pulse leaves that begins in the stretch.
    """
    n = len(stretch)
    if n < FEWEST:
        return None
    slope, _ = _straight(stretch)
    bare = stretch - line(stretch)
    left = float(bare.std(ddof=2))
    if left > NOISE_FACTOR * max(sigma, flicker(stretch)) or _foot(stretch) < bare @ bare:
        return None
    error = max(sigma, left) * math.sqrt(12.0 / n**3) * coloured.wider(bare)
    return (slope, error) if abs(slope) > SURE * error else None


def _foot(stretch):
    """Squares that are left of a stretch beside a pulse that begins in it: from rest at 0, with the square of
    time from some sample on.
    """
    place = np.arange(len(stretch)) / len(stretch)
    feet = np.maximum(place - _ONSETS[:, None], 0.0) ** 2
    return float(stretch @ stretch - ((feet @ stretch) ** 2 / (feet**2).sum(axis=1)).max())


def straight(stretch: np.ndarray, sigma: float) -> bool:
    """Whether a stretch that may hold a weak pulse is a line all the same: it starts off rest."""
    bare = stretch - line(stretch)
    error = 2.0 * sigma / math.sqrt(len(stretch)) * coloured.wider(bare)
    return abs(float(line(stretch)[0])) > _OFF * error and not wanders(bare)


def rest(stretch: np.ndarray, sigma: float, common: float = 0.0) -> tuple[float, float]:
    """Mean of a quiet stretch and its standard error, `common` the error that all its samples share.

    A short stretch tells it where it stands still within its errors, as the foot of a broad pulse does not;
    where it does not, the error is infinite.
    """
    if len(stretch) < FEWEST:
        return level(stretch, sigma, common, 0.0) or (0.0, math.inf)
    return float(stretch.mean()), _error_of_mean(stretch, sigma, common)


def _error_of_mean(stretch, sigma, common):
    error = max(sigma, float(stretch.std())) / math.sqrt(len(stretch))
    return math.hypot(error * coloured.wider(stretch - line(stretch)), common)


def level(
    stretch: np.ndarray, sigma: float, common: float = 0.0, moving: float = 0.5
) -> tuple[float, float] | None:
    """Mean of a quiet stretch and its standard error as in `rest`; None where it is too short, without noise,
    or does not stand still: the foot of a slow pulse shows in the second half, a level in both. `moving` is
    the share of the mean by which a half may differ beyond its error.
    """
    if len(stretch) < _LEVEL_EACH or not max(sigma, float(np.ptp(stretch))) > 0.0:
        return None
    mean, error = float(stretch.mean()), _error_of_mean(stretch, sigma, common)
    if _foot(stretch) < np.square(stretch - mean).sum():
        return None
    apart = max(abs(float(half.mean()) - mean) for half in np.array_split(stretch, 2))
    return (mean, error) if apart < max(moving * abs(mean), 3.0 * error) else None


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
    table = _sinusoid(len(stretch), cycles)
    beside = stretch - table @ np.linalg.lstsq(table, stretch, rcond=None)[0]
    gain = coloured.gain(stretch - line(stretch), beside)
    return gain > 2.0 * math.log(0.5 * len(stretch) / LINE_P)


def wave(stretch: np.ndarray, cycles: float) -> tuple[np.ndarray, float]:
    """Cosine and sine of a sinusoid of so many cycles per sample beside a straight line, and the sum of
    squares left.
    """
    found, left, *_ = np.linalg.lstsq(_sinusoid(len(stretch), cycles), stretch, rcond=None)
    return found[:2], float(left.sum())


def without_wave(trace: np.ndarray, found: np.ndarray, cycles: float) -> np.ndarray:
    """A trace less a sinusoid of so many cycles per sample, of which `found` are cosine and sine (`wave`)."""
    angle = 2.0 * np.pi * cycles * np.arange(len(trace))
    return trace - found @ [np.cos(angle), np.sin(angle)]


def _sinusoid(n, cycles):
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
