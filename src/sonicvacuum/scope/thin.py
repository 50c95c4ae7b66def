"""Thinning of traces sampled finer than their pulses need: a zero-phase low-pass, then every q-th sample.

The low-pass is a root of a raised cosine: the noise of the samples that are kept is then as white as it was
before. One that ends below the new Nyquist frequency leaves a gap in the noise's spectrum, which a search
takes for something that no model explains.
"""

import numpy as np

# Samples that a pulse keeps over its width at half height.
SAMPLES_A_PULSE = 40
# The low-pass: half length in thinned samples, and roll-off: it leaves frequencies below 1 − ROLL_OFF of the
# new Nyquist frequency as they are, halves the power there, and takes those beyond 1 + ROLL_OFF away.
HALF, ROLL_OFF = 10, 0.5
# What the low-pass takes away within the pulse may exceed what it takes from the noise by this factor.
LOSS = 1.5


def low_pass(factor: int) -> np.ndarray:
    """Taps of the filter for one factor, summing to 1.

    Root raised cosine (Proakis & Salehi, Digital Communications, 5th ed., Sec. 9.2-1) of so many samples a
    symbol: products with itself, moved by whole symbols, sum to zero.
    """
    t, b = np.arange(-HALF * factor, HALF * factor + 1) / factor, ROLL_OFF
    corner = np.pi / (4.0 * b)
    middle, limit = np.abs(t) < 1e-9, np.abs(np.abs(t) - 0.25 / b) < 1e-9
    x = np.where(middle | limit, 1.0, t)
    taps = np.sin(np.pi * x * (1.0 - b)) + 4.0 * b * x * np.cos(np.pi * x * (1.0 + b))
    taps /= np.pi * x * (1.0 - (4.0 * b * x) ** 2)
    taps[middle] = 1.0 - b + 4.0 * b / np.pi
    taps[limit] = (
        b / np.sqrt(2.0) * ((1.0 + 2.0 / np.pi) * np.sin(corner) + (1.0 - 2.0 / np.pi) * np.cos(corner))
    )
    return taps / taps.sum()


def factor_for(traces: list[np.ndarray], widths: list[int], arrivals: list[int]) -> int:
    """Largest factor at which no trace loses more than noise; 1 where the sampling is no finer than needed.

    Args:
        traces: (S,) samples each, with rest 0.
        widths, arrivals: width at half height and index of arrival of each, in samples.
    """
    factor = min(widths, default=0) // SAMPLES_A_PULSE
    while factor > 1 and not all(_harmless(x, a, factor) for x, a in zip(traces, arrivals, strict=True)):
        factor //= 2
    return max(1, factor)


def _harmless(values, arrival, factor):
    """Whether the low-pass takes away nothing but noise, or less than a thousandth of the peak."""
    reach = HALF * factor
    if len(values) <= 2 * reach:
        return False
    taken = values[reach:-reach] - _behind(values, factor)
    quiet, pulse = np.split(taken, [max(0, arrival - 2 * reach)])
    if pulse.size == 0:
        return False
    loss = float(np.sqrt(np.mean(pulse**2)))
    noise = float(np.sqrt(np.mean(quiet**2))) if quiet.size > 20 else 0.0
    return loss < max(LOSS * noise, 1e-3 * float(np.abs(values).max()))


def _behind(values, factor):
    """(S − 2 reaches,) samples behind the low-pass, delayed by nothing."""
    from scipy.signal import oaconvolve

    return oaconvolve(values, low_pass(factor), mode="valid")


def kept(begin: int, end: int, count: int, factor: int) -> slice:
    """Samples that are left of those from `begin` to `end` of a trace of `count`.

    Those within reach of its ends are not: what the low-pass would need there was not measured.
    """
    reach = HALF * factor if factor > 1 else 0
    return slice(max(begin, reach), min(end, count - reach), factor)


def thinned(values: np.ndarray, left: slice) -> np.ndarray:
    """The samples that are `left` of a trace, see `kept`, behind the low-pass where they are thinned."""
    if left.step == 1:
        return values[left]
    reach = HALF * left.step
    return _behind(values[left.start - reach : left.stop + reach], left.step)[:: left.step]


def noise_left(factor: int) -> float:
    """Standard deviation of white noise behind the low-pass over that before it."""
    return 1.0 if factor == 1 else float(np.sqrt(np.sum(low_pass(factor) ** 2)))
