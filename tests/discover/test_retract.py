"""Slips that an effect feigns in a trace are taken back beside it; those that were made are kept."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from made_records import SIGMA, made
from made_slips import altered

from sonicvacuum.blas import one_thread
from sonicvacuum.discover.faults import competition
from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.faults.retract import retracted
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import together
from sonicvacuum.discover.search import singles
from sonicvacuum.effects import CATALOGUE, effect

# N, per bead: the slow shot's pulse dies ahead of the first gauge, whose reading is left upside down; with
# more it leaves nothing there.
FRICTION, MORE = 0.7, 1.0
TIME = np.arange(700.0)
SHOT = "run-without-impact"


def make(bench):
    return bench.masked(together((bench.record,)))


@one_thread
def beside_friction(record, left, friction=FRICTION, told=None):
    """What is taken back beside friction, and the slips that the traces showed, or that are told."""
    seen = predicted(together((record,)))
    bench, findings = told or examine(record, seen)
    forward = Forward(make(bench))
    (free,) = variants(effect("guide-friction"), singles.setup_of(forward))[0]
    # Beyond the catalogue's range, which ends at 0.1 N, as a search follows it.
    free = dataclasses.replace(free, high=free.inverse(3.0 * friction))
    alone = Hypothesis((Component(effect("guide-friction"), (free,)),))
    nuisances = np.zeros((1, forward.layout.size))
    null = fit(forward, Hypothesis(), np.zeros((1, 0)), nuisances)
    final = fit(forward, alone, np.array([[free.inverse(friction)]]), nuisances)
    found = SimpleNamespace(forward=forward, null=null, final=final, named=["guide-friction", *left])
    return retracted(found, findings, record, seen, make), {(f.fault, f.sensor or f.run) for f in findings}


@pytest.fixture(scope="module")
def dying():
    return made([("guide-friction", {"force_N": FRICTION})], seed=1)[0]


def turned(record):
    """A record whose first gauge is taken for upside down in the slow shot."""
    told = Finding("gauge-inverted", "v0", "g4", None, 0.999, corrected=True)
    return Bench(altered(record, "g4", np.negative, "v0")), [told]


def test_a_pulse_that_dies_is_not_upside_down(dying):
    """Beside the median of what is left of it, it was."""
    assert not examine(dying, predicted(together((dying,))))[1]
    taken_back, shown = beside_friction(dying, ["unknown"], told=turned(dying))
    assert taken_back == shown == {("gauge-inverted", "g4")}


def test_what_a_pulse_leaves_behind_is_no_drift():
    """What is told as a drift is taken back beside friction, which explains the trace; it shows none."""
    record = made([("guide-friction", {"force_N": 0.07})], seed=1, speeds=(0.05, 0.9))[0]
    assert not examine(record, predicted(together((record,))))[1]
    line = 0.15 * (TIME / 700.0 - 0.2)
    told = Finding("drift", "v0", "g4", 0.15, 0.999, corrected=True)
    put_right = Bench(altered(record, "g4", lambda y: y - line, "v0"))
    taken_back, shown = beside_friction(record, ["unknown"], 0.07, (put_right, [told]))
    assert taken_back == shown == {("drift", "g4")}


def test_where_nothing_is_left_no_slip_is_asked_for(dying):
    assert beside_friction(dying, [], told=turned(dying))[0] == set()


def test_a_gauge_that_is_upside_down_stays_so_beside_friction():
    record = altered(made([("guide-friction", {"force_N": 0.2})], seed=1)[0], "g7", np.negative)
    taken_back, shown = beside_friction(record, ["unknown"])
    assert shown == {("gauge-inverted", "g7")}
    assert taken_back == set()


def test_a_shot_whose_pulse_dies_has_struck():
    record = made([("guide-friction", {"force_N": MORE})], seed=1)[0]
    taken_back, shown = beside_friction(record, [], MORE)
    assert taken_back == shown == {("run-without-impact", "v0")}
    assert not examine(record, predicted(together((record,))), taken_back)[1]


@pytest.mark.parametrize("gauge", ["g4", "g7", "wall"])
def test_silence_that_friction_does_not_foresee_is_a_slip(gauge):
    sound = made([("guide-friction", {"force_N": 0.2})], seed=1)[0]
    noise = np.random.default_rng(np.random.SeedSequence(5)).normal(0.0, SIGMA, 700)
    record = altered(sound, gauge, lambda trace: noise)
    taken_back, shown = beside_friction(record, [], 0.2)
    assert ("gauge-dead", gauge) in shown
    assert taken_back == set()


def test_a_shot_that_missed_is_kept_out():
    record = made([("guide-friction", {"force_N": 0.2})], seed=1)[0]
    noise = np.random.default_rng(np.random.SeedSequence(6)).normal(0.0, SIGMA, (3, 700))
    for gauge, trace in zip(("g4", "g7", "wall"), noise, strict=True):
        record = altered(record, gauge, lambda _, trace=trace: trace, "v0")
    taken_back, shown = beside_friction(record, [], 0.2)
    assert shown == {("run-without-impact", "v0")}
    assert taken_back == set()


@pytest.mark.parametrize("slip", [{"fault": "gauge-dead", "sensor": "g4"}, {"fault": SHOT, "run": "v0"}])
@pytest.mark.parametrize("name", [e.id for e in CATALOGUE if e.id.startswith("sensor")])
def test_a_gauge_that_reads_nothing_is_no_effect_in_place_of_a_dead_one(dying, name, slip):
    """A low-pass of all gauges took back that no shot had struck."""
    of_gauges = SimpleNamespace(effect=effect(name))
    final = SimpleNamespace(hypothesis=SimpleNamespace(components=(of_gauges,)), objective=0.0)
    experiment = SimpleNamespace(sigma=None, correlation=None, colours=())
    found = SimpleNamespace(
        forward=SimpleNamespace(experiment=experiment), null=None, final=final, named=[name]
    )
    assert retracted(found, [Finding(**slip, corrected=True)], dying, {}, make) == set()


def test_a_gauge_that_is_stuck_stays_dead_whatever_effects_say_of_it(dying):
    """No sample of it counts, so that it contradicts none."""
    stuck = altered(dying, "wall", lambda y: np.full_like(y, 3.0))
    taken_back, shown = beside_friction(stuck, [])
    assert ("gauge-dead", "wall") in shown
    assert ("gauge-dead", "wall") not in taken_back


def test_once_a_slip_is_taken_back_the_others_are_asked_for_again(monkeypatch):
    """A gauge that a strong damper seemed to turn over hid that drift and level of another were its work."""
    asked, searched = [], []
    answers = [{("gauge-inverted", "g4")}, {("drift", "g7"), ("baseline", "g7")}, set()]

    class Found:
        forward, final, named = None, None, ("linear-dashpot",)

    class Searched:
        catalogue = threads = make = None

        def __init__(self, *given):
            searched.append(given)

        def run(self):
            return competition.Outcome(Found(), (), None, 1)

    def retracted(found, findings, record, seen, make, spared):
        asked.append(set(spared))
        return answers[len(asked) - 1]

    monkeypatch.setattr(competition, "Search", Searched)
    monkeypatch.setattr(competition, "retracted", retracted)
    monkeypatch.setattr(competition, "examine", lambda record, seen, spared: (frozenset(spared), []))
    monkeypatch.setattr(competition, "value", lambda forward, final: 0.0)
    monkeypatch.setattr(competition, "unexplained", lambda found: False)
    first = competition.Outcome(Found(), (), None, 1)
    found = competition._asked_again(first, [], None, {}, Searched())
    assert asked == [set(), answers[0], answers[0] | answers[1]]
    assert [given[0] for given in searched[1:]] == asked[1:]
    assert found.simulations == 3
