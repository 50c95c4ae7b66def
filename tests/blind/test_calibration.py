"""What is stated of uniform and of honest numbers comes true as often as it should."""

from types import SimpleNamespace

import numpy as np
import pytest

from sonicvacuum_blind.calibration import BASE_RATES, band, distance, ece, honest
from sonicvacuum_blind.stated import brier, credible_set


def test_uniform_numbers_stay_in_their_band_in_95_of_100_studies():
    """Twenty effects of 5 to 60 intervals each, all inside at once."""
    random, sizes, studies = np.random.default_rng(1), np.linspace(5, 60, 20).astype(int), 400
    limits = [band(int(n), len(sizes)) for n in sizes]
    inside = [
        all(distance(random.random(n)) <= b for n, b in zip(sizes, limits, strict=True))
        for _ in range(studies)
    ]
    assert np.mean(inside) == pytest.approx(0.95, abs=3.5 * np.sqrt(0.95 * 0.05 / studies))  # standard errors


def test_narrow_intervals_leave_the_band():
    z = np.random.default_rng(2).standard_normal(300)
    assert distance(_normal(z)) <= band(300)
    assert distance(_normal(1.6 * z)) > band(300)


def _normal(z):
    from scipy.stats import norm

    return norm.cdf(z)


def rows(stated, right, kind="single"):
    return [SimpleNamespace(stated=s, exact=int(r), kind=kind) for s, r in zip(stated, right, strict=True)]


def test_honest_probabilities_have_a_small_calibration_error():
    random = np.random.default_rng(3)
    stated = random.uniform(0.3, 1.0, 4000)
    count, error, low, high = ece(rows(stated, random.random(4000) < stated))
    assert count == 4000
    assert error < 0.02  # seven bins of standard error 0.02, whose signs are lost
    assert low < error < high


def test_so_few_records_show_an_error_of_right_probabilities_too():
    """One bin of n probabilities p: the mean of |error| is √(2 p (1 − p)/(π n)), of a normal number."""
    count, error, low, high = honest(rows([0.75] * 400, [True] * 400))
    assert count == 400
    assert error == pytest.approx(np.sqrt(2.0 * 0.75 * 0.25 / (np.pi * 400)), rel=0.1)  # 500 draws: 3.4 %
    assert 0.0 <= low < error < high
    assert np.isnan(honest([])[1])


def test_calibration_error_follows_the_base_rates():
    """Right of empty records, too sure of foreign ones: the error is what the latter weigh."""
    good, bad = rows([1.0] * 90, [True] * 90, "null"), rows([0.75] * 10, [False] * 10, "foreign")
    assert ece(good + bad)[1] == pytest.approx(0.1 * 0.75)
    rates = {"null": 0.5, "foreign": 0.5}
    assert ece(good + bad, rates)[1] == pytest.approx(0.5 * 0.75)
    assert all(sum(rates.values()) == pytest.approx(1.0) for rates in BASE_RATES.values())


def test_credible_sets_and_brier_scores():
    stated = {"none": 0.02, "tsuji": 0.6, "gravity": 0.34, "unknown": 0.04}
    assert credible_set(stated) == ["tsuji", "gravity", "unknown"]
    assert brier(stated, "tsuji") == pytest.approx(0.4**2 + 0.34**2 + 0.04**2 + 0.02**2)
    assert brier({"none": 1.0}, "none") == 0.0
