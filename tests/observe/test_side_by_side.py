"""Pulses found side by side are those found one by one, to the bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sonicvacuum.forward.together import runs_of
from sonicvacuum.gauges import Gauge
from sonicvacuum.observe.quantities import measure_run
from sonicvacuum.observe.run import Geometry, Run

TIME = np.arange(400) * 1e-6
GAUGES = (Gauge("g", "embedded", 8), Gauge("h", "embedded", 15), Gauge("wall", "wall", None))
GEOMETRY = Geometry(20, 5e-3, GAUGES)
ASKED = [
    *(("amplitude", {"sensor": s}) for s in ("g", "h", "wall")),
    *(("duration", {"sensor": s, "level": level}) for s in ("g", "wall") for level in (0.01, 0.5, 1.5)),
    ("speed", {"from": "g", "to": "h"}),
    ("decay", {"from": "g", "to": "wall"}),
    ("onset", {"sensor": "h", "level": 0.1}),
    ("width_half", {"from": "g", "to": "h", "sensor": "g"}),
    ("pulse_count", {"sensor": "g"}),
    ("arrival", {"sensor": "nowhere"}),
]


def told(quantity, run, options):
    """Value and reason, or the error."""
    try:
        found = measure_run(quantity, run, **options)
    except ValueError as error:
        return str(error)
    return found.value, found.reason


def compare(signals):
    runs = runs_of(signals, TIME, GEOMETRY)
    for run in runs:
        alone = Run(run.readings, TIME, GEOMETRY)
        for quantity, options in ASKED:
            # As text, so that NaN equals NaN.
            assert repr(told(quantity, run, options)) == repr(told(quantity, alone, options))
    return runs[0].together


def pulse(middle, width, height):
    return height / np.cosh(np.clip((TIME - middle) / width, -50.0, 50.0)) ** 4


def test_what_is_usual_is_found_side_by_side():
    rows = [
        [pulse(1e-4 + k * 1e-6, 2e-5, 1.0 + k), pulse(1.6e-4, 2e-5, 2.0), pulse(2.2e-4, 1.5e-5, 3.0)]
        for k in range(9)
    ]
    together = compare(np.array(rows))
    for sensor in ("g", "h", "wall"):
        assert None not in together.pulses(sensor)
        for rising in (True, False):
            assert None not in together.edges(sensor, 0.5, rising)


@settings(max_examples=40, deadline=None)
@given(
    places=st.lists(st.integers(0, 399), min_size=3, max_size=3),
    heights=st.lists(st.floats(-1.0, 5.0), min_size=3, max_size=3),
    width=st.integers(1, 120),
    seed=st.integers(0, 2**32 - 1),
    ripple=st.sampled_from([0.0, 0.0, 1e-12, 0.02, 0.5]),
)
def test_signals_of_any_kind_are_measured_alike(places, heights, width, seed, ripple):
    """Cut off at either end, empty, upside down, with echoes and ripples that break rise and fall."""
    generator = np.random.default_rng(seed)
    rows = [
        [pulse(TIME[p] + lane * 3e-6, width * 1e-6, h) for p, h in zip(places, heights, strict=True)]
        for lane in range(3)
    ]
    echo = pulse(TIME[places[0]] + 1.2e-4, width * 1e-6, 0.7 * abs(heights[1]))
    compare(
        np.array(rows) + np.array([echo, 0 * echo, -echo]) + ripple * generator.standard_normal((3, 3, 400))
    )


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_what_is_not_finite_is_said_as_ever(value):
    signals = np.array([[pulse(1e-4, 2e-5, 1.0)] * 3] * 2)
    signals[1, 0, 7] = value
    compare(signals)
