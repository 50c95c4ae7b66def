"""Rows of units of which that of time alone is known: times must not be taken for seconds."""

import pytest
from odd_files import PULSE, SECOND, TIMES, recording, rows

UNKNOWN = ["cnt", "(counts)", "a.u.", "lbs", "LSB", "V/g", "mV/V", "%FS", "Skt", ""]


@pytest.mark.parametrize("unit", UNKNOWN)
@pytest.mark.parametrize(("time", "factor"), [("ms", 1e3), ("(us)", 1e6), ("msec", 1e3), ("s", 1.0)])
@pytest.mark.parametrize("several", [False, True])
def test_the_unit_of_time_counts_beside_units_that_are_not_known(tmp_path, unit, time, factor, several):
    traces = (PULSE, SECOND)[: 1 + several]
    head = f"Time,{','.join('FG'[: len(traces)])}\n{time},{','.join([unit] * len(traces))}\n"
    found = recording(tmp_path, head + rows(factor * TIMES, *traces)).channels
    assert [c.name for c in found] == list("FG"[: len(traces)])
    if unit:  # where there is none, brackets around that of time tell PicoScope, which writes volts
        assert {c.unit for c in found} == {unit.strip("()")}
    assert [c.interval_s for c in found] == pytest.approx([1e-6] * len(traces), rel=1e-9)


def test_such_a_row_above_the_names(tmp_path):
    (channel,) = recording(tmp_path, "ms,cnt\nTime,F\n" + rows(1e3 * TIMES, PULSE)).channels
    assert (channel.name, channel.unit) == ("F", "cnt")
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-9)


@pytest.mark.parametrize("head", ["ms,F\n", "x,y\nmin,max\n", "Time,F\nfirst,second\n"])
def test_rows_of_names_stay_names(tmp_path, head):
    (channel,) = recording(tmp_path, head + rows(TIMES, PULSE)).channels
    factor = 1e-3 if head.startswith("ms") else 1.0
    assert channel.interval_s == pytest.approx(factor * 1e-6, rel=1e-9)


@pytest.mark.parametrize("key", ["Unit", "Units", "VUnit"])
@pytest.mark.parametrize("unit", ["mN", "N", "cnt"])
def test_a_row_of_units_whose_key_stands_before_the_table(tmp_path, key, unit):
    factor = 1e-3 if unit == "mN" else 1.0
    (channel,) = recording(tmp_path, f"{key},ms,{unit}\nTime,F\n" + rows(1e3 * TIMES, PULSE)).channels
    assert (channel.name, channel.unit) == ("F", "cnt" if unit == "cnt" else "N")
    assert channel.values == pytest.approx(factor * PULSE, rel=1e-9)
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-9)


def test_a_unit_of_time_in_the_header_is_none_of_a_channel(tmp_path):
    (channel,) = recording(tmp_path, "Unit: ms\nTime (s),F\n" + rows(TIMES, PULSE)).channels
    assert channel.unit == "" and channel.values == pytest.approx(PULSE, rel=1e-9)


def test_units_of_channels_that_were_not_saved(tmp_path):
    head = "Vertical Units,V,mV,A\nTime (s),CH1,CH2\n"
    found = recording(tmp_path, head + rows(TIMES, PULSE, 1e3 * SECOND)).channels
    for channel, volts in zip(found, (PULSE, SECOND), strict=True):
        assert channel.unit == "V" and channel.values == pytest.approx(volts, rel=1e-9)


@pytest.mark.parametrize("mark", ["# ", "#", "% "])
@pytest.mark.parametrize("units", ["(us),(N)", "us,N", "[us],[N]", "us,"])
def test_names_and_units_behind_the_mark_of_a_comment(tmp_path, mark, units):
    text = f"{mark}Time,F\n{mark}{units}\n" + rows(1e6 * TIMES, PULSE)
    (channel,) = recording(tmp_path, text).channels
    assert (channel.name, channel.unit) == ("F", "N" if "N" in units else "")
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-9)
