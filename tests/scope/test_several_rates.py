"""Tables of several sampling rates, whose times stand side by side before all channels."""

from itertools import zip_longest

import numpy as np
import pytest
from odd_files import PULSE, TIMES, recording

SLOW = TIMES[0] + 10e-6 * np.arange(20)
NAMES = {"slow": "Time 1 - default rate [s]", "fast": "Time 2 - fast rate [s]"}


def table(names, columns, decimal="."):
    """Text of columns of different lengths, the cells behind the end of the shorter ones empty."""
    rows = zip_longest(*([f"{v:.7f}".replace(".", decimal) for v in c] for c in columns), fillvalue="")
    return "\n".join("\t".join(row) for row in (names, *rows)) + "\n"


@pytest.mark.parametrize("order", [("slow", "fast"), ("fast", "slow")])
@pytest.mark.parametrize("decimal", [".", ","])
@pytest.mark.parametrize("lost", [0, 1])
def test_a_channel_has_the_times_of_its_own_rate(tmp_path, order, decimal, lost):
    times, values = {"slow": SLOW, "fast": TIMES}, {"slow": PULSE[::10], "fast": PULSE}
    columns = [times[k] for k in order] + [values[k][: len(values[k]) - lost] for k in ("fast", "slow")]
    names = [*(NAMES[k] for k in order), "Force [N]", "Wall [N]"]
    found = recording(tmp_path, table(names, columns, decimal)).channels
    assert [c.name for c in found] == ["Force", "Wall"]
    assert [c.interval_s for c in found] == pytest.approx([1e-6, 10e-6])
    assert [c.start_s for c in found] == pytest.approx([TIMES[0]] * 2)
    for channel, rate in zip(found, ("fast", "slow"), strict=True):
        assert np.allclose(channel.values, values[rate][: len(values[rate]) - lost], atol=1e-7)


def test_three_rates(tmp_path):
    steps = (10, 2, 1)
    names = [f"Time {k} [s]" for k in (1, 2, 3)] + ["A [N]", "B [N]", "C [N]"]
    found = recording(tmp_path, table(names, [x[::s] for x in (TIMES, PULSE) for s in steps])).channels
    assert [c.interval_s for c in found] == pytest.approx([s * 1e-6 for s in steps])


def test_a_delay_beside_the_times_stays_a_channel(tmp_path):
    names = ["Time [s]", "Delay [s]", "Force [N]"]
    found = recording(tmp_path, table(names, [TIMES, 3.0 * TIMES, PULSE])).channels
    assert [(c.name, c.interval_s) for c in found] == [
        ("Delay", pytest.approx(1e-6)),
        ("Force", pytest.approx(1e-6)),
    ]
