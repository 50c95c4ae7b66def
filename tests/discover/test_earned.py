"""A set whose last effect hardly earns its evidence is not told from one thing outside the catalogue."""

from dataclasses import replace
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


@pytest.mark.parametrize(
    ("earned", "failed", "whole"), [(50.0, False, True), (9.0, False, False), (50.0, True, False)]
)
def test_a_set_that_leaves_nothing_is_no_part_of_something_unknown(monkeypatch, earned, failed, whole):
    """A pair that only a search with a smooth misfit as noise had found was named beside `unknown`, with
    0.05, and a gap that left 1500 in χ² had 0.33.
    """
    final = SimpleNamespace(objective=100.0, hypothesis=SimpleNamespace(ids=("gravity", "tsuji")))
    pair = replace(found("gravity tsuji", earned), fit=final)
    grown = SimpleNamespace(best=pair, size=SimpleNamespace(size=0.0), tried={})
    turns = SimpleNamespace(grow=lambda null, start: grown, rivals=lambda one: one)
    seen = SimpleNamespace(p=0.4, failed=failed, size=SimpleNamespace(size=0.1))
    monkeypatch.setattr(decision.several, "Turns", lambda *_: turns)
    monkeypatch.setattr(decision.restart, "moved", lambda forward, one: one)
    monkeypatch.setattr(decision, "left", lambda *_, **__: seen)
    monkeypatch.setattr(decision.pairs, "combination", lambda null, one, setup: pair)
    monkeypatch.setattr(decision.Case, "_without_smooth", lambda *_: None)
    monkeypatch.setattr(decision.Case, "_beside", lambda *_: "beside something unknown")
    monkeypatch.setattr(decision.Case, "_whole", lambda self, one, *_: one)
    case = decision.Case(None, SimpleNamespace(objective=500.0), None, [], None, None)
    gap = SimpleNamespace(fit="its fit", effect="contact-gap")
    decided = case._out_of_smooth(gap, 12.0, 0.0, {}, 10.0)
    assert decided == (pair if whole else "beside something unknown")
