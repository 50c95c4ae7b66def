"""A slip that stands for effects takes its share of their probability; what it leaves missing has it then."""

from types import SimpleNamespace

import pytest

from sonicvacuum.discover.faults.weights import give_way


def found(named, **odds):
    return SimpleNamespace(named=named, probabilities=dict(odds))


def test_a_slip_in_place_of_one_of_two_effects_leaves_the_other():
    """It was told that nothing is missing where the slip was made, though only one of two was the slip."""
    pair = "plastic-contact + sensor-gain"
    before = found(["plastic-contact", "sensor-gain"], none=0.0, unknown=0.1, **{pair: 0.9})
    after = found(["plastic-contact"], **{"plastic-contact": 0.8, "none": 0.0, "unknown": 0.2})
    assert give_way(before, 0.4, None, after) == "only plastic-contact"
    told = before.probabilities
    assert told == pytest.approx({"none": 0.0, "unknown": 0.14, pair: 0.54, "plastic-contact": 0.32})
    assert sum(told.values()) == pytest.approx(1.0)


@pytest.mark.parametrize("after", [None, found([], none=0.9, unknown=0.1), found(["unknown"], unknown=1.0)])
def test_nothing_is_missing_where_a_slip_leaves_nothing_to_name(after):
    before = found(["sensor-gain"], none=0.0, unknown=0.1, **{"sensor-gain": 0.9})
    assert give_way(before, 0.5, None, after) == "none"
    assert before.probabilities == pytest.approx({"none": 0.45, "unknown": 0.1, "sensor-gain": 0.45})
