"""Slips that single traces show by themselves, without any model: levels, drift, noise.

Spikes and cut samples are found by `model.masks`, for every record alike.
"""

import math

import numpy as np

from sonicvacuum.discover.model import coloured
from sonicvacuum.discover.model.autoregression import Autoregression
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
# What swings from the first tenth on is no pulse up to so many times that swing, unless it is this high.
_SWING, _PULSE = 1.5, 0.35
# Where in a stretch a pulse may begin, as shares of its length.
_ONSETS = np.linspace(0.0, 0.9, 19)
# Standard errors by which a line starts off rest.
_OFF = 3.0


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


def without_spikes(trace: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The trace with its spikes drawn over straight."""
    place = np.arange(len(trace))
    return np.interp(place, place[~at], trace[~at])


def misstated(
    stretches: dict[str, np.ndarray],
    sigma: float,
    rounded: float = 0.0,
    noise: Autoregression | None = None,
    samples: int = 0,
) -> dict[str, float]:
    """Run → noise over the stated one where it surely is another, of a gauge's quiet stretches by run.

    Stretches too short to be judged are as the others where these agree, unless they say the contrary; where
    all are too short, or none shows it surely by itself, they are judged together. Of `noise` that remembers
    more than one sample, in the gauge's unit, the stated size is that of traces of so many samples.
    """
    if noise is not None:
        found = {run: _ratio_beside(s, sigma, noise, samples) for run, s in stretches.items()}
        return {run: ratio for run, ratio in found.items() if ratio is not None}
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


def _ratio_beside(stretch, sigma, noise, samples):
    """`noise_ratio` of noise of any spectrum: short stretches show less of what is slow than traces do."""
    n = len(stretch)
    if n < FEWEST or not sigma:
        return None
    size, error = noise.about_line(n)
    ratio = _log_ratio(stretch, sigma) - math.log(size / noise.about_line(max(n, samples))[0])
    return math.exp(ratio) if abs(ratio) > max(SURE * error, math.log(NOISE_FACTOR)) else None


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


def drift(
    stretch: np.ndarray, sigma: float, noise: Autoregression | None = None
) -> tuple[float, float] | None:
    """Slope per sample of a quiet stretch and its standard error, None where it may be flat or is no line:
    beside white noise or that of first order, or `noise` in the gauge's unit.

    Of a line only the noise is left once it is taken off; of a pulse that began early, or of a bend, more, or
    as much as a pulse leaves that begins in the stretch.
    """
    n = len(stretch)
    if n < FEWEST:
        return None
    slope, _ = _straight(stretch)
    bare = stretch - line(stretch)
    left = float(bare.std(ddof=2))
    most = max(sigma, flicker(stretch), noise.about_line(n)[0] if noise else 0.0)
    if left > NOISE_FACTOR * most or _foot(stretch) < bare @ bare:
        return None
    error = max(sigma, left) * math.sqrt(12.0 / n**3) * coloured.wider(bare)
    if noise is not None:
        error = noise.error_of_slope(n)
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


def rest(
    stretch: np.ndarray, sigma: float, common: float = 0.0, noise: Autoregression | None = None
) -> tuple[float, float]:
    """Mean of a quiet stretch and its standard error, `common` the error that all its samples share, beside
    noise as in `drift`.

    A short stretch tells it where it stands still within its errors, as the foot of a broad pulse does not;
    where it does not, the error is infinite.
    """
    if len(stretch) < FEWEST:
        return level(stretch, sigma, common, 0.0, noise) or (0.0, math.inf)
    return float(stretch.mean()), _error_of_mean(stretch, sigma, common, noise)


def _error_of_mean(stretch, sigma, common, noise):
    if noise is not None:
        return math.hypot(noise.error_of_mean(len(stretch)), common)
    error = max(sigma, float(stretch.std())) / math.sqrt(len(stretch))
    return math.hypot(error * coloured.wider(stretch - line(stretch)), common)


def level(
    stretch: np.ndarray,
    sigma: float,
    common: float = 0.0,
    moving: float = 0.5,
    noise: Autoregression | None = None,
) -> tuple[float, float] | None:
    """Mean of a quiet stretch and its standard error as in `rest`; None where it is too short, without noise,
    or does not stand still: the foot of a slow pulse shows in the second half, a level in both. `moving` is
    the share of the mean by which a half may differ beyond its error.
    """
    if len(stretch) < _LEVEL_EACH or not max(sigma, float(np.ptp(stretch))) > 0.0:
        return None
    mean, error = float(stretch.mean()), _error_of_mean(stretch, sigma, common, noise)
    if _foot(stretch) < np.square(stretch - mean).sum():
        return None
    apart = max(abs(float(half.mean()) - mean) for half in np.array_split(stretch, 2))
    return (mean, error) if apart < max(moving * abs(mean), 3.0 * error) else None
