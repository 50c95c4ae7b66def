"""Slips beside an effect that changes the pulses beyond what the nominal model can tell of them."""

import numpy as np
import pytest
from made_records import SIGMA, made
from made_slips import altered

from sonicvacuum.discover.faults import expected
from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.faults.lines import drifts
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import together

SEED = np.random.SeedSequence(53)
TIME = np.arange(700.0)
NOISE = SIGMA * np.random.default_rng(SEED).normal(size=700)
LINE = 0.6 * (0.1 + TIME / 700.0)
# Slip → what is added to g4's readings, in which run (None: all), value told.
MADE = {"drift": (LINE, None, 0.6), "baseline": (np.full(700, 0.3), "v1", 0.3)}


def noisy(record):
    """A record with the noise that it states."""
    rng = np.random.default_rng(SEED)
    for gauge in record.gauges:
        for run in record.signals:
            draw = gauge.sigma * rng.normal(size=700)
            record = altered(record, gauge.id, lambda y, draw=draw: y + draw, run)
    return record


@pytest.mark.parametrize("slip", MADE)
@pytest.mark.parametrize(
    "effect", [("dynamic-modulus", {"modulus_ratio": 0.25}), ("linear-dashpot", {"damping_kg_s": 20.0})]
)
def test_lines_are_told_by_what_the_model_reads_beside_an_effect(effect, slip):
    """Where the nominal model reads nothing pulses come, and broad ones leave no place without one."""
    sound = made([effect], noise=0.0)[0]
    read = {run: dict(signals.readings) for run, signals in sound.signals.items()}
    added, run, value = MADE[slip]
    record = altered(noisy(sound), "g4", lambda y: y + added, run)
    (told,) = drifts(record, read)
    assert (told.fault, told.run, told.sensor) == (slip, run, "g4")
    # A line through 700 samples beside a pulse knows its ends to a fifth of a sample's noise; twice that.
    assert told.value(0.0) == pytest.approx(value, abs=0.4 * SIGMA)
    left = told.change(record, 0.0).signals["v1"].readings["g4"] - sound.signals["v1"].readings["g4"]
    assert left.std() == pytest.approx(SIGMA, rel=0.1)  # of 700 samples: three standard errors
    assert {(s.fault, s.run, s.sensor) for s in drifts(record, nominal(record))} != {(slip, run, "g4")}


def test_all_of_a_trace_tells_of_its_line_beside_the_right_effect():
    """A standard deviation of the noise from first sample to last: the half of the trace that is quiet
    has it for a level.
    """
    sound = made([("plastic-contact", {"residual_fraction": 0.3})], noise=0.0)[0]
    read = {run: dict(signals.readings) for run, signals in sound.signals.items()}
    record = altered(noisy(sound), "g4", lambda y: y + SIGMA * TIME / 700.0)
    assert [slip.fault for slip in drifts(record, read)] == ["baseline"]
    (told,) = drifts(record, read, known=True)
    # Two lines through 700 samples each know their common end to a tenth of a sample's noise; twice that.
    assert told.fault == "drift" and told.value(0.0) == pytest.approx(SIGMA, abs=0.2 * SIGMA)


def nominal(record):
    return predicted(together((record,)))


def broad(height, width):
    """A pulse in the middle of 700 samples, in the unit of `SIGMA`."""
    return height * SIGMA * np.exp(-0.5 * ((TIME - 350.0) / width) ** 2)


def test_a_gauge_is_dead_where_a_matched_filter_would_find_its_pulse():
    """Fifteen times the noise high and a hundred samples wide: it was asked for from twenty times on."""
    assert expected.verdict(NOISE, broad(15.0, 40.0), SIGMA) == "silent"
    assert expected.verdict(NOISE, broad(15.0, 4.0), SIGMA) == ""
    assert expected.verdict(NOISE + broad(15.0, 40.0), broad(15.0, 40.0), SIGMA) == ""


def test_a_gauge_is_upside_down_in_noise_too():
    model = broad(6.0, 20.0)
    assert expected.verdict(NOISE - model, model, SIGMA) == "inverted"
    assert expected.verdict(NOISE + model, model, SIGMA) == ""


def test_a_pulse_does_not_die_out_ahead_of_a_gauge_that_reads_it():
    model, ahead = broad(15.0, 40.0), [(4.0, 0.5)]
    assert expected.fades(8.0, model, SIGMA, ahead)
    assert not expected.fades(8.0, model, SIGMA, [*ahead, (12.0, 0.4)])
    assert expected.fades(8.0, model, SIGMA, [*ahead, (12.0, 0.1)])


def test_a_gauge_that_reads_nothing_of_a_weak_shot_is_not_dead_if_no_other_reads_of_it():
    """Friction takes the slow shot's pulse on its way; gauges that see the fast one well were dead in it."""
    for seed in (4, 5):
        record = made([("guide-friction", {"force_N": 0.1})], seed=seed, speeds=(0.05, 0.1, 0.3, 0.9))[0]
        assert examine(record, predicted(together((record,))))[1] == []


def test_pickup_that_few_runs_show_may_be_in_all_of_them():
    """The pulses of fast shots come before a period of it has passed: nothing was told of it there."""
    record = made(speeds=(0.05, 0.9), seed=4)[0]
    wave = 3.0 * SIGMA * np.sin(2.0 * np.pi * 0.021 * TIME + 1.0)
    bench, found = examine(altered(record, "g4", lambda y: y + wave), predicted(together((record,))))
    assert {(f.fault, f.sensor) for f in found} == {("pickup", "g4")}
    amplitudes = [bench.lines[run, "g4"][0] for run in ("v0", "v1")]
    # Two periods and more of a wave three times the noise know its size to a fifth.
    assert amplitudes == pytest.approx([3.0 * SIGMA] * 2, rel=0.2)
