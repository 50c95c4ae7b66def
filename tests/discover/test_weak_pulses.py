"""Pulses that are weak, or small: the right way up, and not dead."""

import numpy as np
import pytest
from made_records import SIGMA, made
from made_slips import altered

from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.faults.expected import EXPECTED
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import together

SEED = np.random.SeedSequence(31)
TIME = np.arange(700.0)


@pytest.fixture(scope="module")
def model(empty):
    """What the nominal model reads."""
    return predicted(together((empty,)))


@pytest.fixture(scope="module", params=[0.05, 0.005])
def weak(request):
    """A record whose slow shot is weak, or lost in noise, and what the model reads."""
    record = made(speeds=(request.param, 0.9), seed=4)[0]
    seen = predicted(together((record,)))
    assert np.abs(seen["v0"]["g7"]).max() < EXPECTED * SIGMA
    return record, seen


def slips(found):
    return [(f.fault, f.run, f.sensor) for f in found]


def test_a_gauge_is_upside_down_where_little_is_expected_of_it_too(weak):
    record, seen = weak
    bench, found = examine(altered(record, "g7", np.negative), seen)
    assert slips(found) == [("gauge-inverted", None, "g7")]
    for run, signals in bench.record.signals.items():
        np.testing.assert_array_equal(signals.readings["g7"], record.signals[run].readings["g7"])


def test_a_weak_pulse_that_is_upright_is_not_turned():
    """The wires were swapped between the shots."""
    record = made(speeds=(0.05, 0.9), seed=4)[0]
    bench, found = examine(altered(record, "g7", np.negative, "v1"), predicted(together((record,))))
    assert slips(found) == [("gauge-inverted", "v1", "g7")]
    assert bench.record.signals["v0"].equals(record.signals["v0"])


def test_an_upright_pulse_speaks_for_the_weak_one():
    record = made(speeds=(0.005, 0.7, 0.9), seed=4)[0]
    bench, found = examine(altered(record, "g7", np.negative, "v2"), predicted(together((record,))))
    assert slips(found) == [("gauge-inverted", "v2", "g7")]
    assert bench.record.signals["v0"].equals(record.signals["v0"])


@pytest.mark.parametrize("share", [1e-3, -1e-3, 0.02])
def test_a_gauge_that_shows_a_small_pulse_is_not_dead(empty, model, share):
    """Kilonewtons written as newtons: the pulse is as clear as it was."""
    _, found = examine(altered(empty, "wall", lambda y: share * y), model)
    assert ("gauge-dead", None, "wall") not in slips(found)
    (told,) = [f for f in found if f.fault == "noise-misstated"]
    assert (told.run, told.sensor) == (None, "wall")
    assert told.value == pytest.approx(abs(share), rel=0.1)


DEAD = {
    "shorted": lambda rng: 0.01 * SIGMA * rng.normal(size=700),
    "constant": lambda _: np.zeros(700),
    "toggling": lambda rng: 0.1 * SIGMA * (rng.random(700) < 0.02),
    "drifting": lambda rng: 0.01 * SIGMA * (rng.normal(size=700) + 0.1 * TIME),
    "humming": lambda rng: 0.01 * SIGMA * (rng.normal(size=700) + 9.0 * np.sin(0.02 * TIME)),
}


@pytest.mark.parametrize("kind", DEAD)
def test_a_dead_channel_that_is_quieter_than_stated_is_dead(empty, model, kind):
    rng = np.random.default_rng(SEED)
    _, found = examine(altered(empty, "wall", lambda _: DEAD[kind](rng)), model)
    assert slips(found) == [("gauge-dead", None, "wall")]
