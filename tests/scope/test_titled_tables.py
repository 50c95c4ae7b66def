"""Tables of single channels one below the other, each under a line that names its channel."""

import numpy as np
import pytest
from odd_files import PULSE, SECOND, TIMES, recording, rows, seen

HEAD = "Time (s),Voltage (V)\n"


@pytest.mark.parametrize(
    ("titles", "names"),
    [
        (("CH1", "CH2"), ("CH1", "CH2")),
        (("[Channel A]", "[Channel B]"), ("Channel A", "Channel B")),
        (("# Kanal 3:", "# Kanal 4:"), ("Kanal 3", "Kanal 4")),
    ],
)
@pytest.mark.parametrize("head", [HEAD, "", "Time (s),Force (N)\n"])
def test_titled_tables_are_channels_of_one_shot(tmp_path, titles, names, head):
    blocks = [f"{t}\n{head}{rows(TIMES, v)}" for t, v in zip(titles, (PULSE, SECOND), strict=True)]
    found = recording(tmp_path, "\n".join(blocks)).channels
    assert [(c.name, c.segment) for c in found] == [(name, 1) for name in names]
    for channel, volts in zip(found, (PULSE, SECOND), strict=True):
        assert np.allclose(channel.values, volts, rtol=1e-6)


def test_channels_that_come_again_are_those_of_the_next_shot(tmp_path):
    once = f"CH1\n{HEAD}{rows(TIMES, PULSE)}\nCH2\n{HEAD}{rows(TIMES, SECOND)}\n"
    found = recording(tmp_path, once + once)
    assert seen(found) == [(name, shot, "V", 200) for shot in (1, 2) for name in ("CH1", "CH2")]


@pytest.mark.parametrize("titles", [("CH1", "CH1"), ("Shot 1", "Shot 2"), ("CH1", "")])
def test_tables_under_other_lines_are_shots(tmp_path, titles):
    text = "\n".join(f"{t}\n{HEAD}{rows(TIMES, PULSE)}" for t in titles)
    assert [c.segment for c in recording(tmp_path, text).channels] == [1, 2]
