"""Tables that follow each other in one file: parts of one shot, or shots."""

import numpy as np
import pytest
from odd_files import PULSE, TIMES, recording, rows

from sonicvacuum.scope.shots import ON

HEAD = "Time (s),CH1 (V)\n"


@pytest.mark.parametrize("between", [HEAD, "# event\n", "Page 2\n\n" + HEAD])
def test_a_shot_goes_on_behind_other_lines(tmp_path, between):
    text = HEAD + rows(TIMES[:90], PULSE[:90]) + between + rows(TIMES[90:], PULSE[90:])
    found = recording(tmp_path, text)
    (channel,) = found.channels
    assert (channel.samples, channel.segment, channel.times_s) == (200, 1, None)
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-6)
    assert np.array_equal(channel.values, [float(f"{v:.7g}") for v in PULSE])
    assert ON in found.notes


@pytest.mark.parametrize("late", [0.0, 5e-6, 0.1])
def test_times_that_do_not_go_on_at_once_are_those_of_another_shot(tmp_path, late):
    text = HEAD + rows(TIMES[:90], PULSE[:90]) + "# event\n" + rows(TIMES[90:] + late, PULSE[90:])
    found = recording(tmp_path, text)
    assert [c.segment for c in found.channels] == ([1, 2] if late else [1])


def test_a_part_in_another_unit_is_none_of_the_shot(tmp_path):
    text = HEAD + rows(TIMES[:90], PULSE[:90]) + "Time (s),CH1 (mV)\n" + rows(TIMES[90:], 1e3 * PULSE[90:])
    assert [c.segment for c in recording(tmp_path, text).channels] == [1, 2]
