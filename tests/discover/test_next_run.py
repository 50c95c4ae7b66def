"""The next run is one that the laboratory can make."""

import numpy as np
import pytest
from made_records import block

from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.next_experiment import changes
from sonicvacuum.files import InputError
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.reader import parse

SPEED = 0.5


def proposals(apparatus=None):
    """What could be changed in the last run of a record with this apparatus."""
    content = block([SPEED]) | ({"apparatus": apparatus} if apparatus is not None else {})
    time = np.arange(0.0, 300.0)
    quiet = Signals(time, {s["id"]: np.zeros(len(time)) for s in content["sensors"]})
    return [change for change, _ in changes(experiment(Record(parse(content), {"v0": quiet})))]


def test_without_apparatus_anything_usual_is_tried():
    keys = {key for change in proposals() for key in change}
    assert {"striker.speed_m_s", "striker.mass_g", "chain.static_force_N", "chain.orientation"} <= keys


def test_within_the_apparatus_nothing_else_is_proposed():
    found = proposals({"speed_m_s": [0.2, 0.8], "static_force_N": [0.0, 3.0], "gauge_beads": [2, 4]})
    assert {key for change in found for key in change} == {
        "striker.speed_m_s", "chain.static_force_N", "sensors.g4.bead"
    }  # fmt: skip
    speeds = [c["striker.speed_m_s"] for c in found if "striker.speed_m_s" in c]
    assert speeds == pytest.approx([0.2, 0.25, 0.8])
    assert {"chain.static_force_N": 3.0} in found
    assert {"sensors.g4.bead": 2} in found


def test_an_empty_apparatus_leaves_nothing_to_propose():
    assert proposals({}) == []


@pytest.mark.parametrize(
    ("apparatus", "told"),
    [
        ({"speed_m_s": [2.0, 1.0]}, "slowest first"),
        ({"speed_m_s": [1.0, 2000.0]}, "mm/s"),
        ({"gauge_beads": [40]}, "no such bead"),
        ({"speeds": [1.0]}, "speed"),
    ],
)
def test_an_apparatus_that_cannot_be_is_refused(apparatus, told):
    with pytest.raises(InputError, match=told):
        parse(block([SPEED]) | {"apparatus": apparatus})
