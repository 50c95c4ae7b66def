"""Records with slips: valid, reproducible, silent about what was done to them, and wrong in that alone."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from sonicvacuum import records
from sonicvacuum.discover.faults.table import FAULTS, told
from sonicvacuum_blind import slip_cases, slip_score
from sonicvacuum_blind.design import Design
from sonicvacuum_blind.plan import Gauge, Plan, Solid
from sonicvacuum_blind.record import as_record
from sonicvacuum_blind.slips import ALONE, FAR, SLIPS, Bench, applies

NO_VERDICT = {"faults": [], "named": [], "probabilities": {"none": 1.0}, "timing_s": {"total": 1.0}}
TRUTH = {"id": "x", "setup": 0, "slip": "gauge-dead", "run": None, "sensor": ["g2"], "effects": ["tsuji"]}
TRUTH |= {"d_prime": None}


STEEL = Solid("stainless-steel", 193e9, 0.3)


def plan(gauges, speed=0.3):
    """Eight steel beads."""
    return Plan(8, STEEL, STEEL, STEEL, 2e-3, math.inf, 4e-4, 4e-4, speed, gauges=gauges)


@pytest.fixture(scope="module")
def sound():
    """A record without slips: smooth pulses, later at each gauge and higher in each run."""
    gauges = (Gauge("g1", "embedded", 3), Gauge("g2", "embedded", 5), Gauge("wall", "wall"))
    runs = tuple(plan(gauges, v) for v in (0.2, 0.4, 0.8))
    design = Design("traces", runs, None, 1e-6, 480, sigma=(0.1, 0.1, 0.1))
    later = np.arange(480.0) - np.array([160.0, 200.0, 260.0])[None, :, None]
    traces = np.array([5.0, 10.0, 20.0])[:, None, None] * np.exp(-((later / 20.0) ** 2))
    noise = np.random.default_rng(np.random.SeedSequence(2)).normal(size=traces.shape)
    return as_record(design, traces + 0.1 * noise, np.zeros(0), "sound")


def slipped(record, name):
    """The record with a slip of what was written down."""
    random = np.random.default_rng(np.random.SeedSequence(3))
    return SLIPS[name].written(Bench(record, 60.0, random))


@pytest.mark.parametrize("name", [s.id for s in SLIPS.values() if s.plan is None and s.id != "sound"])
def test_a_slip_changes_the_record_and_leaves_it_valid(sound, tmp_path, name):
    made, place = slipped(sound, name)
    records.write(made, tmp_path / "slips-0001")
    again = records.read(tmp_path / "slips-0001")
    assert again.block == made.block
    same = all(again.signals[k].equals(s) for k, s in sound.signals.items())
    assert not (same and made.block == sound.block)
    assert place.run is None or set(place.run.split(" and ")) <= set(sound.signals)
    assert place.sensor is None or set(place.sensor) <= {s.id for s in sound.block.sensors}


def test_every_slip_is_named_by_the_vocabulary():
    named = {fault for slip in SLIPS.values() for fault in slip.faults}
    assert named == set(map(told, FAULTS))


def test_every_slip_is_made_in_every_set_up_with_an_effect_and_without():
    every = slip_cases.cases()
    made = {(c.slip, c.setup, bool(c.effect)) for c in every}
    count = 2 * len(slip_cases.SETUPS) * len(set(SLIPS) - set(ALONE))
    assert len(every) == len({c.id for c in every}) == len(made) == count
    assert every == slip_cases.cases()


def test_slips_of_one_run_alone_stand_in_a_list_of_their_own():
    every = slip_cases.alone()
    made = {(c.slip, c.setup, bool(c.effect), c.spec.seed) for c in every}
    seeds = slip_cases.ALONE_SEEDS
    assert len(every) == len(made) == 2 * len(slip_cases.SETUPS) * len(ALONE) * len(seeds)
    assert {c.spec.seed for c in every} == set(seeds)
    assert set(seeds).isdisjoint(c.spec.seed for c in slip_cases.cases())


def test_a_run_alone_is_shifted_or_struck_as_said(sound):
    late, place = slipped(sound, "run-late")
    shifts = {k: s.time_us[0] - sound.signals[k].time_us[0] for k, s in late.signals.items()}
    assert {k for k, shift in shifts.items() if shift} == {place.run}
    assert 0.2 * 60.0 - 0.5 <= abs(shifts[place.run]) <= 2.0 * 60.0 + 0.5  # in whole samples
    far, place = slipped(sound, "run-far-off")
    before, after = (
        next(r.striker.speed_m_s for r in x.block.runs if r.id == place.run) for x in (sound, far)
    )
    assert before / after in [pytest.approx(f, rel=1e-3) for f in FAR]  # four digits of the speed


def test_beside_systematic_errors_each_size_comes_in_turn_in_a_list_of_its_own():
    usual, smooth = slip_cases.cases(), slip_cases.cases(smooth=True)
    assert {c.size for c in usual} == {0.0}
    assert [c.size for c in smooth[:4]] == [0.003, 0.01, 0.03, 0.003]
    assert {c.spec.seed for c in smooth}.isdisjoint(c.spec.seed for c in usual)
    assert {c.spec.d_prime for c in smooth if c.effect} == {100.0}
    assert [(c.slip, c.setup) for c in smooth] != [(c.slip, c.setup) for c in usual]


def test_a_systematic_error_has_its_size_and_is_of_each_record_its_own():
    one, other = (c for c in slip_cases.cases(smooth=True)[1:5:3] if c.size == 0.01)
    peak = np.exp(-(((np.arange(480.0) - 200.0) / 20.0) ** 2))
    clean = SimpleNamespace(traces=np.tile(peak, (3, 2, 1)) * np.array([5.0, 10.0, 20.0])[:, None, None])
    design = SimpleNamespace(runs=[SimpleNamespace(speed=v) for v in (0.2, 0.4, 0.8)])
    off = [slip_cases._off(c, clean, design) for c in (one, other)]
    within = off[0][:, :, 180:280] / clean.traces.max(axis=2, keepdims=True)
    assert np.sqrt(np.square(within).mean()) == pytest.approx(0.01, rel=0.5)  # a few correlation times
    assert np.abs(off[0] - off[1]).max() > 0.005 * clean.traces.max()
    np.testing.assert_array_equal(off[0], slip_cases._off(one, clean, design))


def test_a_slip_is_made_only_where_it_can_be():
    alone = plan((Gauge("g1", "embedded", 8),))
    assert not applies(SLIPS["gauges-swapped"], alone, 3)
    assert not applies(SLIPS["gauge-misplaced"], alone, 3)  # there is no bead behind the last one
    assert not applies(SLIPS["runs-swapped"], alone, 1)
    assert applies(SLIPS["bead-mass-3"], alone, 1)


@pytest.mark.parametrize(
    ("faults", "named", "counted"),
    [
        ([("gauge-dead", "g2", 0.99)], ["tsuji"], (1, 1, 0, 0, 1)),
        ([("gauge-dead", "g1", 0.99)], ["tsuji"], (0, 0, 1, 0, 1)),  # another gauge
        ([("gauge-dead", "g2", 0.3)], ["sensor-gain"], (0, 1, 0, 1, 0)),
        ([], ["sensor-gain", "unknown"], (0, 0, 0, 0, 0)),  # a word of unknown is no confidence
    ],
)
def test_what_is_named_where_counts(faults, named, counted):
    told = [{"fault": f, "run": None, "sensor": s, "probability": p} for f, s, p in faults]
    verdict = NO_VERDICT | {"faults": told, "named": named, "probabilities": {" + ".join(named): 1.0}}
    row = slip_score.row(TRUTH, verdict)
    found = row.slip_named, row.slip_listed, row.wrong_slip, row.confident_wrong, row.effect_named
    assert found == counted


def test_shares_leave_out_what_the_data_cannot_show():
    hidden = slip_score.row(TRUTH | {"slip": "bead-mass-3", "d_prime": 4.0, "sensor": None}, NO_VERDICT)
    plain = slip_score.row(TRUTH, NO_VERDICT)
    lines = {(x.measure, x.group): x for x in slip_score.summary([hidden, plain])}
    assert lines["slip named", "that the data can show"].count == 1
    assert lines["slip named", "all"].count == 2
    assert lines["true effect named", "slip that can be put right"].value == 0.0
