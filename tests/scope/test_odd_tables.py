"""Tables as loggers and people leave them: further headers, rows of units where they may stand, odd names.

What cannot be read without a guess is refused, and what was left out is said.
"""

import numpy as np
import pytest
from odd_files import PULSE, SECOND, TIMES, recording, rows, seen

from sonicvacuum.files import InputError


@pytest.mark.parametrize(
    ("head", "names"),
    [
        ("x-axis,2,4\nsecond,Volt,Volt\n", ["2", "4"]),
        ("Time (s),5,11\n", ["5", "11"]),
        ("Bead,5,11\n", ["5", "11"]),
        ("Time (s),CH1 (V),CH2 (V)\n", ["CH1", "CH2"]),
    ],
)
def test_channels_keep_their_numbers(tmp_path, head, names):
    found = recording(tmp_path, head + rows(TIMES, PULSE, SECOND))
    assert [c.name for c in found.channels] == names


def test_a_key_with_a_number_is_no_row_of_names(tmp_path):
    found = recording(tmp_path, "# Sampling rate [Hz]\t500000\n" + rows(PULSE, SECOND, cell=" "), "t.txt")
    assert [(c.name, c.interval_s) for c in found.channels] == [("CH1", 2e-6), ("CH2", 2e-6)]


# Rows of names, units and anything else, in any order in which they are met.
HEADERS = [
    "Time,CH1,CH2\nms,mV,mV\n,bead 5,bead 11\n",
    "Time,CH1,CH2\nms,mV,mV\nclock,left,right\n",
    "ms,mV,mV\nTime,CH1,CH2\n",
    "[ms],[mV],[mV]\nTime,CH1,CH2\n",
    "Time (ms),CH1 (mV),CH2 (mV)\n# segment 1\n",
    "Time,CH1,CH2\nms,mV,mV\nDouble,Double,Double\n",
    "Time,CH1,CH2\nms,mV,mV\nDAQ,MX410,MX410\nTiefpass,20 kHz,20 kHz\n",
]


@pytest.mark.parametrize("head", HEADERS)
def test_the_row_of_units_is_found_beside_other_rows(tmp_path, head):
    found = recording(tmp_path, head + rows(1e3 * TIMES, 1e3 * PULSE, 1e3 * SECOND))
    assert [(c.name, c.unit) for c in found.channels] == [("CH1", "V"), ("CH2", "V")]
    for channel, values in zip(found.channels, (PULSE, SECOND), strict=True):
        assert channel.values == pytest.approx(values, abs=1e-6)
        assert channel.interval_s == pytest.approx(1e-6, rel=1e-6)
        assert channel.start_s == pytest.approx(-1e-4, rel=1e-6)


def test_a_unit_of_the_header_that_is_not_used_is_no_volt(tmp_path):
    head = "a,mV,N\nnote,x,y\n" + "remark,,\n" * 7 + "Time (s),CH1,CH2\n"
    found = recording(tmp_path, head + rows(TIMES, PULSE, SECOND))
    assert [c.unit for c in found.channels] == ["mV", "N"]
    assert all(any("is not known" in n for n in c.notes) for c in found.channels)


def test_a_row_of_units_of_unknown_places_is_no_volt(tmp_path):
    found = recording(
        tmp_path, "mV,N\nremark,of,some,length\nTime (s),CH1,CH2\n" + rows(TIMES, PULSE, SECOND)
    )
    assert [c.unit for c in found.channels] == ["mV, N"] * 2


@pytest.mark.parametrize("label", ["gauge_A", "ch_C", "gauge_m", "bar", "F_5", "min"])
def test_names_that_look_like_units(tmp_path, label):
    found = recording(tmp_path, f"time_s,{label},wall\n" + rows(TIMES, PULSE, SECOND))
    assert (found.channels[0].name, found.channels[0].unit) == (label, "")
    assert np.array_equal(found.channels[0].values, PULSE)


@pytest.mark.parametrize(
    ("label", "unit", "factor"),
    [("F_N", "N", 1.0), ("v_m/s", "m/s", 1.0), ("acc_g", "g", 1.0), ("F (daN)", "N", 10.0),
     ("F (lbf)", "N", 4.4482216152605), ("F [kgf]", "N", 9.80665)],
)  # fmt: skip
def test_names_that_bear_units(tmp_path, label, unit, factor):
    (channel,) = recording(tmp_path, f"time_s,{label}\n" + rows(TIMES, PULSE)).channels
    assert (channel.name, channel.unit) == (label.split("_")[0].split(" ")[0], unit)
    assert channel.values == pytest.approx(factor * PULSE, rel=1e-12)


@pytest.mark.parametrize("unit", ["counts", "% FS", "1E-3 V", "x10 V"])
def test_unknown_units_are_named(tmp_path, unit):
    (channel,) = recording(tmp_path, f"Time (s),F5 ({unit})\n" + rows(TIMES, PULSE)).channels
    assert channel.unit == unit
    assert f"The unit {unit} is not known; numbers are as written." in channel.notes


def test_times_may_be_counted_in_so_many_seconds(tmp_path):
    (channel,) = recording(tmp_path, "Time (1E-6 s),F (N)\n" + rows(1e6 * TIMES, PULSE)).channels
    assert (channel.start_s, channel.interval_s) == pytest.approx((-1e-4, 1e-6), rel=1e-9)


def test_remarks_in_brackets_are_no_units(tmp_path):
    (channel,) = recording(tmp_path, "Time (s),F5 (bead 5)\n" + rows(TIMES, PULSE)).channels
    assert (channel.name, channel.unit) == ("F5 (bead 5)", "")


def test_a_further_header_names_other_channels_of_the_same_shot(tmp_path):
    text = "Time (s),CH1 (V)\n" + rows(TIMES, PULSE) + "\nTime (s),CH2 (mV)\n" + rows(TIMES, 1e3 * SECOND)
    found = recording(tmp_path, text)
    assert seen(found) == [("CH1", 1, "V", 200), ("CH2", 1, "V", 200)]
    assert found.channels[1].values == pytest.approx(SECOND, abs=1e-6)
    assert any("Line 203" in n for n in found.notes)


def test_a_further_header_whose_key_names_the_channel(tmp_path):
    one = "Source,{}\nTime (s),Voltage (V)\n"
    text = "\n".join(
        one.format(n) + rows(TIMES, v) for n, v in (("CH1", PULSE), ("CH2", SECOND), ("CH1", PULSE))
    )
    assert seen(recording(tmp_path, text)) == [
        ("CH1", 1, "V", 200), ("CH2", 1, "V", 200), ("CH1", 2, "V", 200)
    ]  # fmt: skip


def test_a_further_header_of_other_columns_is_refused(tmp_path):
    text = (
        "Time (s),CH1 (V),CH2 (V)\n" + rows(TIMES, PULSE, SECOND) + "Time (s),CH3 (V)\n" + rows(TIMES, PULSE)
    )
    with pytest.raises(InputError, match=r"further table begins with 'Time \(s\),CH3 \(V\)'.*of its own"):
        recording(tmp_path, text)


@pytest.mark.parametrize("first", ["dt", "Samples", "t0", "Points"])
def test_columns_may_be_called_like_keys(tmp_path, first):
    text = f"{first},left (V),right (V)\n" + rows([str(k) for k in range(200)], PULSE, SECOND)
    assert [c.name for c in recording(tmp_path, text).channels] == ["left", "right"]


def test_the_units_of_a_further_header_are_its_own(tmp_path):
    text = "Time (s),CH1 (V)\n" + rows(TIMES, PULSE) + "Time (s),CH1 (mV)\n" + rows(TIMES, 1e3 * PULSE)
    found = recording(tmp_path, text)
    assert [c.segment for c in found.channels] == [1, 2]
    assert found.channels[1].values == pytest.approx(PULSE, abs=1e-6)


def test_a_remark_between_samples_names_no_channels(tmp_path):
    text = (
        "Time (s),CH1 (V),CH2 (V)\n"
        + rows(TIMES, PULSE, SECOND)
        + "comment,a,b,c,d,e\n"
        + rows(TIMES, PULSE, SECOND)
    )
    found = recording(tmp_path, text)
    assert [(c.name, c.segment) for c in found.channels] == [("CH1", 1), ("CH2", 1), ("CH1", 2), ("CH2", 2)]
    assert any("Line 202 (comment,a,b,c,d,e) holds no samples" in n for n in found.notes)


def test_a_row_of_numbers_wider_than_the_table_is_refused(tmp_path):
    lines = rows(TIMES, PULSE).split("\n")
    lines[40] = "1,2,3,4,5,6"
    with pytest.raises(InputError, match=r"line 42 has 6 cells, more than there are columns.*'1,2,3,4,5,6'"):
        recording(tmp_path, "Time (s),CH1 (V)\n" + "\n".join(lines))


def test_a_line_of_dashes_below_the_names_names_nothing(tmp_path):
    found = recording(tmp_path, "Time (s),CH1 (V)\n--------,-------\n" + rows(TIMES, PULSE))
    assert seen(found) == [("CH1", 1, "V", 200)]
