"""Nothing is named from a fit with as many parameters as there are data."""

from types import SimpleNamespace

import numpy as np
import pytest

from sonicvacuum.discover import session
from sonicvacuum.discover.fit import enough
from sonicvacuum.discover.fit.evidence import Candidate
from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse


def candidate(name, parameters, placed=False):
    effect = SimpleNamespace(id=name, places="bead" if placed else None)
    fit = SimpleNamespace(
        u=np.zeros(parameters), hypothesis=SimpleNamespace(components=[SimpleNamespace(effect=effect)])
    )
    return Candidate(name, fit, 50.0, 20.0)


def measured(*sizes):
    """Stands for a forward model of runs with so many data."""
    experiment = SimpleNamespace(runs=sizes, size=lambda run: sizes[run])
    return SimpleNamespace(experiment=experiment)


def test_effects_with_fewer_parameters_than_data_come_first():
    found = [candidate("shape", 2), candidate("place", 1, placed=True), candidate("one", 1)]
    assert [c.effect for c in enough.first(measured(1, 1), found)] == ["one", "shape", "place"]
    assert [c.effect for c in enough.first(measured(2, 1), found)] == ["shape", "place", "one"]


def test_what_is_passed_over_is_told_with_numbers_and_cure():
    (told,) = enough.told(measured(1, 1), [candidate("shape", 3), candidate("one", 1)])
    assert "too few data, 2 in all" in told
    assert "shape (3)" in told and "one" not in told.split(":")[1]
    assert "measure 2 more" in told
    assert enough.told(measured(9), [candidate("shape", 3)]) == []


@pytest.fixture(scope="module")
def verdict():
    """One ball that rebounds once, much too slowly."""
    ball = {"diameter_mm": 10.0, "mass_g": 4.0, "material": "stainless-steel"}
    rebound = {"quantity": "restitution", "value": 0.8, "sigma": 0.01, "unit": 1}
    striker = {**ball, "shape": "sphere", "speed_m_s": 0.5}
    wall = {"material": "stainless-steel"}
    content = {
        "format": 1,
        "title": "Steel ball on a steel wall",
        "chain": {"beads": 0, "orientation": "vertical", "bead": ball, "wall": wall},
        "sensors": [],
        "runs": [{"id": "slow", "striker": striker, "observables": [rebound]}],
    }
    return session.discover(Record(parse(content), {}, "ball"), threads=1).verdict


def test_one_datum_is_a_misfit_without_a_name(verdict):
    assert verdict.named == ["unknown"] == [max(verdict.probabilities, key=verdict.probabilities.get)]
    assert "too few data, 1 in all" in verdict.reasons[0]
    assert verdict.parameters == {}
