"""Two effects, and what no effect explains: joint gains, naming of pairs, shapes outside the catalogue."""

from types import SimpleNamespace

import numpy as np
import pytest
from linear_models import screened
from made_records import BEADS, made

from sonicvacuum.discover import policy, session
from sonicvacuum.discover.fit import refit, wide
from sonicvacuum.discover.judge.decision import Case
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.rounds import investigate
from sonicvacuum.discover.search import pairs, planes, secants, singles
from sonicvacuum.discover.search.directions import Direction
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.effects import effect


def seen(columns, data, two_sided):
    """What a screen of these columns says, each of an effect of its own."""
    directions = tuple(Direction(f"e{k}", "s", two_sided=t) for k, t in enumerate(two_sided))
    return screened(columns, data, directions)


def test_the_joint_gain_of_two_directions_is_that_of_least_squares():
    rng = np.random.default_rng(np.random.SeedSequence(7))
    columns, data = rng.normal(size=(4, 30)), rng.normal(size=30)
    gain, strength = planes._planes(seen(columns, data, [True] * 4), np.arange(4))
    for i in range(4):
        for j in range(i + 1, 4):
            both = columns[[i, j]].T
            solved = np.linalg.lstsq(both, data, rcond=None)[0]
            explained = data @ data - np.sum((data - both @ solved) ** 2)
            assert gain[i, j] == pytest.approx(explained, rel=1e-9)  # algebra, rounding only
            assert [strength[i, j], strength[j, i]] == pytest.approx(solved.tolist(), rel=1e-9)


def test_a_one_sided_direction_of_the_wrong_sign_makes_no_pair():
    columns = np.eye(3)[:2]
    gain, _ = planes._planes(seen(columns, np.array([1.0, -1.0, 0.0]), [True, False]), np.arange(2))
    assert gain[0, 1] == -np.inf


def test_what_pairs_promise_is_the_best_joint_gain():
    rng = np.random.default_rng(np.random.SeedSequence(8))
    columns, data = rng.normal(size=(5, 30)), rng.normal(size=30)
    scores = seen(columns, data, [True] * 5)
    scores.length[4] = 0.0  # one that nuisances take up altogether counts for nothing
    pairs_of = [columns[[i, j]].T for i in range(4) for j in range(i)]
    left = [np.linalg.lstsq(both, data, rcond=None)[1][0] for both in pairs_of]
    assert planes.promised(scores) == pytest.approx(data @ data - min(left), rel=1e-9)  # rounding only
    scores.length[1:] = 0.0
    assert planes.promised(scores) == -np.inf


def beside_a_gain(hidden):
    """Predictor, nominal fit and the fit of a gauge's gain alone, where more is hidden beside it."""
    gained = ("sensor-gain", {"gain_ratio": 1.2, "sensor": 1})
    forward = Forward(experiment(made([gained, *hidden], seed=4)[0]))
    null, setup = wide.nominal(forward), setup_of(forward)
    gain = effect("sensor-gain")
    hypothesis = Hypothesis((Component(gain, variants(gain, setup)[0], place=1),))
    u = np.array([[c.inverse(1.2) for c in hypothesis.coordinates]])
    return forward, null, refit.fit(forward, hypothesis, u, null.nu[None]), setup


def test_pairs_by_algebra_begin_beside_what_was_fitted():
    """Two effects more; the one there keeps its place, and its strength as it follows."""
    hidden = [("wall-compliance", {"stiffness_ratio": 0.6}), ("contact-gap", {"gap_um": 0.9, "contact": 5})]
    forward, _, one, setup = beside_a_gain(hidden)
    starts = planes.linear(pairs.screened(forward, one, setup), setup)
    assert all(s.hypothesis.ids[0] == "sensor-gain" and len(set(s.hypothesis.ids)) == 3 for s in starts)
    assert [s.gain for s in starts] == sorted((s.gain for s in starts), reverse=True)
    for s in starts:
        assert s.u.shape == (1, len(s.hypothesis.coordinates)) and s.places[0, 0] == 1
        assert np.array_equal(s.hypothesis.inside(s.u), s.u)
    assert any("wall-compliance" in s.effects for s in starts)
    best = pairs.fitted(forward, starts[0])
    assert best.objective < one.objective - 0.5 * starts[0].gain  # slopes err where gaps open


def test_trials_all_over_the_range_promise_what_slopes_do_not():
    """To first order a slow gauge is a late one; of what its width tells slopes promise a seventh."""
    forward, null, one, setup = beside_a_gain([("sensor-lowpass", {"tau_us": 12.0})])
    fine = pairs.everywhere(forward, null, one, setup, sizes=secants.finely)
    by_slopes, by_trials = (
        max((s for s in starts if "sensor-lowpass" in s.effects), key=lambda s: s.gain)
        for starts in (pairs.beside(forward, null, one, setup), fine)
    )
    before = null.objective - one.objective
    more = one.objective - pairs.fitted(forward, by_trials).objective
    assert by_slopes.gain - before < 0.3 * more
    # Strengths tried are 1.7 times apart.
    assert 0.8 * more < by_trials.gain - before <= more
    assert all(s.u.shape[1] == len(s.hypothesis.coordinates) for s in fine)
    assert not any("gravity" in s.effects for s in pairs.everywhere(forward, null, one, setup, ("gravity",)))


def test_either_effect_of_the_best_pair_is_exchanged(monkeypatch):
    """A ball of nylon that loses as Kuwabara and Kono say and is stiffer than its handbook: relaxation alone
    explains more than the loss alone, and relaxation with the loss more than any pair tried before; starts
    with the loss promised less than all those with relaxation, and none was fitted.
    """
    ways = {"loss": (90.0, 80.0, 70.0), "relaxing": (99.0, 98.0, 97.0, 96.0)}
    starts = [
        SimpleNamespace(effects=frozenset([one, f"{one} {gain:g}"]), gain=gain)
        for one, gains in ways.items()
        for gain in gains
    ]
    best = SimpleNamespace(effects=("loss", "relaxing"), log_bayes=0.0)
    search = pairs.Pairs.__new__(pairs.Pairs)
    search.seen, search.asked, search.found, search.tried = starts[:3], starts[3:], {"best": best}, set()
    fitted = []
    monkeypatch.setattr(pairs, "_adapted", lambda start, best: None)
    monkeypatch.setattr(pairs.Pairs, "_refit", lambda self, starts: fitted.append([s.gain for s in starts]))
    search._exchange()
    assert fitted[0] == [99.0, 90.0, 98.0, 80.0]


@pytest.mark.parametrize(("at_end", "fitted"), [(False, ["close"]), (True, ["close", "far"])])
def test_what_stands_in_for_an_effect_of_the_best_pair_is_fitted(monkeypatch, at_end, fitted):
    """A softer wall, a stiffer bead and a heavier ball change rebounds alike: of a pair with one of them the
    others are as likely, and were never asked for where the effect alone was far from what it is in the pair.
    """
    columns = [slice(0, 1), slice(1, 2)]
    best = SimpleNamespace(objective=20.0, hypothesis=SimpleNamespace(columns=columns, ids=("a", "b")))
    search = pairs.Pairs.__new__(pairs.Pairs)
    search.forward, search.null, search.setup = None, SimpleNamespace(objective=1020.0), None
    search.found = {"best": SimpleNamespace(fit=best, log_bayes=0.0)}
    # With both 1000 are gained, without effect 0 it is 900.
    gains = {"close": 975.0, "far": 950.0}
    starts = [SimpleNamespace(effects=frozenset([name]), gain=gain) for name, gain in gains.items()]
    monkeypatch.setattr(pairs, "everywhere", lambda forward, null, k, setup, known: starts if k == 0 else [])
    monkeypatch.setattr(pairs.restart, "less", lambda forward, one, k: k)
    monkeypatch.setattr(pairs.restart, "promised", lambda k: 120.0)
    monkeypatch.setattr(pairs.bounds, "near", lambda one: np.array([at_end, False]))
    asked = []
    monkeypatch.setattr(pairs.Pairs, "_refit", lambda self, starts: asked.append(starts))
    search._stood_in()
    assert [[next(iter(s.effects)) for s in one] for one in asked] == [fitted]


@pytest.mark.parametrize(
    ("more", "named", "kept"),
    [(1.0, ["a", "b"], True), (-1.0, ["a", "b"], False), (1.0, ["a", "unknown"], False), (1.0, None, False)],
    ids=["a pair", "little promised", "something unknown beside one", "none that passes"],
)
def test_a_pair_stands_in_for_one_effect_only_where_slopes_promise_much_more(monkeypatch, more, named, kept):
    """Gravity and friction of d′ 10 each passed for a gap, which left nothing and gained 44 less."""
    pair = named and SimpleNamespace(named=named)
    monkeypatch.setattr(planes, "promised", lambda scores: 130.0 + policy.PROMISED + more)
    monkeypatch.setattr(pairs, "Pairs", lambda *given: SimpleNamespace(search=lambda: []))
    monkeypatch.setattr(Case, "_passing", lambda self, *given: (pair, None, None))
    case = Case(None, None, None, [SimpleNamespace(gain=130.0)], None, None)
    assert case._pair_instead(13.0, 0.0, {}, None) is (pair if kept else None)


def test_two_effects_are_named_together():
    hidden = [("viscous-drag", {"rate_per_s": 150.0}), ("wall-compliance", {"stiffness_ratio": 0.7})]
    found = session.discover(made(hidden, seed=6)[0])
    v = found.verdict
    assert set(v.named) == {"viscous-drag", "wall-compliance"}
    assert v.alarms["single"] < v.alarms["pair"]
    ratio = v.parameters["wall-compliance"]["stiffness_ratio"]
    assert abs(ratio.value - 0.7) < 4.0 * ratio.sigma
    assert v.gap.fitted.after == pytest.approx(1.0, abs=4.0 * np.sqrt(2.0 / found.found.sizes.sum()))


@pytest.mark.long
def test_beads_of_two_kinds_in_turn_are_outside_the_catalogue():
    turn = [("mass", b, 1.06 if b % 2 else 0.94) for b in range(1, BEADS + 1)]
    v = session.discover(made(departures=turn, seed=8)[0]).verdict
    assert v.named == ["unknown"]
    assert v.gap.fitted.before == v.gap.fitted.after  # nothing is added to what has no name
    # A bead beside it was refused, which leaves so much to `unknown`.
    assert v.probabilities["unknown"] == pytest.approx(policy.REFUSED_UNKNOWN)


@pytest.mark.long
def test_a_modulus_far_from_the_handbooks_hides_no_second_effect():
    """e times the handbook's: slopes at the handbook's value point half as far."""
    hidden = [("dynamic-modulus", {"modulus_ratio": 2.7}), ("sensor-lowpass", {"tau_us": 8.0})]
    v = session.discover(made(hidden, seed=11)[0]).verdict
    assert set(v.named) == {"dynamic-modulus", "sensor-lowpass"}
    ratio = v.parameters["dynamic-modulus"]["modulus_ratio"]
    assert abs(ratio.value - 2.7) < 4.0 * ratio.sigma


@pytest.mark.long
def test_a_defect_beside_friction_is_found_at_its_own_bead():
    hidden = [("mass-defect", {"mass_ratio": 1.06, "bead": 6}), ("viscous-drag", {"rate_per_s": 120.0})]
    v = session.discover(made(hidden, seed=12)[0]).verdict
    assert set(v.named) == {"mass-defect", "viscous-drag"}
    assert v.parameters["mass-defect"]["bead"].value == 6


@pytest.mark.long
@pytest.mark.parametrize(
    ("seed", "wall", "tau", "modulus"), [(2, 0.93, 12_000.0, 1.6), (3, 1.05, 20_000.0, 0.7)]
)
def test_a_pair_is_asked_for_a_third_effect_that_leaves_no_residual(seed, wall, tau, modulus):
    """A modulus 7 to 9 of its stated errors off was taken up by that error, and the pair left nothing."""
    hidden = [
        ("wall-compliance", {"stiffness_ratio": wall}),
        ("sensor-droop", {"tau_us": tau}),
        ("dynamic-modulus", {"modulus_ratio": modulus}),
    ]
    found = investigate(experiment(made(hidden, seed=seed)[0]))
    assert set(found.named) == {name for name, _ in hidden}


def test_several_effects_are_held_against_a_smooth_misfit_before_it_counts_as_noise(monkeypatch):
    """Three effects of d′ 20, none alone as likely as a smooth misfit: a fourth was named beside it."""
    asked = []

    def whole(self, needed, most, alarms, start, rival, fewest, tried):
        asked.append((start, rival, fewest))
        return "three effects"

    monkeypatch.setattr(Case, "_without_smooth", whole)
    case = Case(None, None, None, [], None, None)
    best = SimpleNamespace(fit="its fit")
    assert case._out_of_smooth(best, 12.0, 0.0, {}, 98.9) == "three effects"
    assert asked == [("its fit", 98.9, 2)]


def test_a_pair_far_behind_is_spared_its_last_steps():
    """A law with a memory took eight tenths of a second for the errors of a pair 120 in chi2 behind."""
    hidden = [("viscous-drag", {"rate_per_s": 300.0}), ("sensor-gain", {"gain_ratio": 1.2, "sensor": 1})]
    forward = Forward(experiment(made(hidden, seed=3)[0]), 1)
    null, setup = wide.nominal(forward), singles.setup_of(forward)
    drag, gain, other = (
        Component(effect(name), variants(effect(name), setup)[0], place=place)
        for name, place in (("viscous-drag", None), ("sensor-gain", 1), ("sensor-gain", 0))
    )
    nu = np.zeros((1, forward.layout.size))
    starts = []
    for second, place in ((gain, 1), (other, 0)):
        both = Hypothesis((drag,)).with_component(second)
        u = np.array([[c.inverse(v) for c, v in zip(both.coordinates, (300.0, 1.2), strict=True)]])
        starts.append(planes.Start(0.0, both, u, nu, np.array([[0, place]])))
    near, far = pairs.followed(forward, starts)
    assert near.finished and not far.finished
    assert far.objective > near.objective + pairs.BEHIND
    whole = pairs.fitted(forward, starts[0])
    assert near.objective == pytest.approx(whole.objective, abs=1e-6)  # the same steps
    assert not pairs.followed(forward, starts[:1], near.objective - 2.0 * pairs.BEHIND)[0].finished
    last = refit.finished(forward, far)
    assert last.finished and refit.finished(forward, last) is last
    assert last.objective <= far.objective + 1e-6
    assert null.objective > far.objective


def test_two_effects_that_take_each_other_back_are_named_though_neither_passes_alone():
    """A steeper law delays small forces as a preload hastens them: alone either gains Δχ² 6, both gain 76."""
    hidden = [("contact-exponent", {"exponent": 1.508}), ("static-preload", {"force_N": 0.0012})]
    found = investigate(experiment(made(hidden, seed=1)[0]))
    assert found.candidates[0].gain < found.threshold
    assert found.pairs[0].gain > found.candidates[0].gain + policy.PROMISED
    assert sorted(found.named) == ["contact-exponent", "static-preload"]
    assert found.probabilities["contact-exponent + static-preload"] > 0.9  # `unknown` keeps some 0.05
