"""Lines of words above a table that speak of its times, whose label has no unit."""

import pytest
from odd_files import PULSE, TIMES, recording, rows

from sonicvacuum.scope.timebase import SECONDS


@pytest.mark.parametrize(
    ("remark", "factor"),
    [
        ("# time in ms, force in N", 1e3),
        ("# Force in N over time in us", 1e6),
        ("# times in milliseconds", 1e3),
        ("Zeit in ms; Kraft in N", 1e3),
        ("# Time axis in us.", 1e6),
        ("# t in s", 1.0),
    ],
)
@pytest.mark.parametrize("label", ["t", "Time"])
def test_the_unit_of_a_remark_counts(tmp_path, remark, factor, label):
    text = f"{remark}\n{label},F\n" + rows(factor * TIMES, PULSE)
    (channel,) = recording(tmp_path, text).channels
    assert (channel.start_s, channel.interval_s) == pytest.approx((-1e-4, 1e-6), rel=1e-9)
    assert SECONDS not in channel.notes


@pytest.mark.parametrize("remark", ["# arrived in time in Rome", "# time in ms, later time in us"])
def test_remarks_that_tell_no_unit(tmp_path, remark):
    (channel,) = recording(tmp_path, f"{remark}\nTime,F\n" + rows(TIMES, PULSE)).channels
    assert SECONDS in channel.notes


def test_a_label_with_a_unit_counts_before_a_remark(tmp_path):
    (channel,) = recording(tmp_path, "# time in ms\nTime (us),F\n" + rows(1e6 * TIMES, PULSE)).channels
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-9)
