"""Traces are used for as long as a chain can be foretold, and no longer."""

import copy

import numpy as np
import pytest
from made_records import block, made

from sonicvacuum.discover.model.window import fitted
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.predict import Conditions, predict
from sonicvacuum.records.reader import parse

# us: waves cross the preloaded chain in some 90.
LAST = 2500.0


def lasting(static_force):
    """Bare steel beads struck weakly and strongly, with traces of rest: what is recorded does not matter."""
    content = copy.deepcopy(block([0.2, 1.2]))
    content["chain"] |= {
        "beads": 15,
        "bead": {"diameter_mm": 10, "mass_g": 4.19, "material": "stainless-steel"},
        "static_force_N": static_force,
    }
    del content["materials"]
    for run in content["runs"]:
        run["striker"] |= {
            "shape": "sphere",
            "material": "stainless-steel",
            "mass_g": 4.19,
            "diameter_mm": 10,
        }
    time = np.arange(0.0, LAST, 2.0)
    rest = {s["id"]: np.zeros(len(time)) for s in content["sensors"]}
    return Record(parse(content), {r["id"]: Signals(time, rest) for r in content["runs"]})


def test_where_the_striker_is_forgotten_a_trace_ends():
    record = lasting(20.0)
    less, notes = fitted(record)
    assert less.signals["v0"] is record.signals["v0"]
    end = less.signals["v1"].samples
    assert 0.4 * LAST < less.signals["v1"].time_us[-1] < 0.8 * LAST
    assert len(notes) == 1
    assert notes[0].startswith("run v1 cut at ")
    # The same by simulations at full accuracy, of strikers a hundred times further apart.
    here, faster = (predict(record, Conditions(speed_ratio=1.0 + c))[1].readings for c in (0.0, 1e-3))
    change = [0.01 / 1e-3 * np.abs(faster[g] - here[g]) / np.abs(here[g]).max() for g in here]
    assert max(c[:end].max() for c in change) < 0.5  # twice what a pulse's coming earlier can make by then
    assert max(c[end:].max() for c in change) > 1.5


def test_beads_that_part_after_the_pulse_are_foretold_to_the_end():
    record = lasting(0.0)
    assert fitted(record) == (record, ())


def test_an_ordinary_record_is_not_even_simulated(monkeypatch):
    record, _ = made()
    monkeypatch.setattr(
        "sonicvacuum.discover.model.horizon.predicted", lambda *_: pytest.fail("is simulated")
    )
    assert fitted(record)[0] is record
