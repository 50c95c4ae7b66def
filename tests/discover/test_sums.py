"""Pairs of finite strength, judged as if what each effect changes added up."""

import numpy as np
import pytest

from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import pairs, secants, sums
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum_blind.hide import Spec, hide


def judged(changes, data):
    """What `_together` makes of (K, M) changes and what a model leaves of the data."""
    return sums._together(changes @ data, changes @ changes.T)


def test_two_changes_gain_what_least_squares_gain():
    random = np.random.default_rng(np.random.SeedSequence(5))
    changes = random.standard_normal((2, 40))
    changes[1] -= 0.95 * changes[0]  # takes back most of it
    data = 1.3 * changes[0] + 0.8 * changes[1] + 0.01 * random.standard_normal(40)
    gain, share = judged(changes, data)
    best, left, *_ = np.linalg.lstsq(changes.T, data, rcond=None)
    assert gain[0, 1] == gain[1, 0] == pytest.approx(data @ data - left[0], rel=1e-9)
    np.testing.assert_allclose([share[0, 1], share[1, 0]], best, rtol=1e-9)


def test_no_trial_is_taken_farther_than_halfway_to_the_next_strength():
    changes = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    data = np.array([10.0, 0.1, 0.0])
    gain, share = judged(changes, data)
    far = secants.HALFWAY
    assert (share[0, 1], share[1, 0]) == pytest.approx((far, 1.0 / far))
    left = data - far * changes[0] - changes[1] / far
    assert gain[0, 1] == pytest.approx(data @ data - left @ left)


def test_parallel_changes_are_no_pair():
    changes = np.array([[1.0, 2.0], [2.0, 4.0]])
    assert judged(changes, np.array([3.0, 1.0]))[0][0, 1] == -np.inf


def test_a_slow_gauge_in_a_chain_of_softer_contacts_is_asked_for():
    """Alone the softer contacts gain 4 in χ² and the gauge 15, where a heavier bead gains 33."""
    two = ("coating-thickness", "sensor-lowpass")
    record, _ = hide(Spec("full-2177", "pair", "scalars", "white", two, 20.0, 83_589_096, 2177))
    forward = Forward(experiment(record))
    null = wide.nominal(forward)
    first, *others = sums.summed(forward, null, setup_of(forward))
    gains = [s.gain for s in (first, *others)]
    assert gains == sorted(gains, reverse=True)
    assert len({s.effects for s in (first, *others)}) == len(gains)
    # Another exponent of the contacts does nearly what a coating does.
    assert first.effects == {"contact-exponent", "sensor-lowpass"}
    (one,) = pairs.followed(forward, [first])
    assert null.objective - one.objective > first.gain
