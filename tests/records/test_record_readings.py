"""Readings may count anything, as long as there is arithmetic for them; else one message says what to do."""

import re

import pytest
from record_cases import TRACES, put

from sonicvacuum.files import InputError
from sonicvacuum.records import read, signals
from sonicvacuum.records.signals import Signals


def counted(folder, factor, sensor):
    """A record whose gauge `near` counts in a unit of its own, in both runs."""
    put(folder, sensors__0=sensor)
    for run, trace in TRACES.items():
        readings = trace.readings | {"near": factor * trace.readings["near"]}
        signals.write(Signals(trace.time_us, readings), folder / f"{run}.csv")
    return folder


UNCALIBRATED = {"id": "near", "kind": "embedded", "bead": 3, "gain_rel_sigma": "unknown"}


@pytest.mark.parametrize(
    ("factor", "parts"),
    [
        (1e300, ["reach", "e+301;", "between 1e-09 and 1e+15", "a larger unit"]),
        (1e16, ["reach", "e+17;", "a larger unit"]),
        (1e-12, ["reach", "e-11 only;", "a smaller unit", "write 0"]),
        (1e-300, ["reach", "e-299 only;", "a smaller unit", "write 0"]),
    ],
)
def test_readings_that_no_arithmetic_squares_are_refused_whatever_they_count(tmp_path, factor, parts):
    with pytest.raises(InputError) as caught:
        read(counted(tmp_path, factor, UNCALIBRATED))
    pattern = ".*".join(map(re.escape, ["fast.csv, column near:", *parts]))
    assert re.search(pattern, str(caught.value))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("factor", [1e12, 1e-9, 0.0])
def test_an_uncalibrated_gauge_counts_in_any_unit(tmp_path, factor):
    assert read(counted(tmp_path, factor, UNCALIBRATED)).signals


def test_a_channel_that_shows_less_than_its_stated_noise_may_show_next_to_nothing(tmp_path):
    dead = {"id": "near", "kind": "embedded", "bead": 3}
    assert read(counted(tmp_path, 1e-20, dead | {"sigma_N": 0.05})).signals
    with pytest.raises(InputError, match="convert them to N, or write 0 where nothing was read"):
        read(counted(tmp_path, 1e-20, dead))
