"""A valley with bumps on its floor, in closed form: fits stop in any hollow, strides find the lowest."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import broad, refit, strides
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.nuisances import Layout
from sonicvacuum.effects import effect

# Misfit (a + b)² / LONG² + HIGH² sin²(π (a + b) / APART) along the valley and (b − a)² / NARROW² across it,
# a and b in coordinates off the middle.
LONG, NARROW, APART = 0.04, 0.001, 0.03
MIDDLE = np.array([-2.0, 0.5])


class Bumpy:
    """The least of a predictor that fits need: one run of three data, and a nuisance that changes nothing."""

    layout = Layout(1, 0, ())
    nuisance_sigma = np.ones(layout.size)
    experiment = SimpleNamespace(size=lambda run: 3)
    simulations, threads = 0, 1

    def __init__(self, high):
        self.high = high

    def local(self, run):
        return self.layout.local(run)

    def counts(self, run):
        return np.zeros(0, dtype=int)

    def data(self, run):
        return np.zeros(3)

    def values(self, u):
        a, b = np.moveaxis(u - MIDDLE, -1, 0)
        bumps = self.high * np.sin(np.pi * (a + b) / APART)
        return np.stack([(a + b) / LONG, (b - a) / NARROW, bumps], axis=-1)

    def sampled(self, hypothesis, u, nu, places=None):
        return [self.values(np.asarray(u))]

    def columns(self, hypothesis, u, nu, places=None, precise=False, steps=None, held=None):
        u = np.asarray(u, dtype=float)
        step = 1e-6 * np.eye(2)
        slopes = [(self.values(u + s) - self.values(u - s)) / 2e-6 for s in step]
        rest = np.zeros((self.layout.size, *slopes[0].shape))
        return [np.concatenate([np.stack([self.values(u), *slopes]), rest]).swapaxes(0, 1)]


@pytest.fixture
def two():
    own = effect("relaxing-contact")
    return Hypothesis((Component(own, variants(own, None)[0]),))


def settled(forward, two, hollow):
    """A fit at rest in a hollow, so many from the lowest, its last steps not taken."""
    start = MIDDLE[None] + 0.5 * APART * hollow
    return refit.fit(forward, two, start, np.zeros((1, forward.layout.size)), finish=False)


def rough(forward, two, one, size=3):
    columns = forward.columns(two, one.u[None], one.nu[None])
    return strides.rough(one.normal, broad.sloped(forward, two, one.normal, columns), size)


@pytest.mark.parametrize("hollow", [-5, -2, 1, 4])
def test_the_lowest_hollow_is_found_from_any_other(two, hollow):
    forward = Bumpy(high=6.0)
    one = settled(forward, two, hollow)
    # The valley's own slope moves the farthest by a thirtieth of what parts two.
    assert (one.u - MIDDLE).sum() / APART == pytest.approx(hollow, abs=0.05)
    found = strides.farther(forward, two, one.normal)
    assert found.u[0] == pytest.approx(MIDDLE, abs=2e-4)  # a fifth of its error: 0.02 of χ² is settled
    assert found.objective[0] < strides.ENOUGH


def test_nothing_is_lower_than_the_lowest_hollow(two):
    forward = Bumpy(high=6.0)
    one = settled(forward, two, 0)
    assert strides.farther(forward, two, one.normal) is one.normal


def test_the_last_steps_of_a_fit_stride_where_its_floor_is_rough(two):
    forward = Bumpy(high=1.0)
    one = settled(forward, two, 2)
    assert one.objective > 1.0  # (2 × 0.03 / 0.04)², and the hollow stands nearer to the lowest
    assert rough(forward, two, one)
    done = refit.finished(forward, one)
    assert done.u == pytest.approx(MIDDLE, abs=5e-4)  # a tenth of its standard error
    assert done.objective < strides.ENOUGH


def test_a_smooth_floor_is_not_strode_over(two, monkeypatch):
    monkeypatch.setattr(strides, "farther", None)
    forward = Bumpy(high=0.0)
    one = settled(forward, two, 3)
    assert not rough(forward, two, one)
    assert refit.finished(forward, one).u == pytest.approx(MIDDLE, abs=1e-3)  # a twentieth of its error


def test_bumps_are_nothing_beside_a_gross_misfit(two):
    forward = Bumpy(high=1.0)
    one = settled(forward, two, 2)
    gross = replace(one, normal=replace(one.normal, chi2=one.normal.chi2 + 3 * policy.GROSS))
    assert rough(forward, two, one) and not rough(forward, two, gross)


def test_slopes_that_cannot_be_taken_tell_of_no_bumps(two):
    assert not strides.rough(settled(Bumpy(high=1.0), two, 3).normal, None, 3)


@pytest.mark.parametrize("steps", [0, refit.ITERATIONS])
def test_last_steps_are_taken_anew_only_where_further_ones_lead_lower(two, steps, monkeypatch):
    forward, start = Bumpy(high=0.0), MIDDLE[None] + 0.02
    one = refit.fit(forward, two, start, np.zeros((1, forward.layout.size)), iterations=steps, finish=False)
    taken = []
    last = refit._finished
    monkeypatch.setattr(refit, "_finished", lambda *at: taken.append(at) or last(*at))
    ended = replace(one, settled=False, finished=True)
    again = refit.polish(forward, ended)
    assert again.u == pytest.approx(MIDDLE, abs=1e-3)  # a twentieth of its error
    assert bool(taken) == (steps == 0)
    # Slopes over standard errors are not replaced by those of a step that gained next to nothing.
    assert (again.normal is ended.normal) == (steps > 0)
