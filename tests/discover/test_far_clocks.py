"""Clocks off by four: pulses of the model are cut off, and no effect does as much; it took minutes before."""

import math
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import alone, changes, starts
from sonicvacuum.discover.faults.judged import other_clock
from sonicvacuum.discover.faults.slips import hypotheses
from sonicvacuum.discover.model.nominal import MOST, predicted, read_to_the_end
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.records import Record


@pytest.fixture(scope="module")
def sound():
    """Two speeds."""
    return made(seed=21)[0]


def at(record, factor, runs=None):
    """The record with times so many times the true ones."""
    return changes.clock(record, -math.log(factor), runs)


def test_pulses_that_are_cut_off_are_read_to_the_end(sound):
    short = at(sound, 0.25)
    data = experiment(short)
    seen = predicted(data)
    assert starts.unfinished(short, seen)
    whole = read_to_the_end(data)
    assert not starts.unfinished(short, whole)
    for run, own in whole.items():
        for gauge, reading in own.items():
            assert len(reading) > len(seen[run][gauge])
            assert reading[: len(seen[run][gauge])] == pytest.approx(seen[run][gauge], abs=1e-3)


def test_a_record_that_lasts_is_read_as_it_is(sound):
    assert not starts.unfinished(sound, predicted(experiment(sound)))
    longer = at(sound, 3.0)
    assert {len(r) for own in read_to_the_end(experiment(longer)).values() for r in own.values()} == {700}
    hurried = experiment(at(sound, 1e-3))
    assert {len(r) for own in read_to_the_end(hurried).values() for r in own.values()} == {700 * MOST}


@pytest.mark.parametrize("factor", [0.25, 4.0])
def test_a_clock_off_by_four_is_told_before_any_effect_is_asked(sound, factor, monkeypatch):
    def asked(*_):
        raise AssertionError("effects are asked so far from the data")

    monkeypatch.setattr(alone, "alone", asked)
    v = session.discover(at(sound, factor)).verdict
    ((fault, value),) = [(f.fault, f.value) for f in v.faults if f.probability > 0.9]
    assert fault == "clock"
    assert value == pytest.approx(factor, rel=0.03)
    assert v.named == []


def test_a_run_whose_pulses_are_cut_off_starts_at_its_clock(sound):
    short = at(sound, 0.25, ("v1",))
    found = starts.run_clocks(short, read_to_the_end(experiment(short)))
    assert [(s.run, s.start) for s in found] == [("v1", pytest.approx(-math.log(4.0), abs=0.1))]


def test_only_what_no_effect_does_is_a_clock_before_effects_are_asked(sound):
    clock = next(s for s in hypotheses(sound) if s.fault == "clock")
    gauges = [SimpleNamespace(calibrated=True)]
    model = SimpleNamespace(forward=SimpleNamespace(experiment=SimpleNamespace(gauges=gauges)))

    def judged(size, slip=clock):
        return SimpleNamespace(slip=slip, size=size)

    assert other_clock(judged(math.log(0.25)), model)
    assert not other_clock(judged(math.log(2.0)), model)
    assert not other_clock(judged(2.0, next(s for s in hypotheses(sound) if s.fault == "bead-size")), model)
    gauges[0].calibrated = False
    assert not other_clock(judged(math.log(0.25)), model)


def test_traces_without_a_clear_pulse_are_not_waited_for(sound):
    quiet = [msgspec.structs.replace(s, sigma_N=100.0) for s in sound.block.sensors]
    record = Record(msgspec.structs.replace(sound.block, sensors=quiet), at(sound, 0.25).signals)
    cut = {run: {g: np.arange(700.0) for g in s.readings} for run, s in record.signals.items()}
    assert not starts.unfinished(record, cut)
