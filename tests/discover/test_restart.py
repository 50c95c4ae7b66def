"""Minima that no slope leads to: pairs started again, single effects that slopes put far behind."""

from types import SimpleNamespace

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.fit.evidence import Candidate
from sonicvacuum.discover.fit.normal import linearise
from sonicvacuum.discover.fit.refit import Fit, fit, polish
from sonicvacuum.discover.judge import decision
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import directions, pairs, restart, screen, secants, singles
from sonicvacuum.effects import effect

GAP, MASS = ("contact-gap", {"gap_um": 0.15, "contact": 5}), ("mass-defect", {"mass_ratio": 0.95, "bead": 8})


@pytest.fixture(scope="module")
def stuck():
    """Predictor, and a pair whose second effect sits at a wrong bead, from which slopes lead to
    a minimum of its own.
    """
    forward = Forward(experiment(made([GAP, MASS], seed=9)[0]), 1)
    null, setup = wide.nominal(forward), singles.setup_of(forward)
    first, second = (
        Component(effect(name), variants(effect(name), setup)[0], place=place)
        for name, place in (("contact-gap", 5), ("mass-defect", 6))
    )
    hypothesis = Hypothesis((first,)).with_component(second)
    start = [c.inverse(value) for c, value in zip(hypothesis.coordinates, (0.15, 1.02), strict=True)]
    return forward, fit(forward, hypothesis, np.array([start]), null.nu[None])


def test_a_pair_in_a_minimum_of_its_own_is_led_to_the_lower_one(stuck):
    forward, one = stuck
    found = restart.restarted(forward, one, singles.setup_of(forward))
    assert found.objective < one.objective - 1000.0
    assert [c.place for c in found.hypothesis.components] == [5, 8]
    ratio, sigma = np.exp(found.u[1]), found.sigma[1]
    assert abs(np.log(ratio / 0.95)) < 4.0 * sigma


def test_a_pair_at_its_minimum_stays(stuck):
    forward, one = stuck
    setup = singles.setup_of(forward)
    there = restart.restarted(forward, one, setup)
    again = restart.restarted(forward, there, setup)
    assert again.objective == pytest.approx(there.objective, abs=0.02)  # where a fit counts as settled


def test_starts_are_the_best_trials_of_each_place(stuck, monkeypatch):
    """Of a bead 8 % light beside a slow gauge most good trials were at another that had made up for it."""
    forward, one = stuck
    setup = singles.setup_of(forward)
    tried = secants.tried

    def clustered(*what, **how):
        """All trials of the best place first."""
        trials = tried(*what, **how)
        return sorted(trials, key=lambda t: (t.place != trials[0].place, -t.gain))

    monkeypatch.setattr(secants, "tried", clustered)
    for k, component in enumerate(one.hypothesis.components):
        trials = restart._trials(forward, one, k, setup)
        assert component.effect.places and len(trials) == restart.FOLLOWED
        places = restart.put(one.hypothesis, k, trials)[2]
        assert len(set(places[:, k])) == len(trials)
        assert set(places[:, 1 - k]) == {one.hypothesis.components[1 - k].place}


def test_no_start_is_left_for_what_it_leaves_at_first(stuck, monkeypatch):
    """Where all others had to follow, the true bead began 3800 in χ² behind and ended 190 ahead."""
    forward, one = stuck
    asked = []

    def seen(forward, hypothesis, u, nu, places, keep, iterations):
        asked.append((len(u), keep))
        return one

    monkeypatch.setattr(restart, "fit", seen)
    assert restart.restarted(forward, one, singles.setup_of(forward)) is one
    assert len(asked) == 2 and all(0 < count <= keep for count, keep in asked)


def test_what_a_trial_should_gain_is_what_a_fit_gains_where_data_answer_in_proportion():
    """A gauge's gain is linear: the best trial misses the fit's gain by its distance from the best value."""
    hidden = [("sensor-gain", {"gain_ratio": 1.03, "sensor": 1})]
    forward = Forward(experiment(made(hidden, seed=3)[0]), 1)
    null, setup = wide.nominal(forward), singles.setup_of(forward)
    free = variants(effect("sensor-gain"), setup)[0]
    sizes = np.array([0.029, 0.0295, 0.03])
    best = secants.tried(forward, null, Component(effect("sensor-gain"), free), setup, 1, sizes)[0]
    one = fit(
        forward, Hypothesis((Component(effect("sensor-gain"), free, place=1),)), best.u[None], best.nu[None]
    )
    assert best.place == 1
    # The gauge's own error of 2 % takes up half; what is left answers in proportion to a few per cent.
    assert best.gain <= (null.objective - one.objective) * 1.05
    assert best.gain == pytest.approx(null.objective - one.objective, rel=0.2)


def test_a_single_effect_that_a_pair_leads_lower_is_followed_beyond_its_range():
    """A gauge in volts, at 12.5 N/V; gains are tried from a fifth to five times."""
    gain, setup_of = effect("sensor-gain"), singles.setup_of
    forward = Forward(experiment(made([("sensor-gain", {"gain_ratio": 0.08, "sensor": 1})], seed=3)[0]), 1)
    null = wide.nominal(forward)
    setup = setup_of(forward)
    alone, drag = (
        Component(e, variants(e, setup)[0], place=place)
        for e, place in ((gain, 1), (effect("viscous-drag"), None))
    )
    start = Fit(
        Hypothesis((alone,)), linearise(forward, Hypothesis((alone,)), np.zeros((1, 1)), null.nu[None])
    )
    own = Candidate("sensor-gain", start, null.objective - start.objective, 0.0)
    both = Hypothesis((alone,)).with_component(drag)
    at = np.array([[c.inverse(0.3) if c.parameter.name == "gain_ratio" else c.low for c in both.coordinates]])
    pair = pairs.combination(null, fit(forward, both, at, np.zeros((1, forward.layout.size))), setup)
    (found,) = restart.lower(forward, null, [pair], [own])
    assert found.flags == ("beyond",)
    assert np.exp(found.fit.u[0]) == pytest.approx(0.08, rel=0.1)  # each gauge's own gain is known to 2 %


@pytest.mark.parametrize("ahead", [True, False])
def test_an_effect_of_which_slopes_promised_nothing_is_fitted_alone_where_a_pair_has_it(ahead):
    """Friction of d′ 20 was named beside drag, and had never been tried alone."""
    forward = Forward(experiment(made([("sensor-gain", {"gain_ratio": 1.3, "sensor": 1})], seed=3)[0]), 1)
    null, setup = wide.nominal(forward), singles.setup_of(forward)
    gain, drag = (
        Component(effect(name), variants(effect(name), setup)[0], place=place)
        for name, place in (("sensor-gain", 1), ("viscous-drag", None))
    )
    both = Hypothesis((gain,)).with_component(drag)
    at = np.array([[c.inverse(1.3) if c.parameter.name == "gain_ratio" else c.low for c in both.coordinates]])
    pair = pairs.combination(null, fit(forward, both, at, null.nu[None]), setup)
    alone = Hypothesis((gain,))
    rival = Fit(alone, linearise(forward, alone, np.log([[1.1]]), null.nu[None]))
    if not ahead:
        rival = polish(forward, restart.less(forward, pair.fit, 1))
    other = Candidate("viscous-drag", rival, null.objective - rival.objective, 0.0)
    found = restart.lower(forward, null, [pair], [other])
    if not ahead:
        assert found is None
        return
    assert [c.effect for c in found] == ["viscous-drag", "sensor-gain"]
    assert found[1].fit.objective < rival.objective
    assert np.exp(found[1].fit.u[0]) == pytest.approx(1.3, rel=0.1)  # each gauge's own gain is known to 2 %


def test_a_large_gap_is_found_where_pulses_miss_each_other():
    """Gaps of d′ 450 and a bead of two thirds of its mass had ended among the last of the singles."""
    forward = Forward(experiment(made([("contact-gap", {"gap_um": 10.0, "contact": 3})], seed=9)[0]), 1)
    null, setup = wide.nominal(forward), singles.setup_of(forward)
    scores = screen.screen(forward, null, directions.catalogue(setup, forward.experiment.excluded))
    best = singles.fit_all(forward, null, scores)[0]
    assert best.effect == "contact-gap"
    assert [c.place for c in best.fit.hypothesis.components] == [3]
    assert best.fit.u[0] == pytest.approx(np.log(10.0), abs=5.0 * best.fit.sigma[0])  # five standard errors
    size = sum(forward.experiment.size(k) for k in range(2))
    assert best.fit.objective == pytest.approx(size, abs=5.0 * np.sqrt(2.0 * size))  # that of χ²


def test_a_single_effect_that_sets_come_down_to_is_known_by_its_lower_minimum():
    hidden = [("sensor-gain", {"gain_ratio": 1.3, "sensor": 1})]
    forward = Forward(experiment(made(hidden, seed=3)[0]), 1)
    null, setup = wide.nominal(forward), singles.setup_of(forward)
    free = variants(effect("sensor-gain"), setup)[0]
    there = fit(
        forward,
        Hypothesis((Component(effect("sensor-gain"), free, place=1),)),
        np.log([[1.3]]),
        null.nu[None],
    )
    elsewhere = Hypothesis((Component(effect("sensor-gain"), free, place=0),))
    short = Fit(elsewhere, linearise(forward, elsewhere, np.log([[1.1]]), null.nu[None]))
    own = Candidate("sensor-gain", short, null.objective - short.objective, -5.0)
    other = Candidate("viscous-drag", short, own.gain, 0.0)
    led = restart.led(null, there, [own, other])
    assert [c.effect for c in led] == ["sensor-gain", "viscous-drag"]
    assert led[0].fit is there
    assert led[0].gain == pytest.approx(null.objective - there.objective)
    # Of the evidence only the misfit has changed.
    assert led[0].log_bayes == pytest.approx(-5.0 + 0.5 * (led[0].gain - own.gain))
    assert restart.led(null, there, led) is None
    assert [c.effect for c in restart.led(null, there, [other])] == ["viscous-drag", "sensor-gain"]


def test_single_effects_are_led_lower_by_pairs_that_are_found_late_too(monkeypatch):
    """A power of velocity stood at a bound, and was named beside a second law that did nothing: only pairs
    that are started again had found its other power.
    """
    early, late = [SimpleNamespace(name="early")], [SimpleNamespace(name="late")]
    of_two = SimpleNamespace(search=lambda: early, again=lambda: late)
    monkeypatch.setattr(decision.pairs, "Pairs", lambda *_: of_two)
    monkeypatch.setattr(decision.gross, "gross", lambda *_: False)
    lower = {"early": None, "late": ["the other power"]}
    monkeypatch.setattr(decision.restart, "lower", lambda forward, null, found, *_: lower[found[0].name])
    monkeypatch.setattr(decision.Case, "_passing", lambda *_: (None, None, None))
    monkeypatch.setattr(decision.Case, "_anew", lambda self, better: better)
    case = decision.Case(None, None, None, [], None, None)
    assert case._more(12.0, 0.0, None, {}, None) == ["the other power"]


def test_a_law_that_stopped_in_another_minimum_of_the_nuisances_begins_beside_the_leading_one():
    """Kuwabara–Kono damping had stopped at 0.75 of its time, speeds and time zeros making up for that, and
    a contact that relaxes in no time, which is the same damping, was named with 0.83.
    """
    forward = Forward(experiment(made([("kuwabara-kono", {"time_us": 0.6})], seed=6)[0]), 1)
    null, setup = wide.nominal(forward), singles.setup_of(forward)
    free = variants(effect("kuwabara-kono"), setup)[0]
    kuwabara, at = Hypothesis((Component(effect("kuwabara-kono"), free),)), np.log([[0.6]])
    leading = fit(forward, kuwabara, at, null.nu[None])
    off = linearise(forward, kuwabara, at + np.log(0.75), leading.nu[None] + 1.0)
    stopped = Fit(kuwabara, off)
    first = Candidate("relaxing-contact", leading, 500.0, 100.0)
    near, far = (Candidate("kuwabara-kono", stopped, 500.0 - less, 90.0) for less in (10.0, 100.0))
    same, better, behind = restart.beside_leading(forward, null, [first, near, far])
    assert (same, behind) == (first, far)
    assert better.fit.objective == pytest.approx(leading.objective, abs=0.1)
    assert better.log_bayes == pytest.approx(90.0 + 0.5 * (better.gain - near.gain))
    assert restart.beside_leading(forward, null, [first, better]) == [first, better]
