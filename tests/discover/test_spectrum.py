"""Noise of any spectrum: predictors against exact covariances, spectra against the filters that made them."""

import math

import numpy as np
import pytest
from made_noise import COLOURS, first_order, smoothed
from scipy import linalg, signal

from sonicvacuum.discover.model import spectrum
from sonicvacuum.discover.model.autoregression import Autoregression, from_correlations
from sonicvacuum.discover.model.whitening import whitened

SEED = np.random.SeedSequence(71)
LENGTHS = (120, 110, 205, 182, 274, 240)


def slow_noise():
    frequencies = np.arange(4097) / 8192
    return from_correlations(np.fft.irfft(1.0 + 0.05 / np.maximum(frequencies, 1 / 8192))[:257], 2)


@pytest.mark.parametrize(
    "noise", [Autoregression((0.75,), 1), Autoregression((0.6, 0.3, -0.4), 3, scale=2.0), slow_noise()]
)
def test_whitening_turns_the_covariance_into_unity(noise):
    n = 400
    covariance = noise.scale**2 * linalg.toeplitz(noise.correlations(n))
    white = noise.whitened(np.eye(n)).T
    np.testing.assert_allclose(white @ covariance @ white.T, np.eye(n), atol=1e-12)  # rounding


def test_so_it_does_beside_gaps_where_all_samples_before_are_near():
    noise = slow_noise()
    at = np.flatnonzero(np.random.default_rng(SEED).random(60) < 0.5)[:30]
    covariance = noise.correlations(60)[np.abs(np.subtract.outer(at, at))]
    white = noise.whitened(np.eye(len(at)), at).T
    np.testing.assert_allclose(white @ covariance @ white.T, np.eye(len(at)), atol=1e-9)  # 1e-12 of a ridge


def test_predictors_are_those_of_the_normal_equations():
    noise = Autoregression((0.6, 0.3, -0.4, 0.1), 4)
    r = noise.correlations(6)
    np.testing.assert_allclose(noise.predictors[-1], linalg.solve_toeplitz(r[:4], r[1:5]), atol=1e-12)
    again = from_correlations(r[:5], 4)
    np.testing.assert_allclose(again.reflections, noise.reflections, atol=1e-12)  # rounding
    assert noise.innovations[-1] == pytest.approx(1.0 - noise.predictors[-1] @ r[1:5], abs=1e-12)


def test_errors_of_a_mean_and_of_a_line_are_those_of_the_covariance():
    noise, n = Autoregression((0.7, 0.2), 2, scale=3.0), 90
    covariance = 9.0 * linalg.toeplitz(noise.correlations(n))
    table = np.column_stack([np.ones(n), np.arange(n) - 0.5 * (n - 1)])
    fit = np.linalg.pinv(table)
    errors = np.sqrt(np.diag(fit @ covariance @ fit.T))
    assert [noise.error_of_mean(n), noise.error_of_slope(n)] == pytest.approx(errors, rel=1e-9)  # rounding
    left = np.eye(n) - table @ fit
    assert noise.about_line(n)[0] == pytest.approx(math.sqrt(np.trace(left @ covariance) / (n - 2)), rel=1e-9)


def test_gauges_of_first_order_are_whitened_as_before():
    rng = np.random.default_rng(SEED)
    samples, present = rng.standard_normal((4, 2, 50)), rng.random((2, 50)) > 0.1
    for there in (None, present):
        colours = (Autoregression((0.5,), 1), None)
        mixed = whitened(samples, np.array([0.5, 0.3]), there, colours)
        # An autoregression of first order is the same noise.
        np.testing.assert_allclose(mixed, whitened(samples, np.array([0.5, 0.3]), there), atol=1e-9)


@pytest.mark.parametrize("name", COLOURS)
def test_what_remembers_more_than_one_sample_is_told(name):
    """What is told, whitened by it, is as loud at all frequencies; by the first order it is not."""
    rng = np.random.default_rng(np.random.SeedSequence((72, len(name))))
    found = spectrum.told([COLOURS[name](rng, n) for n in LENGTHS])
    fresh = [COLOURS[name](rng, 600) for _ in range(60)]
    power = np.mean([np.abs(np.fft.rfft(found.whitened(x)))[1:] ** 2 for x in fresh], axis=0)
    bands = np.array([band.mean() for band in np.split(power, [8, 24, 75])])
    # 1131 samples tell twelve numbers to a fifth of the power; what is slow is taken for louder.
    assert bands.max() < 1.6 * np.median(bands)
    rho = max(np.mean([x[1:] @ x[:-1] / (x @ x) for x in fresh]), 0.0)
    plain = [Autoregression((float(rho),), 1).whitened(x) for x in fresh]
    power = np.mean([np.abs(np.fft.rfft(x))[1:] ** 2 for x in plain], axis=0)
    bands = np.array([band.mean() for band in np.split(power, [8, 24, 75])])
    assert bands.max() > 2.0 * np.median(bands)


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.9])
def test_white_noise_and_noise_of_first_order_are_left_as_they_are(rho):
    rng = np.random.default_rng(np.random.SeedSequence((73, int(10 * rho))))
    told = [spectrum.told([first_order(rng, n, rho) for n in LENGTHS]) for _ in range(40)]
    assert sum(one is not None for one in told) <= 1  # some 1e-3 are


def test_the_foot_of_a_pulse_is_no_noise():
    rng = np.random.default_rng(np.random.SeedSequence(74))
    feet = [4.0 * np.exp((np.arange(n) - n) / 15.0) for n in LENGTHS]
    for _ in range(10):
        assert spectrum.told([rng.standard_normal(len(foot)) + foot for foot in feet]) is None


def test_readings_without_noise_tell_nothing_of_it():
    smooth = [1e-3 * np.exp((np.arange(n) - n) / 30.0) for n in LENGTHS]
    assert spectrum.audible(smooth, 1.0) == []
    wave = [np.sin(0.3 * np.arange(n)) for n in LENGTHS]
    # Two samples foretell the next one but for rounding: what is left stays a number.
    found = spectrum.told(wave)
    assert found is None or (found.innovations[-1] > 0.0 and np.isfinite(found.whitened(wave[0])).all())
    kept = spectrum.audible(wave, 1.0)
    assert all(one is other for one, other in zip(kept, wave, strict=True))


def test_gauges_share_a_spectrum_and_one_of_another_keeps_its_own():
    rng = np.random.default_rng(np.random.SeedSequence(75))

    def drawn(make, size):
        return [size * make(rng, n) for n in (200, 260, 300)]

    pink = COLOURS["flicker"]
    alike = spectrum.together([drawn(pink, 1.0), drawn(pink, 50.0), drawn(pink, 0.1)])
    assert len({one and one.reflections for one in alike}) == 1
    assert alike[0] is not None
    other = spectrum.together([drawn(pink, 1.0), drawn(pink, 1.0), drawn(smoothed, 1.0)])
    assert other[2].reflections != other[0].reflections
    assert spectrum.together([[], []]) == [None, None]


def test_sizes_are_those_of_the_stretches():
    rng = np.random.default_rng(np.random.SeedSequence(76))
    noise = Autoregression((0.6, 0.3), 2)
    stretches = [7.0 * signal.lfilter([1.0], [1.0, -0.42, -0.3], rng.standard_normal(n)) for n in (800, 900)]
    unit = 1.0 / math.sqrt(noise.innovations[-1])
    # 1700 samples tell a size to 1.7 %.
    assert spectrum.sized(noise, stretches).scale == pytest.approx(7.0 * unit, rel=0.06)
