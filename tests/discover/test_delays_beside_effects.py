"""A gauge that is late beside an effect: how late it is was told by pulses that no effect had moved."""

import pytest
from made_records import block, made

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes, judged, timing
from sonicvacuum.discover.faults.competition import Search
from sonicvacuum.discover.faults.found import Bench
from sonicvacuum.discover.faults.slips import WIDTH
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.effects import CATALOGUE

LATE = 12.0


@pytest.fixture(scope="module")
def slowed():
    """A chain whose beads are slowed, so that pulses are late by what they have run, and a gauge that is."""
    record, _ = made([("viscous-drag", {"rate_per_s": 600.0})], seed=12)
    return changes.delayed(record, "g4", -LATE)


def test_the_delay_put_right_is_known_to_a_pulse(empty):
    open_ = timing.delay_left_open(empty, "g4", predicted(experiment(empty)))
    sigma = {s.id: s.delay_sigma_us for s in open_.block.sensors}
    assert 20.0 < sigma["g4"] < 100.0
    assert sigma["g7"] == sigma["wall"] == 0.0
    # What the record states is no less known for that.
    assert changes.delay_known_to(open_, "g4", 1.0).block == open_.block


def test_what_was_put_right_leaves_the_delay_to_the_effects(slowed):
    search = Search(Bench(slowed), CATALOGUE, 1, [])
    late = next(j for j in search.ranked(search.nominal()) if j.slip.fault == "gauge-delayed")
    # Beside the nominal model alone the gauge in front is later than it is.
    assert late.size > LATE + 1.0
    search._accept([late], late)
    assert next(s for s in search.bench.record.block.sensors if s.id == "g4").delay_sigma_us > 20.0


@pytest.mark.long
def test_the_delay_told_is_that_beside_the_effect(slowed):
    """Beside the delay as the nominal model had it, drag left something unknown, after a search of sets."""
    v = session.discover(slowed).verdict
    assert v.named == ["viscous-drag"]
    (fault,) = v.faults
    assert (fault.fault, fault.sensor) == ("gauge-delayed", "g4")
    assert fault.value == pytest.approx(LATE, abs=0.2)


def test_a_delay_below_its_prior_width_is_found_where_pulses_are_shorter_still():
    """Slopes know nothing of a pulse 8 us long that comes 17 us late: nothing else was found than wrong
    places of the gauge, and a minute of sets of effects followed.
    """
    gauges = [{"id": id, "kind": "embedded", "bead": b, "sigma_N": 0.3} for id, b in (("g4", 4), ("g7", 7))]
    steel = {
        **block((0.3, 0.9), sensors=[{**g, "gain_rel_sigma": 0.02} for g in gauges]),
        "chain": {
            "beads": 10,
            "orientation": "horizontal",
            "bead": {"diameter_mm": 4.76, "mass_g": 0.452, "material": "stainless-steel"},
            "wall": {"material": "stainless-steel"},
        },
        "materials": {},
    }
    record = changes.delayed(made(given=steel)[0], "g7", -17.0)
    assert WIDTH["gauge-delayed"] > 17.0
    search = Search(Bench(record), CATALOGUE, 1, [])
    model = search.nominal()
    best = search.ranked(model)[0]
    assert (best.slip.fault, best.slip.sensor) == ("gauge-delayed", "g7")
    assert best.size == pytest.approx(17.0, abs=0.1)
    assert judged.obvious(best, model)
