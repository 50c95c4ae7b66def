"""What the rows above the samples say of units and time: the right channel, the right factor, or a remark."""

import re

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from odd_files import PULSE, SECOND, TIMES, recording, rows

from sonicvacuum.scope.units import quantity, unit_of

THIRD = 0.3 * PULSE
NAMES = "CH1 (V),CH2 (V)\n"


@pytest.mark.parametrize("lead", ["", ","])
@pytest.mark.parametrize("units", [("mV", "V", "V"), ("V", "", "mV"), ("", "V", "mV"), ("V", "V", "V")])
def test_units_of_a_row_belong_to_their_channels(tmp_path, lead, units):
    head = '"TraceName","CH1","CH2","CH3"\n"VUnit",' + ",".join(f'"{u}"' for u in units)
    head += '\n"HResolution",1E-6,1E-6,1E-6\n"HOffset",-1E-4,-1E-4,-1E-4\n\n'
    values = {"mV": 1e3, "V": 1.0, "": 1.0}
    columns = [values[u] * c for u, c in zip(units, (PULSE, SECOND, THIRD), strict=True)]
    lines = "".join(lead + line + "\n" for line in rows(*columns).splitlines())
    found = recording(tmp_path, head + lines).channels
    for channel, unit, expected in zip(found, units, (PULSE, SECOND, THIRD), strict=True):
        assert (channel.unit, channel.interval_s, channel.start_s) == ("V", 1e-6, -1e-4)
        assert channel.values == pytest.approx(expected, abs=1e-6)
        assert any("No unit given" in n for n in channel.notes) == (unit == "")


@pytest.mark.parametrize("mark", ["#", "# ", "%", "% "])
def test_units_below_names_in_a_comment(tmp_path, mark):
    """`#s,mV` was no row of units: readings in mV stood as they are, their times in s by assumption."""
    text = f"{mark}time,CH1\n{mark}us,mV\n" + rows(1e6 * TIMES, 1e3 * PULSE)
    (channel,) = recording(tmp_path, text).channels
    assert (channel.name, channel.unit, channel.interval_s, channel.notes) == ("CH1", "V", 1e-6, ())
    assert channel.values == pytest.approx(PULSE, abs=1e-6)


def test_units_above_columns_without_times(tmp_path):
    head = "Sample Interval,1e-06\nSource,CH1,CH2,CH3\nVertical Units,mV,V,V\nWaveform Data\n"
    found = recording(tmp_path, head + rows(1e3 * PULSE, SECOND, THIRD)).channels
    assert [(c.name, c.unit) for c in found] == [("CH1", "V"), ("CH2", "V"), ("CH3", "V")]
    assert found[0].values == pytest.approx(PULSE, abs=1e-6)


# Ways in which headers give an interval of 2 us.
COMMENTS = [
    "# fs: 500 kHz", "# fs 500 kHz", "# fs = 500000 Hz", "# fs=500000", "# dt = 2e-6", "# dt [us]: 2",
    "% dt = 2 us", "# Sampling rate [Hz]\t500000", "# sample interval (us) = 2", "dt=2us", "# dt: 2 µs",
]  # fmt: skip


# Where semicolons part the cells, a tab is part of one.
CELLS = [(c, cell) for c in COMMENTS for cell in " ,;\t" if (cell != ";" or "\t" not in c)]


@pytest.mark.parametrize(("comment", "cell"), CELLS)
def test_the_interval_of_a_comment(tmp_path, comment, cell):
    text = f"{comment}\n# g5{cell}g11\n" + rows(PULSE, SECOND, cell=cell)
    found = recording(tmp_path, text).channels
    assert [(c.name, c.interval_s) for c in found] == [("g5", 2e-6), ("g11", 2e-6)]


@pytest.mark.parametrize("name", ["Channel 1", "CH 1", "Trace 3", "Kanal 2"])
@pytest.mark.parametrize("unit", ["", " (V)"])
def test_a_name_with_a_number_is_no_key(tmp_path, name, unit):
    (channel,) = recording(tmp_path, f"Sample Interval,1e-6\n{name}{unit}\n" + rows(PULSE)).channels
    assert (channel.name, channel.interval_s) == (name, 1e-6)


VAGUE = ["Resolution,12", "Resolution,12 bit", "Clock,Internal", "Sampling,Real Time", "Rate,fast"]
EXACT = ["Sample Rate,500000", "Sample Interval,2e-06", "Sampling Frequency,500 kHz"]


@pytest.mark.parametrize("exact", EXACT)
@pytest.mark.parametrize("vague", VAGUE)
@pytest.mark.parametrize("first", [True, False])
def test_a_vague_key_says_less_than_an_exact_one(tmp_path, vague, exact, first):
    head = "\n".join([vague, exact] if first else [exact, vague])
    (channel, _) = recording(tmp_path, f"{head}\n{NAMES}" + rows(PULSE, SECOND)).channels
    assert channel.interval_s == 2e-6


def test_bits_are_no_interval(tmp_path):
    (channel, _) = recording(tmp_path, f"Resolution,12\n{NAMES}" + rows(PULSE, SECOND)).channels
    assert channel.interval_s is None


def test_a_date_is_no_start(tmp_path):
    head = f"T0,2024-05-01 12:00\nX0,-1e-4\nSample Interval,1e-6\n{NAMES}"
    (channel, _) = recording(tmp_path, head + rows(PULSE, SECOND)).channels
    assert (channel.start_s, channel.interval_s) == (-1e-4, 1e-6)


# Values of an interval of 2 us and of a rate of 500 kHz as recorders write them.
INTERVALS = ["2uS", "2.000 µS", "2000 nS", "2us", "0.002 mS", "2e-6 s", "2 usec", "2 microseconds"]
RATES = ["500KSa/s", "500 KHz", "500KS/s", "500 kSPS", "500ksps", "500 kS/sec", "500k", "500 000 Hz",
         "0.5 MS/s", "500 kSamples/s", "5e5 samples/s", "5e5"]  # fmt: skip


@pytest.mark.parametrize(
    ("key", "value"), [*(("Time interval", v) for v in INTERVALS), *(("Sample Rate", v) for v in RATES)]
)
def test_units_of_time_as_recorders_write_them(tmp_path, key, value):
    (channel, _) = recording(tmp_path, f"{key}:,{value},{value}\n{NAMES}" + rows(PULSE, SECOND)).channels
    assert channel.interval_s == pytest.approx(2e-6, rel=1e-12)


def test_a_rate_with_thousands_apart(tmp_path):
    (channel, _) = recording(tmp_path, f"Sample Rate: 500,000\n{NAMES}" + rows(PULSE, SECOND)).channels
    assert channel.interval_s == 2e-6


def test_what_is_not_understood_is_told(tmp_path):
    (channel, _) = recording(tmp_path, f"Sample Rate,2 us/S\n{NAMES}" + rows(PULSE, SECOND)).channels
    assert channel.interval_s is None
    assert channel.notes == (
        "No time: the header's Sample Rate '2 us/S' is not understood; give --interval.",
    )


def test_values_below_headings(tmp_path):
    head = (
        "channel names:\t\nDev1_ai0\tDev1_ai1\nstart times:\n09.03.2020 12:00:00,0\t09.03.2020 12:00:00,0\n"
    )
    text = head + "dt:\n0,000002\t0,000002\ndata:\n" + rows(PULSE, SECOND, cell="\t").replace(".", ",")
    found = recording(tmp_path, text).channels
    assert [(c.name, c.interval_s, c.samples) for c in found] == [
        ("Dev1_ai0", 2e-6, 200),
        ("Dev1_ai1", 2e-6, 200),
    ]


CLOCKS = [
    lambda k: f"2024-05-01T12:00:00.{k * 2000:09d}+00:00",
    lambda k: f"2024-05-01T12:00:00.{k * 2000:09d}-0530",
    lambda k: f"12:00:00.{k * 2:06d} PM",
    lambda k: f"11:59:59.{999_900 + 2 * k:06d} AM" if k < 50 else f"12:00:00.{2 * k - 100:06d} PM",
    lambda k: f"00:{k * 2e-6:09.6f}",
    lambda k: f"12:00:00,{k * 2:06d}",
]


@pytest.mark.parametrize("clock", CLOCKS)
def test_times_of_day(tmp_path, clock):
    text = "Time;CH1 (V)\n" + rows([clock(k) for k in range(200)], PULSE, cell=";")
    (channel,) = recording(tmp_path, text).channels
    assert (channel.start_s, channel.times_s) == (0.0, None)
    assert channel.interval_s == pytest.approx(2e-6, rel=1e-9)


@settings(max_examples=50, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.floats(0.0, 1.0), st.integers(4, 12), st.sampled_from([4, 5, 6]))
def test_times_printed_with_few_digits_give_a_line(tmp_path, phase, coarse, digits):
    """Each printed time stands for several samples; the ends alone are off by up to one of them."""
    unit = 10.0**-digits
    times = unit * (5e3 + np.arange(300) / coarse + phase)
    text = "Time (s),CH1 (V)\n" + rows([f"{t:.{digits}f}" for t in times], np.resize(PULSE, 300))
    (channel,) = recording(tmp_path, text).channels
    (note,) = [n for n in channel.notes if "few digits" in n]
    error = float(note.split("good to ")[1].split(" %")[0]) / 100.0
    assert abs(channel.interval_s / (unit / coarse) - 1.0) < error
    assert channel.times_s is None


@pytest.mark.parametrize("times", [["100.00"] * 200, ["12:00:00"] * 200, ["0.01"] * 100 + ["0.02"] * 100])
def test_times_that_hardly_move_tell_no_interval(tmp_path, times):
    text = "Time (s),CH1 (V)\n" + rows(times, PULSE)
    (channel,) = recording(tmp_path, text).channels
    said = "No time: the times are printed too coarsely to tell an interval; give --interval."
    assert channel.interval_s is None and said in channel.notes
    (channel,) = recording(tmp_path, "Sample Interval,2e-06\n" + text).channels
    assert channel.interval_s == 2e-6


def test_an_unnamed_count_is_no_time(tmp_path):
    for first in (0, 1):
        counts = [str(k) for k in range(first, 200 + first)]
        (channel, _) = recording(tmp_path, ",CH1 (V),CH2 (V)\n" + rows(counts, PULSE, SECOND)).channels
        assert channel.interval_s is None


@pytest.mark.parametrize(
    ("text", "base", "factor"),
    [("KHz", "Hz", 1e3), ("kSPS", "Hz", 1e3), ("MS/sec", "Hz", 1e6), ("uS", "s", 1e-6), ("S", "s", 1.0),
     ("daN", "N", 10.0), ("KN", "N", 1e3), ("mS", "s", 1e-3)],
)  # fmt: skip
def test_units_in_another_case(text, base, factor):
    unit = unit_of(text)
    assert (unit.base, unit.factor) == (base, pytest.approx(factor, rel=1e-12))


@pytest.mark.parametrize("text", ["Kg", "KS", "K"])
def test_capitals_that_are_no_prefix(text):
    unit = unit_of(text)
    assert unit is None or unit.factor == 1.0


def test_blanks_part_thousands():
    assert quantity("500 000 Hz")[0] == 5e5
    assert quantity("12 34 Hz") is None


BARE = "X Units,us\nX Increment,{}\nY Units,mV\n"


@pytest.mark.parametrize(
    ("head", "columns"),
    [(BARE.format(1) + "CH1\n", (PULSE,)), (BARE.format(1) + "Time,CH1\n", (1e6 * TIMES, PULSE))],
)
def test_an_interval_of_two_units_is_none(tmp_path, head, columns):
    (channel,) = recording(tmp_path, head + rows(*columns)).channels
    assert channel.interval_s is None
    assert re.search("No time: .* unit of time is us; .* --interval", channel.notes[0])


@pytest.mark.parametrize(
    "head",
    [
        BARE.format("1 us") + "CH1\n",
        "X Units,us\nX Increment,1e-6\nSample Rate,1 MHz\nY Units,mV\nCH1\n",
        "Time Unit,s\nX Increment,1e-6\nY Units,mV\nCH1\n",
    ],
)
def test_an_interval_with_a_unit_or_a_rate_is_one(tmp_path, head):
    (channel,) = recording(tmp_path, head + rows(PULSE)).channels
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-9)


@pytest.mark.parametrize(("factor", "told"), [("0.001", True), ("1.0", False)])
def test_a_factor_of_the_header_is_told(tmp_path, factor, told):
    (channel,) = recording(tmp_path, f"Scale factor,{factor}\nTime (s),F (N)\n" + rows(TIMES, PULSE)).channels
    assert np.array_equal(channel.values, [float(f"{v:.7g}") for v in PULSE])
    assert any(f"factor, {factor}, counts as in the numbers" in n for n in channel.notes) == told


@pytest.mark.parametrize(
    ("key", "interval"),
    [("Abtastintervall: 1,0 µs", 1e-6), ("Sampling rate: 2,5 MHz", 4e-7), ("Sampling rate: 1,000 kHz", None)],
)
def test_a_decimal_comma_within_a_key(tmp_path, key, interval):
    (channel,) = recording(tmp_path, f"{key}\nCH1 (V)\n" + rows(PULSE)).channels
    assert channel.interval_s == (interval and pytest.approx(interval, rel=1e-9))
    assert any("is not understood; give --interval" in n for n in channel.notes) == (interval is None)


def test_the_unit_of_time_in_a_row_of_units_that_says_so(tmp_path):
    head = "Name;Time;Force\nUnit;ms;mN\nFactor;1;12.5\n;;\n"
    text = head + rows([""] * 200, 1e3 * TIMES, 1e3 * PULSE, cell=";", form="{:.9g}")
    (channel,) = recording(tmp_path, text).channels
    assert (channel.name, channel.unit) == ("Force", "N")
    assert (channel.start_s, channel.interval_s) == pytest.approx((-1e-4, 1e-6), rel=1e-6)
    assert any("factor, 12.5, counts" in n for n in channel.notes)


@pytest.mark.parametrize("tail", ["", ";", ";;;"])
def test_marks_behind_a_row_move_no_values(tmp_path, tail):
    head = f"Name;Time;Force{tail}\nUnit;ms;kN{tail}\n"
    text = head + rows([""] * 200, 1e3 * TIMES, 1e-3 * PULSE, cell=";", form="{:.9g}")
    (channel,) = recording(tmp_path, text).channels
    assert channel.unit == "N"
    assert channel.values == pytest.approx(PULSE, abs=1e-6)


@pytest.mark.parametrize("units", ["CH1:mV,CH2:A", "CH1:mV,CH2:A,,,", "CH1:mV CH2:A", "mV,A", "mV,A,,"])
def test_units_that_name_their_channels(tmp_path, units):
    head = f"Vertical Units,{units}\nSource,CH1,CH2\nSecond,Value,Value\n"
    first, second = recording(tmp_path, head + rows(TIMES, 1e3 * PULSE, SECOND)).channels
    assert (first.unit, second.unit) == ("V", "A")
    assert first.values == pytest.approx(PULSE, abs=1e-6)


def test_units_stand_above_the_columns_that_they_are_of(tmp_path):
    head = "Model,DPO2002B\nVertical Units,V,,A,\n\nTIME,CH1,CH1 Peak Detect,CH2,CH2 Peak Detect\n"
    found = recording(tmp_path, head + rows(TIMES, PULSE, PULSE, SECOND, SECOND)).channels
    assert [c.unit for c in found if "Peak" not in c.name] == ["V", "A"]


def test_a_decimal_comma_names_no_channel(tmp_path):
    head = "Horizontal Scale; 0,00001\nSecond;Volt\n"
    text = head + rows(TIMES, PULSE, cell=";", form="{:.7f}").replace(".", ",")
    assert [c.name for c in recording(tmp_path, text).channels] == ["CH1"]
