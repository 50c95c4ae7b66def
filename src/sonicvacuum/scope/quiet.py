"""One trace looked at: its rest, its noise, where the pulse arrives, and what the recorder did to it."""

from dataclasses import dataclass

import numpy as np

# The trace is cut into so many stretches to find those at rest.
STRETCHES = 64
# A trace has arrived when this many samples in a row are off the rest by so many standard deviations, by
# this share of the largest excursion, and by so many steps of the converter.
IN_A_ROW, SIGMAS, SHARE, STEPS = 3, 6.0, 0.03, 2.5
# Peak over noise below which there is no pulse.
WEAKEST = 8.0
# Equal samples in a row at an extreme from which the recorder's range counts as exceeded.
CLIPPED = 5
# A single sample off the median of its neighbours by so many standard deviations is a spike.
SPIKE = 10.0
# Pulses of fewer samples at half height are flattened by a median of five: they are taken as recorded.
SHORT = 12
# Standard deviation of a normal law over its median absolute deviation.
_NORMAL = 1.4826


@dataclass(frozen=True, eq=False)
class Trace:
    """What was found in one trace of S samples, in its own unit.

    Attributes:
        rest: level before the pulse.
        sigma: standard deviation of white noise of one sample, the converter's step included.
        slow: standard deviation at rest of all noise, hum and drift included.
        quiet: number of samples at rest before the arrival.
        arrival: index at which the pulse arrives, None without a pulse.
        width: samples for which the largest excursion exceeds its half.
        last: index of the last sample that stands out.
        peak: largest excursion from rest, with its sign.
        step: step of the converter, 0 where none shows.
        clipped: samples at an extreme that look cut off.
        spikes: indices of single samples far off their neighbours.
    """

    rest: float
    sigma: float
    slow: float
    quiet: int
    arrival: int | None
    width: int
    last: int
    peak: float
    step: float
    clipped: int
    spikes: np.ndarray


def look(values: np.ndarray) -> Trace:
    """Find rest, noise and pulse in (S,) finite samples."""
    from scipy.ndimage import median_filter

    values = np.asarray(values, dtype=float)
    step = converter_step(values)
    rest, sigma, wander = _rest(values, step)
    smooth = median_filter(values, 5, mode="nearest") if len(values) > 50 else values
    off = np.abs(smooth - rest)
    width = _width(off, int(off.argmax()))
    if width < SHORT and len(values) > 50:
        # Two samples in a row are no spike, and may be a pulse.
        smooth = median_filter(values, 3, mode="nearest")
        off = np.abs(smooth - rest)
    top = int(off.argmax())
    least = max(SIGMAS * wander, SHARE * off[top], STEPS * step)
    arrival = _first_row(off > least) if off[top] > max(WEAKEST * wander, STEPS * step) else None
    quiet = values[: int(0.9 * arrival)] if arrival else values[:0]
    if len(quiet) >= 20:
        rest, sigma = float(np.median(quiet)), white(quiet, step)
        quiet_mean = quiet[np.abs(quiet - rest) < 6.0 * max(sigma, step)]
        rest = float(quiet_mean.mean()) if len(quiet_mean) else rest
    slow = float(_NORMAL * np.median(np.abs(quiet - rest))) if len(quiet) >= 20 else sigma
    above = np.flatnonzero(off > least)
    peak, spikes = float(smooth[top] - rest), _spikes(values, smooth, sigma, width)
    if width < SHORT:
        width, peak = _as_recorded(values - rest, top, width)
    return Trace(
        rest,
        sigma,
        max(slow, sigma),
        len(quiet),
        arrival,
        width,
        int(above[-1]) if len(above) else len(values) - 1,
        peak,
        step,
        _clipped(values),
        spikes,
    )


def white(values: np.ndarray, step: float) -> float:
    """White noise of one sample from differences of neighbours, at least that of rounding to the step.

    Differences of white noise have √2 times its standard deviation; hum and drift drop out of them. A
    rounded value is off by step/√12 on average (Widrow & Kollár, Quantization Noise, 2008).
    """
    steps = np.diff(values)
    sigma = float(np.sqrt(np.mean(steps**2) / 2.0)) if len(steps) else 0.0
    robust = float(_NORMAL * np.median(np.abs(steps)) / np.sqrt(2.0)) if len(steps) else 0.0
    # A few spikes blow up the mean square; where steps are coarse the median is of no use.
    found = robust if robust > 0.0 and sigma > 1.5 * robust and robust > step else sigma
    return max(found, step / np.sqrt(12.0))


def converter_step(values: np.ndarray) -> float:
    """Step of the converter, of which all distances of neighbouring values are multiples; 0 without one."""
    levels = np.unique(values)
    if len(levels) < 3 or len(levels) > len(values) / 3:
        return 0.0
    gaps = np.diff(levels)
    gaps = gaps[gaps > 1e-7 * (levels[-1] - levels[0])]
    step = float(np.median(gaps[gaps < 1.5 * gaps.min()]))
    whole = np.abs(gaps / step - np.round(gaps / step)) < 0.1
    return step if whole.mean() > 0.9 else 0.0


def _rest(values, step):
    """Level, white noise and spread of the stretches that lie calm before the first that does not."""
    size = max(8, len(values) // STRETCHES)
    stretches = (
        values[: len(values) // size * size].reshape(-1, size) if len(values) >= size else values[None]
    )
    spread = stretches.std(axis=1)
    calm = spread <= 2.0 * np.quantile(spread, 0.2) + step
    end = int(np.argmin(calm)) if not calm.all() else len(calm)
    chosen = stretches[:end] if end >= 1 else stretches[calm][:1]
    level = float(np.median(chosen))
    sigma = max(white(np.ravel(chosen), step), 1e-12 * float(np.abs(values).max()))
    return level, sigma, max(sigma, float(_NORMAL * np.median(np.abs(chosen - level))))


def _first_row(flags):
    """First index from which IN_A_ROW flags are set; None where there is none."""
    if len(flags) < IN_A_ROW:
        return None
    run = np.convolve(flags, np.ones(IN_A_ROW, dtype=int), mode="valid") == IN_A_ROW
    return int(run.argmax()) if run.any() else None


def _width(off, top):
    low = np.flatnonzero(off < 0.5 * off[top])
    before, after = low[low < top], low[low > top]
    begin = int(before[-1]) if len(before) else 0
    end = int(after[0]) if len(after) else len(off) - 1
    return max(1, end - begin - 1)


def _as_recorded(moved, top, width):
    """Width and peak of the short pulse around sample `top`, from what is off the rest there."""
    first = max(0, top - width)
    off = np.abs(moved)
    highest = first + int(off[first : top + width + 1].argmax())
    return _width(off, highest), float(moved[highest])


def _clipped(values):
    """Samples that lie in rows of equal ones at the highest or lowest level, 0 for shorter rows."""
    middle, count = float(np.median(values)), 0
    for level in (values.max(), values.min()):
        edges = np.flatnonzero(np.diff(np.concatenate(([0], (values == level).astype(int), [0]))))
        rows = edges[1::2] - edges[::2]
        if level != middle and len(rows) and rows.max() >= CLIPPED and rows.max() > 0.2 * rows.sum():
            far = abs(level - middle) > 0.5 * max(abs(values.max() - middle), abs(values.min() - middle))
            count += int(rows[rows >= CLIPPED].sum()) if far else 0
    return count


def _spikes(values, smooth, sigma, width):
    """Indices of single samples off the median of five, where pulses are much longer than that."""
    if width < SHORT or sigma <= 0.0:
        return np.zeros(0, dtype=int)
    return np.flatnonzero(np.abs(values - smooth) > SPIKE * max(sigma, 1e-300))
