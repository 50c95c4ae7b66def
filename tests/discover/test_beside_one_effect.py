"""A slip without a size beside one strong effect is put right before sets of effects are asked for."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import alone, changes, competition, searching
from sonicvacuum.discover.faults.judged import Judged, Model
from sonicvacuum.discover.faults.slips import Slip
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.effects import CATALOGUE

SIZE = 1000
NOISE = SIZE + 50.0  # a standard deviation of χ² is 45
GROSS = 5.0 * SIZE


def model(leaves):
    """A model of as many data, beside which the best effect leaves that."""
    experiment = SimpleNamespace(runs=[None], size=lambda run: SIZE)
    forward = SimpleNamespace(experiment=experiment, chains=0)
    return SimpleNamespace(forward=forward, leaves=leaves, fit=SimpleNamespace(objective=101.0 * SIZE))


def slip(fault, leaves, width=0.0, of_values=False, gain=100.0):
    one = Slip(fault, None, width=width, of_values=of_values)
    return Judged(one, 0.0, gain, 0.5 * gain, model(leaves))


@pytest.fixture
def all_near(monkeypatch):
    """Beside any slip a leading effect explains more."""
    monkeypatch.setattr(alone, "nearer", lambda before, forward, fits: (True, 0))


@pytest.mark.usefixtures("all_near")
@pytest.mark.parametrize(
    ("as_is", "slips", "chosen"),
    [
        (GROSS, [("gauges-swapped", GROSS), ("gauge-misplaced", NOISE)], "gauge-misplaced"),
        # An effect is enough without any.
        (NOISE, [("gauge-misplaced", NOISE)], None),
        # Two that both do it have to be weighed.
        (GROSS, [("bead-count", NOISE), ("gauge-misplaced", NOISE)], None),
        (GROSS, [("gauge-misplaced", GROSS)], None),
        (GROSS, [], None),
    ],
)
def test_the_only_one_that_leaves_noise_is_chosen(monkeypatch, as_is, slips, chosen):
    monkeypatch.setattr(alone, "alone", lambda m, only=(): (best(m.leaves), 100))
    kept = alone.Kept()
    found = kept.explained([slip(*one) for one in slips], model(as_is))
    assert (found and found.slip.fault) == chosen
    assert kept.simulations == 100 * (1 + len(slips) * (as_is == GROSS))


@pytest.mark.usefixtures("all_near")
@pytest.mark.parametrize(
    ("leaves", "ranked", "chosen"),
    [
        (9.0, GROSS, "gauges-swapped"),
        # What is left is no more than what sets of effects may explain.
        (3.0, GROSS, None),
        # One that gains by itself does it.
        (9.0, NOISE, "gauge-misplaced"),
    ],
)
def test_a_slip_that_an_effect_hides_is_asked_for_where_nothing_else_will_do(
    monkeypatch, leaves, ranked, chosen
):
    monkeypatch.setattr(alone, "alone", lambda m, only=(): (best(m.leaves), 0))
    behind = [slip("gauges-swapped", NOISE), slip("bead-count", GROSS)]
    found = alone.Kept().explained([slip("gauge-misplaced", ranked)], model(leaves * SIZE), behind)
    assert (found and found.slip.fault) == chosen


@pytest.mark.usefixtures("all_near")
@pytest.mark.parametrize("hidden", [False, True])
@pytest.mark.parametrize(("leaves", "chosen"), [(1.5, True), (9.0, True), (1.1, False)])
def test_a_slip_that_traces_show_is_asked_for_beside_effects_that_leave_little(
    monkeypatch, leaves, chosen, hidden
):
    """A gauge at the wall stated in the last bead is hidden by damping, and much like one off centre."""
    monkeypatch.setattr(alone, "alone", lambda m, only=(): (best(m.leaves), 0))
    one = slip("gauge-misplaced", NOISE)
    one = replace(one, slip=replace(one.slip, shown=True))
    others = [slip("bead-count", GROSS)]
    given = (others, [one]) if hidden else ([*others, one], [])
    found = alone.Kept().explained(given[0], model(leaves * SIZE), given[1])
    assert (found is one) is chosen
    unshown = alone.Kept().explained([slip("gauge-misplaced", NOISE)], model(1.5 * SIZE))
    assert unshown is None


def test_slips_beside_which_leading_effects_explain_less_are_passed_over(monkeypatch):
    """In a dimer under a dashpot, which left 5.5 times the noise at a first look, effects were followed
    beside thirteen exchanges of gauges, for half of the time that its verdict took.
    """
    asked = []
    monkeypatch.setattr(alone, "alone", lambda m, only=(): (asked.append(m) or best(m.leaves), 100))
    ranked, behind = (
        [slip("gauge-misplaced", GROSS)],
        [slip("gauges-swapped", NOISE), slip("bead-count", NOISE)],
    )
    far = [j.model.forward for j in (*ranked, behind[1])]
    monkeypatch.setattr(alone, "nearer", lambda before, forward, fits: (forward not in far, 3))
    kept, as_is = alone.Kept(), model(9.0 * SIZE)
    assert kept.explained(ranked, as_is, behind) is behind[0]
    assert asked == [as_is, behind[0].model]
    assert kept.simulations == 2 * 100 + 3 * 3


def test_an_effect_comes_nearer_beside_a_slip_that_was_made():
    """Two gauges exchanged in a damped chain: damping is nearer to what they show in their places;
    beside an exchange of two that stand in theirs it is farther.
    """
    record, _ = made([("kuwabara-kono", {"time_us": 1.0})], seed=3)
    crossed = changes.gauges_swapped(record, "g4", "g7")
    setup = setup_of(Forward(experiment(record)))
    damping = CATALOGUE.effect("kuwabara-kono")
    law = Hypothesis((Component(damping, variants(damping, setup)[0]),))
    fits, put = {}, {}
    for name, one in (
        ("crossed", crossed),
        ("right", record),
        ("wall", changes.gauges_swapped(record, "g7", "wall")),
    ):
        put[name] = Forward(experiment(one))
        start = np.zeros((1, put[name].layout.size))
        fits[name] = fit(put[name], law, np.zeros((1, 1)), start)
    assert alone.nearer(put["crossed"], put["right"], [fits["crossed"]])[0]
    assert not alone.nearer(put["right"], put["crossed"], [fits["right"]])[0]
    assert not alone.nearer(put["right"], put["wall"], [fits["right"]])[0]


@pytest.mark.usefixtures("all_near")
@pytest.mark.parametrize(("share", "every"), [(0.9, True), (0.03, False)])
def test_every_effect_is_asked_beside_a_slip_that_takes_most_of_the_misfit_away(monkeypatch, share, every):
    asked = []
    monkeypatch.setattr(alone, "alone", lambda m, only=(): (asked.append(only) or best(m.leaves), 0))
    slips = [slip("bead-count", GROSS, gain=share * 100.0 * SIZE), slip("gauge-misplaced", GROSS)]
    alone.Kept().explained(slips, model(GROSS))
    leading = {"one", "another"}
    assert [set(only) for only in asked[1:]] == [set() if every else leading, leading]


@pytest.mark.parametrize(
    ("leaves", "slips", "chosen"),
    [
        (GROSS, {"gauge-misplaced": 4000.0, "bead-count": 3000.0}, "gauge-misplaced"),
        # Two that do it have to be weighed, and none may.
        (GROSS, {"gauge-misplaced": 4000.0, "run-off": 3990.0}, None),
        (GROSS, {"bead-count": 3000.0}, None),
        # An effect that explains no more than most may be no effect.
        (20.0 * SIZE, {"gauge-misplaced": 19_000.0}, None),
        (NOISE, {"gauge-misplaced": 30.0}, None),
    ],
)
def test_a_slip_is_asked_for_beside_the_effect_that_explains_nearly_all(leaves, slips, chosen):
    beside = [Judged(Slip(fault, None), 0.0, gain, 0.5 * gain) for fault, gain in slips.items()]
    as_is = Model(None, model(0.0).forward, SimpleNamespace(objective=101.0 * SIZE))
    search = object.__new__(competition.Search)
    search.behind, search._alone = ["kept"], SimpleNamespace(beside=lambda m: best(leaves))
    search.ranked = lambda m, afar, least: beside if m.fit.objective == leaves and afar else []
    found = search._beside_the_leading(as_is)
    assert (found and found.slip.fault) == chosen
    assert search.behind == ["kept"]


def best(leaves):
    """Two effects; the better one leaves that."""
    ends = {"one": leaves, "another": leaves + 9000.0}
    return [SimpleNamespace(effect=k, fit=SimpleNamespace(objective=v)) for k, v in ends.items()]


@pytest.mark.usefixtures("all_near")
def test_few_values_need_more_than_their_own_number(monkeypatch):
    """Of a table of twenty what is left may be twice its noise and a chance."""
    monkeypatch.setattr(alone, "data", lambda forward: 20)
    monkeypatch.setattr(alone, "alone", lambda m, only=(): (best(m.leaves), 0))
    near, far = (alone.Kept().explained([slip("bead-count", 25.0)], model(x)) for x in (100.0, 300.0))
    assert near is None and far is not None


def test_what_has_a_size_or_is_a_value_is_weighed_against_effects():
    given = [slip("clock", NOISE, width=0.01), slip("runs-swapped", NOISE, of_values=True)]
    assert alone.wholes([*given, slip("bead-count", NOISE)])[0].slip.fault == "bead-count"
    assert alone.wholes(given) == []


def test_single_effects_are_fitted_once_for_a_model(monkeypatch):
    asked = []
    monkeypatch.setattr(alone, "alone", lambda m: (asked.append(m) or [m], 0))
    kept, one, other = alone.Kept(), model(NOISE), model(GROSS)
    assert kept.at_hand(one) is None
    assert kept.beside(one) == kept.beside(one) == kept.at_hand(one) == [one]
    assert kept.beside(other) == [other] and kept.at_hand(one) is None
    assert asked == [one, other]


@pytest.mark.long
@pytest.mark.parametrize(
    ("left", "slip", "told"),
    [
        (0.3, lambda record: changes.gauge_moved(record, "g4", 1), ("gauge-misplaced", "g4", 4.0)),
        # Of the record as it is four other effects explain more.
        (
            0.5,
            lambda record: changes.gauges_swapped(record, "g4", "g7"),
            ("gauges-swapped", ["g4", "g7"], None),
        ),
    ],
)
def test_sets_of_effects_are_not_asked_for_where_gauges_stand_in_wrong_places(monkeypatch, left, slip, told):
    gauges = [
        {"id": "g4", "kind": "embedded", "bead": 4, "sigma_N": 0.1, "gain_rel_sigma": 0.02},
        {"id": "g7", "kind": "embedded", "bead": 7, "sigma_N": 0.1, "gain_rel_sigma": 0.02},
        {"id": "wall", "kind": "wall", "sigma_N": 0.2, "gain_rel_sigma": 0.02},
    ]
    record, _ = made(
        [("plastic-contact", {"residual_fraction": left})], seed=5, speeds=(0.3, 0.45, 0.6), sensors=gauges
    )
    investigated, investigate = [], searching.investigate
    monkeypatch.setattr(
        searching, "investigate", lambda e, *given: investigated.append(e) or investigate(e, *given)
    )
    found = session.discover(slip(record)).verdict
    assert found.named == ["plastic-contact"]
    assert [(f.fault, f.sensor, f.value) for f in found.faults] == [told]
    assert len(investigated) == 1
