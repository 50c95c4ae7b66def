"""Two parameters that nearly replace one another: a bent valley with walls known in closed form, and jumps
that differences of short steps take for slopes.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from sonicvacuum.discover import posterior, proposals
from sonicvacuum.discover.fit import broad, ridge
from sonicvacuum.discover.fit.normal import from_slopes
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.nuisances import Layout
from sonicvacuum.effects import effect

WIDE, NARROW, BEND = 0.6, 0.01, 0.15


class Valley:
    """Data of one run whose misfit is a valley: a + b over WIDE along it, b − a − BEND (a + b)² over NARROW
    across, a and b in coordinates off the middle; one nuisance adds a third of itself to the first.

    `jumps`: data that jump as the coordinates pass multiples of short distances.
    """

    simulations, threads = 0, 1

    def branch(self, beside):
        return self

    def learned(self, branch):
        pass

    def join(self, learned):
        pass

    def __init__(self, middle, jumps=0):
        self.middle, self.layout = np.asarray(middle), Layout(1, 0, ())
        random = np.random.default_rng(np.random.SeedSequence(11))
        self.period = random.uniform(0.009, 0.013, (jumps, 2))
        self.phase = random.uniform(0.0, 1.0, (jumps, 2))

    def local(self, run):
        return self.layout.local(run)

    def counts(self, run):
        return np.zeros(0, dtype=int)

    def data(self, run):
        return np.zeros(2 + len(self.period))

    def values(self, u, nu):
        a, b = (u - self.middle).T
        along, across = (a + b + 0.3 * WIDE * nu[:, 0]) / WIDE, (b - a - BEND * (a + b) ** 2) / NARROW
        place = (u - self.middle)[:, None] / self.period + self.phase
        jumps = 0.02 * np.sign(np.sin(2.0 * np.pi * place)).sum(axis=2)
        return np.column_stack([along, across, jumps])

    def sampled(self, hypothesis, u, nu, places=None):
        u = np.asarray(u)
        assert all(
            c.low <= x.min() and x.max() <= c.high for c, x in zip(hypothesis.coordinates, u.T, strict=True)
        )
        return [self.values(u, np.asarray(nu))]

    def columns(self, hypothesis, u, nu, places=None, precise=False, steps=None, held=None, step=0.02):
        moves = np.concatenate([np.zeros((1, 2)), step * np.eye(2)])
        value = self.values(u + moves, np.repeat(nu, 3, axis=0))
        own = np.concatenate([value[:1], (value[1:] - value[0]) / step])
        rest = np.zeros((self.layout.size, value.shape[1]))
        rest[list(self.local(0)).index(0), 0] = 0.3
        return [np.concatenate([own, rest])[None]]

    def fit(self, hypothesis, u):
        u, nu = np.asarray(u, dtype=float)[None], np.zeros((1, self.layout.size))
        return Fit(hypothesis, from_slopes(self, 2, u, nu, self.columns(hypothesis, u, nu)))


@pytest.fixture
def two():
    own = effect("relaxing-contact")
    (free,) = variants(own, None)
    return Hypothesis((Component(own, free),))


def broadened(forward, two, now, columns):
    return broad.broadened(forward, two, now, broad.sloped(forward, two, now, columns), columns)


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
