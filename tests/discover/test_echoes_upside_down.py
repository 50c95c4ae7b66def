"""Motion gauges read the reflected pulse upside down: its echo is no sign that the gauge is upside down."""

import numpy as np
import pytest

from sonicvacuum.discover.faults import expected

SIGMA = 0.03
TIME = np.arange(480.0)
NOISE = np.random.default_rng(np.random.SeedSequence(7)).normal(0.0, SIGMA, len(TIME))


def swing(at, width):
    """What an accelerometer reads of a pulse: forward, then back."""
    x = (TIME - at) / width
    return -x * np.exp(0.5 - 0.5 * x * x)


def reading(width, first, echo, size=1.0):
    """A pulse and its echo, which comes the other way and so upside down."""
    return size * (swing(first, width) - swing(echo, width))


# A shot of half the stated speed: broader and lower, its echo a half swing later than the model's, so that
# both do not fit at one shift.
MODEL = reading(11.0, 140.0, 438.0)
SLOW = reading(13.0, 144.0, 470.0, 0.43)


def test_an_echo_that_lies_on_the_model_s_pulse_says_nothing():
    off = SLOW + NOISE
    slid = expected.correlated(off, MODEL)
    assert -slid.min() > expected.INVERTED * slid.max()  # the matched filter alone would turn it around
    assert expected.verdict(off, MODEL, SIGMA) == ""


@pytest.mark.parametrize("late", [-60, 0, 60])
def test_a_gauge_upside_down_is_still_told(late):
    early = np.roll(reading(11.0, 150.0, 400.0), late)
    assert expected.verdict(NOISE - early, reading(11.0, 150.0, 400.0), SIGMA) == "inverted"
    assert expected.verdict(NOISE + early, reading(11.0, 150.0, 400.0), SIGMA) == ""


def hump(at, width):
    """What a vibrometer reads of a pulse."""
    return np.exp(-0.5 * ((TIME - at) / width) ** 2)


# Contacts a fifth stiffer than the model's: pulse and echo come earlier, and the model's echo after the end.
VELOCITY = hump(205.0, 20.0)
STIFF = hump(194.0, 18.0) - 0.8 * hump(400.0, 22.0)


def test_of_a_pulse_and_its_echo_the_earlier_one_tells_the_way_up():
    slid = expected.correlated(NOISE - STIFF, VELOCITY)
    assert slid.max() > -slid.min() / expected.INVERTED  # the matched filter alone does not tell
    assert expected.verdict(NOISE - STIFF, VELOCITY, SIGMA, echo=-1.0) == "inverted"
    assert expected.way(NOISE + STIFF, VELOCITY, SIGMA, echo=-1.0) == "upright"


def test_an_echo_ahead_of_what_is_larger_tells_nothing():
    late = hump(205.0, 20.0) * 0.8 - hump(400.0, 22.0)
    assert expected.verdict(NOISE + late, VELOCITY, SIGMA, echo=-1.0) == ""


def test_forces_come_back_the_same_way_up():
    assert expected.verdict(NOISE - STIFF, VELOCITY, SIGMA) == ""
