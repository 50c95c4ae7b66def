"""Fits beside which a chain cannot be followed, and first effects beside nothing: no step is made up."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from linear_models import drawn, of_drag

from sonicvacuum.discover.fit import refit
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.search import pairs
from sonicvacuum.discover.search.directions import Direction


@pytest.mark.parametrize("missing", ["gradient", "hessian"])
def test_a_fit_stays_where_slopes_are_missing(setup, monkeypatch, missing):
    model = drawn(strength=50.0)
    whole = model.normal(np.zeros(5))
    lacking = replace(whole, **{missing: np.full_like(getattr(whole, missing), np.nan)})
    forward = SimpleNamespace(experiment=SimpleNamespace(size=lambda run: 40))
    monkeypatch.setattr(refit, "spread", lambda forward: np.ones(4))
    monkeypatch.setattr(refit, "linearised", lambda *rest: pytest.fail("a step without slopes was tried"))
    now, settled = refit.descend(forward, of_drag(setup), lacking, None, 5)
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
    monkeypatch.setattr(pairs.singles, "starts", lambda *rest: starts)
    (start,) = pairs.beside(None, nothing, nothing, setup, scores)
    assert np.arange(3)[start.places].tolist() == [[1]]
