"""Slopes are taken over strengths that change the data by about what is aimed at, after a try or two."""

import numpy as np
import pytest

from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import directions as ways
from sonicvacuum.discover.search import singles, unknown


@pytest.fixture(scope="module")
def seen(empty):
    """A predictor, its nominal fit, and families of the catalogue and of shapes outside."""
    forward = Forward(experiment(empty))
    null = wide.nominal(forward)
    families = ways.catalogue(singles.setup_of(forward), forward.experiment.excluded)
    return forward, null, [*families, *unknown.families(forward)]


def sloped(seen, family, rough=False):
    """Slopes (K, data), strengths (K,), and how often chains were simulated."""
    forward, null, _ = seen
    branch = forward.branch()
    slopes, strengths = ways.simulate(branch, null.hypothesis, null.u, null.nu, family, rough)
    return np.concatenate(slopes, axis=1), strengths, branch.calls


def test_a_try_or_two_finds_strengths_that_change_the_data_as_wanted(seen):
    once = 0
    for family in seen[2]:
        slopes, strengths, calls = sloped(seen, family)
        changed = np.linalg.norm(slopes, axis=1) * strengths / ways.AIM
        free = (strengths > 1.01 * family.least) & (strengths < 0.99 * ways.STRONGEST)
        # Half as much again: where the first try was far off, slopes bend on the way to the second.
        assert np.all(changed[free] < 1.5 * ways.NEAR[1]) and np.all(changed[free] > ways.NEAR[0] / 1.5)
        assert calls <= 2
        once += calls == 1
    assert once > len(seen[2]) / 3


def test_rough_slopes_point_where_precise_ones_do(seen):
    for family in seen[2]:
        precise, *_ = sloped(seen, family)
        rough, _, calls = sloped(seen, family, rough=True)
        assert calls <= 2
        lengths = np.linalg.norm(precise, axis=1) * np.linalg.norm(rough, axis=1)
        cosine = np.einsum("kt,kt->k", precise, rough)[lengths > 0.0] / lengths[lengths > 0.0]
        assert cosine.min() > 0.98  # a change of AIM to ten times that in data of a thousand


def test_only_directions_that_are_asked_for_are_simulated(seen):
    forward, null, families = seen
    family = max(families, key=lambda f: len(f.directions))
    strengths, some = np.full(len(family.directions), 1e-3), np.array([4, 0, 2])
    at = null.hypothesis, null.u, null.nu, family
    whole = ways.finite(forward, *at, strengths)
    before = forward.simulations
    part = ways.finite(forward, *at, np.concatenate([strengths[some], 2.0 * strengths[some]]), some)
    assert forward.simulations - before == 7 * forward.layout.runs
    for one, other in zip(part, whole, strict=True):
        # Last digits of chains of a thousand standard errors.
        np.testing.assert_allclose(one[:3], other[some], atol=1e-8)
        assert np.linalg.norm(one[3:] - 2.0 * other[some]) < 0.1 * np.linalg.norm(one[3:])
