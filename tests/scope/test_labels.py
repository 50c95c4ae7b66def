"""What one label says: name and unit of a column, wherever the unit stands in it."""

import numpy as np
import pytest
from odd_files import PULSE, SECOND, TIMES, recording, rows

# Labels of times and of forces with their units before a remark, and the name that is left.
REMARKED = [
    ("Time (ms) Run #1", "Force (mN) Run #1", "Force Run #1"),
    ("Time (ms) - Plot 0", "Force (mN) - Plot 0", "Force - Plot 0"),
    ("Time [ms] - Ch1", "Force [mN] - Ch1", "Force - Ch1"),
    ("Time(ms)CH1", "Force(mN)CH1", "Force CH1"),
    ("Time (ms):", "Force (mN):", "Force"),
    ("timeMs", "force_mN", "force"),
]


@pytest.mark.parametrize(("clock", "label", "name"), REMARKED)
def test_units_count_before_a_remark(tmp_path, clock, label, name):
    text = f"{clock},{label}\n" + rows(1e3 * TIMES, 1e3 * PULSE, form="{:.9g}")
    (channel,) = recording(tmp_path, text).channels
    assert (channel.name, channel.unit) == (name, "N")
    assert channel.values == pytest.approx(PULSE, abs=1e-9)
    assert (channel.start_s, channel.interval_s) == pytest.approx((-1e-4, 1e-6), rel=1e-6)


@pytest.mark.parametrize("unit", ["h", "samples", "div"])
def test_an_unknown_unit_of_time_before_a_remark_is_none(tmp_path, unit):
    (channel,) = recording(tmp_path, f"Time ({unit}) Run #1,F (N)\n" + rows(1e6 * TIMES, PULSE)).channels
    assert channel.interval_s is None
    assert channel.notes[0].startswith(f"No time: the unit of time, '{unit}', is not known")


@pytest.mark.parametrize("label", ["F5 (bead 5) left", "CH1 (V) x10", "CH1 (V) 1e-3"])
def test_what_follows_brackets_may_be_no_remark(tmp_path, label):
    (channel,) = recording(tmp_path, f"Time (s),{label}\n" + rows(TIMES, PULSE)).channels
    assert (channel.name, channel.unit) == (label, "")
    assert np.array_equal(channel.values, PULSE)


@pytest.mark.parametrize("first", ["Frequency (Hz)", "Freq", "Position (mm)", "Displacement", "Voltage (V)"])
def test_a_column_of_another_quantity_is_no_time(tmp_path, first):
    channels = recording(tmp_path, f"{first},F (N)\n" + rows(1e-3 * np.arange(200), PULSE)).channels
    assert [(c.interval_s, c.samples) for c in channels] == [(None, 200)] * 2
    assert f"the first column, {first.split(' ')[0]!r}, is no time" in channels[1].notes[0]


@pytest.mark.parametrize(
    ("head", "names"),
    [
        ("Time,X,Y\n", ["X", "Y"]),
        ("t,x,y\n", ["x", "y"]),
        ("mass_A\nt,x,y\n", ["x", "y"]),
        ("time,in,out\n", ["in", "out"]),
    ],
)
def test_coordinates_beside_times_are_channels(tmp_path, head, names):
    channels = recording(tmp_path, head + rows(TIMES, PULSE, SECOND)).channels
    assert [c.name for c in channels] == names
    for channel, values in zip(channels, (PULSE, SECOND), strict=True):
        assert channel.values == pytest.approx(values, abs=1e-7)
        assert channel.interval_s == pytest.approx(1e-6, rel=1e-6)


@pytest.mark.parametrize("head", ["t,F1,t,F2\n", "x,F1,x,F2\n", "t1,F1,t2,F2\n"])
def test_times_of_the_same_name_are_times(tmp_path, head):
    channels = recording(tmp_path, head + rows(TIMES, PULSE, TIMES + 5e-6, SECOND)).channels
    assert [c.name for c in channels] == ["F1", "F2"]
    assert [c.start_s for c in channels] == pytest.approx([-1e-4, -9.5e-5], rel=1e-6)


def test_an_empty_column_with_times_is_left_out(tmp_path):
    text = "Time (s),CH1 (V),CH2 (V)\n" + rows(TIMES, ["nan"] * 200, SECOND)
    assert [c.name for c in recording(tmp_path, text).channels] == ["CH2"]


def test_a_time_named_in_a_row_of_its_own(tmp_path):
    head = "Channel,1,2\nName,near,far\nUnit,mN,mV\nTime (ms),,\n"
    channels = recording(tmp_path, head + rows(1e3 * TIMES, 1e3 * PULSE, 1e3 * SECOND)).channels
    assert [(c.unit, c.interval_s) for c in channels] == [("N", 1e-6), ("V", 1e-6)]


def test_names_of_the_first_columns_only(tmp_path):
    text = "Time (ms),CH1 (mV)\n" + rows(1e3 * TIMES, 1e3 * PULSE, SECOND, form="{:.9g}")
    first, second = recording(tmp_path, text).channels
    assert (first.name, first.unit, second.unit) == ("CH1", "V", "")
    assert first.values == pytest.approx(PULSE, abs=1e-9)
    assert first.interval_s == second.interval_s == 1e-6


@pytest.mark.parametrize("key", ["UnitName=", "Unit Name", "Y Axis Units"])
def test_units_of_the_header_by_any_key(tmp_path, key):
    text = f"{key}\tmV\tN\n" + rows(TIMES, 1e3 * PULSE, SECOND, cell="\t")
    first, second = recording(tmp_path, text).channels
    assert (first.unit, second.unit) == ("V", "N")
    assert first.values == pytest.approx(PULSE, abs=1e-6)


def test_kinds_of_numbers_name_nothing(tmp_path):
    head = "Channel;Zeit;Kraft\nEinheit;ms;mN\nDatentyp;double;double\n"
    counts = [str(k) for k in range(200)]
    text = head + rows(counts, 1e3 * TIMES, 1e3 * PULSE, cell=";", form="{:.9g}")
    (channel,) = recording(tmp_path, text).channels
    assert (channel.name, channel.unit) == ("Kraft", "N")
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-6)


def test_of_more_names_than_channels_the_first_count(tmp_path):
    text = "Source,CH1,CH2,CH3\nSecond,Volt,Volt\n" + rows(TIMES, PULSE, SECOND)
    assert [c.name for c in recording(tmp_path, text).channels] == ["CH1", "CH2"]


def test_scans_are_counted(tmp_path):
    text = "Scan #,Time (s),AI0\n" + rows([str(k + 1) for k in range(200)], TIMES, PULSE)
    assert [c.name for c in recording(tmp_path, text).channels] == ["AI0"]


def test_a_known_unit_of_unknown_place_is_told_as_such(tmp_path):
    text = "mN,N\nremark,of,some,length\nTime (s),CH1,CH2\n" + rows(TIMES, PULSE, SECOND)
    for channel in recording(tmp_path, text).channels:
        assert "That the unit is mN, N is not known; numbers are as written." in channel.notes
