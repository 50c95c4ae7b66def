"""Draws of two parameters that nearly replace one another, and slopes of predictions that jump."""

from dataclasses import replace

import numpy as np
import pytest
from valleys import BEND, NARROW, WIDE, Valley, broadened

from sonicvacuum.discover import posterior, proposals
from sonicvacuum.discover.fit import broad, ridge
from sonicvacuum.discover.fit.normal import from_slopes


def test_draws_reach_the_bound_that_cuts_a_valley_off(two):
    """Against sums over a fine grid within the bounds: up to there all is as probable as the misfit says."""
    bound = two.coordinates[1].high
    middle = np.array([-2.0, bound - 0.4])
    forward = Valley(middle)
    fit = forward.fit(two, middle)
    columns = forward.columns(two, fit.u[None], fit.nu[None])
    found = ridge.valley(forward, two, fit.normal, broad.covariance(fit.normal), columns)
    assert bound - found.u[-1, 1] < ridge.NO_STEP * ridge.LONGEST
    along, across = np.meshgrid(np.linspace(-4.0, 4.0, 2001) * WIDE, np.linspace(-5.0, 5.0, 201) * NARROW)
    other = 0.5 * (along + across + BEND * along**2)
    weight = np.exp(-0.5 * (along**2 / WIDE**2 / 1.09 + across**2 / NARROW**2)) * (other < 0.4)
    order = np.argsort(other, axis=None)
    below = np.cumsum(weight.ravel()[order]) / weight.sum()
    drawn = posterior.posterior(forward, fit)[1]
    told = [two.coordinates[1].inverse(drawn.quantile(q)) - middle[1] for q in (0.5, 0.975)]
    wide = np.sqrt((weight * other**2).sum() / weight.sum())
    # Draws worth a hundred equal ones err by an eighth of the spread in the median, and by less at a bound.
    assert told == pytest.approx(np.interp([0.5, 0.975], below, other.ravel()[order]), abs=0.25 * wide)


def test_draws_along_a_bent_valley_have_its_moments(two):
    """Against sums over a fine grid of the posterior itself."""
    middle = np.array([-2.0, 0.5])
    forward = Valley(middle)
    fit = forward.fit(two, middle)
    one, other = posterior.posterior(forward, fit)
    assert {one.how, other.how} == {"sampled"}
    assert one.effective > 0.4 * posterior.DRAWS
    along, across = np.meshgrid(np.linspace(-4.0, 4.0, 801) * WIDE, np.linspace(-5.0, 5.0, 201) * NARROW)
    weight = np.exp(-0.5 * (along**2 / WIDE**2 / 1.09 + across**2 / NARROW**2))
    difference = across + BEND * along**2
    for drawn, u in ((one, 0.5 * (along - difference)), (other, 0.5 * (along + difference))):
        k = 0 if drawn is one else 1
        value = np.array([two.coordinates[k].inverse(x) for x in drawn.value]) - middle[k]
        mean, truth = drawn.weight @ value, float((weight * u).sum() / weight.sum())
        spread = np.sqrt(drawn.weight @ np.square(value - mean))
        wide = np.sqrt(float((weight * np.square(u - truth)).sum() / weight.sum()))
        # Draws worth a hundred equal ones err by a tenth of the spread, and by 7 % of it.
        assert mean == pytest.approx(truth, abs=0.2 * wide)
        assert spread == pytest.approx(wide, rel=0.15)


def test_where_draws_are_not_trusted_the_valley_itself_is_told(two, monkeypatch):
    """Against sums over a fine grid of the posterior, as above."""
    middle = np.array([-2.0, 0.5])
    forward = Valley(middle)
    fit = forward.fit(two, middle)
    monkeypatch.setattr(posterior, "TRUSTED", -np.inf)
    told = posterior.posterior(forward, fit)
    along, across = np.meshgrid(np.linspace(-4.0, 4.0, 801) * WIDE, np.linspace(-5.0, 5.0, 201) * NARROW)
    weight = np.exp(-0.5 * (along**2 / WIDE**2 / 1.09 + across**2 / NARROW**2)).ravel()
    difference = across + BEND * along**2
    for k, u in enumerate((0.5 * (along - difference).ravel(), 0.5 * (along + difference).ravel())):
        order, ends = np.argsort(u), [0.05, 0.5, 0.95]
        wanted = np.interp(ends, np.cumsum(weight[order]) / weight.sum(), u[order])
        found = [two.coordinates[k].inverse(told[k].quantile(q)) - middle[k] for q in ends]
        assert told[k].how == "valley"
        # A tenth of the spread: points of the valley lie up to an error apart, straight between them.
        assert found == pytest.approx(wanted, abs=0.1 * np.sqrt(weight @ u**2 / weight.sum()))


def test_the_root_of_a_covariance_that_rounding_made_negative_is_next_to_nothing_there():
    axes = np.linalg.qr(np.arange(9.0).reshape(3, 3) + np.eye(3))[0]
    root = ridge.root_of((axes * [1.0, 0.1, -1e-14]) @ axes.T)
    assert root @ root.T == pytest.approx(
        (axes * [1.0, 0.1, 0.0]) @ axes.T, abs=1e-11
    )  # 1e-12 of the largest


def test_draws_across_a_valley_are_as_wide_as_errors_over_which_predictions_jump(two):
    """Slopes of short steps made it six times too narrow: a few draws beside it carried all of the weight."""
    middle = np.array([-2.0, 0.5])
    forward = Valley(middle)
    fit = forward.fit(two, middle)
    columns = forward.columns(two, fit.u[None], fit.nu[None])
    found = ridge.valley(forward, two, fit.normal, broad.covariance(fit.normal), columns)
    own = broad.covariance(fit.normal)
    short = proposals.along(replace(found, root=found.root / 6.0), own, 200, 1)[0]
    wide = proposals.along(found, own, 200, 1)[0]
    least = proposals.along(replace(found, root=found.root / 6.0), 1e-6 * own, 200, 1)[0]
    beside = [
        np.std(u @ [-1.0, 1.0] - BEND * (u.sum(axis=1) - middle.sum()) ** 2) for u in (short, wide, least)
    ]
    assert beside[0] == pytest.approx(beside[1], rel=0.2)  # 200 draws of heavy tails
    assert beside[2] < 0.5 * beside[1]  # a sixth, and what bends between the points of the valley


def test_jumps_are_not_taken_for_slopes(two):
    """The bend left aside, errors are known: NARROW and WIDE, and the jumps of 40 data tell nothing."""
    middle = np.array([-2.0, 0.5])
    forward = Valley(middle, jumps=40)
    fit = forward.fit(two, middle + 0.05 * np.array([1.0, 1.0 + 0.2 * BEND]))
    truth = WIDE * np.sqrt(1.09) / 2.0
    assert np.sqrt(np.diag(broad.covariance(fit.normal))).max() < 0.3 * truth
    columns = forward.columns(two, fit.u[None], fit.nu[None])
    better = broadened(forward, two, fit.normal, columns)
    error = np.sqrt(np.diag(broad.covariance(better)))
    # Slopes through four points of jumping data err: a factor of two either way is what intervals bear.
    assert error == pytest.approx([truth, truth], rel=0.5)
    assert better.objective[0] <= fit.objective


def test_beside_a_gross_misfit_the_floor_of_a_valley_is_not_looked_for(two, monkeypatch):
    """Errors are those of slopes over themselves all the same."""
    middle = np.array([-2.0, 0.5])
    forward = Valley(middle, jumps=40)
    fit = forward.fit(two, middle + 0.05 * np.array([1.0, 1.0 + 0.2 * BEND]))
    columns = forward.columns(two, fit.u[None], fit.nu[None])
    wide = broad.sloped(forward, two, fit.normal, columns)
    monkeypatch.setattr(ridge, "valley", lambda *given: pytest.fail("the valley was followed"))
    found = broad.broadened(forward, two, fit.normal, wide, columns, gross=True)
    np.testing.assert_array_equal(found.u, fit.normal.u)
    before, after = (np.sqrt(np.diag(broad.covariance(one))).max() for one in (fit.normal, found))
    assert after > broad.ALIKE * before


def test_slopes_that_hold_over_the_errors_are_kept_to_the_byte(two):
    forward = Valley([-2.0, 0.5])
    fit = forward.fit(two, [-2.0, 0.5])
    columns = forward.columns(two, fit.u[None], fit.nu[None])
    forward_bend = broadened(forward, two, fit.normal, columns)
    assert forward_bend is fit.normal


@pytest.mark.parametrize("room", [0.0, 0.01, 0.4])
def test_slopes_beside_a_bound_are_those_of_the_law(two, room):
    """Errors reach WIDE, more than there is room for: a point clipped leaves the valley by many NARROW."""
    bound = two.coordinates[1].high
    middle = np.array([-2.0, bound - room])
    forward = Valley(middle)
    fit = forward.fit(two, middle)
    # The law's own slopes at the middle, without the steps of a difference.
    columns = forward.columns(two, fit.u[None], fit.nu[None], step=1e-6)
    exact = from_slopes(forward, 2, fit.u[None], fit.nu[None], columns)
    wide = broad.sloped(forward, two, exact, columns)
    error = np.sqrt(np.diag(broad.covariance(wide)))
    # A bend is a parabola, which the points tell from a slope: equal but for rounding over such differences.
    assert error == pytest.approx(np.sqrt(np.diag(broad.covariance(exact))), rel=1e-4)
    assert error == pytest.approx(WIDE * np.sqrt(1.09) / 2.0, rel=1e-3)  # and NARROW / 2 across, squared
