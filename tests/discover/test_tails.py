"""Tails and correlations of `discover` against scipy.stats and scipy.signal, which it does without."""

import itertools

import numpy as np
from scipy import signal, stats

from sonicvacuum.discover import proposals
from sonicvacuum.discover.correlation import correlated
from sonicvacuum.discover.fit import tails


def test_tails_are_those_of_scipy_stats():
    # From far below the mean to far above it, few degrees of freedom and as many as a record ever counts.
    for freedom in (1, 2, 3.7, 19, 300, 1250.5):
        for value in (
            0.0,
            0.1,
            *(freedom + x * np.sqrt(2.0 * freedom) for x in (-0.7, 0.0, 0.1, 1.5, 4.0, 12.0)),
        ):
            assert np.isclose(
                tails.chi_squared(value, freedom), stats.chi2.sf(value, freedom), rtol=1e-11, atol=0.0
            )
    assert tails.chi_squared(-1.0, 3) == 1.0
    assert tails.chi_squared(1e9, 3) == tails.chi_squared(np.inf, 3) == 0.0
    assert np.isnan(tails.chi_squared(np.nan, 3))
    for p, freedom in itertools.product((1e-9, 1e-3, 0.5), (1, 7, 40)):
        assert np.isclose(tails.chi_squared_at(p, freedom), stats.chi2.isf(p, freedom), rtol=1e-12)
    for count, mean in ((0, 0.1), (1, 0.1), (5, 2.3), (2, 1e-7), (3, 40.0)):
        assert np.isclose(tails.poisson(count, mean), stats.poisson.sf(count - 1, mean), rtol=1e-12, atol=0.0)
    values = np.array([-3.0, 0.0, 9.0])
    assert np.allclose(tails.normal(values), stats.norm.sf(values), rtol=1e-13, atol=0.0)


def test_draws_of_students_t_are_those_of_scipy_stats():
    points = proposals.even(500, 3, seed=4)
    scaled, _ = proposals.students(points)
    wide = np.sqrt(proposals.FREEDOM / stats.chi2.isf(points[:, 2], proposals.FREEDOM))
    assert np.allclose(scaled, wide[:, None] * stats.norm.ppf(points[:, :2]), rtol=1e-12)
    assert np.isfinite(proposals.students(np.array([[0.0, 1.0, 0.0], [0.5, 0.5, 1.0]]))[0]).all()


def test_discovery_rate_is_that_of_scipy_stats():
    p = np.random.default_rng(1).uniform(size=50) ** 3
    assert np.allclose(tails.discovery_rate(p), stats.false_discovery_control(p), rtol=1e-13)


def test_correlation_is_that_of_scipy_signal():
    one, other = np.random.default_rng(2).normal(size=(2, 300))
    # Transforms err by rounding times the root of the length.
    assert np.allclose(correlated(one, other[:211]), signal.correlate(one, other[:211]), atol=1e-12)
