"""The simplest shape outside the catalogue, against which effects are held: found, and its gain as it is."""

from dataclasses import replace

import numpy as np
import pytest

from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import unknown
from sonicvacuum.records import Record


def bent(record: Record, gauge: str, share: float) -> Record:
    """A record one of whose gauges reads y (1 + share |y| / peak)."""
    peak = max(np.abs(one.readings[gauge]).max() for one in record.signals.values())
    signals = {
        run: replace(
            one,
            readings={
                g: y * (1.0 + share * np.abs(y) / peak) if g == gauge else y for g, y in one.readings.items()
            },
        )
        for run, one in record.signals.items()
    }
    return replace(record, signals=signals)


@pytest.mark.parametrize("share", [0.1, 0.6])
def test_a_bent_gauge_gains_what_the_fit_without_it_gains(empty, share):
    straight, curved = (Forward(experiment(r)) for r in (empty, bent(empty, "g7", share)))
    null = nominal(curved)
    name, gain = unknown.simplest(curved, null)
    assert name == "quadratic of gauge g7"
    # All of the misfit but what the shape of predicted readings leaves, a few per cent of it.
    assert gain == pytest.approx(null.objective - nominal(straight).objective, rel=0.1)
