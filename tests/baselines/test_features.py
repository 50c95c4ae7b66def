"""The vector of features: lengths, means, slopes, and what is missing."""

import math

import numpy as np
import pytest
import yaml
from made_cases import case, cell

from sonicvacuum.files import InputError
from sonicvacuum_blind.baselines import features


@pytest.fixture
def record(tmp_path):
    """Folder of a record of three runs, speeds a factor e apart."""
    runs = [{"id": f"r{k}", "striker": {"speed_m_s": math.exp(k)}} for k in range(3)]
    content = {"runs": runs, "chain": {"beads": 20}, "sensors": [{}, {}, {}]}
    (tmp_path / "record.yaml").write_text(yaml.safe_dump(content))
    return tmp_path


def test_a_record_without_what_is_needed_of_it_is_named(record):
    (record / "record.yaml").write_text("runs: []\n")
    with pytest.raises(InputError, match=r"record\.yaml: chain: missing"):
        features.vector(case(record=record))


def entry(vector, key, which):
    place = list(features._keys()).index(key)
    return vector[place * features.PER_CELL + which]


def test_mean_and_slope_over_the_logarithm_of_speed(record):
    cells = [cell(f"r{k}", "g1", "delay", 2.0 + 3.0 * k) for k in range(3)]
    vector = features.vector(case(cells=cells, record=record))
    assert len(vector) == features.WIDTH
    assert entry(vector, ("first", "delay"), 0) == pytest.approx(5.0)
    assert entry(vector, ("first", "delay"), 1) == pytest.approx(3.0)
    total = math.sqrt(2.0**2 + 5.0**2 + 8.0**2)
    assert entry(vector, ("first", "delay"), 2) == pytest.approx(5.0 / total)
    assert math.isnan(entry(vector, ("last", "delay"), 0))


def test_shape_does_not_depend_on_strength(record):
    weak = [cell(f"r{k}", "g1", "tail", 1.0 + k) for k in range(3)]
    strong = [cell(f"r{k}", "g1", "tail", 10.0 * (1.0 + k)) for k in range(3)]
    one, ten = (features.vector(case(cells=c, record=record)) for c in (weak, strong))
    assert entry(one, ("first", "tail"), 3) == pytest.approx(entry(ten, ("first", "tail"), 3))
    assert entry(ten, ("first", "tail"), 0) == pytest.approx(10.0 * entry(one, ("first", "tail"), 0))


def test_gauges_are_told_by_their_order(record):
    cells = [cell("r1", s, "tail", z) for s, z in (("a", 1.0), ("b", 2.0), ("c", 4.0), ("wall", 8.0))]
    vector = features.vector(case(cells=cells, record=record))
    assert [entry(vector, (role, "tail"), 0) for role in features.ROLES] == pytest.approx([1.0, 3.0, 8.0])
    assert math.isnan(entry(vector, ("first", "tail"), 1))


def test_scalars_are_told_by_their_order_in_the_run(record):
    cells = [cell("r0", "", "amplitude", z, math.nan) for z in (1.0, 2.0, 3.0)]
    vector = features.vector(case(cells=cells, record=record))
    assert [entry(vector, (k, "amplitude"), 0) for k in range(3)] == pytest.approx([1.0, 2.0, 3.0])
    assert np.isnan(entry(vector, (0, "amplitude"), 4))
