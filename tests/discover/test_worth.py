"""Which starts of a fit are followed: not those that creep, come together, or stay far behind."""

import numpy as np
import pytest

from sonicvacuum.discover.fit import worth
from sonicvacuum.discover.fit.normal import Normal

SIZE = 1000


def normal(u, objective, curvature=1.0):
    """Normal equations of lanes with one parameter and no nuisance but one of zero."""
    lanes = len(u)
    hessian = np.zeros((1, lanes, 2, 2))
    hessian[0, :, 0, 0] = curvature
    chi2, gradient = np.array([objective], dtype=float), np.zeros((1, lanes, 2))
    return Normal(np.array(u, dtype=float)[:, None], np.zeros((lanes, 1)), chi2, gradient, hessian)


def after(steps, reach=np.inf):
    """Progress after steps, each with what all lanes gain by it."""
    progress = worth.Progress(len(steps[0]), SIZE, reach)
    for gained in steps:
        progress.noted(np.arange(len(gained)), np.array(gained, dtype=float))
    return progress


def test_nothing_is_given_up_before_two_steps():
    for steps in ([[np.inf, np.inf]], [[0.0, 1.0]]):
        progress = after(steps)
        far = np.array([SIZE + 1.0, 1e9])
        assert not progress.hopeless(far).any() and not progress.creeping(far).any()


def test_a_start_is_hopeless_that_gains_little_of_what_it_is_behind():
    progress = after([[1.0, 30.0, 90.0], [1.0, 60.0, 70.0]])
    found = progress.hopeless(np.array([1000.0, 1000.0 + 15 * 60.0 + 1.0, 1000.0 + 15 * 90.0 - 1.0]))
    assert found.tolist() == [False, True, False]


def test_the_best_start_is_never_hopeless_but_where_something_has_to_be_reached():
    steps, objective = [[1.0], [1.0]], np.array([1100.0])
    assert not after(steps).hopeless(objective).any()
    assert after(steps, reach=1080.0).hopeless(objective).all()
    assert not after(steps, reach=1090.0).hopeless(objective).any()


def test_creeping_is_measured_by_what_is_left_beyond_the_noise():
    objective = np.array([SIZE + 1e5, SIZE + 1e2, SIZE - 5.0])
    assert after([[5.0] * 3, [5.0] * 3]).creeping(objective).tolist() == [True, False, False]


def test_steps_that_lead_up_do_not_pass_for_creeping():
    objective = np.array([SIZE + 1e5])
    assert not after([[1e4], [0.0], [0.0]]).creeping(objective).any()
    assert after([[100.0], [0.0], [0.0]]).creeping(objective).all()


def test_starts_that_have_come_together_are_one():
    objective = [1500.0, 1500.2, 1500.1, 1500.3]
    near = normal([0.0, 0.3, 2.0, -0.3], objective)  # an excess of 500: what parts them may be 0.5
    assert worth.doubled(near, SIZE, None).tolist() == [False, True, False, True]


def test_starts_at_other_places_are_not_the_same():
    both = normal([0.0, 0.0], [1500.0, 1500.0])
    assert worth.doubled(both, SIZE, np.array([[3], [3]])).tolist() == [False, True]
    assert not worth.doubled(both, SIZE, np.array([[3], [4]])).any()


def test_a_flat_start_is_not_taken_for_another():
    # Where an effect hardly acts χ² does not depend on its strength; where it does, it does.
    both = normal([-10.0, 1.0], [1500.0, 1500.1], curvature=[1e-9, 10.0])
    assert not worth.doubled(both, SIZE, None).any()


@pytest.mark.parametrize("missing", [np.inf, np.nan])
def test_starts_that_cannot_be_simulated_are_left_alone(missing):
    both = normal([0.0, 0.0], [missing, missing])
    assert not worth.doubled(both, SIZE, None).any()


def test_near_the_noise_starts_are_told_apart_by_a_fiftieth():
    both = normal([0.0, 0.2, 0.1], [999.0, 999.0, 999.0])  # χ² differs by 0.04 and 0.01
    assert worth.doubled(both, SIZE, None).tolist() == [False, False, True]


@pytest.mark.filterwarnings("error")
def test_where_no_start_has_a_finite_misfit_none_is_given_up_for_another():
    """Pulses that never come leave no number to compare: inf − inf was no reason and a warning."""
    nowhere = np.full(3, np.inf)
    assert not after([[10.0] * 3, [10.0] * 3]).hopeless(nowhere).any()
