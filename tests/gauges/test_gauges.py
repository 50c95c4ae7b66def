"""Gauges: the contacts they feel, where they sit, and their filters against exact responses."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import lfilter

from sonicvacuum.forward import discharge
from sonicvacuum.gauges import Gauge, contacts_of, needed, position, reading
from sonicvacuum.gauges.base import Recorded
from sonicvacuum.gauges.electronics import filtered, high_passed

INTERVAL = 2e-6
TIME = INTERVAL * np.arange(700)
LOWPASS, DROOP = 7e-6, 1e-3
ROUNDING = 1e-12  # a few hundred roundings of 1e-16, on responses of order one


def seen(forces):
    """A recorded motion of which only contact forces are known."""
    samples = len(next(iter(forces.values())))
    return Recorded(INTERVAL * np.arange(samples), forces)


def test_gauge_feels_the_two_contacts_of_its_bead_and_the_wall_gauge_the_last():
    g9, wall = Gauge("g9", "embedded", 13), Gauge("wall", "wall", None)
    assert contacts_of(g9, 21) == (12, 13)
    assert contacts_of(wall, 21) == (21,)
    assert contacts_of(wall, 0) == (0,)
    assert needed([wall, Gauge("next", "embedded", 14), g9], 21) == ((12, 13, 14, 21), ())


def test_positions_are_bead_centres_counted_from_the_wall():
    # The ninth bead from the bottom of 21, as in Daraio & Nesterenko (2006): 8.5 diameters from the wall.
    assert position(Gauge("g9", "embedded", 13), 21, 4.86e-3) == 8.5 * 4.86e-3
    assert position(Gauge("first", "embedded", 1), 21, 2.0) == 41.0
    assert position(Gauge("wall", "wall", None), 21, 4.86e-3) == 0.0


@pytest.mark.parametrize(
    "changes",
    [
        {"kind": "floor"},
        {"bead": None},
        {"bead": 0},
        {"kind": "wall"},
        {"kind": "wall", "bead": None, "offset_fraction": 0.1},
        {"droop_s": 0.0},
        {"lowpass_s": -1e-6},
        {"offset_fraction": 0.6},
        {"gain": 0.0},
        {"gain": math.nan},
    ],
)
def test_impossible_gauge_is_refused_by_name(changes):
    with pytest.raises(ValueError, match="sensor g9: "):
        Gauge(**{"id": "g9", "kind": "embedded", "bead": 13, **changes})


def test_gauge_outside_the_chain_and_unrecorded_contact_are_refused():
    with pytest.raises(ValueError, match="bead 22; the chain has 21"):
        position(Gauge("g", "embedded", 22), 21, 1.0)
    with pytest.raises(ValueError, match="force of contact 12 was not recorded"):
        reading(Gauge("g", "embedded", 13), seen({13: TIME}), 21)


def test_embedded_gauge_reads_the_weighted_mean_times_its_gain():
    before, after = np.sin(TIME / 1e-5), np.cos(TIME / 1e-5)
    forces = {12: before, 13: after}
    middle = reading(Gauge("g", "embedded", 13), seen(forces), 21)
    np.testing.assert_array_equal(middle, 0.5 * before + 0.5 * after)
    off = reading(Gauge("g", "embedded", 13, offset_fraction=0.1, gain=2.0), seen(forces), 21)
    np.testing.assert_allclose(off, 2.0 * (0.6 * before + 0.4 * after), rtol=0, atol=ROUNDING)


def test_off_values_return_the_force_itself():
    force = np.random.default_rng(1).standard_normal((700, 3))
    np.testing.assert_array_equal(reading(Gauge("w", "wall", None), seen({21: force}), 21), force)
    # Arrays of time constants, some of them off: those columns are exact too.
    some = filtered(force, INTERVAL, [0.0, LOWPASS, 0.0], [math.inf, math.inf, DROOP])
    np.testing.assert_array_equal(some[:, 0], force[:, 0])
    assert np.all(np.any(some[:, 1:] != force[:, 1:], axis=0))


def test_low_pass_of_step_and_ramp_is_exact():
    decay = np.exp(-TIME / LOWPASS)
    np.testing.assert_allclose(filtered(np.ones(700), INTERVAL, LOWPASS), 1.0 - decay, atol=ROUNDING)
    ramp = TIME / LOWPASS
    np.testing.assert_allclose(
        filtered(ramp, INTERVAL, LOWPASS), ramp - (1.0 - decay), atol=ROUNDING * ramp[-1]
    )


def test_droop_of_step_and_ramp_is_exact():
    decay = np.exp(-TIME / DROOP)
    np.testing.assert_allclose(filtered(np.ones(700), INTERVAL, 0.0, DROOP), decay, atol=ROUNDING)
    np.testing.assert_allclose(filtered(TIME / DROOP, INTERVAL, 0.0, DROOP), 1.0 - decay, atol=ROUNDING)


def test_bandwidth_then_droop_of_step_and_ramp_is_exact():
    b, d = LOWPASS, DROOP
    fast, slow = np.exp(-TIME / b), np.exp(-TIME / d)
    step = d / (d - b) * (slow - fast)
    np.testing.assert_allclose(filtered(np.ones(700), INTERVAL, b, d), step, atol=ROUNDING)
    ramp = (d * (1.0 - slow) - b * (1.0 - fast)) / (d - b)
    np.testing.assert_allclose(filtered(TIME / d, INTERVAL, b, d), ramp, atol=ROUNDING)


def test_equal_time_constants_have_their_limit():
    tau = 1e-4
    limit = TIME / tau * np.exp(-TIME / tau)
    # The two constants are parted by 1e-5: 1e-10 from the parting, as much from cancellation.
    np.testing.assert_allclose(filtered(np.ones(700), INTERVAL, tau, tau), limit, atol=1e-9)


@pytest.mark.parametrize("b", [0.5e-6, 2e-6, 2e-5])
def test_low_pass_of_a_smooth_pulse_converges_with_the_fourth_power_of_the_interval(b):
    """A time constant of a sample or less is what fast electronics have: drawn straight between samples, the
    pulse would be taken for smoother than it is, and the time constant for some per cent shorter.
    """
    width, finer = 2e-5, 64

    def error(interval):
        t = np.arange(0.0, 4e-4, interval / finer)
        pulse = np.exp(-0.5 * ((t - 1.5e-4) / width) ** 2)
        # Sixty-four times as many samples: their own error is 64^-4 of the coarse one's.
        exact = filtered(pulse, interval / finer, b)[::finer]
        return np.abs(filtered(pulse[::finer], interval, b) - exact).max()

    coarse, fine = error(2e-6), error(1e-6)
    assert coarse < (2e-6 / width) ** 4 / 8  # as the cubic through four samples lies off the pulse
    assert coarse / fine == pytest.approx(16.0, rel=0.3)  # fourth order; 30 % for the next one


def test_exponential_force_converges_with_the_square_of_the_interval():
    c, taus = 1e-4, (1e-4, 5e-5, 1e-3)

    def error(interval):
        t = interval * np.arange(round(1.4e-3 / interval))
        # Response to 1 − exp(−t/c), whose transform with both filters is d/((1 + c s)(1 + b s)(1 + d s)).
        exact = taus[2] * sum(
            tau * np.exp(-t / tau) / math.prod(tau - other for other in taus if other != tau) for tau in taus
        )
        return np.abs(filtered(1.0 - np.exp(-t / c), interval, *taus[1:]) - exact).max()

    coarse, fine = error(4e-6), error(2e-6)
    assert (
        coarse < (4e-6 / c) ** 2 / 8
    )  # the chord's greatest distance from the curve, which no filter amplifies
    assert coarse / fine == pytest.approx(4.0, rel=0.05)  # second order; 5 % for the next order


def test_summation_by_doubling_is_the_recursion():
    force = np.random.default_rng(2).standard_normal(1000)
    for tau in (1e-7, 1e-6, 1e-5, 1e-3, 1.0):
        h = INTERVAL / tau
        decay, weight = math.exp(-h), -math.expm1(-h) / h
        jump = decay ** np.arange(1000) * force[0] * (1.0 - weight)
        recursion = lfilter([weight, -weight], [1.0, -decay], force) + jump
        # Rounding grows with the number of samples summed, 1000.
        np.testing.assert_allclose(high_passed(force, INTERVAL, tau), recursion, rtol=0, atol=1e-12)


def test_time_constants_may_differ_from_column_to_column():
    force = np.random.default_rng(3).standard_normal((500, 3))
    low, droop = np.array([0.0, 1e-6, 2e-5]), np.array([1e-3, math.inf, 5e-4])
    together = filtered(force, INTERVAL, low, droop)
    for k in range(3):
        alone = filtered(force[:, k], INTERVAL, low[k], droop[k])
        np.testing.assert_allclose(together[:, k], alone, rtol=0, atol=ROUNDING)


def test_discharge_sags_a_pulse_of_the_paper_by_an_eighth():
    # RC about 1 ms, pulse of 130 µs (Daraio & Nesterenko 2006): a flat force sags by 1 − exp(−0.13) = 12.2 %.
    step = reading(Gauge("w", "wall", None, droop_s=1e-3), seen({0: np.ones(66)}), 0)
    assert 1.0 - step[65] == pytest.approx(-math.expm1(-0.13), abs=ROUNDING)


@given(st.floats(-5, 5), st.floats(-5, 5), st.floats(-0.5, 0.5), st.floats(1e-7, 1e-4), st.floats(2e-4, 1e-2))
def test_gauges_are_linear(a, b, offset, lowpass, droop):
    x, y = np.random.default_rng(4).standard_normal((2, 2, 200))
    sensor = Gauge("g", "embedded", 1, droop, lowpass, offset, 1.3)

    def read(z):
        return reading(sensor, seen({0: z[0], 1: z[1]}), 3)

    # Terms of order 5 × 4 × gain; a few roundings per sample of memory.
    np.testing.assert_allclose(read(a * x + b * y), a * read(x) + b * read(y), rtol=0, atol=1e-11)


def test_a_bandwidth_of_next_to_no_time_changes_nothing_and_overflows_nowhere():
    steps = np.linspace(0.0, 1.0, 20)
    with np.errstate(divide="raise", invalid="raise", over="raise"):
        assert np.array_equal(filtered(steps, 1e-6, lowpass_s=1e-314), steps)


@pytest.mark.parametrize("bent", [False, True])
@pytest.mark.parametrize("shape", [(1,), (2, 3), (5,), (400, 2, 3), (0, 2)])
def test_simulated_signals_are_filtered_in_one_pass_as_all_others_are(shape, bent):
    """Of constants that are all alike, or off both ways, and each its own."""
    rng = np.random.default_rng(np.random.SeedSequence(5))
    signal = rng.normal(size=shape)
    own = rng.choice([0.0, 1e-9, 3.0 * INTERVAL, 1e-3, math.inf], size=shape[1:])
    for tau in (0.0, 3.0 * INTERVAL, math.inf, own):
        found = discharge.high_passed(signal, INTERVAL, tau, bent)
        # Sums of 400 numbers of order 1, in another order.
        np.testing.assert_allclose(found, high_passed(signal, INTERVAL, tau, bent), rtol=0, atol=1e-12)
