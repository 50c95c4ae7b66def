"""Readings between samples: exact for polynomials, at rest before the first sample, held after the last."""

import numpy as np
import pytest

from sonicvacuum.discover.model.gauges import shifted

INTERVAL = 0.5e-6


@pytest.fixture(scope="module")
def quintic():
    """(L, S, T') samples of two quintics, their value and slope at any time in s."""
    one = np.polynomial.Polynomial([1.0, -2.0, 0.5, 3.0, -1.0, 0.2])
    two = np.polynomial.Polynomial([0.0, 1.0, 4.0, -0.3, 0.1, -0.7])
    x = np.arange(41) / 40.0
    return np.array([[one(x), two(x)]] * 3), (one, two), 40 * INTERVAL


def test_quintics_and_their_slopes_are_exact_between_samples(quintic):
    samples, curves, span = quintic
    time, shift = 4e-6 + 2.0 * INTERVAL * np.arange(10), np.array([0.0, 0.13e-6, -0.21e-6])
    value, rate = shifted(samples, INTERVAL, time, shift)
    for lane, late in enumerate(shift):
        for gauge, curve in enumerate(curves):
            x = (time - late) / span
            # Rounding only: six-point polynomials are exact up to the fifth degree.
            assert value[lane, gauge] == pytest.approx(curve(x), rel=1e-11, abs=1e-11)
            assert rate[lane, gauge] == pytest.approx(curve.deriv()(x) / span, rel=1e-7)


def test_slopes_are_given_for_every_so_many_lanes(quintic):
    samples, _, _ = quintic
    time, shift = 4e-6 + INTERVAL * np.arange(10), np.array([0.0, 0.13e-6, -0.21e-6])
    every = shifted(samples, INTERVAL, time, shift)[1]
    assert np.array_equal(shifted(samples, INTERVAL, time, shift, rated=slice(None, None, 2))[1], every[::2])


def test_a_gauge_is_at_rest_before_the_first_sample_and_held_after_the_last():
    samples = np.linspace(1.0, 2.0, 9)[None, None]
    time = INTERVAL * np.arange(-20, 40)
    value, rate = shifted(samples, INTERVAL, time, np.zeros(1))
    assert np.all(value[0, 0, time < -3.0 * INTERVAL] == 0.0)
    assert value[0, 0, time > 11.0 * INTERVAL] == pytest.approx(2.0, rel=1e-14)
    # Rounding of a difference of equal numbers over half a microsecond.
    assert np.abs(rate[0, 0, time > 11.0 * INTERVAL]).max() < 1e-7
