"""Noise of traces whose pulse is weak, whose steps are coarse, or which are far from what is stated."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest
from made_records import SIGMA
from made_slips import altered

from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.faults.expected import predicted
from sonicvacuum.discover.model.noise import noise
from sonicvacuum.discover.model.problem import together

SEED = np.random.SeedSequence(31)
TIME = np.arange(700.0)


@pytest.fixture(scope="module")
def model(empty):
    """What the nominal model reads."""
    return predicted(together((empty,)))


@pytest.mark.parametrize("height", [3.0, 4.0, 6.0, 9.0])
@pytest.mark.parametrize("stated", [True, False])
def test_a_weak_pulse_is_no_noise(empty, height, stated):
    """It shows in no sample of its own, or by its crest only."""
    rng = np.random.default_rng(SEED)

    def faint(_):
        swing = np.sin(np.pi * np.clip((TIME - 250.0) / 200.0, 0.0, 1.0)) ** 2
        return SIGMA * (height * swing + rng.normal(size=700))

    record = altered(empty, "g7", faint)
    assert examine(record)[1] == []
    if not stated:
        sensors = [msgspec.structs.replace(s, sigma_N=None) for s in record.block.sensors]
        record = replace(record, block=msgspec.structs.replace(record.block, sensors=sensors))
    sigma, correlation = noise([record])
    assert sigma[1] == pytest.approx(SIGMA, rel=0.15)  # two stretches of 175 samples know it to a twentieth
    assert correlation[1] == 0.0


def test_noise_far_above_the_stated_one_is_told_of_all_runs(empty, model):
    """A gain set ten times too high: no sample before the pulse is quiet by the stated noise."""
    record = altered(empty, "g7", lambda y: 10.0 * y)
    _, (one,) = examine(record, model)
    assert (one.fault, one.run, one.sensor) == ("noise-misstated", None, "g7")
    assert one.value == pytest.approx(10.0, rel=0.1)
    assert noise([record])[0][1] == pytest.approx(10.0 * SIGMA, rel=0.1)
