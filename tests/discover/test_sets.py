"""Sets of effects, the search's bookkeeping alone: what is held against what, fits given by a table."""

from types import SimpleNamespace

import numpy as np
import pytest

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import heldout
from sonicvacuum.discover.search import pairs, planes, several

# Log evidence of every set that could be fitted.
EVIDENCE = {"bd": 40.0, "bcd": 50.0, "abcd": 52.0, "be": 49.0, "bce": 60.0, "ab": 30.0, "bc": 45.0}


def fitted(effects):
    """A fit of some effects, as far as bookkeeping looks at it."""
    own = "".join(sorted(effects))
    hypothesis = SimpleNamespace(components=tuple(own), ids=tuple(own))
    return SimpleNamespace(hypothesis=hypothesis, objective=-2.0 * EVIDENCE.get(own, 0.0))


@pytest.fixture
def turns(monkeypatch):
    """A search in which every effect of the alphabet promises what its set gains."""
    found = several.Turns(None, None, 1.0, None)
    found.null = fitted("")
    asked = []

    def beside(forward, null, one, setup):
        asked.append("".join(one.hypothesis.ids))
        return [(*one.hypothesis.ids, x) for x in "abcde" if x not in one.hypothesis.ids]

    monkeypatch.setattr(pairs, "beside", beside)
    monkeypatch.setattr(pairs, "everywhere", lambda *rest, **sizes: [])
    monkeypatch.setattr(found, "_less", lambda one, k: fitted(np.delete(list(one.hypothesis.ids), k)))
    monkeypatch.setattr(found, "_evidence", lambda one: -0.5 * one.objective)
    monkeypatch.setattr(
        found, "_likeliest", lambda starts, enough: max(map(fitted, starts), key=found._evidence)
    )
    return found, asked


def test_one_effect_takes_the_place_of_two(turns):
    """e, for which a and d had made up, is in no set that was tried before."""
    found, asked = turns
    assert found._one_for_two(fitted("abcd")).hypothesis.ids == tuple("bce")
    assert sorted(asked) == ["ab", "ac", "ad", "bc", "bd", "cd"]


@pytest.mark.parametrize("effects", ["bce", "bc"])
def test_a_set_that_is_likelier_than_any_with_one_effect_less_stays(turns, effects):
    found, asked = turns
    assert found._one_for_two(fitted(effects)) is None
    assert len(asked) == (3 if len(effects) == 3 else 0)


def test_a_move_that_leads_nowhere_is_not_made_again(turns):
    found, _ = turns
    made = []

    def move(name, to):
        found.__dict__[name] = lambda one: made.append(name) or to
        return found.__dict__[name]

    moves = [move("_exchanged", None), move("_again", fitted("bcd")), move("_one_for_two", fitted("bce"))]
    assert found._elsewhere(fitted("bd"), moves).hypothesis.ids == tuple("bcd")
    assert found._elsewhere(fitted("bd"), moves).hypothesis.ids == tuple("bce")
    assert found._elsewhere(fitted("bd"), moves) is None
    # One for two leads to a set whose members have not been exchanged.
    assert made == ["_exchanged", "_again", "_one_for_two", "_exchanged"]


@pytest.mark.parametrize(("two", "grown"), [("bce", "bce"), ("be", "bcd"), (None, "bcd")])
def test_before_a_pair_grows_two_effects_are_tried_in_place_of_one(turns, two, grown):
    """One of a pair may be none: what is added to it leads further from the set that it stands for."""
    found, _ = turns
    found._counted = lambda null, one: one
    found._pruned = found._grown = lambda one: one
    found._hopeless, found._elsewhere = lambda *rest: False, lambda *rest: None
    found._added = lambda one: fitted("bcd") if len(one.hypothesis.ids) == 2 else None
    found._two = lambda one: two and fitted(two)
    assert found.grow(None, fitted("bd")).hypothesis.ids == tuple(grown)


def test_large_sets_are_only_started_again(turns):
    found, _ = turns
    found._again, found._two = lambda one: None, lambda one: pytest.fail("a large set was searched")
    moves = [found._again, found._two]
    assert found._elsewhere(fitted("abcde"), moves) is None
    assert moves == [found._two]


@pytest.mark.parametrize(("gain", "found_there"), [(90.0, "abe"), (85.0, None)])
def test_two_effects_take_the_place_of_one(turns, monkeypatch, gain, found_there):
    """A gap stood for preload and a coating, which alone do little and nearly cancel."""
    found, _ = turns
    asked = []

    def start(effects, promise):
        return planes.Start(promise, fitted(effects).hypothesis, *np.zeros((3, 1, len(effects))))

    def linear(scores, setup):
        return [start("abe", gain)] if scores == "b" else []

    monkeypatch.setattr(pairs, "screened", lambda forward, one, setup: "".join(one.hypothesis.ids))
    monkeypatch.setattr(planes, "linear", linear)
    monkeypatch.setattr(found, "_each_less", lambda one, which: [fitted("b"), fitted("d")])
    monkeypatch.setattr(found, "_asked", lambda before: 13.0)
    monkeypatch.setattr(found, "_earned", lambda before, after: True)

    def ranked(starts, least):
        asked.append(least)
        return iter([fitted(s.effects) for s in starts if s.gain > least])

    monkeypatch.setattr(found, "_ranked", ranked)
    more = found._two(fitted("bd"))
    # Beside b nothing is gained yet, beside b and d 80.
    assert asked == [80.0 + several.PROMISE * 13.0]
    assert (more and "".join(more.hypothesis.ids)) == found_there


@pytest.mark.parametrize(("rival", "given_up"), [(79.9, False), (80.1, True)])
def test_a_set_that_cannot_come_to_its_rival_is_given_up(turns, rival, given_up):
    """Three effects at 50 after two at 45: three more, each with twice the last one's 5, come to 80."""
    found, _ = turns
    found.rival = rival
    assert policy.MOST_EFFECTS == 6
    assert found._hopeless(fitted("bc"), fitted("bcd")) is given_up


@pytest.fixture
def missing(turns, monkeypatch):
    """A search beside b and c in which d alone predicts a run worse, as long as a is missing."""
    found, _ = turns
    more = {"bc": ["bcd", "bce"], "bcd": ["abcd"], "bce": []}
    monkeypatch.setattr(found, "_beside", lambda one: map(fitted, more["".join(one.hypothesis.ids)]))
    monkeypatch.setattr(found, "_worth", lambda before, after: True)
    monkeypatch.setattr(heldout, "better", lambda before, after, share: after.hypothesis.ids != tuple("bcd"))
    return found


def test_an_effect_that_waits_for_another_is_added_with_it(missing):
    """A striker beside a contact that relaxes: 41 in χ², and one run predicted worse without that contact."""
    assert missing._added(fitted("bc")).hypothesis.ids == tuple("abcd")


@pytest.mark.parametrize("worthless", ["abcd", "bcd"])
def test_where_the_likeliest_effect_does_not_earn_its_place_the_next_may(missing, monkeypatch, worthless):
    """A gauge that discharges was the likeliest and waited for friction, which then was never asked."""
    monkeypatch.setattr(missing, "_worth", lambda before, after: after.hypothesis.ids != tuple(worthless))
    assert missing._added(fitted("bc")).hypothesis.ids == tuple("bce")


def test_all_that_may_stand_in_an_effects_place_share_a_sets_probability(turns, monkeypatch):
    """In place of d those that promise 0.7 of its gain are fitted, each set once; the likeliest leads."""
    found, _ = turns
    evidence = {"bc": 20.0, "bcd": 50.0, "bca": 49.0, "bce": 50.4, "bcf": 51.0, "cd": 0.0, "bd": 0.0}
    at = {frozenset(k): v for k, v in evidence.items()}

    def one(effects):
        ids = tuple(effects)
        return SimpleNamespace(
            hypothesis=SimpleNamespace(
                components=ids, ids=ids, columns=[slice(k, k + 1) for k in range(len(ids))]
            ),
            objective=-2.0 * at.get(frozenset(ids), -9.0),
        )

    def beside(forward, null, less, setup):
        # What slopes promise of b, c in place of d: f nearly all, g too little.
        promised = {"a": 95.0, "e": 90.0, "f": 85.0, "g": 60.0}
        ids = less.hypothesis.ids if less.hypothesis.ids == ("b", "c") else ()
        return [SimpleNamespace(gain=g, effects=frozenset((*ids, x))) for x, g in promised.items() if ids]

    def noted(fit):
        key = frozenset(fit.hypothesis.ids)
        found.tried[key] = SimpleNamespace(effects=tuple(key), fit=fit, log_bayes=-0.5 * fit.objective)

    asked = []
    monkeypatch.setattr(several.bounds, "near", lambda fit: np.zeros(len(fit.hypothesis.ids), dtype=bool))
    monkeypatch.setattr(pairs, "beside", beside)
    monkeypatch.setattr(
        pairs, "followed", lambda forward, starts, least: asked.extend(starts) or map(one, map(_ids, asked))
    )
    monkeypatch.setattr(found, "_each_less", lambda fit, which: [one("bc"), one("bd"), one("cd")])
    monkeypatch.setattr(found, "_noted", noted)
    whole = one("bcd")
    noted(whole)
    noted(one("bca"))  # tried on the way: not fitted again
    assert set(found.rivals(whole).hypothesis.ids) == set("bcf")
    assert [set(s.effects) for s in asked] == [set("bce"), set("bcf")]
    assert frozenset("bce") in found.tried
    # Less than half a unit of evidence ahead is no other verdict, but shares the probability.
    at[frozenset("bcf")] = 50.1
    found.tried = {}
    noted(whole)
    asked.clear()
    assert found.rivals(whole) is whole


def _ids(start):
    """Effects of a start, in order."""
    return sorted(start.effects)


@pytest.mark.parametrize(
    ("gains", "alone", "growing"),
    [([-5.9, 3.0, 20.0], True, True), ([-9.2, 4.6, 135.5], False, True), ([-20.0, 4.6, 135.5], False, False)],
)
def test_while_others_are_missing_a_run_may_be_predicted_a_little_worse(monkeypatch, gains, alone, growing):
    """Damping beside a soft wall and a gauge that discharges, before a heavier bead: -9.2 of +131."""
    before, after = predicting(monkeypatch, gains, 0.0)
    assert heldout.better(before, after) is alone
    assert heldout.better(before, after, share=several.WORSE) is growing


@pytest.mark.parametrize(
    ("gains", "kept"), [([-6.2, 8.0, 31.5], True), ([-9.0, 8.0, 31.5], False), ([-6.2, 3.0, 4.0], False)]
)
def test_one_run_may_be_predicted_worse_by_chance_where_others_gain_much(monkeypatch, gains, kept):
    """A gap of d' 10 lost 6.2 in one run of three, and gained 33 in all: two of its standard errors."""
    before, after = predicting(monkeypatch, gains, 0.0)
    assert heldout.better(before, after, share=policy.BY_CHANCE) is kept


@pytest.mark.parametrize(("gained", "kept"), [(30.0, False), (157.5, True)])
def test_what_strains_a_nuisance_alone_need_not_predict_better(monkeypatch, gained, kept):
    """A modulus 2.25 times as large is one that the other runs tell as well, at 12 of its standard errors."""
    before, after = predicting(monkeypatch, [-0.99, -0.28, -0.85, -0.12], gained)
    assert heldout.better(before, after) is kept


def predicting(monkeypatch, gains, gained):
    """Two fits: the second predicts runs by `gains` better, and has gained so much in χ² on all of them."""
    before, after = (
        SimpleNamespace(objective=o, gains=g) for o, g in ((gained, 0.0), (0.0, np.array(gains)))
    )
    monkeypatch.setattr(heldout, "predictive", lambda one: one.gains + np.zeros(len(gains)))
    return before, after
