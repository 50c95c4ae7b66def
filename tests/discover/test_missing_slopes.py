"""Fits beside which a chain cannot be followed, and first effects beside nothing: no step is made up."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from linear_models import drawn, of_drag

from sonicvacuum.discover import posterior
from sonicvacuum.discover.fit import descent, refit
from sonicvacuum.discover.model.forward import NO_CHAIN, Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import pairs
from sonicvacuum.discover.search.directions import Direction


@pytest.mark.parametrize("missing", ["gradient", "hessian"])
def test_a_fit_stays_where_slopes_are_missing(setup, monkeypatch, missing):
    model = drawn(strength=50.0)
    whole = model.normal(np.zeros(5))
    lacking = replace(whole, **{missing: np.full_like(getattr(whole, missing), np.nan)})
    forward = SimpleNamespace(experiment=SimpleNamespace(size=lambda run: 40))
    monkeypatch.setattr(descent, "spread", lambda forward: np.ones(4))
    for module in (descent, refit):
        monkeypatch.setattr(
            module, "linearised", lambda *rest: pytest.fail("a step without slopes was tried")
        )
    now, settled, _ = descent.descend(forward, of_drag(setup), lacking, None, 5)
    assert settled.all()
    assert np.array_equal(now.u, whole.u) and np.array_equal(now.nu, whole.nu)
    assert refit._finished(forward, of_drag(setup), lacking) is lacking


def test_places_of_an_effect_beside_none_are_indices(setup, monkeypatch):
    nothing = SimpleNamespace(objective=0.0, hypothesis=Hypothesis(()), u=np.zeros(0))
    scores = SimpleNamespace(
        best=lambda: {"sensor-gain": 0}, z=[3.0], directions=[Direction("sensor-gain", "gain_ratio")]
    )
    starts = np.zeros((1, 1)), np.array([[1]]), np.zeros((1, 3))
    monkeypatch.setattr(pairs.secants, "search", lambda *rest, **options: [])
    monkeypatch.setattr(pairs, "starts_of", lambda *rest: starts)
    monkeypatch.setattr(pairs.abreast, "each", lambda f, work, items, calls: [work(f, i) for i in items])
    monkeypatch.setattr(pairs, "screened", lambda *rest: scores)
    (start,) = pairs.beside(None, nothing, nothing, setup)
    assert np.arange(3)[start.places].tolist() == [[1]]


@pytest.mark.parametrize("far", [1.01 * NO_CHAIN, -1.01 * NO_CHAIN, np.nan, 1e4])
def test_what_no_laboratory_has_is_not_simulated(hidden, far):
    """A speed a thousand times what was stated: no numbers, instead of steps without end."""
    forward = Forward(experiment(hidden))
    nu = np.zeros((3, forward.layout.size))
    nu[1, forward.layout.speed(0)] = far / forward.nuisance_sigma[forward.layout.speed(0)]
    found = forward.sampled(Hypothesis(), np.zeros((3, 0)), nu)
    for value in found:
        assert np.isnan(value[1]).all()
        assert np.array_equal(value[0], value[2]) and np.isfinite(value[0]).all()


def test_points_that_run_away_do_not_bend_a_posterior(monkeypatch):
    """Of values held on a line, those whose nuisances find no minimum are left out, alone."""
    away = np.linspace(-2.0, 2.0, 41)[:, None]
    point = np.concatenate([away, np.zeros_like(away)], axis=1)

    def misfit(around, at):
        """The nuisance's best value is 0.3 of the square of what is held; no numbers from 1.5 on."""
        slope = 0.3 * np.square(at[:, 0]) - at[:, 1]
        return None, np.stack([np.zeros_like(slope), np.where(at[:, 0] > 1.5, np.nan, slope)], axis=1)

    monkeypatch.setattr(posterior.Around, "misfit", misfit)
    monkeypatch.setattr(posterior.Around, "inner", np.eye(1))
    bent = posterior.Around(None, SimpleNamespace(u=np.zeros(1))).bent(point, away)
    assert bent[:, 1] == pytest.approx(0.3 * np.square(away[:, 0]), abs=1e-6)  # a quadratic is what it fits
