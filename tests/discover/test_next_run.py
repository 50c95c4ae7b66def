"""The next run is one that the laboratory can make."""

import numpy as np
import pytest
from made_records import block

from sonicvacuum.discover.imagined import changes
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.next_experiment import put_behind, resolved
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


def worth(weights, *apart):
    """Probability that each run leaves one explanation alone."""
    return resolved(weights, put_behind(weights, np.array(apart)))


def between(*pairs, count=3):
    """Matrix of χ² between pairs (i, j, χ²), 0 between the others."""
    found = np.zeros((count, count))
    for i, j, value in pairs:
        found[i, j] = found[j, i] = value
    return found


def test_a_run_that_tells_nothing_apart_resolves_nothing_and_a_decisive_one_all():
    found = worth(np.zeros(3), np.zeros((3, 3)), np.full((3, 3), 200.0))
    assert found == pytest.approx([0.0, 1.0], abs=1e-6)  # 191 of 200 more than asked, scatter 28


def test_a_run_that_separates_the_best_alone_is_worth_no_more_than_the_best_is_likely():
    """Which of the others is true stays open after it."""
    weights = np.log([0.4, 0.3, 0.3])
    best_alone = between((0, 1, 300.0), (0, 2, 300.0))
    all_three = between((0, 1, 40.0), (0, 2, 40.0), (1, 2, 40.0))
    one, other = worth(weights, best_alone, all_three)
    assert one == pytest.approx(0.4, abs=1e-6)  # scatter of 300 is 35
    assert other > 0.9


def test_what_a_run_decides_is_half_open_where_it_takes_as_much_as_is_asked():
    """A χ² of 9 has to be gained, and its mean is 9: as often more as less."""
    assert worth(np.zeros(2), between((0, 1, 9.0), count=2)) == pytest.approx([0.5])


def test_what_no_run_tells_apart_decides_nothing_between_runs():
    """The first two are limits of one another; runs are told by what they say of the third."""
    weak, strong = between((0, 2, 5.0), (1, 2, 5.0)), between((0, 2, 90.0), (1, 2, 90.0))
    one, other = worth(np.zeros(3), weak, strong)
    assert one < 0.4 < 0.99 < other
