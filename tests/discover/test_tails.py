"""Tails and correlations of `discover` against scipy.stats and scipy.signal, which it does without."""

import numpy as np
from scipy import signal, stats

from sonicvacuum.discover.correlation import correlated
from sonicvacuum.discover.fit import tails


def test_tails_are_those_of_scipy_stats():
    for value, freedom in ((0.0, 3), (3.2, 4), (800.0, 700.5), (60.0, 2)):
        assert tails.chi_squared(value, freedom) == stats.chi2.sf(value, freedom)
    # Inverse by another routine of the same library: rounding errors only.
    assert np.isclose(tails.chi_squared_at(1e-3, 7), stats.chi2.isf(1e-3, 7), rtol=1e-12)
    for count, mean in ((0, 0.1), (1, 0.1), (5, 2.3)):
        assert np.isclose(tails.poisson(count, mean), stats.poisson.sf(count - 1, mean), rtol=1e-12)
    values = np.array([-3.0, 0.0, 9.0])
    assert np.allclose(tails.normal(values), stats.norm.sf(values), rtol=1e-13)


def test_discovery_rate_is_that_of_scipy_stats():
    p = np.random.default_rng(1).uniform(size=50) ** 3
    assert np.allclose(tails.discovery_rate(p), stats.false_discovery_control(p), rtol=1e-13)


def test_correlation_is_that_of_scipy_signal():
    one, other = np.random.default_rng(2).normal(size=(2, 300))
    # Transforms err by rounding times the root of the length.
    assert np.allclose(correlated(one, other[:211]), signal.correlate(one, other[:211]), atol=1e-12)
