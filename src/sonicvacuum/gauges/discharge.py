"""How a gauge discharges through its resistance, sample by sample: many signals in one compiled pass."""

from pathlib import Path

import numpy as np

from sonicvacuum.physics.kernels import Compiled


def _discharged(signals, decay, rise, bend, shown):
    samples = signals.shape[1]
    for row in range(len(signals)):
        signal, one = signals[row], shown[row]
        share, follow, curve = decay[row], rise[row], bend[row]
        left = one[0] = signal[0]
        for t in range(1, samples):
            more = follow * (signal[t] - signal[t - 1])
            if curve != 0.0 and 1 < t < samples - 1:
                more += curve * (signal[t + 1] - signal[t] - signal[t - 1] + signal[t - 2])
            # What comes is worked out before: steps wait for one product and one sum only.
            left = share * left + more
            one[t] = left


def _made():
    from sonicvacuum.physics.table import OPTIONS

    return _discharged, OPTIONS


_compiled = Compiled(_made, "discharged", (Path(__file__),))


def discharged(signals: np.ndarray, decay: np.ndarray, rise: np.ndarray, bend: np.ndarray) -> np.ndarray:
    """y[n + 1] = E y[n] + r (x[n + 1] − x[n]) + c (x[n + 2] − x[n + 1] − x[n] + x[n − 1]), y[0] = x[0].

    The last term only where all four samples are.

    Args:
        signals: (N, S), one sample or more.
        decay: (N,) E, what is left of a reading after one interval.
        rise: (N,) r, by which it follows a signal that rises evenly.
        bend: (N,) c, and one that bends.

    Returns:
        (N, S).
    """
    signals = np.ascontiguousarray(signals, dtype=float)
    shown = np.empty_like(signals)
    _compiled(signals, *(np.ascontiguousarray(n, dtype=float) for n in (decay, rise, bend)), shown)
    return shown
