"""Reading between samples: peaks and crossings of known pulses at awkward offsets; malformed signals."""

import numpy as np
import pytest
from pulse_shapes import SHAPES

from sonicvacuum.observe.pulse import main_pulse
from sonicvacuum.observe.shape import ending, onset
from sonicvacuum.observe.trace import Trace, crossing, grid, maximum

OFFSETS = np.linspace(0.0, 1.0, 23)


def sampled(shape, per_width, offset):
    """The shape with `per_width` samples per width at half height, shifted by a fraction of a sample."""
    interval = shape.half / per_width
    time = interval * (np.arange(-20 * per_width, 30 * per_width) + offset)
    return Trace.of(time, shape.force(time))


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize(
    ("per_width", "time_bound", "force_bound"),
    [
        # Largest errors found over all offsets, rounded up. A coated chain's pulse is 34 µs wide at half
        # height: 2e-5 of that is 0.7 ns, 5 ns would be 1.5e-4.
        (10, 2e-5, 6e-6),
        (20, 2e-5, 3e-6),
        (200, 2e-5, 3e-6),
    ],
)
def test_peaks_are_found_between_samples(name, per_width, time_bound, force_bound):
    shape = SHAPES[name]
    found = [main_pulse(sampled(shape, per_width, offset)) for offset in OFFSETS]
    assert max(abs(p.time) for p in found) < time_bound * shape.half
    assert max(abs(p.force - 1.0) for p in found) < force_bound


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("level", [0.01, 0.1, 0.5])
@pytest.mark.parametrize(
    ("per_width", "bound"),
    # Largest errors found, rounded up: 1.7 ns of 34 µs at 20 samples per width; fourth order in the interval.
    [(10, 8e-4), (20, 5e-5), (40, 4e-6)],
)
def test_crossings_are_found_between_samples(name, level, per_width, bound):
    shape = SHAPES[name]
    rise, fall = shape.crossings(level)
    for offset in OFFSETS:
        trace = sampled(shape, per_width, offset)
        main = main_pulse(trace)
        assert abs(onset(trace, main, level).value - rise) < bound * shape.half
        assert abs(ending(trace, main, level).value - fall) < bound * shape.half


def test_fits_are_exact_for_the_polynomials_they_are():
    x = np.arange(12.0)
    # 3 − (x − 5.3)²(1 + (x − 5.3)⁴/100): sixth degree, one maximum.
    place, height = maximum(3.0 - (x - 5.3) ** 2 * (1.0 + (x - 5.3) ** 4 / 100.0), 1, 9)
    assert place == pytest.approx(5.3, abs=1e-9)  # rounding of the fit, values up to 40, curvature 2
    assert height == pytest.approx(3.0, abs=1e-11)
    cubic = (x - 4.37) * (1.0 + (x - 4.0) ** 2)
    assert crossing(cubic, 4, 0.0) == pytest.approx(4.37, abs=1e-12)  # rounding
    for before in (0, 10):  # at the ends of the record the four samples are one-sided
        exact = before + 0.25
        assert crossing((x - exact) * (2.0 + (x - exact) ** 2), before, 0.0) == pytest.approx(
            exact, abs=1e-11
        )


def test_times_rounded_in_a_file_are_equidistant_enough():
    time = np.round(np.arange(300) * 5 / 3, 2)  # 1.67, 3.33, 5.00 …: off by 0.2 % of the interval
    start, interval = grid(time)
    assert (start, interval) == (0.0, pytest.approx(5 / 3, rel=1e-5))  # the last time, 498.33, is rounded too


@pytest.mark.parametrize(
    ("time", "force", "says"),
    [
        (np.arange(9.0), np.zeros(8), "force"),
        (np.zeros((3, 3)), np.zeros((3, 3)), "must be"),
        (np.arange(4.0), np.zeros(4), "at least 5"),
        (np.array([0, 1, 2, 4, 5, 6.0]), np.zeros(6), "equal steps"),
        (np.arange(9.0)[::-1], np.zeros(9), "equal steps"),
        (np.full(9, np.nan), np.zeros(9), "equal steps"),
        (np.arange(9.0), np.array([0, 0, 0, np.nan, 0, 0, 0, 0, 0]), r"force\[3\] is nan"),
        (np.arange(9.0), np.array([0, 0, 0, 0, 0, np.inf, 0, 0, 0]), r"force\[5\] is inf"),
    ],
)
def test_malformed_signals_are_refused(time, force, says):
    with pytest.raises(ValueError, match=says):
        Trace.of(time, force)


def test_noise_must_be_a_number():
    with pytest.raises(ValueError, match="noise"):
        Trace.of(np.arange(9.0), np.zeros(9), -1.0)
