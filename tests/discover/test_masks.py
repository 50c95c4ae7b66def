"""Spikes and cut samples are found, pulses are left alone."""

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover.model.masks import cut, spikes
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.records import Record, Signals

SIGMA = 0.01


def pulse(width, samples=400, seed=0, sigma=SIGMA):
    """Two pulses, (cos)^6 as a solitary wave has it, in noise."""
    phase = (np.arange(samples)[:, None] - np.array([100.3, 250.8])) / width
    clean = (np.cos(np.clip(phase, -np.pi / 2, np.pi / 2)) ** 6) @ np.array([1.0, 0.6])
    return clean + sigma * np.random.default_rng(np.random.SeedSequence(seed)).normal(size=samples)


@pytest.mark.parametrize("width", [4.0, 10.0, 40.0])
def test_a_pulse_is_neither_spike_nor_cut(width):
    for seed in range(20):
        trace = pulse(width, seed=seed)
        assert not spikes(trace, SIGMA).any() and not cut(trace, SIGMA).any()


@pytest.mark.parametrize("at", [[20], [20, 21], [20, 180, 390], [0], [1], [2], [397], [398], [399], [0, 399]])
def test_spikes_are_found_and_nothing_else(at):
    trace = pulse(20.0)
    trace[at] += 30.0 * SIGMA * np.array([1.0, -1.0, 1.0])[: len(at)]
    np.testing.assert_array_equal(np.flatnonzero(spikes(trace, SIGMA)), at)


def test_single_samples_far_out_of_white_noise_are_spikes():
    """Of twelve samples the noise's size is known only roughly: half of such spikes were left for it."""
    found = 0
    for seed in range(40):
        trace = SIGMA * np.random.default_rng(np.random.SeedSequence(seed)).normal(size=200)
        trace[100] += 17.0 * SIGMA
        at = np.flatnonzero(spikes(trace, SIGMA)).tolist()
        assert at in ([], [100])
        found += len(at)
    assert found >= 38


@pytest.mark.parametrize("seed", range(10))
def test_echoes_that_are_sampled_too_coarsely_are_no_spikes(seed):
    """Late in real traces neighbours differ by many times the noise: no spikes, as five of nine had there."""
    trace, rng = pulse(4.0, seed=seed), np.random.default_rng(np.random.SeedSequence(seed))
    trace[290:] += 20.0 * SIGMA * rng.normal(size=110)
    assert not spikes(trace, SIGMA).any()
    trace[[60, 350]] += np.array([1.0, 15.0])  # a spike stands out of the noise, or of what is as rough
    np.testing.assert_array_equal(np.flatnonzero(spikes(trace, SIGMA)), [60, 350])


@pytest.mark.parametrize("width", [4.0, 10.0, 40.0])
def test_a_record_may_begin_or_end_within_a_pulse(width):
    for seed, cut_at in enumerate(range(80, 130)):
        trace = pulse(width, seed=seed)
        assert not spikes(trace[:cut_at], SIGMA).any() and not spikes(trace[cut_at:], SIGMA).any()


def test_a_cut_peak_is_found_and_a_coarse_one_is_left():
    trace = pulse(30.0, sigma=1e-4)
    high = np.minimum(trace, 0.7)
    np.testing.assert_array_equal(cut(high, 1e-4), trace >= 0.7)
    coarse = np.round(pulse(60.0, sigma=1e-4) * 64.0) / 64.0
    assert not cut(coarse, 1e-4).any()


def test_a_long_flat_top_is_cut_whatever_lies_beside_it():
    """A slow wave cut off at its crest: no slope beside the plateau tells how far it went."""
    slow = 0.5 * np.cos(np.linspace(-3.0, 3.0, 400)) + pulse(60.0, sigma=0.0) * 0.05
    trace = np.round(slow + SIGMA * np.random.default_rng(5).normal(size=400), 3)
    top = trace > 0.45
    high = np.minimum(trace, 0.45)
    np.testing.assert_array_equal(cut(high, SIGMA), high == 0.45)
    np.testing.assert_array_equal(cut(-high, SIGMA), high == 0.45)
    assert cut(high, SIGMA).sum() >= top.sum()


@pytest.mark.parametrize("step", [0.02, 1.0 / 64.0])
def test_equal_readings_of_a_coarse_or_quiet_recorder_are_no_cut(step):
    """Where a step exceeds the noise, a crest has many equal readings, whatever noise the record states."""
    slow = np.cos(np.linspace(-1.5, 1.5, 400))
    for sigma in (0.0, 0.2 * step):
        noise = sigma * np.random.default_rng(3).normal(size=400)
        trace = np.round((slow + noise) / step) * step
        assert not cut(trace, 2.0 * step).any()


def test_what_is_masked_is_said_and_does_not_count():
    record, _ = made(seed=2)
    signals = {}
    for run, one in record.signals.items():
        readings = {g: r.copy() for g, r in one.readings.items()}
        readings["g7"][[5, 600]] += 5.0
        signals[run] = Signals(one.time_us, readings)
    e, clean = experiment(Record(record.block, signals, "spiky")), experiment(record)
    assert e.notes == ("g7: 4 spikes left out",)
    assert [e.size(k) for k in (0, 1)] == [clean.size(k) - 2 for k in (0, 1)]
    np.testing.assert_allclose(e.sigma, clean.sigma, rtol=0.01)  # two samples in hundreds
