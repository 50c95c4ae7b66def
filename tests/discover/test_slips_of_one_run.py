"""A run that was triggered at another moment than the others, or struck far from its stated speed."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes, judged
from sonicvacuum.discover.faults.competition import Search
from sonicvacuum.discover.faults.found import Bench
from sonicvacuum.discover.faults.slips import Slip, hypotheses
from sonicvacuum.discover.faults.timing import gauge_delay
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.records import Signals
from sonicvacuum.report import bench


@pytest.mark.parametrize(
    ("change", "slip", "value"),
    [
        # Twelve standard errors of the trigger; the pulse is 25 us wide.
        (lambda r: changes.time_zero(r, {"v1": 12.0}, 0.0), "time-zero", -12.0),
        (lambda r: changes.time_zero(r, {"v1": -90.0}, 0.0), "time-zero", 90.0),
        # Beyond what slopes at the stated speed lead to.
        (lambda r: changes.strikers(r, "speed_m_s", -np.log(2.0), ("v1",)), "run-off", 2.0),
        (lambda r: changes.strikers(r, "speed_m_s", np.log(10.0), ("v1",)), "run-off", 0.1),
        (lambda r: changes.strikers(r, "speed_m_s", -np.log(10.0), ("v0",)), "run-off", 10.0),
    ],
)
def test_it_is_told_with_its_size_and_nothing_is_missing(empty, change, slip, value):
    found = session.discover(change(empty), catalogue=CATALOGUE, limits=False).verdict
    assert found.named == []
    (one,) = found.faults
    assert (one.fault, one.run) == (slip, "v1" if value != 10.0 else "v0")
    assert one.probability > 0.95
    # The trigger's own error is 1 us, that of a speed 1 %.
    assert one.value == pytest.approx(value, rel=0.03, abs=2.0 if slip == "time-zero" else 0.0)
    if slip == "time-zero":
        (said,) = bench.slips(found)
        way = "before" if value < 0.0 else "after"
        assert f"us {way} the impact in run v1" in said


@pytest.mark.parametrize(
    ("fault", "run", "sensor", "gain", "of_it"),
    [
        ("time-zero", "v1", None, 145.0, True),
        ("run-off", "v1", None, 145.0, True),
        ("time-zero", "v1", None, 55.0, False),
        # Something else is missing besides.
        ("time-zero", "v1", None, 130.0, False),
        ("gain", None, "g4", 145.0, False),
    ],
)
def test_one_that_takes_away_nearly_all_is_of_one_run(monkeypatch, empty, fault, run, sensor, gain, of_it):
    monkeypatch.setattr(judged, "excess", lambda model: 150.0)
    slip = Slip(fault, None, run=run, sensor=sensor, width=1.0)
    one = judged.Judged(slip, 0.1, gain, 0.5 * gain)
    assert judged.of_one_run(one, SimpleNamespace(bench=Bench(empty))) is of_it


@pytest.mark.parametrize(("gained", "sure"), [(100.0, True), (140.0, False)])
def test_it_is_put_right_before_sets_where_no_effect_alone_gains_nearly_as_much(
    monkeypatch, empty, gained, sure
):
    monkeypatch.setattr(judged, "excess", lambda model: 150.0)
    search = Search(Bench(empty), CATALOGUE, 1, [])
    search._alone = SimpleNamespace(beside=lambda model: [SimpleNamespace(gain=gained)])
    slip = Slip("time-zero", None, run="v1", width=1.0)
    one = judged.Judged(slip, 0.1, 145.0, 70.0)
    assert search._sure(one, SimpleNamespace(bench=Bench(empty))) is sure


def test_a_slip_that_was_judged_beside_an_effect_too_is_said_once():
    one, other = (Slip("time-zero", None, run=run, width=1.0) for run in ("v0", "v1"))
    odds = ((one, 8.0), (one, 9.0), (other, 8.5))
    nominal, beside, elsewhere = (judged.Judged(slip, 0.1, 0.0, log) for slip, log in odds)
    assert judged.each_once([nominal, elsewhere, beside]) == [beside, elsewhere]


def test_a_gauge_at_one_bead_or_another_is_not_the_same_slip():
    beads = [Slip("gauge-misplaced", None, sensor="g4", value=lambda _, bead=b: bead) for b in (3.0, 5.0)]
    both = [judged.Judged(slip, 0.0, 0.0, log) for slip, log in zip(beads, (9.0, 8.0), strict=True)]
    assert judged.each_once(both) == both


def test_a_gauge_is_not_put_right_by_as_much_as_its_record_lasts(empty):
    """Where a clock cuts most pulses off, traces fit where they meet the model's least."""
    slip = next(s for s in hypotheses(empty) if s.fault == "gauge-delayed" and s.sensor == "wall")
    pulse = np.exp(-(((np.arange(700) - 30.0) / 5.0) ** 2))
    seen = {run: {"g4": pulse, "wall": pulse} for run in empty.signals}

    def late(by):
        readings = {"g4": pulse, "wall": np.roll(pulse, by)}
        signals = {run: Signals(s.time_us, readings) for run, s in empty.signals.items()}
        return gauge_delay(slip, replace(empty, signals=signals), seen)

    assert late(100) == pytest.approx(100.0)
    assert late(600) == 0.0  # of 700
