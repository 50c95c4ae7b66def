"""Traces beside the nominal model's: is there a pulse at all, and is it the right way up?"""

import numpy as np

from sonicvacuum.discover.correlation import correlated

# A pulse is expected where the model's reading is this many standard deviations of the noise high ...
EXPECTED = 20.0
# ... and missing where the matched filter finds less than this, in standard deviations of its noise (the
# largest of a thousand shifts of pure noise is about 4) and in shares of what the model has.
SILENT, SHARE = 7.0, 0.05
# Upside down: the matched filter finds more below than above, by this factor.
INVERTED = 1.5


def verdict(trace: np.ndarray, model: np.ndarray, sigma: float) -> str:
    """ "silent", "inverted" or "" for (T,) measured and predicted readings and the noise of one sample.

    The matched filter is the model's reading slid over the trace: a pulse is found wherever it is in time.
    """
    peak = float(np.abs(model).max())
    if not peak > EXPECTED * sigma or not peak > 0.0:
        return ""
    power = float(model @ model)
    found = correlated(trace - np.median(trace), model) / power
    up, down = float(found.max()), float(-found.min())
    if max(up, down) < max(SHARE, SILENT * sigma / np.sqrt(power)) and np.abs(trace).max() < SILENT * max(
        sigma, 1e-12
    ):
        return "silent"
    # A motion gauge's reading swings both ways by itself: what the model's own would show.
    own = correlated(model, model) / power
    swing = max(1.0, INVERTED * max(float(-own.min()), 0.0))
    return "inverted" if down > INVERTED * up and down * swing > SHARE and down > up else ""
