"""What is left along groups of shapes: p that noise keeps to, one direction among many that stands out."""

import numpy as np
import pytest
from linear_models import screened

from sonicvacuum.discover.search import unknown
from sonicvacuum.discover.search.directions import Direction

DIRECTIONS, DATA, SHAPE = 40, 300, Direction("mass-defect", "mass_ratio")


@pytest.fixture(scope="module")
def columns():
    """Neighbours alike by a third, as slopes to the masses of neighbouring beads are."""
    rng = np.random.default_rng(np.random.SeedSequence(31))
    own = rng.normal(size=(DIRECTIONS, DATA))
    return own + 0.5 * np.roll(own, 1, axis=0)


def left_along(columns, data):
    return unknown.test(screened(columns, data, (SHAPE,) * len(columns)), np.arange(len(columns)))


def test_noise_is_told_as_often_as_is_said(columns):
    rng = np.random.default_rng(np.random.SeedSequence(32))
    p = np.array([left_along(columns, rng.normal(size=DATA))[2] for _ in range(1500)])
    for level in (0.01, 0.1):
        # Two tests at half the level each, which seldom fail together; four binomial standard errors.
        room = 4.0 * np.sqrt(level / len(p))
        assert 0.5 * level - room < np.mean(p < level) < level + room


def test_one_direction_among_many_stands_out(columns):
    """z of 5.2 at one bead of forty: χ² of all failed at 0.01 only, and two masses were told as one."""
    rng = np.random.default_rng(np.random.SeedSequence(33))
    noise = rng.normal(size=DATA)
    one = columns[17] / np.linalg.norm(columns[17])
    chi2, freedom, p = left_along(columns, noise + (5.5 - one @ noise) * one)
    assert freedom == DIRECTIONS
    spread = unknown.tails.chi_squared(chi2, float(freedom))
    assert p < 1e-4 < spread


def test_a_misfit_along_all_is_told_by_all(columns):
    """χ² of 2 per direction: none stands out by itself."""
    axes = np.linalg.svd(columns, full_matrices=False)[2]
    chi2, freedom, p = left_along(columns, np.sqrt(2.0) * axes.sum(axis=0))
    assert chi2 == pytest.approx(2.0 * DIRECTIONS, rel=1e-9)  # rounding only
    assert p == pytest.approx(2.0 * unknown.tails.chi_squared(chi2, float(freedom)), rel=1e-9)


def test_a_group_of_one_direction_is_its_score(columns):
    data = 3.0 * columns[0] / np.linalg.norm(columns[0])
    chi2, freedom, p = left_along(columns[:1], data)
    assert (round(chi2, 9), freedom) == (9.0, 1)
    assert p == unknown.tails.chi_squared(chi2, 1.0)
