"""Explanations: their keys, shares among names that act alike, what is named being the likeliest."""

import math
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit.calibration import Calibration
from sonicvacuum.discover.judge import beside, degenerate, explanations
from sonicvacuum.effects import CATALOGUE


def single(name, log_bayes):
    return SimpleNamespace(effect=name, log_bayes=log_bayes)


def several(names, log_bayes):
    return SimpleNamespace(effects=names, log_bayes=log_bayes)


@given(st.lists(st.sampled_from(["tsuji", "gravity", "sensor-droop", "unknown"]), unique=True))
def test_keys_and_effects_are_each_others_inverse(names):
    key = explanations.key(names)
    assert sorted(explanations.effects(key)) == sorted(names)
    assert not names or key == " + ".join(sorted(names, key=lambda n: (n == "unknown", n)))


@given(st.floats(-20.0, 60.0), st.floats(-20.0, 60.0), st.floats(1e-9, 0.9))
def test_probabilities_of_sets_add_up_to_one(one, two, p):
    logs = explanations.log_weights([single("tsuji", one)], [several(("tsuji", "gravity"), two)])
    beside = {"none": 0.0, "tsuji": one}
    for given_ in (None, beside):
        found = explanations.probabilities(logs, p, given_)
        assert sum(found.values()) == pytest.approx(1.0, abs=1e-9)  # rounding


def test_a_set_has_a_probability_of_its_own():
    logs = explanations.log_weights([single("tsuji", 80.0)], [several(("tsuji", "gravity"), 200.0)])
    found = explanations.probabilities(logs, 0.5)
    assert found["gravity + tsuji"] > 0.85


def test_a_set_may_stand_for_something_unknown_where_one_effect_hardly_does():
    """Of 108 sets of five fresh samples 79 were right and 7 stood for something outside the catalogue, of the
    last 56 one.
    """
    one = explanations.log_weights([single("tsuji", 80.0)], [])
    two = explanations.log_weights([single("tsuji", 80.0)], [several(("tsuji", "gravity"), 200.0)])
    alone, together = (explanations.probabilities(logs, 0.5)["unknown"] for logs in (one, two))
    assert alone < 0.01
    assert 0.02 < together < 0.09


def test_something_left_goes_to_the_set_that_stands_beside_it():
    logs = explanations.log_weights([single("tsuji", 80.0)], [])
    found = explanations.probabilities(logs, 1e-30, {"none": 0.0, "tsuji": 40.0})
    assert found["tsuji + unknown"] > 0.99
    assert explanations.probabilities(logs, 1e-30)["unknown"] > 0.99


def test_names_that_act_alike_share_by_their_evidence():
    """Nothing tells two names apart: equal shares. A law that contains another has its Occam factor less."""
    plain = Calibration(temper=1.0)
    found = [single("tsuji", 50.0), single("gravity", 50.0), single("velocity-power", 50.0 - math.log(3.0))]
    odds = explanations.probabilities(explanations.log_weights(found, []), 0.9, None, plain)
    assert odds["tsuji"] == pytest.approx(odds["gravity"])
    assert odds["tsuji"] == pytest.approx(3.0 * odds["velocity-power"])
    total = sum(odds[c.effect] for c in found)
    assert total == pytest.approx(1.0 - odds["unknown"], rel=1e-6)  # none: e^-50


def test_odds_of_the_record_multiply_those_of_the_catalogue():
    found = [single("tsuji", 3.0), single("gravity", 4.0)]
    pair = [several(("tsuji", "gravity"), 5.0)]
    usual = explanations.log_weights(found, pair)
    stated = explanations.log_weights(found, pair, {"tsuji": 10.0})
    assert stated["tsuji"] - usual["tsuji"] == pytest.approx(math.log(10.0))
    assert stated["gravity + tsuji"] - usual["gravity + tsuji"] == pytest.approx(math.log(10.0))
    assert (stated["gravity"], stated["none"]) == (usual["gravity"], usual["none"])
    excluded = explanations.log_weights(found, pair, {"gravity": 0.0})
    assert set(excluded) == {"none", "tsuji"}


def test_what_is_named_is_likelier_than_all_that_was_refused_together():
    many = {f"effect {k}": 0.05 for k in range(19)}
    found, likelier = explanations.consistent({**many, "unknown": 0.049, "none": 0.001}, ["unknown"])
    assert likelier in many
    assert found["unknown"] == policy.REFUSED_UNKNOWN
    assert math.isclose(sum(found.values()), 1.0)


def test_what_failed_a_test_is_not_left_the_likeliest():
    found, likelier = explanations.consistent({"none": 0.2, "tsuji": 0.7, "unknown": 0.1}, [])
    assert likelier == "tsuji"
    assert max(found, key=found.get) == "none"
    assert math.isclose(sum(found.values()), 1.0)
    spread = {"none": 0.1} | {f"effect {k}": 0.15 for k in range(6)}
    assert explanations.consistent(spread, [])[0]["none"] == policy.REFUSED_NONE
    assert explanations.consistent({"none": 0.1, "tsuji": 0.9}, ["tsuji"]) == (
        {"none": 0.1, "tsuji": 0.9},
        "",
    )


def test_names_beside_something_unknown_are_no_surer_than_such_names_came_true():
    odds = {"tsuji + unknown": 0.99, "unknown": 0.01}
    found, said = explanations.no_surer(odds, ["tsuji", "unknown"])
    assert "tsuji" in said[0]
    assert found == pytest.approx({"tsuji + unknown": policy.ONE_BESIDE, "unknown": 1.0 - policy.ONE_BESIDE})
    smooth, _ = explanations.no_surer(odds, ["tsuji", "unknown"], smooth_only=True)
    assert smooth["tsuji + unknown"] == pytest.approx(policy.SMOOTH_BESIDE)
    less = {"tsuji + unknown": 0.4, "unknown": 0.6}
    assert explanations.no_surer(less, ["tsuji", "unknown"]) == (less, [])
    alone = {"tsuji": 0.99, "unknown": 0.01}
    assert explanations.no_surer(alone, ["tsuji"]) == (alone, [])
    assert explanations.no_surer({"unknown": 1.0}, ["unknown"]) == ({"unknown": 1.0}, [])


def test_of_a_set_beside_shapes_mostly_one_is_there_or_none():
    odds = {"gravity + tsuji + unknown": 0.6, "gravity + kuwabara-kono + unknown": 0.3, "unknown": 0.1}
    named = ["tsuji", "gravity", "unknown"]
    found, said = explanations.no_surer(odds, named)
    assert "tsuji + gravity come nearest" in said[0]
    assert sum(found.values()) == pytest.approx(1.0)
    sets = [found["gravity + tsuji + unknown"], found["gravity + kuwabara-kono + unknown"]]
    # All sets lose alike, so that what cannot be told apart stays so.
    assert sum(sets) == pytest.approx(policy.SET_BESIDE)
    assert sets[0] / sets[1] == pytest.approx(2.0)
    lost = 0.9 - policy.SET_BESIDE
    assert (
        found["tsuji + unknown"] == found["gravity + unknown"] == pytest.approx(policy.ONE_OF_SET * lost / 2)
    )
    assert found["unknown"] == pytest.approx(0.1 + (1.0 - policy.ONE_OF_SET) * lost)
    # A smooth misfit hides no law: there a set stays as likely as all others together.
    smooth, _ = explanations.no_surer({**odds, "gravity + tsuji + unknown": 0.9}, named, smooth_only=True)
    assert smooth["gravity + tsuji + unknown"] == policy.SMOOTH_SET_BESIDE
    few = {"gravity + tsuji + unknown": 0.03, "unknown": 0.97}
    assert explanations.no_surer(few, named) == (few, [])


def test_beside_something_unknown_what_is_confusable_goes_by_probabilities():
    """Evidence on noise alone says nothing there: it counts what the smooth misfit does."""
    odds = {
        "tsuji + unknown": 0.6,
        "kuwabara-kono + unknown": 0.3,
        "gravity + unknown": 0.003,
        "unknown": 0.05,
    }
    named = ["tsuji", "unknown"]
    on_noise = [single("tsuji", 90.0), single("sensor-droop", 89.0), single("kuwabara-kono", 50.0)]
    assert degenerate.confusable(named, on_noise, [], (), odds) == [["tsuji", "kuwabara-kono"]]
    assert degenerate.confusable(named, on_noise, [], ()) == [["tsuji", "sensor-droop"]]


def test_of_a_set_beside_something_unknown_one_effect_at_a_time_is_exchanged():
    odds = {"gravity + tsuji + unknown": 0.5, "tsuji + static-preload + unknown": 0.4, "unknown": 0.1}
    found = degenerate.confusable(["gravity", "tsuji", "unknown"], [], [], (), odds)
    assert found == [["gravity", "static-preload"]]


@pytest.mark.parametrize(
    ("p", "named"),
    [(1e-6, ["linear-dashpot", "sensor-gain"]), (1e-3, ["linear-dashpot", "mass-defect", "sensor-gain"])],
)
def test_no_bead_is_named_beside_a_shape_that_no_smooth_error_has(monkeypatch, p, named):
    """Of tens of places one is always near to what is unknown; a gauge, of three, is told from it."""

    def fit(ids):
        return SimpleNamespace(hypothesis=SimpleNamespace(ids=ids, components=ids))

    def fewer(_forward, _null, one, k):
        return fit([name for place, name in enumerate(one.hypothesis.ids) if place != k])

    monkeypatch.setattr(beside.restart, "fewer", fewer)
    monkeypatch.setattr(beside.unknown, "irreplaceable", lambda *_: [0, 1, 2])
    case = beside.Beside(None, None, [], None, SimpleNamespace(catalogue=CATALOGUE))
    seen, reasons = SimpleNamespace(failed=True, p=p, group="profile"), []
    one = fit(["linear-dashpot", "mass-defect", "sensor-gain"])
    grown = SimpleNamespace(forward=None, null=None)
    kept = case._irreplaceable(grown, one, seen, 10.0, reasons)
    assert kept.hypothesis.ids == named
    assert [r.split()[0] for r in reasons] == (["mass-defect"] if len(named) == 2 else [])


def test_what_was_tried_while_a_set_grew_competes_with_it():
    """Gravity for a preload in a set of four: a twentieth of its probability, which had not been counted."""
    pairs = [several(("tsuji", "gravity"), 10.0), several(("tsuji", "static-preload"), 9.0)]
    rival = several(("tsuji", "gravity", "sensor-droop"), 40.0)
    grown = [single("tsuji", 5.0), rival, several(("gravity", "tsuji"), 8.0)]
    for one in grown[:1]:
        one.effects = (one.effect,)
    own = several(("tsuji", "static-preload", "sensor-droop"), 42.0)
    found = explanations.together(pairs, grown, own)
    assert [c.log_bayes for c in found] == [42.0, 40.0, 10.0, 9.0]


@pytest.mark.parametrize(
    ("found", "rival", "named"),
    [(60.0, 57.0, "tsuji"), (57.0, 60.0, "kuwabara-kono"), (60.0, 60.0, None)],
)
def test_beside_what_is_left_the_likelier_is_named_though_another_was_found(monkeypatch, found, rival, named):
    """The search adds what gains most; once what is left counts as noise, another may be likelier."""
    fits = {
        name: SimpleNamespace(hypothesis=SimpleNamespace(ids=ids, components=()))
        for name, ids in (("tsuji", ["tsuji"]), ("kuwabara-kono", ["kuwabara-kono"]), ("none", []))
    }
    own, other = several(("tsuji",), found), several(("kuwabara-kono",), rival)
    own.fit, other.fit = fits["tsuji"], fits["kuwabara-kono"]
    grown = SimpleNamespace(
        forward=None,
        null=fits["none"],
        best=own,
        size=SimpleNamespace(size=0.01, found=True),
        tried={frozenset(): own},
    )
    case = SimpleNamespace(
        forward=SimpleNamespace(experiment=SimpleNamespace(prior_odds={})),
        null=None,
        _rivals=lambda _: [other],
        _irreplaceable=lambda _grown, one, _seen, _needed, _reasons: one,
    )
    monkeypatch.setattr(beside.restart, "moved", lambda _, one: one)
    monkeypatch.setattr(beside, "_idle", lambda _: False)
    left = SimpleNamespace(where="a smooth misfit", p=0.0)
    made = beside.Beside.decide(case, grown, 10.0, {}, left, [])
    assert made.named == [*([named] if named else []), "unknown"]
    assert made.final is (fits[named] if named else None)
    # Each half as likely as both together; none is e^59 times less.
    told = "something of the catalogue is there with probability 1.00, which is open: "
    assert [r for r in made.reasons if r.startswith(told)] == (
        [] if named else [told + "tsuji 0.50, kuwabara-kono 0.50"]
    )
