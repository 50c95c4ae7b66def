"""Several values of a table that are off, or stand in each other's place, with an effect and without."""

import numpy as np
import pytest
from made_tables import ERROR, ball, chain, changed

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import course, tables
from sonicvacuum.discover.faults.found import Bench
from sonicvacuum.discover.faults.ranking import Ranking
from sonicvacuum.effects import CATALOGUE

SPEEDS = (0.15, 0.2, 0.3, 0.45, 0.6, 0.9)


def off(record, **factors):
    """The table with values so many times as large: v1_3 is the fourth of run v1."""
    for at, factor in factors.items():
        run, place = (int(n) for n in at.removeprefix("v").split("_"))
        record = changed(record, run, place, value=lambda v, f=factor: f * v)
    return record


def exchanged(record, place, a, b):
    first, second = (record.block.runs[k].observables[place].value for k in (a, b))
    return changed(changed(record, a, place, value=lambda _: second), b, place, value=lambda _: first)


def standing(record):
    model = Ranking(Bench(record), CATALOGUE, 1, []).nominal()
    runs = tables._runs(record)
    start = tables._at_stated(tables._with_open_speeds(model.forward), model.fit)
    return course.standing_out(runs, start, model)


def discovered(record):
    found = session.discover(record, threads=1, limits=False).verdict
    return found.named, {(f.fault, f.run, f.quantity) for f in found.faults}


@pytest.fixture(scope="module")
def sound():
    return chain(SPEEDS)


def test_few_values_that_leave_the_courses_of_all_are_told(sound):
    found = standing(off(sound, v1_0=0.7, v4_0=1.4, v2_3=1.3))
    assert found == course.Standing(frozenset({(1, 0), (4, 0), (2, 3)}))


def test_two_values_in_each_others_place_are_told_as_exchanged(sound):
    assert standing(exchanged(sound, 1, 1, 4)) == course.Standing(frozenset(), (((1, 1), (4, 1)),))


def test_of_three_values_two_may_be_exchanged():
    speed, off = np.linspace(-1.0, 1.0, 10), np.zeros(10)
    off[[2, 7, 5]] = speed[7] - speed[2], speed[2] - speed[7], 0.4
    places = tuple((k, 0) for k in range(10))
    one = course._Course(places, speed + off, np.zeros(10), speed, np.full(10, 0.01))
    left, chosen = one.without(3)
    assert left < 1e-9 and set(chosen) == {2, 5, 7}  # it is a straight line, to rounding
    told = course._told([one], [chosen])
    assert told == course.Standing(frozenset({(5, 0)}), (((2, 0), (7, 0)),))


def test_a_run_at_another_speed_leaves_no_value_by_itself(sound):
    assert standing(off(sound, v3_0=1.2, v3_1=1.2)) == course.Standing()


@pytest.mark.parametrize("departures", [(), [("mass", 5, 3.0)], [("stiffness", 2, 0.3)]])
def test_nothing_leaves_the_courses_of_a_sound_table(departures):
    assert standing(chain(SPEEDS, departures=departures)) == course.Standing()


def test_a_value_that_was_taken_for_off_tells_no_course():
    record = off(ball(), v2_1=1.3)
    for place in (2, 3, 4):
        record = changed(record, place, 1, sigma=lambda s: 1e4 * s)
    # Three values are left, along which a line may go anywhere.
    assert standing(record) == course.Standing()


def test_left_is_what_a_straight_line_leaves():
    random, n = np.random.default_rng(3), 7
    speed, measured, expected = random.normal(size=(3, n))
    error = random.uniform(0.1, 1.0, n)
    one = course._Course(tuple((k, 0) for k in range(n)), measured, expected, speed, error)
    kept = [k for k in range(n) if k not in (1, 4)]
    rows = np.column_stack([np.ones(n), speed])[kept] / error[kept, None]
    _, (left,), *_ = np.linalg.lstsq(rows, ((measured - expected) / error)[kept])
    assert one.but((1, 4)) == pytest.approx(left, rel=1e-9)  # sums of seven numbers near one


@pytest.mark.long
def test_values_off_and_exchanged_beside_an_effect_are_no_noise():
    """Each moves its value by eight errors or so; beside the nominal model, with what the effect does, errors
    of another size explain more.
    """
    record = exchanged(chain(SPEEDS, departures=[("mass", 5, 1.5)]), 4, 1, 2)
    named, faults = discovered(record)
    assert named == ["mass-defect"]
    assert faults == {("runs-swapped", "v1 and v2", "speed g7-wall")}


@pytest.mark.long
def test_values_off_beside_a_strong_effect_leave_it_alone():
    """Neither of the two explains what the effect leaves, and sets of effects would be asked for it."""
    record = off(chain(SPEEDS, departures=[("mass", 5, 3.0)]), v1_4=1.06, v3_1=0.93)
    found = session.discover(record, threads=1, limits=False).verdict
    assert found.named == ["mass-defect"]
    value = {(f.run, f.quantity): f.value for f in found.faults if f.fault == "spikes"}
    assert value.keys() == {("v1", "speed g7-wall"), ("v3", "amplitude g7")}
    # Three standard errors of a value; beside the nominal model g7 reads a third less than it should.
    assert value["v1", "speed g7-wall"] == pytest.approx(1.06, abs=3.0 * ERROR)
    assert value["v3", "amplitude g7"] == pytest.approx(0.93, abs=3.0 * ERROR)
