"""Gauges stated at the wall that sit in a bead, the other way round, and beads away: effects or no verdict
before.
"""

from dataclasses import replace

import msgspec
import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes, seats
from sonicvacuum.discover.model.nominal import predicted, read_at
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.records import Record
from sonicvacuum.report.bench import slip


def without(record, *ids):
    """The record without some of its gauges."""
    sensors = [s for s in record.block.sensors if s.id not in ids]
    return Record(msgspec.structs.replace(record.block, sensors=sensors), record.signals, record.name)


def asked(record):
    """(gauge, bead or None) of what is asked of a record."""
    data = experiment(record)
    found = seats.seats(record, predicted(data), lambda gauges: read_at(data, gauges))
    return [(s.sensor, s.value(0.0)) for s in found]


def told(record):
    """Slips of a verdict that are sure, gauge → value, and what is named."""
    v = session.discover(record).verdict
    sure = [f for f in v.faults if f.probability > 0.9]
    return {(f.fault, f.sensor): f.value for f in sure}, v.named, [slip(f) for f in sure]


def test_readings_elsewhere_are_those_of_gauges_that_sit_there(empty):
    data = experiment(empty)
    one, other = predicted(data), read_at(data, [data.gauges[1]])
    assert {run: list(own) for run, own in other.items()} == {"v0": ["g7"], "v1": ["g7"]}
    assert other["v1"]["g7"] == pytest.approx(one["v1"]["g7"], abs=1e-3)


def test_nothing_is_asked_of_gauges_that_read_what_they_should(empty):
    assert asked(empty) == []
    assert asked(without(empty, "wall")) == []
    uncalibrated = [msgspec.structs.replace(s, gain_rel_sigma="unknown") for s in empty.block.sensors]
    assert asked(Record(msgspec.structs.replace(empty.block, sensors=uncalibrated), empty.signals)) == []


@pytest.mark.parametrize("bead", [10, 9])
def test_a_gauge_at_the_wall_that_is_stated_in_a_bead_is_told(empty, bead):
    moved = changes.gauge_seated(empty, "wall", bead)
    assert asked(moved) == [("wall", None)]
    found, named, (said,) = told(moved)
    assert found == {("gauge-misplaced", "wall"): None}
    assert named == []
    assert said == "gauge wall seems to sit at the wall"


def test_a_gauge_alone_in_a_bead_that_is_stated_at_the_wall_is_asked_for(empty):
    beads = asked(changes.gauge_seated(without(empty, "wall", "g7"), "g4", None))
    assert ("g4", 4.0) in beads
    assert len(beads) == seats.NEAREST


def test_a_gauge_in_a_bead_that_is_stated_at_the_wall_is_told(empty):
    found, named, (said,) = told(changes.gauge_seated(without(empty, "wall"), "g7", None))
    assert found == {("gauge-misplaced", "g7"): 7.0}
    assert named == []
    assert said == "gauge g7 seems to sit in bead 7"


def test_a_gauge_in_the_last_bead_that_is_stated_at_the_wall_is_told():
    sensors = [
        {"id": f"g{b}", "kind": "embedded", "bead": b, "sigma_N": 0.02, "gain_rel_sigma": 0.02}
        for b in (4, 10)
    ]
    record, _ = made(seed=6, sensors=sensors)
    found, named, _ = told(changes.gauge_seated(record, "g10", None))
    assert found == {("gauge-misplaced", "g10"): 10.0}
    assert named == []


@pytest.mark.parametrize("bead", [2, 5, 7, 10])
def test_a_gauge_that_is_beads_away_is_told(empty, bead):
    (own,) = (s.bead for s in empty.block.sensors if s.id == "g4")
    moved = changes.gauges_at(empty, {"g4": bead})
    assert ("g4", float(own)) in asked(moved) or abs(bead - own) < 2
    found, named, (said,) = told(moved)
    assert found == {("gauge-misplaced", "g4"): float(own)}
    assert named == []
    assert said == f"gauge g4 seems to sit in bead {own}"


def test_only_beads_away_are_asked_for_beside_the_neighbouring_ones(empty):
    found = asked(changes.gauges_at(empty, {"g4": 9}))
    assert found and all(id == "g4" and abs(bead - 9) > 1 for id, bead in found)


def test_gauges_whose_pulses_lie_before_the_impact_say_nothing_of_the_speed(empty):
    """Where the model's pulse is not in the window a shift by the wave's speed was beyond any number."""
    early = {run: replace(s, time_us=s.time_us - 1e4) for run, s in empty.signals.items()}
    record = replace(empty, signals=early)
    still = {run: {g: np.zeros(len(s.time_us)) for g in s.readings} for run, s in early.items()}
    model = {run: {"own": s.readings["g7"]} for run, s in early.items()}
    gauge = next(g for g in record.gauges if g.id == "g4")
    assert np.isfinite(seats._alike(record, gauge, {r: still[r] | model[r] for r in still}, model)).all()
