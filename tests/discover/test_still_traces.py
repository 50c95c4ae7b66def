"""Traces that never move, and shots that never struck: no data, and no effect in their place."""

import numpy as np
import pytest
from made_records import SIGMA, made
from made_slips import altered, unstated

from sonicvacuum.discover import session
from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import together

NOISE = np.random.default_rng(np.random.SeedSequence(14)).normal(size=700)


@pytest.fixture(scope="module")
def model(empty):
    """What the nominal model reads."""
    return predicted(together((empty,)))


@pytest.mark.parametrize("stated", [True, False])
@pytest.mark.parametrize("level", [0.0, 0.03, -5.0])
@pytest.mark.parametrize("run", ["v1", None])
def test_a_gauge_that_is_stuck_is_dead(empty, model, run, level, stated):
    """Whatever it reads; it ended in an error where that was not 0, of which no sample counts."""
    stuck = altered(empty, "g4", lambda y: np.full_like(y, level), run)
    stuck = stuck if stated else unstated(stuck)
    seen = predicted(together((stuck,)))
    assert seen["v1"]["g4"].max() == pytest.approx(model["v1"]["g4"].max(), rel=1e-3)
    bench, (one,) = examine(stuck, seen)
    assert (one.fault, one.run, one.sensor) == ("gauge-dead", run, "g4")
    assert "g4" not in bench.record.signals["v1"].readings


@pytest.mark.parametrize("stated", [True, False])
@pytest.mark.parametrize("noisy", [True, False])
def test_where_no_shot_struck_no_sample_counts(empty, model, noisy, stated):
    """Effects of gauges explained the silence, or the search ended in an error."""
    record = empty
    for gauge in ("g4", "g7", "wall"):
        record = altered(record, gauge, lambda _: SIGMA * NOISE * noisy)
    record = record if stated else unstated(record)
    bench, findings = examine(record, model)
    missed = [("run-without-impact", "v0"), ("run-without-impact", "v1")]
    assert [(f.fault, f.run) for f in findings] == missed
    data = bench.masked(together((bench.record,)))
    assert [data.size(run) for run in range(2)] == [0, 0]
    v = session.discover(record, threads=1).verdict
    assert (v.named, [(f.fault, f.run) for f in v.faults]) == ([], missed)
    # As probable as before, and nothing above noise.
    assert v.probabilities["none"] == pytest.approx(0.3, abs=0.02)
    assert sum(v.probabilities.values()) == pytest.approx(1.0)
    assert v.gap.fitted.before == v.gap.fitted.after == 1.0
    assert v.reasons[0].startswith("nothing was measured")


@pytest.mark.parametrize("level", [0.0, SIGMA])
def test_a_shot_of_which_little_is_expected_is_blank_where_all_others_are(level):
    """Its noise was an effect that lets nothing through. One that shows no noise is, whatever others are."""
    record = made(speeds=(0.05, 0.9))[0]
    seen = predicted(together((record,)))
    assert 7.0 * SIGMA < np.abs(seen["v0"]["g4"]).max() < 20.0 * SIGMA
    noises = {"g4": NOISE, "g7": NOISE[::-1], "wall": 2.0 * NOISE}
    for gauge, noise_ in noises.items():
        record = altered(record, gauge, lambda _, own=noise_: level * own, "v0")
    assert [f.run for f in examine(record, seen)[1]] == ([] if level else ["v0"])
    for gauge, noise_ in noises.items():
        record = altered(record, gauge, lambda _, own=noise_: SIGMA * np.roll(own, 100), "v1")
    found = {(f.fault, f.run) for f in examine(record, seen)[1]}
    assert found == {("run-without-impact", "v0"), ("run-without-impact", "v1")}
