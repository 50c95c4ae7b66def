"""Noise of gauges, amplifiers and recorders, (n,) samples of a variance of its own, for tests of spectra."""

import math

import numpy as np
from scipy import signal


def flicker(rng, n, corner, power=1.0):
    """White noise of variance 1 and 1/f^power beside it, of equal power at a corner in cycles per sample: the
    last samples of a series eight times as long.
    """
    frequencies = np.fft.rfftfreq(8 * n)
    frequencies[0] = frequencies[1]
    drawn = np.fft.rfft(rng.standard_normal(8 * n)) * np.sqrt(1.0 + (corner / frequencies) ** power)
    return np.fft.irfft(drawn, 8 * n)[-n:]


def smoothed(rng, n):
    """Noise of a low-pass of second order at an eighth of the sampling rate, and of the recorder."""
    drawn = signal.lfilter(*signal.butter(2, 0.25), rng.standard_normal(n + 200))[200:]
    return drawn + 0.05 * rng.standard_normal(n)


def ringing(rng, n):
    """Noise of a resonance of twenty samples that remembers fourteen, and of the recorder."""
    drawn = signal.lfilter(
        [1.0], [1.0, -1.86 * math.cos(math.pi / 10.0), 0.8649], rng.standard_normal(n + 300)
    )
    return drawn[300:] + 1.5 * rng.standard_normal(n)


def relaxing(rng, n):
    """Slow noise that remembers sixty samples beside white noise as loud."""
    slow = signal.lfilter([math.sqrt(1.0 - 0.983**2)], [1.0, -0.983], rng.standard_normal(n + 800))[800:]
    return slow + rng.standard_normal(n)


def first_order(rng, n, rho):
    return signal.lfilter([math.sqrt(1.0 - rho**2)], [1.0, -rho], rng.standard_normal(n + 300))[300:]


COLOURS = {
    "flicker": lambda rng, n: flicker(rng, n, 0.1),
    "smoothed": smoothed,
    "ringing": ringing,
    "relaxing": relaxing,
}
