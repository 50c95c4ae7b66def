"""Noise larger than stated by a third or more is told from all samples, where those at rest are few."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest
from made_records import SIGMA, made

from sonicvacuum.discover.faults.traces import misstated
from sonicvacuum.discover.model.noise import noise
from sonicvacuum.records import Record, Signals

EVERY, RATIO = 3, 1.45


def stated(seed, share) -> Record:
    """A record of three runs with a third of its samples, whose noise is stated `share` times as large."""
    record, _ = made(seed=seed, speeds=(0.3, 0.5, 0.9))
    signals = {
        run: Signals(one.time_us[::EVERY], {id: trace[::EVERY] for id, trace in one.readings.items()})
        for run, one in record.signals.items()
    }
    sensors = [msgspec.structs.replace(s, sigma_N=share * s.sigma_N) for s in record.block.sensors]
    return replace(record, signals=signals, block=msgspec.structs.replace(record.block, sensors=sensors))


@pytest.mark.parametrize("seed", range(6))
def test_noise_is_what_all_samples_show_and_as_stated_where_that_is_right(seed):
    found, _ = noise((stated(seed, 1.0 / RATIO),))
    # Half as many samples as there are tell it to 4 %: three standard errors of 630 of them.
    np.testing.assert_allclose(found[:2], SIGMA, rtol=0.12)
    right, _ = noise((stated(seed, 1.0),))
    np.testing.assert_allclose(right[:2], SIGMA, rtol=1e-3)  # beside it the simulation's own error counts


def test_stretches_of_which_none_shows_it_surely_are_judged_together():
    draws = np.random.default_rng(np.random.SeedSequence(4)).normal(size=(200, 5, 60))
    told = [misstated({f"v{k}": RATIO * one for k, one in enumerate(rows)}, 1.0) for rows in draws[:40]]
    assert sum(len(one) == 5 for one in told) >= 20
    assert not any(misstated({f"v{k}": one for k, one in enumerate(rows)}, 1.0) for rows in draws)
