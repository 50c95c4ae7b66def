"""Readings between equidistant samples, for many chains at once: one compiled pass over all outputs.

Polynomials through six neighbours. Before its first sample a signal is at rest, after its last one it is
held.
"""

import numpy as np
from numba import njit

from sonicvacuum.physics.compiled import cached, prepare
from sonicvacuum.physics.table import OPTIONS

# Neighbours that a reading is made of, of which so many lie before it.
POINTS, BEFORE = 6, 2


@njit(**OPTIONS)
def _resampled(signals, whole, weights, stride, value):
    lanes, gauges, samples = signals.shape
    for lane in range(lanes):
        w0, w1, w2, w3, w4, w5 = weights[lane]
        for gauge in range(gauges):
            signal = signals[lane, gauge]
            for t in range(value.shape[2]):
                first = whole[lane] - BEFORE + t * stride
                if first >= 0 and first + POINTS <= samples:
                    value[lane, gauge, t] = (
                        w0 * signal[first]
                        + w1 * signal[first + 1]
                        + w2 * signal[first + 2]
                        + w3 * signal[first + 3]
                        + w4 * signal[first + 4]
                        + w5 * signal[first + 5]
                    )
                else:
                    total = 0.0
                    for k in range(POINTS):
                        if first + k >= 0:
                            total += weights[lane, k] * signal[min(first + k, samples - 1)]
                    value[lane, gauge, t] = total


_compiled = cached(_resampled)


def resampled(signals: np.ndarray, whole: np.ndarray, weights: np.ndarray, stride: int, count: int):
    """Weighted sums of neighbouring samples, at equal distances.

    Args:
        signals: (L, S, T) samples.
        whole: (L,) the last sample before the first reading.
        weights: (L, POINTS) of the neighbours from `whole` − BEFORE on.
        stride: samples from one reading to the next.
        count: number of readings.

    Returns:
        (L, S, count).
    """
    value = np.empty((*signals.shape[:2], count))
    arguments = (
        np.ascontiguousarray(signals, dtype=float),
        np.ascontiguousarray(whole, dtype=np.int64),
        np.ascontiguousarray(weights, dtype=float),
        stride,
        value,
    )
    prepare(_compiled, "resampled", arguments)
    _compiled(*arguments)
    return value
