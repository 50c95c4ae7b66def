"""Along a valley that bends fits creep, and are followed farther on the way that they went."""

from types import SimpleNamespace

import numpy as np
import pytest
from valleys import WIDE, Valley

from sonicvacuum.discover.fit import refit, valley
from sonicvacuum.discover.model.nuisances import Layout

MIDDLE = np.array([-2.0, 0.5])
# Its floor falls by ALONG² over a coordinate, its walls stand NARROW apart and bend by BEND.
ALONG, NARROW, BEND = 50.0, 1e-4, 0.5


class Creeping(Valley):
    """A valley that fits go along by short steps only, as beside a gross misfit."""

    experiment = SimpleNamespace(size=lambda run: 2)
    nuisance_sigma = np.ones(Layout(1, 0, ()).size)

    def values(self, u, nu):
        a, b = (u - self.middle).T
        along = ALONG * (a + b + 0.3 * WIDE * nu[:, 0])
        return np.column_stack([along, (b - a - BEND * (a + b) ** 2) / NARROW])

    def columns(self, hypothesis, u, nu, places=None, precise=False, steps=None, held=None, step=1e-5):
        lanes = zip(u[:, None], nu[:, None], strict=True)
        return [np.concatenate([self._columns(hypothesis, *at, step) for at in lanes])]

    def _columns(self, hypothesis, u, nu, step):
        return super().columns(hypothesis, u, nu, step=step)[0]


@pytest.fixture
def creeping(two):
    """The valley, and a fit that was given up in it."""
    forward = Creeping(MIDDLE)
    start = np.array([[-2.9, -0.4]])
    return forward, refit.fit(forward, two, start, np.zeros((1, forward.layout.size)), finish=False)


def test_a_fit_that_creeps_is_followed_to_the_lowest_point(creeping):
    forward, one = creeping
    assert one.objective > 100.0 and not one.settled
    assert refit.polish(forward, one, valley.SHOWN, finish=False).objective > 10.0
    found = valley.along(forward, one)
    assert found.u == pytest.approx(MIDDLE, abs=1e-3)  # a twentieth of the error along it
    assert found.objective < 0.05  # less than a fit has to gain by a step


def test_at_the_lowest_point_a_fit_stays(creeping):
    forward, one = creeping
    found = valley.along(forward, one)
    assert valley.along(forward, found).objective <= found.objective


def test_fits_begin_within_bounds(creeping, two):
    forward, one = creeping
    forward.middle = np.array([c.high for c in two.coordinates])
    found = valley.along(forward, one)
    assert np.all(found.u <= forward.middle)


def test_no_fit_is_followed_beyond_where_fits_begin(creeping, monkeypatch):
    """In one of nine real records the valley led to shots ten times as fast as stated."""
    forward, one = creeping
    monkeypatch.setattr(valley.wide, "MOST", 0.5 * np.abs(one.nu).max())
    found = valley.along(forward, one)
    assert found.objective == refit.polish(forward, one, valley.SHOWN, finish=False).objective
