"""Traces of runs that lack a gauge, or of which one sample alone is believed, are drawn all the same."""

import numpy as np
import pytest

from sonicvacuum.figures import discovery
from sonicvacuum.figures.drawing import Text
from sonicvacuum.figures.frame import Scale

GAUGES = ("g3", "g5", "g7", "g9", "wall")


def table(**runs):
    """Rows as discover writes them: run → gauge → number of samples."""
    return [
        {"run": run, "sensor": gauge, "time_us": f"{10 * k}", "measured_N": "1.5", "sigma_N": "0.1"}
        | {"nominal_N": f"{k}", "extended_N": f"{k + 1}"}
        for run, samples in runs.items()
        for gauge, count in samples.items()
        for k in range(count)
    ]


def words(drawing):
    return [mark.words for mark in drawing.marks if isinstance(mark, Text)]


@pytest.mark.parametrize("lacking", ["first", "last"])
def test_a_gauge_that_a_run_lacks_is_told_of_in_its_place(lacking):
    whole = dict.fromkeys(GAUGES[:3], 20)
    runs = {"first": dict(whole), "middle": dict(whole), "last": dict(whole)}
    del runs[lacking]["g7"]
    found = words(discovery.traces(table(**runs), ["kuwabara-kono"]))
    other = "last" if lacking == "first" else "first"
    assert f"{lacking}, g7: no trace" in found
    assert {f"{other}, g7", f"{lacking}, g5", f"{other}, g3"} <= set(found)
    assert found.count("time (µs)") == 2  # below the lowest panel of each run


def test_gauges_that_both_runs_have_come_before_others():
    found = words(discovery.traces(table(one=dict.fromkeys(GAUGES, 20), two={"g9": 20, "wall": 20}), []))
    assert [w for w in found if w.startswith("two")] == [
        "two, g3: no trace",
        "two, g5: no trace",
        "two, g9",
        "two, wall",
    ]


def test_runs_without_a_common_gauge_are_drawn():
    found = words(discovery.traces(table(one=dict.fromkeys(GAUGES[:4], 20), two={"wall": 20}), []))
    assert found.count("two, g3: no trace") == found.count("one, g3") == 1


def test_a_single_sample_is_drawn():
    assert "one, g3" in words(discovery.traces(table(one={"g3": 1, "wall": 20}), []))


@pytest.mark.parametrize("value", [550.0, -2.0, 0.0, 1e-30, 1e30])
def test_an_axis_of_one_value_is_one_about_it(value):
    scale = Scale(value, value)
    assert scale.at(value) == pytest.approx(0.5)
    assert len(scale.ticks(5)) > 1
    assert Scale.over([value]) == scale


def test_a_logarithmic_axis_of_one_value_is_one_about_it():
    scale = Scale(3.0, 3.0, log=True)
    assert scale.at(3.0) == pytest.approx(0.5)
    assert np.all(np.isfinite([value for value, _ in scale.ticks(5)]))
