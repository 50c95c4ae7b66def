"""Readings between equidistant samples, for many chains at once: one compiled pass over all outputs.

Polynomials through six neighbours. Before its first sample a signal is at rest, after its last one it is
held.
"""

import numpy as np

from sonicvacuum.physics.kernels import Compiled

# Neighbours that a reading is made of, of which so many lie before it.
POINTS, BEFORE = 6, 2


def _resampled(signals, chain, whole, weights, gain, stride, value):
    samples = signals.shape[2]
    for row in range(len(chain)):
        w = weights[row]
        for gauge in range(signals.shape[1]):
            signal, factor = signals[chain[row], gauge], gain[row, gauge]
            for t in range(value.shape[2]):
                first = whole[row] - BEFORE + t * stride
                if first >= 0 and first + POINTS <= samples:
                    total = (
                        w[0] * signal[first]
                        + w[1] * signal[first + 1]
                        + w[2] * signal[first + 2]
                        + w[3] * signal[first + 3]
                        + w[4] * signal[first + 4]
                        + w[5] * signal[first + 5]
                    )
                else:
                    total = 0.0
                    for k in range(POINTS):
                        if first + k >= 0:
                            total += w[k] * signal[min(first + k, samples - 1)]
                value[row, gauge, t] = factor * total


def _made():
    from sonicvacuum.physics.table import OPTIONS

    return _resampled, OPTIONS


_compiled = Compiled(_made, "resampled")


def resampled(
    signals: np.ndarray,
    chain: np.ndarray,
    whole: np.ndarray,
    weights: np.ndarray,
    gain: np.ndarray,
    stride: int,
    count: int,
) -> np.ndarray:
    """Weighted sums of neighbouring samples, at equal distances, one row for each reading of a chain.

    Args:
        signals: (L, S, T) samples of L chains.
        chain: (N,) which of them is read.
        whole: (N,) the last sample before the first reading.
        weights: (N, POINTS) of the neighbours from `whole` − BEFORE on.
        gain: (N, S) what each reading is multiplied by.
        stride: samples from one reading to the next.
        count: number of readings.

    Returns:
        (N, S, count).
    """
    value = np.empty((len(chain), signals.shape[1], count))
    arguments = (
        np.ascontiguousarray(signals, dtype=float),
        np.ascontiguousarray(chain, dtype=np.int64),
        np.ascontiguousarray(whole, dtype=np.int64),
        np.ascontiguousarray(weights, dtype=float),
        np.ascontiguousarray(gain, dtype=float),
        stride,
        value,
    )
    _compiled(*arguments)
    return value
