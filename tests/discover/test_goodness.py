"""Goodness of fit: p-values of noise are what they say, and misfits of any shape are seen."""

import numpy as np
import pytest
from scipy import signal, stats

from sonicvacuum.discover.fit import goodness, smooth
from sonicvacuum.discover.judge.left import Left
from sonicvacuum.discover.search.unknown import ShapeTest

SAMPLES, WIDE, TRACES = 400, 30, 200


@pytest.fixture(scope="module")
def noise():
    return np.random.default_rng(np.random.SeedSequence(3)).normal(size=(TRACES, SAMPLES))


@pytest.mark.parametrize(
    "test",
    [
        goodness._chi2,
        goodness._whiteness,
        goodness.outliers,
        lambda r: goodness._oscillation(r, WIDE),
    ],
    ids=["chi2", "whiteness", "outliers", "oscillation"],
)
def test_noise_fails_as_often_as_it_should(noise, test):
    failed = sum(test(r) < 0.05 for r in noise)
    # At most 5 % of 200: beyond 20 by chance once in a thousand.
    assert failed <= stats.binom.isf(1e-3, TRACES, 0.05)


def test_the_tail_of_whiteness_is_true_far_out():
    noise = np.random.default_rng(np.random.SeedSequence(8)).normal(size=(3000, 120))
    neighbours = signal.lfilter([1.0], [1.0, -0.5], noise, axis=1)
    for draws in (noise, neighbours):
        failed = sum(goodness._whiteness(r) < 1e-3 for r in draws)
        # One in a thousand of 3000: beyond 9 by chance once in a thousand.
        assert failed <= stats.binom.isf(1e-3, len(draws), 1e-3)


def test_every_member_of_the_bank_is_a_chi_square_of_two(noise):
    for start, decay in ((0, np.inf), (100, 15.0), (50, 60.0)):
        window = goodness._window(noise.shape[1], start, decay)
        values = goodness._squares(noise * window, goodness._products(window))
        seen = values[:, values.any(axis=0)]
        # Mean of 200 draws for each frequency, neighbours correlated: five standard errors of 2/√200.
        np.testing.assert_allclose(seen.mean(axis=0), 2.0, atol=5.0 * 2.0 / np.sqrt(TRACES))


def test_ringing_is_seen_where_the_whole_residual_looks_like_noise(noise):
    time = np.arange(SAMPLES) - 150.0
    ring = np.where(time >= 0.0, np.exp(-time.clip(0.0) / 40.0) * np.sin(0.45 * time), 0.0)
    r = noise[0] + 9.0 * ring / np.linalg.norm(ring)
    assert goodness._chi2(r) > 1e-4
    assert goodness._oscillation(r, WIDE) < 1e-6


def test_one_wild_sample_is_seen(noise):
    r = noise[1].copy()
    r[77] = 8.0
    assert goodness.outliers(r) < 1e-8


def test_correlation_beyond_neighbours_is_seen(noise):
    r = noise[2] + 0.7 * np.roll(noise[2], 6)
    assert goodness._whiteness(r) < 1e-6


def test_what_is_left_by_single_samples_is_told_as_one_thing():
    """It stands before "is left"."""
    shapes = ShapeTest({}, 1.0, "contacts", None)
    found = goodness.Goodness((), {"outliers": 1e-9}, 1e-9, "outliers")
    told = Left(shapes, found, smooth.Size(0.0, 0.0)).where
    assert f"{told} is left" == "scatter far beyond the noise in single samples is left"
