"""Finding pulses: which one is the main one, which are separate, what happens where there is none."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pulse_shapes import SHAPES

from sonicvacuum.observe.pulse import PROMINENCE, main_pulse, pulses
from sonicvacuum.observe.shape import (
    asymmetry,
    duration,
    ending,
    extra_pulse_fraction,
    onset,
    valley_depth,
)
from sonicvacuum.observe.trace import TIE, Trace

COS4 = SHAPES["cos4"]
INTERVAL = 0.02
TIME = INTERVAL * np.arange(1000) - 2.0137


def train(*parts, noise=0.0):
    """Sum of cos⁴ pulses (time, height), each π long; noise (a standard deviation) is added and declared."""
    force = sum(height * COS4.force(TIME - time) for time, height in parts)
    if noise:
        force = force + noise * np.random.default_rng(5).standard_normal(len(TIME))
    return Trace.of(TIME, force, noise)


def found(trace, **options):
    return [(p.time, p.force) for p in pulses(trace, main_pulse(trace), **options)]


@pytest.mark.parametrize("gap", [1.7, 2.0, 2.5, 3.0, 4.0])
def test_two_equal_pulses_have_the_valley_of_their_sum(gap):
    # Further apart than half a pulse, π/2, they leave each other's peak alone; the valley lies in the middle.
    trace = train((0.0, 2.0), (gap, 2.0))
    depth = 1.0 - 2.0 * COS4.force(gap / 2.0)
    assert valley_depth(trace, main_pulse(trace)).value == pytest.approx(depth, abs=2e-5)  # fit of the valley
    peaks = found(trace)
    assert len(peaks) == 2
    # Fit of the peaks; at 1.7 the other pulse begins within the top.
    np.testing.assert_allclose(peaks, [(0.0, 2.0), (gap, 2.0)], atol=5e-5)
    below, above = 0.98 * (1.0 - depth), 1.02 * (1.0 - depth) + 0.001
    main = main_pulse(trace)
    if gap < math.pi:
        assert duration(trace, main, below).reason.startswith("merged")
        assert duration(trace, main, above).known
    else:
        assert duration(trace, main, 0.001).known


@pytest.mark.parametrize("gap", [1.09, 1.12, 1.15, 1.2])
@pytest.mark.parametrize("higher", [-0.004, 0.0, 0.004, 0.05])
def test_of_two_humps_as_high_as_each_other_the_first_is_the_peak(gap, higher):
    """A gauge inside a bead adds its two contacts: which hump of a short wave is higher, a trifle says."""
    trace = train((0.0, 1.0), (gap, 1.0 + higher))
    fine = np.linspace(-0.5, gap + 0.5, 200_001)
    force = COS4.force(fine) + (1.0 + higher) * COS4.force(fine - gap)
    left = fine < gap / 2.0
    dip = 1.0 - force[np.abs(fine - gap / 2.0) < 0.1].min() / force[left].max()
    # Beyond the tie the higher one, unless the first is a peak of its own.
    side = left if higher < TIE or dip > PROMINENCE else ~left
    time = fine[side][force[side].argmax()]
    # The fit of one hump up to its dip by a polynomial of degree 6; a single hump is fitted to 5e-5.
    assert main_pulse(trace).time == pytest.approx(time, abs=2e-3)
    assert main_pulse(trace).force == pytest.approx(force[side].max(), rel=2e-4)


def test_the_peak_of_two_humps_moves_with_them():
    """Neither jumps to the other hump, nor with the samples that meet it."""
    shifts = np.linspace(0.0, 3.0 * INTERVAL, 40)
    trains = [train((t, 1.0), (t + 1.12, 1.0 + 1e-4 * math.sin(9.0 * k))) for k, t in enumerate(shifts)]
    times = np.array([main_pulse(one).time for one in trains])
    # As above, and what heights 1e-4 apart move.
    np.testing.assert_allclose(times - times[0], shifts, atol=4e-3)


def test_unequal_pulses_compare_the_valley_with_the_lower_one():
    trace = train((0.0, 1.0), (2.4, 0.4))
    fine = np.linspace(0.0, 2.4, 100001)
    valley = (COS4.force(fine) + 0.4 * COS4.force(fine - 2.4)).min()
    depth = valley_depth(trace, main_pulse(trace))
    assert depth.value == pytest.approx(1.0 - valley / 0.4, abs=1e-4)  # fit of the valley, over 0.4


def test_one_pulse_is_not_split_and_apart_ones_are_wholly():
    assert valley_depth(train((0.0, 1.0)), main_pulse(train((0.0, 1.0)))).value == 0.0
    apart = train((0.0, 1.0), (4.0, 1.0))
    assert valley_depth(apart, main_pulse(apart)).value == pytest.approx(
        1.0, abs=1e-12
    )  # rounding of the fit
    # Droop lets the force fall below rest: still 1.
    below = Trace.of(TIME, apart.force - 0.3 * COS4.force(TIME - 2.0))
    assert valley_depth(below, main_pulse(below)).value == 1.0


def test_main_pulse_is_the_first_high_enough_not_the_largest():
    # A small precursor, the main pulse, and a reflection that meets a later pulse and rises higher.
    trace = train((-1.0, 0.2), (3.0, 1.0), (9.0, 1.8))
    assert main_pulse(trace).time == pytest.approx(3.0, abs=1e-5)  # fit of the peak


def test_pulses_count_above_the_threshold_and_before_the_end():
    trace = train((0.0, 1.0), (4.0, 0.5), (8.0, 0.16), (12.0, 0.14), (16.0, 0.9))
    assert len(found(trace)) == 4
    assert len(found(trace, threshold=0.1)) == 5
    assert len(found(trace, until=12.0)) == 3
    assert len(found(trace, until=7.99)) == 2
    assert len(found(trace, until=-5.0)) == 1  # the main pulse always counts


def test_end_of_the_search_lies_between_samples():
    trace = train((0.0, 1.0), (4.0, 0.5))
    assert (len(found(trace, until=4.0001)), len(found(trace, until=3.9999))) == (2, 1)


def test_a_shallow_valley_does_not_separate_and_a_deeper_one_does():
    # Flat-topped hump with a dip of 4 % and of 6 %: the rule is 5 % of the main peak.
    for dip, count in ((0.04, 1), (0.06, 2)):
        hump = np.interp(TIME, [-1.0, 0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 1.0 - dip, 1.0, 0.0])
        trace = Trace.of(TIME, hump)
        assert len(found(trace)) == count


def test_extra_pulses_are_seen_below_the_threshold_of_counting():
    trace = train((0.0, 3.0), (4.0, 0.06), (8.0, 0.09), (12.0, 2.0))
    main = main_pulse(trace)
    assert len(found(trace, until=11.0)) == 1
    assert extra_pulse_fraction(trace, main, 11.0).value == pytest.approx(0.03, abs=1e-5)  # fit of the peak
    assert extra_pulse_fraction(trace, main, 3.9).value == 0.0


def test_merged_pulses_have_no_duration_below_the_valley():
    trace = train((0.0, 1.0), (2.0, 0.9))
    main = main_pulse(trace)
    merged = duration(trace, main)
    assert math.isnan(merged.value) and merged.reason.startswith("merged")
    assert duration(trace, main, 0.5).known
    # Seen from the second pulse, it is the first that lies before its rise.
    second = pulses(trace, main)[1]
    assert onset(trace, second, 0.01).reason.startswith("merged")
    assert ending(trace, second, 0.01).known


@pytest.mark.parametrize("level", [0.01, 0.3])
def test_pulses_followed_through_others_last_until_the_force_has_fallen(level):
    """A second hump grows from a shoulder into a pulse of its own; how long the level lasts goes on."""
    merged = []
    for gap in (1.3, 1.33, 1.36, 1.39):
        trace = train((0.0, 1.0), (gap, 0.6))
        main = main_pulse(trace)
        assert onset(trace, main, level, through=True) == onset(trace, main, level)
        fall = ending(trace, main, level, through=True).value
        # The second one ends as it would alone.
        assert fall == pytest.approx(gap + COS4.crossings(level * main.force / 0.6)[1], abs=2e-7)
        merged.append(ending(trace, main, level).reason.startswith("merged"))
    assert merged == [False, False, True, True]


def test_a_pulse_too_low_to_count_belongs_to_the_one_before():
    trace = train((0.0, 1.0), (2.2, 0.14))
    rise, fall = -math.acos(0.02**0.25), 2.2 + math.acos((0.02 / 0.14) ** 0.25)
    lasting = duration(trace, main_pulse(trace), 0.02)
    assert lasting.value == pytest.approx(fall - rise, abs=1e-5)  # fit of the crossings


def test_level_between_the_peak_and_its_highest_sample_is_not_resolved():
    trace = train((0.0, 1.0))
    main = main_pulse(trace)
    assert trace.force.max() < 0.99995 < main.force
    assert duration(trace, main, 0.99995).reason.startswith("unresolved")


def test_absent_pulse():
    nothing = Trace.of(TIME, np.zeros_like(TIME))
    main = main_pulse(nothing)
    assert not main.found and math.isnan(main.time) and math.isnan(main.force)
    assert pulses(nothing, main) == ()
    for value in (
        duration(nothing, main),
        valley_depth(nothing, main),
        asymmetry(nothing, main),
        extra_pulse_fraction(nothing, main),
    ):
        assert math.isnan(value.value) and value.reason.startswith("absent")
    low = train((0.0, 0.5))
    assert main_pulse(low, floor=0.4).found
    assert main_pulse(low, floor=0.6).reason.startswith("absent")
    assert main_pulse(Trace.of(TIME, low.force, noise=0.1)).reason.startswith("absent")


def test_negative_signal_is_no_pulse():
    assert main_pulse(Trace.of(TIME, -COS4.force(TIME))).reason.startswith("absent")


def cut(trace, first, last):
    inside = (first <= TIME) & (last >= TIME)
    return Trace.of(TIME[inside], trace.force[inside])


def test_truncated_pulses():
    whole = train((0.0, 1.0))
    rising = main_pulse(cut(whole, -2.0, -0.1))
    assert rising.reason.startswith("truncated") and math.isnan(rising.time)
    assert main_pulse(cut(whole, 0.1, 3.0)).reason.startswith("truncated")
    # Cut on the flanks: the peak is there, the duration is not.
    for first, last, reason in ((-2.0, 1.0, "ends above"), (-1.0, 3.0, "starts above")):
        part = cut(whole, first, last)
        main = main_pulse(part)
        assert main.time == pytest.approx(0.0, abs=1e-5)  # fit of the peak
        assert math.isnan(duration(part, main).value) and reason in duration(part, main).reason
        assert asymmetry(part, main).known == (COS4.crossings(0.5)[1] < 1.0)


def test_level_outside_the_pulse_is_refused():
    trace = train((0.0, 1.0))
    for level in (0.0, 1.0, -0.1, math.nan):
        with pytest.raises(ValueError, match="level"):
            duration(trace, main_pulse(trace), level)


def test_asymmetry_has_the_sign_of_the_slower_side():
    shape = SHAPES["skewed"]
    time = np.arange(-2.0, 8.0, 0.01) + 0.0037
    trace = Trace.of(time, shape.force(time))
    rise, fall = shape.crossings(0.5)
    exact = (fall + rise) / (fall - rise)
    assert exact > 0.05
    leaning = asymmetry(trace, main_pulse(trace)).value
    assert leaning == pytest.approx(
        exact, abs=5e-5
    )  # peak found to 2e-5 of the width, twice in the numerator
    back = Trace.of(-time[::-1], trace.force[::-1])
    assert asymmetry(back, main_pulse(back)).value == pytest.approx(-leaning, abs=1e-6)  # rounding of the fit


@given(st.floats(-1e3, 1e3))
def test_shift_of_time_shifts_times_alone(shift):
    trace = train((0.0, 1.0), (4.0, 0.3))
    moved = Trace.of(TIME + shift, trace.force)
    before, after = main_pulse(trace), main_pulse(moved)
    # Rounding of times of order 1000, and of the interval found from them.
    assert after.time - shift == pytest.approx(before.time, abs=1e-11)
    assert after.force == before.force
    assert duration(moved, after).value == pytest.approx(duration(trace, before).value, abs=1e-11)
    assert found(moved)[1][1] == found(trace)[1][1]


@given(st.floats(1e-6, 1e6))
def test_scale_of_force_scales_forces_alone(scale):
    trace = train((0.0, 1.0), (2.5, 0.3))
    scaled = Trace.of(TIME, scale * trace.force)
    before, after = main_pulse(trace), main_pulse(scaled)
    # Rounding of the fit, 1e-16 over the curvature of its top in units of its half-length, 0.1.
    assert after.time == pytest.approx(before.time, abs=1e-11)
    assert after.force == pytest.approx(scale * before.force, rel=1e-13)
    assert duration(scaled, after, 0.5).value == pytest.approx(duration(trace, before, 0.5).value, abs=1e-11)
    assert len(found(scaled)) == 2
    assert valley_depth(scaled, after).value == pytest.approx(valley_depth(trace, before).value, abs=1e-11)


@given(st.floats(0.0, 1.0), st.floats(1.9, 2.1))
def test_duration_falls_steadily_with_the_level(level, gap):
    trace = train((0.0, 1.0), (gap, 0.05))
    main = main_pulse(trace)
    low, high = 0.06 + 0.4 * level, 0.07 + 0.4 * level
    assert duration(trace, main, low).value > duration(trace, main, high).value


def test_noise_makes_no_pulses_and_no_bias():
    lasting, times, forces = [], [], []
    force = COS4.force(TIME) + 0.5 * COS4.force(TIME - 5.0)
    for seed in range(40):
        sigma = 0.02
        noise = sigma * np.random.default_rng(seed).standard_normal(len(TIME))
        trace = Trace.of(TIME, force + noise, sigma)
        main = main_pulse(trace)
        assert len(pulses(trace, main)) == 2
        lasting.append(duration(trace, main, 0.1).value)
        times.append(main.time)
        forces.append(main.force)
    rise, fall = COS4.crossings(0.1)
    for values, exact in ((lasting, fall - rise), (times, 0.0), (forces, 1.0)):
        error = np.std(values) / math.sqrt(len(values))
        assert abs(np.mean(values) - exact) < 4.0 * error  # four standard errors of the mean
    assert np.std(times) < 0.02 * COS4.half  # 2 % noise, 57 samples per half width: found 0.011


def test_level_within_the_noise_has_no_duration():
    trace = train((0.0, 1.0), noise=0.02)
    assert duration(trace, main_pulse(trace), 0.05).reason.startswith("noise")
    assert duration(trace, main_pulse(trace), 0.07).known


def test_quantised_signal_with_flat_top_is_one_pulse():
    trace = Trace.of(TIME, np.round(COS4.force(TIME) / 0.05) * 0.05)
    main = main_pulse(trace)
    assert len(pulses(trace, main)) == 1
    assert main.time == pytest.approx(0.0, abs=0.05)  # steps of 5 %: the flat top is 0.6 long
