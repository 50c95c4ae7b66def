"""Columns of times as loggers and people label them: each channel has its own clock, in its own unit."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from odd_files import PULSE, SECOND, TIMES, recording, rows

from sonicvacuum.scope.timebase import PAIRS

SETTINGS = settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
# The times of the second channel of two.
LATER = 1e-4 + 2.0 * TIMES
FORM = "{:.7f}"


@pytest.mark.parametrize(
    "pair",
    [
        "t1 (s)|t2 (s)", "Time1 [s]|Time2 [s]", "X1 (s)|X2 (s)", "Zeit 1 [s]|Zeit 2 [s]", "t_a (s)|t_b (s)",
        "x(s)|x.1(s)", "A_X [s]|B_X [s]", "t1|t2", "X|X.1", "t|t2", "A_X|B_X", "left [s]|right [s]",
        "Time (s)|Time (s)", "CH1 time (s)|CH2 time (s)",
    ],
)  # fmt: skip
@pytest.mark.parametrize("lead", ["", "No,"])
def test_each_channel_has_the_times_before_it(tmp_path, pair, lead):
    first, second = pair.split("|")
    counts = [[str(k) for k in range(1, 201)]] if lead else []
    if lead and "s" not in pair:
        return
    text = f"{lead}{first},F1 (N),{second},F2 (N)\n" + rows(*counts, TIMES, PULSE, LATER, SECOND, form=FORM)
    one, two = recording(tmp_path, text).channels
    assert (one.name, one.start_s, one.interval_s) == ("F1", -1e-4, pytest.approx(1e-6))
    assert (two.name, two.start_s, two.interval_s) == ("F2", -1e-4, pytest.approx(2e-6))
    assert two.values == pytest.approx(SECOND, abs=1e-6)


def test_times_of_a_shorter_channel(tmp_path):
    texts = [[FORM.format(v) if k < 150 else "" for k, v in enumerate(c)] for c in (LATER, SECOND)]
    text = "t1 (ms),F1 (N),t2 (s),F2 (N)\n" + rows(1e3 * TIMES, PULSE, *texts)
    one, two = recording(tmp_path, text).channels
    assert (one.samples, one.interval_s) == (200, pytest.approx(1e-6))
    assert (two.samples, two.interval_s, two.start_s) == (150, pytest.approx(2e-6), -1e-4)


@SETTINGS
@given(st.sampled_from(["CH1|CH2|CH3", "A|B|C", "x1|x2|x3", "t1|t2|t3"]), st.integers(0, 2**32 - 1))
def test_what_does_not_rise_is_no_time(tmp_path, names, seed):
    names, columns = names.split("|"), np.random.default_rng(seed).normal(size=(3, 200))
    found = recording(tmp_path, f"Time (s),{','.join(names)}\n" + rows(TIMES, *columns, form="{:.9g}"))
    assert [c.name for c in found.channels] == names
    assert [c.interval_s for c in found.channels] == [pytest.approx(1e-6, rel=1e-6)] * 3


LABELS = [
    ("micros", 1e-6), ("Time (micros)", 1e-6), ("Time (millis)", 1e-3), ("Zeit (Mikrosekunden)", 1e-6),
    ("Time (mus)", 1e-6), ("Time (\\mus)", 1e-6), ("Time ($\\mu$s)", 1e-6), ("Time (u s)", 1e-6),
    ("Time (us.)", 1e-6), ("Time (Sec.)", 1.0), ("Time (10^-6 s)", 1e-6), ("Time (E-6 s)", 1e-6),
    ("Time (1e-6 s)", 1e-6), ("Time us", 1e-6), ("Time: us", 1e-6), ("Time - us", 1e-6), ("Time|us", 1e-6),
    ("Time {us}", 1e-6), ("Time.us", 1e-6), ("t1 us", 1e-6), ("Time (us rel)", 1e-6), ("Time (æs)", 1e-6),
    ("Time (ms since trigger)", 1e-3), ("Время (мк\u0441)", 1e-6), ("時間 (ミリ秒)", 1e-3),
    ("Time (秒)", 1.0),
]  # fmt: skip
# What says of what kind or whose the times are, not in which unit.
REMARKS = ["left side of it", "relative", "CH1", "A", "Run 2", "local", "since trigger", "rel.", "1"]


@pytest.mark.parametrize(("label", "factor"), LABELS)
def test_units_of_time_behind_any_mark(tmp_path, label, factor):
    (channel,) = recording(tmp_path, f"{label},CH1 (V)\n" + rows(TIMES / factor, PULSE)).channels
    assert (channel.start_s, channel.interval_s) == (pytest.approx(-1e-4), pytest.approx(1e-6, rel=1e-6))
    assert channel.notes == ()


@pytest.mark.parametrize("form", ["Time - {}", "Time: {}", "Time ({})", "{} time", "X [{}]"])
@pytest.mark.parametrize("name", ["Force", "Wall_1", "near", "Plot 0"])
def test_times_named_by_their_channel(tmp_path, form, name):
    text = f"{form.format(name)},Amplitude - {name}\n" + rows(TIMES, PULSE)
    (channel,) = recording(tmp_path, text).channels
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-6)
    assert channel.notes[0] == "The unit of time is not given; s assumed."


@pytest.mark.parametrize("label", ["CH1: mV", "CH1 - mV", "CH1|mV", "CH1 {mV}", "CH1 mV"])
def test_units_of_channels_behind_any_mark(tmp_path, label):
    (channel,) = recording(tmp_path, f"Time (s),{label}\n" + rows(TIMES, 1e3 * PULSE)).channels
    assert (channel.name, channel.unit) == ("CH1", "V")
    assert channel.values == pytest.approx(PULSE, abs=1e-6)


@pytest.mark.parametrize(
    "label", ["Channel A", "Gauge N", "CH1 min", "Side - A", "Front amp", "CH1.s", "CH1 s"]
)
def test_names_that_end_like_a_unit(tmp_path, label):
    (channel,) = recording(tmp_path, f"Time (s),{label}\n" + rows(TIMES, PULSE)).channels
    assert (channel.name, channel.unit) == (label, "")


UNKNOWN = [
    ("Time (?s)", "?s"), ("Time (MS)", "MS"), ("Time (h)", "h"), ("Time (jiffies)", "jiffies"),
    ("Time: xs", "xs"), ("Time (ms or so)", "ms or so"), ("t1 [ticks]", "ticks"), ("Time {xs}", "xs"),
    ("Time (2 xs)", "2 xs"),
]  # fmt: skip


@pytest.mark.parametrize(("label", "unit"), UNKNOWN)
def test_a_unit_of_time_that_is_not_known_is_no_second(tmp_path, label, unit):
    text = f"{label},CH1 (V)\n" + rows(3.0 * TIMES, PULSE)
    (channel,) = recording(tmp_path, text).channels
    said = f"No time: the unit of time, {unit!r}, is not known; give --interval."
    assert (channel.interval_s, channel.notes) == (None, (said,))
    (channel,) = recording(tmp_path, "Sample Interval,3e-06\n" + text.replace("(MS)", "(xs)")).channels
    assert channel.interval_s == pytest.approx(3e-6)


@pytest.mark.parametrize("count", ["samples", "ticks", "pts", "Points", "n"])
def test_counts_are_no_times(tmp_path, count):
    text = f"Time ({count}),CH1 (V)\n" + rows(np.arange(200) - 100.0, PULSE)
    (channel,) = recording(tmp_path, text).channels
    assert channel.interval_s is None and "give --interval" in channel.notes[0]
    (channel,) = recording(tmp_path, "Sample Rate,500 kHz\n" + text).channels
    assert channel.interval_s == 2e-6


@pytest.mark.parametrize("remark", REMARKS)
def test_a_remark_is_no_unit_of_time(tmp_path, remark):
    (channel,) = recording(tmp_path, f"Time ({remark}),CH1 (V)\n" + rows(TIMES, PULSE)).channels
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-6)
    assert channel.notes == ("The unit of time is not given; s assumed.",)


@pytest.mark.parametrize(
    "label", ["Time (UTC+1)", "Time (HH:MM:SS)", "Time (ms)", "Time (CET)", "Time (Berlin)"]
)
def test_times_of_day_are_seconds_whatever_is_beside(tmp_path, label):
    clock = [f"12:00:00.{k * 2:06d}" for k in range(200)]
    (channel,) = recording(tmp_path, f"{label},CH1 (V)\n" + rows(clock, PULSE)).channels
    assert (channel.interval_s, channel.notes) == (pytest.approx(2e-6), ())


def test_times_that_run_backwards_are_none(tmp_path):
    order = np.arange(200)
    order[60:64] = order[60:64][::-1]
    for head in ("", "Sample Interval,1e-06\n"):
        text = f"{head}Time (s),CH1 (V)\n" + rows(TIMES[order], PULSE, form="{:.7f}")
        (channel,) = recording(tmp_path, text).channels
        said = "No time: the times run backwards behind sample 61, from -3.7e-05 to -3.8e-05; put the rows"
        assert channel.interval_s is None and channel.notes[0].startswith(said)
    (channel,) = recording(tmp_path, "Time (s),CH1 (V)\n" + rows(TIMES[::-1], PULSE, form="{:.7f}")).channels
    assert channel.interval_s is None


@pytest.mark.parametrize("head", ["", "Sampling interval,1ms\n"])
def test_fractions_that_start_again_each_second_are_no_times(tmp_path, head):
    lines = "".join(f"{k + 1},2016/10/05 13:31:4{k // 80},{k % 80},{v:.4f}\n" for k, v in enumerate(PULSE))
    text = f"{head}Number,Date&Time,ms,CH1\nNO.,Time,ms,V\n" + lines
    (channel,) = recording(tmp_path, text).channels
    assert channel.interval_s == (1e-3 if head else None)
    assert any("he times run backwards behind sample 80, from 79 to 0" in n for n in channel.notes)
    assert any("start and interval are the header's" in n for n in channel.notes) == bool(head)


@SETTINGS
@given(st.integers(0, 2**32 - 1), st.integers(1, 8))
def test_rows_in_any_wrong_order_tell_no_time(tmp_path, seed, swaps):
    random, order = np.random.default_rng(seed), np.arange(200)
    for k in random.integers(0, 190, swaps):
        order[[k, k + 7]] = order[[k + 7, k]]
    if (np.diff(order) > 0).all():
        return
    text = "Time (s),CH1 (V)\n" + rows(TIMES[order], PULSE, form="{:.7f}")
    assert all(c.interval_s is None for c in recording(tmp_path, text).channels)


def test_an_envelope_in_rows_of_equal_times_is_told(tmp_path):
    both = np.ravel(np.column_stack([PULSE - 0.1, PULSE + 0.1]))
    text = "in s,C1 in V\n" + rows(np.repeat(TIMES, 2), both)
    (channel,) = recording(tmp_path, text).channels
    assert PAIRS in channel.notes
    assert channel.samples == 400
