"""Traces whose pulse hardly stands out of the noise: what looks like rest may hold it.

A chain that loses much spreads a pulse over the whole record. Where no sample of it stands out, it looks like
a level, a drift or louder noise, and shows by its power at the lowest frequencies.
"""

import numpy as np

from sonicvacuum.discover.model import coloured

# A pulse not so many times as high as what ends a quiet stretch shows by its crest or not at all.
WEAK = 2.0
# Samples of a stretch whose frequencies can be told apart.
FEWEST = 40
# What is slow is told by so many of the lowest cosines, which gain more than this beside noise alone with a
# probability of 0.001 (χ²).
_SLOW, _GAIN = 8, 26.1


def weak(trace: np.ndarray, level: float) -> bool:
    """Whether (T,) samples, counted from rest, hardly get above what ends a quiet stretch."""
    return bool(np.abs(trace).max(initial=0.0) <= WEAK * level)


def wanders(stretch: np.ndarray) -> bool:
    """Whether (n,) samples hold something slow beside a level: the lowest cosines gain more than beside
    noise, its neighbours correlated or not.
    """
    n = len(stretch)
    if n < FEWEST:
        return False
    bare = stretch - stretch.mean()
    waves = np.cos(np.pi * np.arange(1, _SLOW + 1)[:, None] * (np.arange(n) + 0.5) / n)
    left = bare - (waves @ bare) @ waves * (2.0 / n)
    return coloured.gain(bare, left) > _GAIN
