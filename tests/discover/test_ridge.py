"""Two parameters that nearly replace one another: a bent valley is followed to where it ends."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from valleys import BEND, NARROW, WIDE, Valley, broadened

from sonicvacuum.discover.fit import broad, ridge
from sonicvacuum.discover.model.hypothesis import Hypothesis


def test_an_effect_of_several_parameters_asks_for_it(two):
    assert broad.asks(two)
    assert not broad.asks(Hypothesis())


def test_a_bent_valley_is_followed_along_its_bottom(two):
    middle = np.array([-2.0, 0.5])
    forward = Valley(middle)
    fit = forward.fit(two, middle)
    columns = forward.columns(two, fit.u[None], fit.nu[None])
    found = ridge.valley(forward, two, fit.normal, broad.covariance(fit.normal), columns)
    assert found.objective[0] > 20.0
    assert found.objective[-1] > 20.0
    assert np.all(np.diff(found.t) > 0.0)
    a, b = (found.u - middle).T
    # Within a fifth of the width across, which χ² shows as 0.04.
    assert b - a == pytest.approx(BEND * (a + b) ** 2, abs=0.2 * NARROW)
    # Best over the nuisance with its prior: the first datum has the variance 1 + 0.3².
    assert found.objective == pytest.approx((a + b) ** 2 / WIDE**2 / 1.09, abs=0.1)
    # An error of b − a is √½ of it along the unit vector (1, −1) / √2; the bend tilts it by a hair.
    assert found.root[:, 0, 0] == pytest.approx(NARROW / np.sqrt(2.0), rel=0.1)


class Steep(Valley):
    """A straight valley between slopes that flatten, where a step of Gauss and Newton from 0.6 widths on goes
    too far.
    """

    def values(self, u, nu):
        a, b = (u - self.middle).T
        along = (a + b + 0.3 * WIDE * nu[:, 0]) / WIDE
        return np.column_stack([along, 3.0 * np.arctan((b - a) / NARROW)])


def test_a_step_that_goes_too_far_is_tried_once_more_and_shorter(two):
    middle = np.array([-2.0, 0.5])
    forward = Steep(middle)
    aside = middle + np.array([-0.85, 0.85]) * NARROW
    start = forward.fit(two, aside)
    columns = forward.columns(two, start.u[None], start.nu[None], step=1e-5)
    axis, across = np.array([1.0, 1.0]) / np.sqrt(2.0), np.array([[-1.0], [1.0]]) / np.sqrt(2.0)
    steps = np.full(2, 1e-5)
    walk = ridge._Walk(forward, two, axis, across, columns, middle, steps)
    before = float(np.square(forward.values(aside[None], np.zeros((1, forward.layout.size)))).sum())
    assert before == pytest.approx(9.0 * np.arctan(1.7) ** 2, rel=1e-9)  # 9.6
    # A full step leads to 3.0 widths on the other side, 14; a quarter of it to half a width.
    assert walk.settled(aside, np.zeros(forward.layout.size)).objective < 0.05 * before


def test_profiles_across_a_bent_valley_are_those_of_its_bottom(two):
    """Against minima found one by one; with the slopes of the fit alone nothing would be left of them."""
    middle = np.array([-2.0, 0.5])
    forward = Valley(middle)
    fit = forward.fit(two, middle)
    columns = forward.columns(two, fit.u[None], fit.nu[None])
    for k, (u, objective) in enumerate(ridge.profiles(forward, two, fit.normal, fit.sigma, columns)):
        assert np.all(np.diff(u) > 0.0) and objective[0] > 20.0 and objective[-1] > 20.0
        wanted = [lowest(k, x) for x in u - middle[k]]
        assert objective == pytest.approx(wanted, abs=0.05)  # the settling of each point, far below 1


def test_a_profile_ends_at_a_bound(two):
    middle = np.array([c.high - 0.003 for c in two.coordinates])
    forward = Valley(middle)
    fit = forward.fit(two, middle)
    columns = forward.columns(two, fit.u[None], fit.nu[None])
    for c, (u, _) in zip(
        two.coordinates, ridge.profiles(forward, two, fit.normal, fit.sigma, columns), strict=True
    ):
        assert u[0] < c.high - 0.1 and u[-1] <= c.high


@pytest.mark.parametrize("outward", [True, False])
def test_what_stands_at_a_bound_is_held_where_a_step_pushes_it_out(two, outward):
    """Of two coordinates that nearly replace one another and a nuisance; all else goes where it is best then:
    clipped alone, a fit at a bound had a profile a hundred times too narrow.
    """
    middle = np.array([-2.0, 0.5])
    forward = Valley(middle)
    fit = forward.fit(two, middle)
    columns = forward.columns(two, fit.u[None], fit.nu[None])
    walk = ridge._walk(forward, two, np.eye(2)[0], fit.normal, columns)
    matrix = np.array([[100.0, 99.0, 3.0], [99.0, 100.0, 5.0], [3.0, 5.0, 2.0]])
    slope = matrix @ ([-0.3, 0.5, 0.2] if outward else [0.3, -0.5, 0.2])
    u = two.inside(np.array([0.0, two.coordinates[1].high]))
    move = walk._step(u, np.eye(3), slope, matrix)
    free = [0, 2] if outward else [0, 1, 2]
    wanted = np.zeros(3)
    wanted[free] = np.linalg.solve(matrix[np.ix_(free, free)], slope[free])
    assert move == pytest.approx(wanted, abs=1e-6)  # what is held gives way by as little


def lowest(k, held):
    """Least χ² of the valley with one coordinate held, its nuisance at its best."""

    def misfit(other):
        a, b = (held, other) if k == 0 else (other, held)
        return (a + b) ** 2 / WIDE**2 / 1.09 + (b - a - BEND * (a + b) ** 2) ** 2 / NARROW**2

    return minimize_scalar(misfit, bracket=(held - 0.1, held + 0.1), tol=1e-10).fun


@pytest.mark.parametrize("room", [0.0, 0.003, 0.3])
def test_no_valley_leads_beyond_the_bounds(two, room):
    """The stand-in for the predictor refuses what lies beyond."""
    middle = np.array([c.high - room for c in two.coordinates])
    forward = Valley(middle)
    fit = forward.fit(two, middle)
    columns = forward.columns(two, fit.u[None], fit.nu[None])
    found = ridge.valley(forward, two, fit.normal, broad.covariance(fit.normal), columns)
    assert found.objective[0] > 20.0
    assert found.t[-1] <= 1.5 * room
    assert np.isfinite(found.u).all()


class Counted(Valley):
    """A count more, right from half a width along the valley on, off by four standard errors before."""

    def counts(self, run):
        return np.array([2])

    def data(self, run):
        return np.zeros(3)

    def values(self, u, nu):
        a, b = (u - self.middle).T
        return np.column_stack([super().values(u, nu), np.where(a + b < 0.5 * WIDE, 4.0, 0.0)])


def test_where_data_hold_counts_the_valley_is_followed_to_where_they_are_right(two):
    middle = np.array([-2.0, 0.5])
    forward = Counted(middle)
    fit = forward.fit(two, middle)
    assert fit.objective == pytest.approx(16.0)
    columns = forward.columns(two, fit.u[None], fit.nu[None])
    better = broadened(forward, two, fit.normal, columns)
    # Right from (1/2)² / 1.09 = 0.23 on; points of the valley lie up to a standard error further.
    assert better.objective[0] < 2.5
    assert (better.u[0] - middle).sum() >= 0.5 * WIDE


class Cliff(Valley):
    """A valley that ends at a cliff of 36 in χ², half a width from its middle."""

    def __init__(self, middle):
        super().__init__(middle)
        self.asked = 0

    def data(self, run):
        return np.zeros(3)

    def values(self, u, nu):
        self.asked += 1
        a, b = (u - self.middle).T
        return np.column_stack([super().values(u, nu), np.where(a + b > 0.5 * WIDE, 6.0, 0.0)])


def test_a_cliff_ends_a_valley_and_is_not_approached_for_ever(two):
    middle = np.array([-2.0, 0.5])
    forward = Cliff(middle)
    fit = forward.fit(two, middle)
    columns, forward.asked = forward.columns(two, fit.u[None], fit.nu[None]), 0
    found = ridge.valley(forward, two, fit.normal, broad.covariance(fit.normal), columns)
    ends = (found.u - middle).sum(axis=1)
    before, beyond = ends[ends < 0.5 * WIDE].max(), ends[ends > 0.5 * WIDE].min()
    assert found.objective[-1] > 36.0
    # Steps of half a coordinate, 0.7 of this sum, are cut to a sixteenth before one beyond ends the valley.
    assert beyond - before < 0.2 * WIDE
    # 28 steps of Gauss and Newton; 48 where steps are cut as long as they are not the shortest.
    assert forward.asked < 40


class Nowhere(Valley):
    """Nothing beside the point itself can be simulated."""

    def values(self, u, nu):
        value = super().values(u, nu)
        value[np.abs(u - self.middle).max(axis=1) > 0.0] = np.nan
        return value


def test_where_nothing_can_be_simulated_the_fit_stays_as_it_is(two):
    middle = [-2.0, 0.5]
    fit = Valley(middle).fit(two, middle)
    columns = Valley(middle).columns(two, fit.u[None], fit.nu[None])
    forward = Nowhere(middle)
    assert broadened(forward, two, fit.normal, columns) is fit.normal
    assert ridge.valley(forward, two, fit.normal, broad.covariance(fit.normal), columns) is None
