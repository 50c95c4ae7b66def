"""Columns of times as loggers and people label them: each channel has its own clock, in its own unit."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from odd_files import PULSE, SECOND, TIMES, recording, rows

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
