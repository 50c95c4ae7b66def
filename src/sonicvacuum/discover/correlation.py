"""One trace slid along another."""

import numpy as np


def correlated(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """(n + m − 1,) sums of products of `one` (n,) with `other` (m,) at every shift, by Fourier transform.

    The first is at the shift 1 − m, at which only the last sample of `other` meets the first of `one`: what
    `scipy.signal.correlate` gives, which takes longer to load than this takes for a record.
    """
    count = len(one) + len(other) - 1
    size = 1 << (count - 1).bit_length()
    product = np.fft.rfft(one, size) * np.fft.rfft(other[::-1], size)
    return np.fft.irfft(product, size)[:count]
