"""What one label says: name and unit of a column, wherever the unit stands in it."""

import numpy as np
import pytest
from odd_files import PULSE, TIMES, recording, rows

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
