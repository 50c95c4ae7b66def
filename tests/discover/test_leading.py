"""Running integrals only lead to where fits begin: simulated to about a standard error of all data."""

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover.model import accuracy
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment


def test_leading_simulations_err_by_about_a_standard_error(monkeypatch):
    seen = experiment(made([("viscous-drag", {"rate_per_s": 900.0})], seed=11)[0])

    def predicted():
        forward = Forward(seen, 1)
        nu = np.zeros((1, forward.layout.size))
        coarse, fine = forward.coarse.sampled(Hypothesis(), [[]], nu), forward.sampled(Hypothesis(), [[]], nu)
        return forward, np.concatenate(coarse, axis=1), np.concatenate(fine, axis=1)

    forward, coarse, fine = predicted()
    assert forward.coarse._refine < forward._refine < 1.0
    monkeypatch.setattr(accuracy, "refinement", lambda norm, leading=False: 1.0)
    _, exact, also = predicted()
    assert np.linalg.norm(fine - also) < 3.0 * accuracy.ERROR_AIM  # the aim holds for a typical record
    assert np.linalg.norm(coarse - exact) < 3.0 * accuracy.LEADING_AIM  # likewise
    assert np.linalg.norm(coarse - exact) > accuracy.ERROR_AIM  # else steps could be longer


@pytest.mark.parametrize("norm", [0.0, 10.0, 1e4, 1e9])
def test_nothing_is_more_than_fully_accurate_nor_below_the_longest_step(norm):
    for leading in (False, True):
        assert 1.0 / accuracy.LONGEST <= accuracy.refinement(norm, leading) <= 1.0
    assert accuracy.refinement(norm, True) <= accuracy.refinement(norm)
