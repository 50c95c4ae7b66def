"""Rest, noise, arrival, clipping, steps and spikes of traces whose truth is known, and thinning."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sonicvacuum.scope import thin
from sonicvacuum.scope.quiet import converter_step, look, white

COUNT, CENTRE, WIDTH = 20_000, 9_000, 150.0


def pulse(height=1.0):
    return height * np.exp(-(((np.arange(COUNT) - CENTRE) / WIDTH) ** 2))


def noise(sigma, seed=1):
    return np.random.default_rng(seed).normal(0.0, sigma, COUNT)


@settings(max_examples=25, deadline=None)
@given(st.floats(-3.0, 3.0), st.floats(1e-3, 0.05), st.sampled_from([1.0, -1.0]), st.integers(0, 1000))
def test_rest_noise_and_arrival(offset, sigma, sign, seed):
    found = look(offset + pulse(sign) + noise(sigma, seed))
    # Five standard errors of a mean and of a standard deviation from so many samples at rest.
    assert found.rest == pytest.approx(offset, abs=5.0 * sigma / found.quiet**0.5)
    assert found.sigma == pytest.approx(sigma, rel=5.0 / found.quiet**0.5)
    assert found.peak == pytest.approx(sign, abs=4.0 * sigma)
    # The pulse leaves 3 % of its height 1.9 widths ahead, six times the largest noise 1.1 widths ahead.
    assert CENTRE - 2.2 * WIDTH < found.arrival < CENTRE - 0.9 * WIDTH
    assert found.clipped == 0 and len(found.spikes) == 0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_pulse_of_few_samples_is_told_as_it_was_recorded(sign):
    """The median of five halves what three samples show; a recorder at 51.2 kS/s sees steel balls so."""
    pulse = sign * np.array([0.08, 0.41, 0.93, 1.0, 0.52, 0.03, -0.22, -0.25, -0.2])
    values = 0.3 + 0.002 * np.random.default_rng(3).standard_normal(400)
    values[60:69] += pulse
    values[300] += 2.0  # a spike is no pulse
    found = look(values)
    assert found.peak == pytest.approx(sign, abs=0.01)  # five standard deviations
    assert found.width == 3
    assert found.arrival in (60, 61)


def test_a_pulse_of_two_samples_is_one_and_a_spike_is_none():
    values = 0.002 * np.random.default_rng(4).standard_normal(400)
    values[[200, 201, 202, 203]] += [0.08, 1.0, 0.8, 0.06]
    found = look(values)
    assert (found.arrival, found.width) == (200, 2)
    assert found.peak == pytest.approx(1.0, abs=0.01)  # five standard deviations
    values[200:204] = [0.0, 1.0, 0.0, 0.0]
    assert look(values).arrival is None


def test_hum_is_not_white():
    hum = 0.05 * np.sin(2.0 * np.pi * np.arange(COUNT) / 1500.0)
    found = look(pulse(2.0) + hum + noise(0.01))
    assert found.sigma == pytest.approx(0.01, rel=0.1)  # five standard errors are 0.06
    assert found.slow > 2.0 * found.sigma


def test_the_converter_s_step_counts_as_noise():
    step = 8.0 / 256
    found = look(np.round(pulse(2.0) / step) * step)
    assert found.step == pytest.approx(step, rel=1e-9)
    assert found.sigma == pytest.approx(step / 12.0**0.5, rel=1e-9)
    assert converter_step(noise(1.0)) == 0.0


def test_clipping_and_spikes_are_counted():
    trace = pulse() + noise(0.005)
    cut = np.minimum(trace, 0.7)
    assert look(cut).clipped == int((trace >= 0.7).sum())
    spiked = trace.copy()
    spiked[[1000, 5000, 15000]] += 0.4
    assert look(spiked).spikes.tolist() == [1000, 5000, 15000]


def test_nothing_but_noise_has_no_pulse():
    assert look(noise(0.1)).arrival is None


def test_white_noise_ignores_a_few_spikes():
    trace = noise(0.01)
    trace[::1000] += 5.0
    assert white(trace, 0.0) == pytest.approx(0.01, rel=0.05)  # median of differences: 1.7 times the error


@pytest.mark.parametrize("factor", [2, 5, 16])
def test_thinning_keeps_pulse_and_time(factor):
    trace, left = pulse(), thin.kept(0, COUNT, COUNT, factor)
    thinned = thin.thinned(trace, left)
    # Half of the new Nyquist frequency is passed to 0.13 %, at these pulses' frequencies to far less.
    assert thinned == pytest.approx(trace[left], abs=2e-4)


@pytest.mark.parametrize("factor", [2, 5, 16])
def test_noise_of_thinned_samples_is_as_stated(factor):
    thinned = thin.thinned(noise(1.0), thin.kept(0, COUNT, COUNT, factor))
    # Four standard errors of a standard deviation.
    assert thinned.std() == pytest.approx(thin.noise_left(factor), rel=4.0 / (2.0 * len(thinned)) ** 0.5)


@pytest.mark.parametrize(("begin", "end"), [(0, 400), (150, 250), (5, 398)])
def test_all_that_thinning_keeps_was_measured(begin, end):
    factor, trace = 4, np.zeros(400)
    trace[[0, -1]] = 1e6
    left = thin.kept(begin, end, 400, factor)
    assert begin <= left.start and left.stop <= end
    thinned = thin.thinned(trace, left)
    assert len(thinned) == len(trace[left])
    # A sample at the very end shows in what is within reach of it, and nowhere as if it had lasted.
    assert np.abs(thinned).max() <= 1.000001e6 * np.abs(thin.low_pass(factor)[[0, -1]]).max()
    assert np.array_equal(thin.thinned(trace, thin.kept(begin, end, 400, 1)), trace[begin:end])


@pytest.mark.parametrize("factor", [2, 3, 5, 16])
def test_noise_of_thinned_samples_is_as_white_as_before(factor):
    taps = thin.low_pass(factor)
    moved = [taps[: -k * factor] @ taps[k * factor :] / (taps @ taps) for k in range(1, 2 * thin.HALF)]
    # Cut after ten symbols, where a thousandth is left; a search sees correlations of some 0.05.
    assert np.abs(moved).max() < 1e-3


def test_only_what_is_sampled_too_finely_is_thinned():
    found = look(pulse() + noise(0.01))
    assert thin.factor_for([pulse() + noise(0.01)], [found.width], [found.arrival]) == found.width // 40
    coarse = pulse()[::50]
    assert thin.factor_for([coarse], [look(coarse).width], [look(coarse).arrival]) == 1
    # A fast ripple on a wide pulse forbids it.
    ripple = pulse() * (1.0 + 0.2 * np.sin(np.arange(COUNT) * 2.0 * np.pi / 6.0))
    assert thin.factor_for([ripple], [found.width], [found.arrival]) <= 2
