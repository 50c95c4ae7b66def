"""Speed against amplitude: exact on power laws, against scipy on scattered points."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import linregress

from sonicvacuum.observe.sweep import loglog_slope, speed_at_amplitude

FORCE = np.array([0.2, 0.5, 1.1, 2.3, 4.8, 9.9])


@given(st.floats(-1.0, 1.0), st.floats(1.0, 1e3))
def test_slope_of_a_power_law_is_its_exponent(exponent, scale):
    slope = loglog_slope(FORCE, scale * FORCE**exponent)
    assert slope.value == pytest.approx(exponent, abs=1e-13)  # rounding
    assert slope.sigma < 1e-13  # rounding


def test_slope_and_its_error_are_those_of_scipy():
    speed = 150.0 * FORCE ** (1 / 6) * np.exp(0.02 * np.random.default_rng(6).standard_normal(6))
    theirs = linregress(np.log(FORCE), np.log(speed))
    ours = loglog_slope(FORCE, speed)
    assert ours.value == pytest.approx(theirs.slope, rel=1e-12)  # rounding
    assert ours.sigma == pytest.approx(theirs.stderr, rel=1e-10)  # rounding of a small scatter


def test_absent_pulses_are_left_out_of_a_slope():
    speed = 150.0 * FORCE**0.25
    speed[2] = math.nan
    assert loglog_slope(FORCE, speed).value == pytest.approx(0.25, abs=1e-13)  # rounding
    few = loglog_slope(FORCE[:3], speed[:3])
    assert math.isnan(few.value) and few.reason.startswith("too few")
    assert loglog_slope(np.ones(4), np.arange(1.0, 5.0)).reason.startswith("too few")


@given(st.floats(0.2, 9.9))
def test_speed_between_runs_of_a_power_law_is_exact(amplitude):
    # A power law is a straight line on logarithms, which PCHIP keeps.
    speeds = 150.0 * FORCE ** (1 / 6)
    shuffled = np.random.default_rng(7).permutation(6)
    found = speed_at_amplitude(amplitude, FORCE[shuffled], speeds[shuffled])
    assert found.value == pytest.approx(150.0 * amplitude ** (1 / 6), rel=1e-12)  # rounding


@given(st.lists(st.floats(1.0, 5.0), min_size=6, max_size=6), st.floats(0.2, 9.8))
def test_speed_never_overshoots_its_neighbours(steps, amplitude):
    speeds = np.cumsum(steps)
    found = speed_at_amplitude(amplitude, FORCE, speeds).value
    right = max(1, int(np.searchsorted(FORCE, amplitude)))
    assert speeds[right - 1] * (1 - 1e-12) <= found <= speeds[right] * (1 + 1e-12)  # rounding


def test_no_speed_outside_the_sweep():
    for amplitude in (0.19, 10.0):
        found = speed_at_amplitude(amplitude, FORCE, FORCE)
        assert math.isnan(found.value) and found.reason.startswith("outside")
    assert speed_at_amplitude(1.0, [1.0, math.nan], [1.0, 2.0]).reason.startswith("too few")


@pytest.mark.parametrize(
    ("amplitudes", "speeds", "says"),
    [
        ([1.0, 2.0], [1.0], "shape"),
        ([1.0, -2.0], [1.0, 2.0], "force -2 is not positive"),
        ([1.0, 2.0], [0.0, 2.0], "speed 0 is not positive"),
        ([1.0, 2.0, 2.0], [1.0, 2.0, 3.0], "2 N is given twice"),
    ],
)
def test_malformed_sweeps_are_refused(amplitudes, speeds, says):
    with pytest.raises(ValueError, match=says):
        speed_at_amplitude(1.5, amplitudes, speeds)


def test_amplitude_asked_for_must_be_positive():
    with pytest.raises(ValueError, match="amplitude is 0"):
        speed_at_amplitude(0.0, FORCE, FORCE)
