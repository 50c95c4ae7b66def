"""What rival explanations make of what they share, against mixtures that are known in closed form."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.special import ndtri

from sonicvacuum.discover import draws, posterior, rounds
from sonicvacuum.discover.fit.evidence import Candidate, Combination
from sonicvacuum.discover.fit.normal import linearise
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import rivals
from sonicvacuum.discover.judge.rivals import Rival
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.search import singles
from sonicvacuum.discover.verdict import parameters
from sonicvacuum.effects import effect


@pytest.fixture(scope="module")
def fit(verdict):
    """A fit with one effect, of one free coordinate."""
    return verdict.found.final


def beside(fit, u, nu):
    """The same explanation with its coordinate and its nuisances so many standard errors off."""
    n = fit.normal
    moved = fit.u + np.array([u]) * fit.sigma, fit.nu + nu
    return replace(fit, normal=replace(n, u=moved[0][None], nu=moved[1][None]))


def test_an_error_holds_what_rivals_make_of_it(fit):
    """Law of total variance about what is told: σ² + p Δ²."""
    found = [Rival(0.6, fit), Rival(0.2, beside(fit, 3.0, 2.0))]
    assert rivals.nuisances(fit, found) == pytest.approx(np.full(len(fit.nu), 0.25 * 2.0**2))
    alone, wide = (parameters(fit, one)["kuwabara-kono"]["time_us"] for one in ((), found))
    assert wide.value == alone.value
    assert wide.sigma == pytest.approx(alone.sigma * np.sqrt(1.0 + 0.25 * 3.0**2))


def test_an_effect_with_something_unknown_beside_it_is_as_it_is_fitted(verdict, fit):
    """Told so, it was none of its own rivals: its draws stood where another set has it, 48 errors off."""
    null, other = verdict.found.null, beside(fit, 5.0, 0.0)
    single = replace(verdict.found.candidates[0], effect="kuwabara-kono", fit=fit)
    pair = Combination(("kuwabara-kono", "gravity"), other, 0.0, 0.0)
    odds = {"kuwabara-kono + unknown": 0.6, "kuwabara-kono": 0.05, "gravity + kuwabara-kono": 0.35}
    found = rivals.of_odds({**odds, "unknown": 0.01}, null, [single], [pair])
    assert sorted((one.probability, one.fit is fit) for one in found) == [(0.35, False), (0.65, True)]


def test_rivals_without_an_effect_say_nothing_of_its_parameter(verdict, fit):
    null = verdict.found.null
    ((share, off),) = rivals.shifts(fit, [Rival(0.5, fit), Rival(0.5, null)])
    assert (share.tolist(), off.tolist()) == ([1.0], [0.0])
    ((share, off),) = rivals.shifts(fit, [Rival(1.0, null)])
    assert (share.tolist(), off.tolist()) == ([1.0], [0.0])


def test_an_effect_that_sits_elsewhere_has_its_parameter_there(fit):
    (elsewhere,) = (replace(c, place=3) for c in fit.hypothesis.components)
    moved = replace(beside(fit, 1.0, 0.0), hypothesis=replace(fit.hypothesis, components=(elsewhere,)))
    ((share, off),) = rivals.shifts(fit, [Rival(0.5, fit), Rival(0.5, moved)])
    assert share.tolist() == [0.5, 0.5]
    assert off == pytest.approx([0.0, fit.sigma[0]])


def test_one_strength_may_do_what_another_does(verdict):
    """σ² + p u² where the other does it all with probability p: the striker has its mass then."""
    forward, null = verdict.found.forward, verdict.found.null
    setup = singles.setup_of(forward)
    speed, mass, _ = variants(effect("striker-error"), setup)
    fits = [
        Fit(h, linearise(forward, h, np.array([[u]]), null.nu[None]))
        for h, u in ((Hypothesis((Component(effect("striker-error"), free),)), 0.1) for free in (mass, speed))
    ]
    one = Candidate("striker-error", fits[0], 9.0, 3.0, instead=((0.0, fits[1]),))
    assert [share for share, _ in one.ways] == [0.5, 0.5]
    found = rivals.of_odds({"striker-error": 0.8, "none": 0.2}, null, [one], [])
    assert sorted(r.probability for r in found) == pytest.approx([0.2, 0.4, 0.4])
    ((share, off),) = rivals.shifts(fits[0], found)
    assert (share.tolist(), off.tolist()) == ([0.5, 0.5], [0.0, -0.1])
    # Another nominal fit is worth as much to both; a better fit of the one makes the other less likely.
    lower = SimpleNamespace(objective=null.objective - 5.0)
    assert rounds._moved(one, lower, fits[0], ()).ways == one.ways
    better = SimpleNamespace(objective=fits[0].objective - 2.0 * np.log(3.0))
    shares = [share for share, _ in rounds._moved(one, null, better, ()).ways]
    assert shares == pytest.approx([0.75, 0.25])


def test_draws_are_of_the_mixture(fit):
    """Two explanations ten standard errors apart with 0.7 and 0.3: quantiles are those of the nearer one up
    to 0.7, of the farther one from there on.
    """
    share = (np.arange(20_000) + 0.5) / 20_000
    normal = fit.u[0] + fit.sigma[0] * ndtri(share)
    found = [Rival(0.7, fit), Rival(0.3, beside(fit, 10.0, 0.0))]
    weight = np.full(len(share), 1.0 / len(share))
    ((how, u, weight),) = posterior._averaged(fit, [(draws.SAMPLED, normal, weight)], found)
    one = draws.Draws("a", "b", how, (u - fit.u[0]) / fit.sigma[0], weight)
    assert how == draws.AVERAGED
    assert weight.sum() == pytest.approx(1.0)
    for at in (0.05, 0.5, 0.8, 0.95):
        exact = ndtri(at / 0.7) if at < 0.7 else 10.0 + ndtri((at - 0.7) / 0.3)
        assert one.quantile(at) == pytest.approx(exact, abs=1e-3)  # the distance of the draws


def test_rivals_that_agree_change_nothing(fit):
    drawn = [(draws.SAMPLED, fit.u + fit.sigma * np.linspace(-2.0, 2.0, 5), np.full(5, 0.2))]
    ((how, u, _),) = posterior._averaged(fit, drawn, [Rival(0.9, fit), Rival(0.1, beside(fit, 0.5, 0.0))])
    assert how == draws.SAMPLED
    assert u is drawn[0][1]


def test_rivals_go_by_their_weights_and_faint_ones_are_left_aside(verdict, fit):
    sets = [Combination(("kuwabara-kono",), fit, 0.0, 0.0), Combination((), verdict.found.null, 0.0, 0.0)]
    found = rivals.of_weights({"kuwabara-kono": np.log(3.0), "none": 0.0, "tsuji": -20.0}, sets)
    assert [one.probability for one in found] == pytest.approx([0.75, 0.25], abs=1e-8)  # e^-20 left aside
    assert [one.fit for one in found] == [fit, verdict.found.null]


def test_a_verdict_has_its_own_explanation_among_its_rivals(verdict):
    assert any(one.fit is verdict.found.final and one.probability > 0.5 for one in verdict.found.rivals)
