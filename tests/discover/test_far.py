"""Far from the data, in a record of which much is hardly known, simulations are no finer than noise asks;
what explains it is judged by finer ones.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from test_gross import TAU, made

from sonicvacuum.discover.faults import searching
from sonicvacuum.discover.faults.found import Bench
from sonicvacuum.discover.faults.searching import Searching
from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.model import accuracy
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.effects import CATALOGUE


@pytest.fixture(scope="module")
def discharging():
    """A gauge that discharges, before a wall that is hardly known."""
    return made([("sensor-droop", {"tau_us": TAU})], 0.06)


def search_of(record):
    return Searching(Bench(record), CATALOGUE, 1, [])


def test_far_from_the_data_the_search_is_no_finer_than_noise_asks(discharging, monkeypatch):
    monkeypatch.setattr(accuracy, "TOLERATED", 1e-3)  # so that steps are cut ...
    monkeypatch.setattr(accuracy, "LASTING", 0.1)  # ... in traces no longer than these
    search = search_of(discharging)
    model = search.nominal()
    assert search.far
    assert wide.far(model.forward, model.fit)
    assert model.forward.experiment.approximate
    assert model.forward.cut == 1.0
    finer = Forward(replace(model.forward.experiment, approximate=False))
    assert finer.cut > 1.0
    nu = model.fit.nu[None]
    seen = [
        np.concatenate(f.sampled(model.fit.hypothesis, np.zeros((1, 0)), nu), axis=1)
        for f in (finer, model.forward)
    ]
    error = float(np.square(seen[0] - seen[1]).sum())
    assert error < 1e-3 * model.fit.objective  # what is left hides it


def test_near_the_data_or_with_all_well_known_it_is_as_fine_as_ever(discharging):
    search = search_of(made((), 0.0))
    model = search.nominal()
    assert not search.far
    assert not model.forward.experiment.approximate


@pytest.mark.parametrize("explained", [True, False])
def test_what_explains_the_data_is_judged_by_finer_simulations(explained, discharging, monkeypatch):
    search = search_of(discharging)
    search.far = True
    asked = []

    def searched():
        asked.append(search.make(search.bench).approximate)
        return SimpleNamespace(forward=SimpleNamespace(chains=7), final=None)

    monkeypatch.setattr(search, "_searched", searched)
    monkeypatch.setattr(searching, "far", lambda forward, one: not explained)
    monkeypatch.setattr(searching, "unexplained", lambda found: 0.0)
    search._investigate()
    assert asked == ([True, False] if explained else [True])
    assert search.simulations == (7 if explained else 0)
