"""Whole numbers with commas between them are columns, decimals with commas one number; or it is refused."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from odd_files import recording

from sonicvacuum.files import InputError

SETTINGS = settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
FORCE = np.round(1000.0 + 900.0 * np.exp(-(((np.arange(200) - 90.0) / 8.0) ** 2)) + np.arange(200) % 7 - 3.0)
WALL = np.round(1000.0 - 0.6 * (FORCE - 1000.0))
whole = st.lists(st.integers(-4095, 4095), min_size=20, max_size=60)


def pairs(first, second):
    return "".join(f"{a:.0f},{b:.0f}\n" for a, b in zip(first, second, strict=True))


@pytest.mark.parametrize(
    ("head", "names", "interval"),
    [
        ("Time (us),CH1 (mV)\n", ["CH1"], 1e-6),
        ("time_us,adc\n", ["adc"], 1e-6),
        ("Time interval:,1.00uS\n\nindex,CH1_Voltage(mV)\n", ["CH1_Voltage"], 1e-6),
    ],
)
@pytest.mark.parametrize("begin", [-100, 0])
def test_whole_times_and_readings_are_two_columns(tmp_path, head, names, interval, begin):
    begin = 0 if "index" in head else begin
    found = recording(tmp_path, head + pairs(begin + np.arange(200), FORCE)).channels
    assert [(c.name, c.interval_s) for c in found] == [(names[0], interval)]
    assert np.ptp(found[0].values) == pytest.approx(np.ptp(FORCE) * (1.0 if "adc" in head else 1e-3))


@pytest.mark.parametrize(
    "head",
    [
        "Sample Interval,1e-06\nCH1,CH2\n",
        "Sample Rate: 1 MHz\nCH1 (mV),CH2 (mV)\n",
        "Sample Interval,0.000001\nSource,CH1,CH2\nValue,Value\n",
        "Sample Interval,0.000001\nSource,CH1,CH2\n",
        "Model,X\nSample Rate,1000000\nCH1,CH2\n",
        "",
    ],
)
def test_whole_readings_are_two_columns(tmp_path, head):
    found = recording(tmp_path, head + pairs(FORCE, WALL)).channels
    assert [c.name for c in found] == ["CH1", "CH2"]
    factor = 1e-3 if "mV" in head else 1.0
    assert found[0].values == pytest.approx(factor * FORCE)
    assert found[1].values == pytest.approx(factor * WALL)


@SETTINGS
@given(st.data())
def test_named_whole_readings_are_two_columns(tmp_path, data):
    first = data.draw(whole)
    second = data.draw(st.lists(st.integers(0, 4095), min_size=len(first), max_size=len(first)))
    found = recording(tmp_path, "CH1 (mV),CH2 (mV)\n" + pairs(first, second)).channels
    assert [c.name for c in found] == ["CH1", "CH2"]
    assert found[0].values == pytest.approx(1e-3 * np.array(first))
    assert found[1].values == pytest.approx(1e-3 * np.array(second))


@SETTINGS
@given(
    st.lists(st.floats(-9.0, 9.0), min_size=20, max_size=60),
    st.integers(1, 6),
    st.sampled_from(["F (N)\n", "F, N\n", "Kraft\n", "Messung;3\n\n\nF (N)\n"]),
    st.booleans(),
)
def test_decimals_below_one_name_are_one_column(tmp_path, values, digits, head, trimmed):
    values = [0.05, 0.25, *values]  # a zero behind a comma gives decimals away where the name does not
    texts = [f"{v:.{max(2, digits) if 'F, N' in head else digits}f}" for v in values]
    texts = [repr(float(t)) for t in texts] if trimmed else texts
    (channel,) = recording(tmp_path, head + "\n".join(texts).replace(".", ",") + "\n").channels
    assert list(channel.values) == [float(t) for t in texts]


@pytest.mark.parametrize(
    "head", ["", "F, N\n", "Kraft, N\n", "Data:\n", "Waveform Data\n", "Sample Interval,1e-06\n"]
)
def test_what_may_be_one_column_or_two_is_refused(tmp_path, head):
    lines = pairs(500 + np.arange(60) % 7, 500 + np.arange(60) % 5)
    with pytest.raises(InputError, match=r"'503,504' and the other lines .* a line that names each column"):
        recording(tmp_path, head + lines)
    head = "" if "N" in head else head
    assert len(recording(tmp_path, head + "CH1,CH2\n" + lines).channels) == 2
    for name in ("Kraft (N)", "Kraft (N);"):
        (channel,) = recording(tmp_path, head + name + "\n" + lines).channels
        assert (channel.unit, channel.values[0]) == ("N", 500.5)
    assert len(recording(tmp_path, head + "mV,V\n" + lines).channels) == 2


def test_whole_numbers_of_three_digits_are_columns(tmp_path):
    columns = [500 + np.arange(60) % m for m in (7, 5, 3)]
    lines = "".join(",".join(map(str, row)) + "\n" for row in zip(*columns, strict=True))
    found = recording(tmp_path, "CH1,CH2,CH3\n" + lines).channels
    assert [list(c.values) for c in found] == [list(c) for c in columns]
    assert len(recording(tmp_path, "97,100,1002\n" + lines).channels) == 3
    with pytest.raises(InputError, match="one number with thousands apart or several whole numbers"):
        recording(tmp_path, lines)


@pytest.mark.parametrize(("cell", "mark"), [(";", ","), ("\t", ","), (";", "."), ("\t", ".")])
def test_marks_of_thousands_in_whole_numbers_are_refused(tmp_path, cell, mark):
    """Whichever the mark is: it reads as one of decimals as well, and divides by a thousand what is large."""
    times = [f"{k - 300:,}".replace(",", mark) for k in range(1500)]
    text = f"Time [us]{cell}F [mN]\n" + "".join(f"{t}{cell}{k % 7}\n" for k, t in enumerate(times))
    with pytest.raises(
        InputError, match=rf"line 1303, column 1: '1{mark}001' may be .*; export without marks"
    ):
        recording(tmp_path, text)


@pytest.mark.parametrize("peak", [1, 40])
def test_a_few_points_in_whole_numbers_are_refused(tmp_path, peak):
    counts = [str(k % 7) for k in range(200)]
    counts[100 : 100 + peak] = [f"1.{234 + k}" for k in range(peak)]
    text = "Time [us];F [mN]\n" + "".join(f"{k};{c}\n" for k, c in enumerate(counts))
    with pytest.raises(InputError, match=r"line 102, column 2: '1\.234' may be .*; export without marks"):
        recording(tmp_path, text)


@SETTINGS
@given(st.lists(st.integers(-9_999, 9_999), min_size=20, max_size=60), st.sampled_from(";\t"))
def test_points_beside_decimal_commas_are_marks_of_thousands(tmp_path, counts, cell):
    counts = [*counts, *range(20)]
    times = [f"{k / 1000:.4f}".replace(".", ",") for k in range(len(counts))]
    lines = [
        f"{t}{cell}{v:,}".replace(",", ".").replace(".", ",", 1) for t, v in zip(times, counts, strict=True)
    ]
    (channel,) = recording(tmp_path, f"Zeit [ms]{cell}Kraft [N]\n" + "\n".join(lines) + "\n").channels
    assert (list(channel.values), channel.interval_s) == (counts, 1e-6)


def test_points_of_decimals_beside_decimal_commas_are_refused(tmp_path):
    cells = [f"{k / 1e4:.4f}".replace(".", ",") + (";0.512" if 80 < k < 90 else ";0") for k in range(200)]
    with pytest.raises(InputError, match=r"line 83, column 2: '0\.512' may be"):
        recording(tmp_path, "Zeit [ms];Kraft [N]\n" + "\n".join(cells) + "\n")
