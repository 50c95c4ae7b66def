"""Records whose noise remembers more than one sample: nothing is told of it that is not there.

Noise of 1/f, of a low-pass, of a ringing disc and of a slow amplifier was told as drifts, levels and pick-up,
and as something unknown, in 34 of 35 empty records with a quarter of a trace before the impact.
"""

import numpy as np
import pytest
from made_noise import COLOURS
from made_records import DAMPING, SIGMA, made
from made_slips import altered

from sonicvacuum.discover import session
from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.model.problem import together
from sonicvacuum.records import Record, Signals

# Samples before the impact.
BEFORE = 160
KUWABARA_KONO = [("kuwabara-kono", {"time_us": DAMPING})]


def coloured(name, seed, effects=()):
    """A record that begins before the impact, under noise of a colour and of the stated size."""
    record, _ = made(effects, noise=0.0)
    rng = np.random.default_rng(np.random.SeedSequence((77, seed)))
    size = np.sqrt(np.mean([np.mean(COLOURS[name](rng, 700) ** 2) for _ in range(40)]))
    signals = {}
    for run, own in record.signals.items():
        readings = {}
        for gauge, trace in own.readings.items():
            sigma = 2.0 * SIGMA if gauge == "wall" else SIGMA
            later = np.concatenate([np.zeros(BEFORE), trace[:-BEFORE]])
            readings[gauge] = later + sigma / size * COLOURS[name](rng, len(trace))
        signals[run] = Signals(own.time_us - BEFORE, readings)
    return Record(record.block, signals, "coloured")


@pytest.mark.parametrize("name", COLOURS)
def test_an_empty_record_is_empty_whatever_the_colour_of_its_noise(name):
    verdict = session.discover(coloured(name, 1)).verdict
    assert verdict.named == []
    assert verdict.faults == []
    assert verdict.probabilities["none"] > 0.5
    assert any(
        "noise that is not white, its spectrum taken from the samples at rest" in one
        for one in verdict.reasons
    )


@pytest.mark.parametrize("name", ["flicker", "smoothed"])
def test_an_effect_is_named_alone_beside_it(name):
    verdict = session.discover(coloured(name, 2, KUWABARA_KONO)).verdict
    assert verdict.named == ["kuwabara-kono"]
    assert verdict.faults == []
    found = verdict.parameters["kuwabara-kono"]["time_us"]
    assert found.value == pytest.approx(DAMPING, abs=4.0 * found.sigma)


def test_noise_that_is_white_has_no_other_colour():
    record, _ = made(seed=4)
    assert together((record,)).colours == ()


@pytest.mark.parametrize("name", ["flicker", "relaxing"])
def test_slips_are_told_beside_slow_noise_where_they_stand_out_of_it(name):
    record, place = coloured(name, 3), np.arange(700)
    for fault, change in {
        "drift": lambda y: y + 80.0 * SIGMA * place / len(place),
        "baseline": lambda y: y + 60.0 * SIGMA,
        "pickup": lambda y: y + 6.0 * SIGMA * np.sin(0.7 * place),
    }.items():
        assert [(f.fault, f.sensor) for f in examine(altered(record, "g7", change))[1]] == [(fault, "g7")]
    assert examine(record)[1] == []
