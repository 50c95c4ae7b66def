"""A set whose last effect hardly earns its evidence is not told from one thing outside the catalogue."""

from types import SimpleNamespace

import pytest

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit.evidence import Combination
from sonicvacuum.discover.judge import decision, explanations

LEFT = SimpleNamespace(size=SimpleNamespace(log_odds=0.0), where="a misfit in place", p=1e-5)
NOTHING = SimpleNamespace(p=0.4)


def found(effects, log_bayes):
    return Combination(tuple(effects.split(" ")), effects, 100.0, log_bayes)


def decided(monkeypatch, whole, others, smooth=0.0, more=None):
    seen = SimpleNamespace(size=SimpleNamespace(log_odds=smooth), where=LEFT.where, p=LEFT.p)
    monkeypatch.setattr(decision, "left", lambda forward, fit, known: seen)
    monkeypatch.setattr(
        decision.abreast, "each", lambda forward, work, sets: [work(forward, s) for s in sets]
    )
    monkeypatch.setattr(decision.Case, "_two_more", lambda case, part, seen, most: more and (more, 0.3))
    case = decision.Case(None, None, None, [], None, None)
    return case._whole(whole, others, {}, NOTHING, [], 0.0)


@pytest.mark.parametrize(
    ("gained", "smooth", "kept"), [(1.1, 0.0, True), (0.9, 0.0, False), (1.1, 3.0, False)]
)
def test_the_last_effect_of_a_set_earns_its_evidence(monkeypatch, gained, smooth, kept):
    """A smooth misfit beside one effect less counts for that."""
    pair = found("gravity tsuji", 50.0)
    others = [
        found("tsuji", 50.0 - gained * policy.FURTHER),
        found("gravity", 10.0),
        found("gravity tsuji", 50.0),
    ]
    one = decided(monkeypatch, pair, others, smooth)
    if kept:
        assert (one.named, one.final, one.left) == (["gravity", "tsuji"], pair.fit, NOTHING.p)
        return
    assert (one.named, one.final, one.left) == (["tsuji", "unknown"], "tsuji", LEFT.p)
    assert "gravity" in one.reasons[0]
    odds = explanations.probabilities(
        {"none": -50.0, "tsuji": 0.0, "gravity + tsuji": 4.0}, one.left, one.beside
    )
    assert max(odds, key=odds.get) == "tsuji + unknown"


def test_only_what_has_one_effect_less_is_held_against_a_set(monkeypatch):
    three = found("gravity mass-defect tsuji", 50.0)
    others = [found("tsuji", 49.0), found("gravity tsuji", 20.0), found("gravity sensor-gain", 49.0)]
    assert decided(monkeypatch, three, others).named == ["gravity", "mass-defect", "tsuji"]
    assert decided(monkeypatch, three, []).named == ["gravity", "mass-defect", "tsuji"]


def test_two_more_that_only_together_explain_what_is_left_are_named(monkeypatch):
    """Asked only where one more earns too little."""
    pair, two = found("gravity tsuji", 50.0), found("tsuji mass-defect sensor-gain", 80.0)
    for gained, named in ((0.9, list(two.effects)), (1.1, ["gravity", "tsuji"])):
        others = [found("tsuji", 50.0 - gained * policy.FURTHER)]
        one = decided(monkeypatch, pair, others, more=two)
        assert (one.named, one.left) == (named, 0.3 if named == list(two.effects) else NOTHING.p)
        assert (two in one.combinations) == (named == list(two.effects))
