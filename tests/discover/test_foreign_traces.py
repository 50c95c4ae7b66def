"""Traces that belong to another run or gauge: exchanged, in another order, or one file or column taken for
both. Most ended as `unknown` before.
"""

from dataclasses import replace

import numpy as np
import pytest
from made_records import made
from made_slips import altered

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes, exchanges
from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.records import Signals
from sonicvacuum.report.bench import slip

SPEEDS = (0.3, 0.5, 0.9)


@pytest.fixture(scope="module")
def sound():
    """Three speeds."""
    return made(seed=12, speeds=SPEEDS)[0]


def asked(record):
    """What is asked of a record."""
    return exchanges.exchanged_traces(record, predicted(experiment(record)))


def told(record):
    """Slips that are sure, and what is named."""
    v = session.discover(record).verdict
    sure = [f for f in v.faults if f.probability > 0.9]
    return [(f.fault, f.run, f.sensor) for f in sure], v.named, [slip(f) for f in sure]


def test_nothing_is_asked_of_traces_in_their_places(sound):
    assert asked(sound) == []
    # What all gauges show is another run's as a whole.
    assert asked(changes.runs_swapped(sound, "v0", "v2")) == []


@pytest.mark.parametrize(("gauge", "runs"), [("g4", ("v0", "v2")), ("wall", ("v1", "v2"))])
def test_traces_of_one_gauge_in_each_others_run_are_told(sound, gauge, runs):
    mixed = changes.traces_swapped(sound, gauge, *runs)
    (one,) = asked(mixed)
    assert one.change(mixed, 0.0).signals["v2"].readings[gauge] is sound.signals["v2"].readings[gauge]
    found, named, (said,) = told(mixed)
    pair = " and ".join(runs)
    assert found == [("runs-swapped", pair, gauge)]
    assert named == []
    assert said == f"the traces of {gauge} in runs {pair} look exchanged, or one of them taken for both"


def test_cables_exchanged_in_one_run_are_told(sound):
    """A null of that kind was `striker-error` beside `unknown` with 0.65 before, after two minutes."""
    mixed = changes.gauges_swapped_in(sound, "v1", "g4", "g7")
    assert exchanges.exchanged_gauges(sound, predicted(experiment(sound))) == []
    (one,) = exchanges.exchanged_gauges(mixed, predicted(experiment(mixed)))
    assert one.change(mixed, 0.0).signals["v1"].readings["g4"] is sound.signals["v1"].readings["g4"]
    found, named, _ = told(mixed)
    assert found == [("gauges-swapped", "v1", ["g4", "g7"])]
    assert named == []


def test_traces_at_other_times_are_not_exchanged(sound):
    mixed = changes.traces_swapped(sound, "g4", "v0", "v2")
    later = Signals(mixed.signals["v2"].time_us + 5.0, mixed.signals["v2"].readings)
    assert asked(replace(mixed, signals={**mixed.signals, "v2": later})) == []


@pytest.mark.parametrize(("of", "to"), [("v0", "v1"), ("v2", "v0")])
def test_a_trace_taken_for_two_runs_is_left_out_of_the_wrong_one(sound, of, to):
    copy = altered(sound, "g7", lambda _: sound.signals[of].readings["g7"], to)
    bench, findings = examine(copy, predicted(experiment(copy)))
    ((a, b),) = [f.run.split(" and ") for f in findings]
    assert ({a, b}, findings[0].sensor) == ({of, to}, "g7")
    lacking = [run for run, s in bench.record.signals.items() if "g7" not in s.readings]
    assert lacking == [to]


def test_a_file_taken_for_two_runs_is_left_out_of_the_wrong_one(sound):
    record = replace(sound, signals={**sound.signals, "v1": sound.signals["v2"]})
    found, named, (said,) = told(record)
    assert found == [("runs-swapped", "v1 and v2", None)]
    assert named == []
    assert said == "runs v1 and v2 look exchanged, or one of them taken for both"
    bench, _ = examine(record, predicted(experiment(record)))
    assert list(bench.record.signals) == ["v0", "v2"]


def test_of_runs_struck_alike_nobody_knows_whose_a_trace_is():
    alike = made(seed=12, speeds=(0.5, 0.5))[0]
    copy = replace(alike, signals={"v0": alike.signals["v0"], "v1": alike.signals["v0"]})
    assert examine(copy, predicted(experiment(copy)))[1] == []


def test_constant_traces_are_nobodys(sound):
    flat = {run: {**s.readings, "g7": np.zeros(s.samples)} for run, s in sound.signals.items()}
    record = replace(sound, signals={k: Signals(sound.signals[k].time_us, flat[k]) for k in flat})
    assert list(exchanges.taken_twice(record, predicted(experiment(record)))) == []


def ordered(record):
    """The order of runs that is asked for."""
    return exchanges.other_order(record, predicted(experiment(record)))


def test_runs_that_are_in_another_order_than_their_strikers_are_told(sound):
    turned = changes.runs_struck(sound, {"v0": "v1", "v1": "v2", "v2": "v0"})
    (one,) = ordered(turned)
    assert one.change(turned, 0.0).block.runs == sound.block.runs
    found, named, (said,) = told(turned)
    assert found == [("runs-swapped", "v0, v1 and v2", None)]
    assert named == []
    assert said == "runs v0, v1 and v2 look exchanged, or one of them taken for both"


def test_no_order_is_asked_of_runs_that_are_in_theirs_or_of_two_exchanged(sound):
    assert ordered(sound) == []
    assert ordered(changes.runs_swapped(sound, "v0", "v2")) == []  # a slip of its own
    alike = made(seed=12, speeds=(0.5, 0.51, 0.9))[0]
    assert ordered(changes.runs_struck(alike, {"v0": "v1", "v1": "v2", "v2": "v0"})) == []


def twin(record, of, to):
    """The record with the traces of one gauge taken for another's as well."""
    taken = {run: Signals(s.time_us, {**s.readings, to: s.readings[of]}) for run, s in record.signals.items()}
    return replace(record, signals=taken)


@pytest.mark.parametrize(("of", "to"), [("g4", "g7"), ("g7", "g4"), ("wall", "g4")])
def test_a_column_taken_for_two_gauges_is_left_out_of_the_wrong_one(sound, of, to):
    record = twin(sound, of, to)
    bench, (found,) = examine(record, predicted(experiment(record)))
    assert (found.fault, set(found.sensor)) == ("gauges-swapped", {of, to})
    assert all(to not in s.readings and of in s.readings for s in bench.record.signals.values())


def test_a_column_taken_for_two_gauges_is_told(sound):
    found, named, (said,) = told(twin(sound, "g7", "g4"))
    assert found == [("gauges-swapped", None, ["g4", "g7"])]
    assert named == []
    assert said == "gauges g4 and g7 look swapped, or one of them taken for both"


def test_a_dead_gauge_that_reads_the_same_in_all_runs_is_dead(sound):
    noise = 0.02 * np.random.default_rng(3).normal(size=700)
    dead = altered(sound, "g7", lambda _: noise)
    _, findings = examine(dead, predicted(experiment(dead)))
    assert [(f.fault, f.run, f.sensor) for f in findings] == [("gauge-dead", None, "g7")]
