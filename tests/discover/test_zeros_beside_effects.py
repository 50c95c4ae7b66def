"""A run triggered late beside an effect: by how much was told by pulses that no effect had moved."""

import pytest
from made_records import block, made

from sonicvacuum.discover.faults import changes, timing
from sonicvacuum.discover.faults.competition import Search
from sonicvacuum.discover.faults.found import Bench
from sonicvacuum.discover.faults.judging import Judge
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.effects import CATALOGUE

LATE = 40.0


def test_the_time_zero_put_right_is_asked_for_once_more_beside_the_effect():
    """It was held to the trigger's own error, 1 us, from where the nominal model had it, drag or not."""
    few = ("viscous-drag", "kuwabara-kono", "static-preload")  # of all it takes longer
    given = {**block((0.3, 0.9)), "priors": {id: 0.0 for id in CATALOGUE.ids if id not in few}}
    record, nu = made([("viscous-drag", {"rate_per_s": 600.0})], seed=12, given=given)
    search = Search(Bench(changes.time_zero(record, {"v1": LATE}, 0.0)), CATALOGUE, 1, [])
    model = search.nominal()
    slips = timing.late_runs(model.bench.record, model, predicted(search.make(model.bench)))
    judge = Judge(model, search.judged)
    (late,) = judge.follow_all(judge.look_at([s for s in slips if s.run == "v1"]))
    search._accept([late], late)
    found = search._investigate()
    trigger = found.forward.layout.trigger(1)
    assert abs(found.final.nu[trigger]) > 3.0
    after = search._factors_anew(found)
    assert after.named == ["viscous-drag"]
    assert after.final.objective < found.final.objective - 6.0
    assert abs(after.final.nu[trigger]) < 0.5
    (told,) = search.findings
    assert told.value == pytest.approx(-LATE - nu[trigger], abs=0.5)
