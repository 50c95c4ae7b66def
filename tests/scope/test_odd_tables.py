"""Tables as loggers and people leave them: odd cells, further headers, rows of units where they may stand.

What cannot be read without a guess is refused, and what was left out is said.
"""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from odd_files import PULSE, SECOND, TIMES, recording, rows

from sonicvacuum.files import InputError
from sonicvacuum.scope.keys import Keys
from sonicvacuum.scope.runs import Shot, common_grid
from sonicvacuum.scope.timebase import from_column
from sonicvacuum.scope.units import unit_of

SETTINGS = settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def seen(found):
    return [(c.name, c.segment, c.unit, c.samples) for c in found.channels]


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


@pytest.mark.parametrize(
    ("kept", "said"),
    [
        (
            np.delete(np.arange(200), np.arange(50, 70)),
            "Samples missing, left out: 20, the first behind -5.1e",
        ),
        (
            np.delete(np.arange(200), 120),
            "Samples missing, left out: 1, the first behind 1.9e-05 s, sample 120.",
        ),
        (
            np.sort([*range(200), 120]),
            "Times that stand twice: 1, the first 2e-05 s; one sample of each counts.",
        ),
    ],
)
def test_rows_that_are_lost_or_stand_twice_leave_the_clock_as_it_is(tmp_path, kept, said):
    """One row of 2,000 moved all others by up to half an interval, and a straight line stood for fifty."""
    found = recording(tmp_path, "Time (s),CH1 (V)\n" + rows(TIMES[kept], PULSE[kept]))
    (channel,) = found.channels
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-9)  # as printed
    assert [note for note in channel.notes if note.startswith(said)]
    begin, step, samples, _ = common_grid(Shot("a", {"g": channel}, (), {"g": tmp_path}))
    lost = np.isin(np.arange(200), kept, invert=True)
    assert (begin, step) == pytest.approx((TIMES[0], 1e-6))
    assert np.array_equal(np.isnan(samples["g"]), lost)
    np.testing.assert_allclose(samples["g"][~lost], PULSE[~lost], atol=1e-9)  # times have rounding errors


def test_the_time_between_two_records_is_not_filled():
    """Of two records an hour apart, in one column, even times would be some billions."""
    times = np.concatenate([TIMES[:100], TIMES[100:] + 3600.0])
    base = from_column(times, unit_of("s"), Keys("."))
    assert base.interval_s == pytest.approx(3600.0 / 199, rel=1e-3)  # the mean, as of uneven times
    assert [note for note in base.notes if "samples are missing" in note]


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


LOST = [
    "****",
    "*",
    "n.a.",
    "#DIV/0!",
    ">>>",
    "--.--",
    "-1.#IND00",
    "1.#QNAN",
    "NaN",
    "?",
    "0.39 <-- trigger",
    "xyz",
]
OVER = {
    "OFL": np.inf,
    "Sat": np.inf,
    "ovr": np.inf,
    "Out of range": np.inf,
    "1.#INF00": np.inf,
    "-1.#INF": -np.inf,
}


@SETTINGS
@given(st.sampled_from([*LOST, *OVER]), st.integers(1, 198), st.sampled_from([";", ",", "\t"]))
def test_an_odd_cell_is_one_lost_sample(tmp_path, word, row, cell):
    column = [word if k == row else f"{v:.4f}" for k, v in enumerate(PULSE)]
    text = cell.join(["Time (s)", "CH1 (V)", "CH2 (V)"]) + "\n" + rows(TIMES, column, SECOND, cell=cell)
    found = recording(tmp_path, text)
    assert seen(found) == [("CH1", 1, "V", 200), ("CH2", 1, "V", 200)]
    expected = PULSE.copy()
    expected[row] = OVER.get(word, np.nan)
    assert np.array_equal(found.channels[0].values, expected, equal_nan=True)
    assert np.array_equal(found.channels[1].values, SECOND)
    told = any(f"line {row + 2}, column 2: {word!r}" in n for n in found.notes)
    assert told == (word in ("0.39 <-- trigger", "xyz"))


def test_a_lost_time_lies_between_its_neighbours(tmp_path):
    times = [f"{t:.7g}" for t in TIMES]
    times[30] = "***"
    (channel,) = recording(tmp_path, "Time (s),CH1 (V)\n" + rows(times, PULSE)).channels
    assert (channel.samples, channel.times_s) == (200, None)
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-6)
    assert "1 times are lost: taken between their neighbours." in channel.notes


def test_a_column_of_words_is_refused_with_the_first(tmp_path):
    words = ["on" if k % 2 else f"{v:.4f}" for k, v in enumerate(PULSE)]
    words[-20:] = ["0.0100"] * 20
    with pytest.raises(InputError, match=r"line 3 \('-9.9e-05,on'\) is no row of numbers.*export"):
        recording(tmp_path, "Time (s),CH1 (V)\n" + rows(TIMES, words))


GROUPS = [
    (",", ".", "\t"),
    (",", ".", ";"),
    (".", ",", ";"),
    (" ", ",", ";"),
    ("'", ".", ";"),
    (",", ".", "|"),
]


@SETTINGS
@given(st.sampled_from(GROUPS), st.lists(st.integers(-9_999_999, 9_999_999), min_size=30, max_size=60))
def test_thousands_apart_read_back(tmp_path, marks, tenths):
    """Numbers with one decimal and thousands apart, as spreadsheets write them."""
    group, decimal, cell = marks
    texts = [f"{v / 10:,.1f}".translate(str.maketrans(",.", group + decimal)) for v in tenths]
    times = [f"{k}{decimal}5" for k in range(len(texts) % 900)]
    found = recording(tmp_path, f"Time [us]{cell}F [N]\n" + rows(times, texts, cell=cell))
    assert np.array_equal(found.channels[0].values, np.array(tenths) / 10)


def test_whole_thousands_beside_small_numbers(tmp_path):
    counts = [f"{v * 1e4:,.0f}" for v in PULSE]
    found = recording(
        tmp_path, "Time [us]\tF [mN]\n" + rows([f"{t * 1e6:.0f}" for t in TIMES], counts, cell="\t")
    )
    assert seen(found) == [("F", 1, "N", 200)]
    assert found.channels[0].values == pytest.approx(PULSE * 10, abs=1e-9)


@pytest.mark.parametrize(
    ("cell", "bad"),
    [(";", "8.012"), ("\t", "80,12")],
    ids=["thousands or decimals", "decimals of another mark"],
)
def test_marks_that_may_mean_two_things_are_refused(tmp_path, cell, bad):
    counts = [f"{v * 100:.0f}" for v in PULSE]
    counts[100:140] = [bad] * 40
    with pytest.raises(InputError, match=rf"t.csv: line 102, column 2: '{bad}' may be .* export without"):
        recording(
            tmp_path, f"Time [us]{cell}F [mN]\n" + rows([f"{k}" for k in range(200)], counts, cell=cell)
        )


@SETTINGS
@given(
    st.sampled_from(["{:.3f}", "{:.2f}", "{:.6e}", "{:.0f}", "{:+.3f}"]),
    st.sampled_from([(",", "."), (";", "."), (";", ","), ("\t", ","), ("\t", "."), (" ", ".")]),
    st.floats(-900.0, 900.0),
    st.lists(st.floats(-2.0, 2.0), min_size=30, max_size=60),
)
def test_plain_numbers_are_never_taken_for_thousands(tmp_path, form, marks, level, values):
    cell, decimal = marks
    texts = [form.format(level + v).replace(".", decimal) for v in values]
    times = [f"{k}{decimal}5" for k in range(len(texts))]
    found = recording(tmp_path, f"Time(us){cell}F(N)\n" + rows(times, texts, cell=cell))
    assert np.array_equal(found.channels[0].values, [float(t.replace(",", ".")) for t in texts])


def test_a_line_of_dashes_below_the_names_names_nothing(tmp_path):
    found = recording(tmp_path, "Time (s),CH1 (V)\n--------,-------\n" + rows(TIMES, PULSE))
    assert seen(found) == [("CH1", 1, "V", 200)]


def test_a_typographic_minus_is_a_minus(tmp_path):
    text = "Time (s),CH1 (V)\n" + rows(TIMES, SECOND, form="{:.7f}").replace("-", "\N{MINUS SIGN}")
    (channel,) = recording(tmp_path, text).channels
    assert np.array_equal(channel.values, SECOND) and channel.start_s == -1e-4


def test_commas_for_both_are_refused(tmp_path):
    text = "Zeit (s),CH1 (V),CH2 (V)\n" + rows(TIMES, PULSE, SECOND, cell=";", form="{:.6E}")
    exponents = text.replace(".", ",").replace(";", ",")
    mixed = "t,CH1\n" + "".join(f"{k},{k % 7 + 1},{9 - k % 9}\n" for k in range(60))
    for content in (exponents, mixed):
        with pytest.raises(InputError, match=r"commas serve both .* export with semicolons"):
            recording(tmp_path, content)


@SETTINGS
@given(st.integers(1, 12))
def test_a_file_cut_off_within_its_last_number(tmp_path, cut):
    text = "Time (s),CH1 (V),CH2 (V)\n" + rows(TIMES, PULSE, SECOND, form="{:.6e}")
    found = recording(tmp_path, text.rstrip("\n")[:-cut])
    for channel, values in zip(found.channels, (PULSE, SECOND), strict=True):
        # Digits lost before the exponent leave a number of the same size, the exponent does not.
        assert np.array_equal(channel.values, values[: channel.samples])
        assert channel.samples == 199
    assert any("The last line ends in the middle" in n for n in found.notes)


def test_a_whole_last_line_without_a_line_end_stays(tmp_path):
    text = "Time (s),CH1 (V)\n" + rows(TIMES, PULSE)
    assert recording(tmp_path, text.rstrip("\n")).channels[0].samples == 200


def test_a_long_footer_is_left_out_and_said(tmp_path):
    foot = "".join(f"Meta key {k}: some text, value {k}\n" for k in range(50))
    found = recording(tmp_path, "Time (s),CH1 (V)\n" + rows(TIMES, PULSE) + foot)
    assert found.channels[0].samples == 200
    assert any(
        "Line 202 (Meta key 0: some text, value 0)" in n and "50 lines left out" in n for n in found.notes
    )


def test_leaps_of_time_part_shots(tmp_path):
    times = np.concatenate([TIMES, TIMES + 1.5])
    found = recording(tmp_path, "Time (s),CH1 (V)\n" + rows(times, np.tile(PULSE, 2), form="{:.10g}"))
    assert seen(found) == [("CH1", 1, "V", 200), ("CH1", 2, "V", 200)]
    assert [c.interval_s for c in found.channels] == pytest.approx([1e-6, 1e-6], rel=1e-6)
    assert any("Time leaps by 1.5" in n for n in found.notes)


def test_blocks_of_the_announced_size_are_shots(tmp_path):
    head = '"Header Size",16\n"BlockNumber",2\n"TraceName","CH1"\n"BlockSize",200\n"VUnit","V"\n'
    head += '"HResolution",1E-6\n"HOffset",-1E-4\n\n'
    lines = "\n".join(f",{v:.4f}" for v in PULSE)
    found = recording(tmp_path, head + lines + "\n\n" + lines + "\n")
    assert seen(found) == [("CH1", 1, "V", 200), ("CH1", 2, "V", 200)]
