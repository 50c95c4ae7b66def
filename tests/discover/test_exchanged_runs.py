"""Two runs exchanged beside a strong effect: told by where they lead the speeds, whatever else is missing."""

from types import SimpleNamespace

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.faults.competition import Search
from sonicvacuum.discover.faults.found import Bench
from sonicvacuum.discover.faults.judged import Judged, exchanged, obvious
from sonicvacuum.discover.faults.slips import hypotheses
from sonicvacuum.effects import CATALOGUE

PLASTIC = [("plastic-contact", {"residual_fraction": 0.1})]
# Noise of a hundredth of the peaks: in less, slopes lead from the stated speeds nowhere.
GAUGES = [
    {"id": "g4", "kind": "embedded", "bead": 4, "sigma_N": 0.1, "gain_rel_sigma": 0.02},
    {"id": "wall", "kind": "wall", "sigma_N": 0.2, "gain_rel_sigma": 0.02},
]
SPEEDS = (0.3, 0.45, 0.6)


def model_of(record):
    """The search of a record, and its nominal model."""
    search = Search(Bench(record), CATALOGUE, 1, [])
    return search, search.nominal()


def pairs_of(record):
    """Each two runs in each other's place, as if it explained a third of what is missing."""
    slips = [s for s in hypotheses(record) if s.fault == "runs-swapped"]
    return {s.run: Judged(s, 0.0, 1000.0, 500.0, SimpleNamespace()) for s in slips}


@pytest.fixture(scope="module")
def swapped():
    record, _ = made(PLASTIC, seed=5, speeds=SPEEDS, sensors=GAUGES)
    return changes.runs_swapped(record, "v0", "v2")


@pytest.fixture(scope="module")
def told(swapped):
    return model_of(swapped)


def test_they_are_put_right_before_effects_are_asked_for(swapped, told):
    search, model = told
    found = {run: exchanged(judged, model) for run, judged in pairs_of(swapped).items()}
    assert found == {"v0 and v1": False, "v0 and v2": True, "v1 and v2": False}
    one = pairs_of(swapped)["v0 and v2"]
    assert search._sure(one, model) and not obvious(one, model)


@pytest.mark.parametrize("slip", [None, ("v1", 0.8)])
def test_neither_an_effect_nor_one_speed_that_is_wrong_looks_so(slip):
    record, _ = made(PLASTIC, seed=5, speeds=SPEEDS, sensors=GAUGES)
    if slip is not None:
        record = changes.strikers(record, "speed_m_s", slip[1], (slip[0],))
    _, model = model_of(record)
    assert not any(exchanged(judged, model) for judged in pairs_of(record).values())


def test_speeds_that_their_errors_could_exchange_do_not_tell():
    record, _ = made([], seed=5, speeds=(0.29, 0.3, 0.31), sensors=GAUGES)
    record = changes.runs_swapped(record, "v0", "v2")
    _, model = model_of(record)
    assert not any(exchanged(judged, model) for judged in pairs_of(record).values())


def test_runs_of_one_speed_do_not_tell(swapped, told):
    """Whatever else their strikers differ in, and however well the speed is known."""
    record = changes.strikers(swapped, "mass_g", 0.2, ("v0",))
    alike = {run.id: 0.3 / run.striker.speed_m_s for run in record.block.runs}
    for run, ratio in alike.items():
        record = changes.strikers(record, "speed_m_s", np.log(ratio), (run,))
    _, model = told
    exact = SimpleNamespace(experiment=model.forward.experiment, nuisance_sigma=np.zeros(9))
    known = SimpleNamespace(bench=Bench(record), forward=exact, fit=model.fit)
    assert not any(exchanged(judged, known) for judged in pairs_of(swapped).values())


def test_nothing_is_asked_for_beside_what_explains_less_than_nothing(told):
    search, model = told
    worse = SimpleNamespace(objective=2.0 * model.fit.objective)
    assert search._beside(SimpleNamespace(null=model.fit, final=worse)) == []
