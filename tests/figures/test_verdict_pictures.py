"""The pictures of a verdict: names that tell quantities apart, no certainty, no line where nothing counts."""

import numpy as np
import pytest

from sonicvacuum.figures import disagreement, discovery, posterior
from sonicvacuum.figures.drawing import Text


def said(drawing):
    return [mark.words for mark in drawing.marks if isinstance(mark, Text)]


def test_two_amplitudes_of_one_run_are_told_apart():
    cells = [
        {"run": "a", "sensor": "", "feature": "amplitude", "z_before": z, "z_after": "0"} for z in ("3", "-4")
    ]
    quantities = [{"run": "a", "quantity": name} for name in ("amplitude p1", "speed p1-w3")]
    words = said(disagreement.scalars(cells, quantities))
    assert {"a, amplitude p1", "a, speed p1–w3"} <= set(words)
    assert said(disagreement.scalars(cells)).count("a, amplitude") == 2  # of an older folder


def test_no_bar_says_that_something_is_certain():
    words = said(discovery.candidates({"tsuji": 0.9999, "none": 0.0001, "unknown": 0.0}))
    assert "> 0.99" in words and "1.00" not in words and "0.00" not in words


def test_a_posterior_is_called_as_on_the_page():
    row = {
        "effect": "viscous-drag", "parameter": "rate_per_s", "unit": "1/s", "value": "299", "sigma": "1.4",
        "low": "1", "high": "30000", "off": "0", "from_90": "296.7", "to_90": "301.3", "how": "gaussian",
    }  # fmt: skip
    assert "viscous-drag: rate of slowing (s⁻¹)" in said(posterior.parameters([row]))


@pytest.mark.parametrize("count", [1, 4])
def test_no_line_joins_what_left_out_samples_part(count):
    time = np.concatenate([np.arange(20.0), 100.0 + np.arange(30.0)])
    parts = discovery.neighbours(time, count)
    assert [len(part) for part in parts] == [20 - count + 1, 30 - count + 1]
    (whole,) = discovery.neighbours(np.arange(50.0), count)
    assert np.array_equal(whole, np.arange(50 - count + 1))
