"""Cells that are odd: lost samples, marks of thousands, a file cut off, footers and leaps of time.

What cannot be read without a guess is refused, and what was left out is said.
"""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from odd_files import PULSE, SECOND, TIMES, recording, rows, seen

from sonicvacuum.files import InputError
from sonicvacuum.scope.keys import Keys
from sonicvacuum.scope.runs import Shot, common_grid
from sonicvacuum.scope.timebase import from_column
from sonicvacuum.scope.units import unit_of

SETTINGS = settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


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
