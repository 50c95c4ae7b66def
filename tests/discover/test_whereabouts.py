"""Where an effect may sit: odds of places against fits at every place, and what is said of them."""

from dataclasses import replace

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover import posterior, verdict
from sonicvacuum.discover.draws import PLACES
from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.judge import whereabouts
from sonicvacuum.discover.judge.rivals import Rival
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.effects import effect


def fitted(forward, null, name, place, value):
    """An effect fitted at a place, from a value."""
    own = effect(name)
    hypothesis = Hypothesis((Component(own, variants(own, setup_of(forward))[0], place=place),))
    start = [[hypothesis.coordinates[0].inverse(value)]]
    return fit(forward, hypothesis, np.array(start), null.nu[None])


@pytest.fixture(scope="module")
def faint():
    """A bead 0.05 % light, two standard errors: the data hardly tell where it is."""
    record, _ = made([("mass-defect", {"mass_ratio": 0.9995, "bead": 5})], seed=3)
    forward = Forward(experiment(record), 1)
    null = wide.nominal(forward)
    return forward, null, fitted(forward, null, "mass-defect", 5, 0.9995)


@pytest.fixture(scope="module")
def odds(faint):
    forward, _, told = faint
    return whereabouts.spread(forward, told, setup_of(forward))


def test_odds_are_those_of_fits_at_every_bead(faint, odds):
    """Likelihoods, the prior of strengths being the same everywhere; each bead from ten starts by itself."""
    forward, null, told = faint
    free = told.hypothesis.coordinates[0]
    ratios = [free.inverse(x) for x in (0.99, 0.996, 0.998, 0.999, 0.9995, 1.0005, 1.001, 1.002, 1.004, 1.01)]
    u, nu = np.array(ratios)[:, None], np.repeat(null.nu[None], len(ratios), axis=0)
    best = {b: fit(forward, told.hypothesis.with_places([b]), u, nu, keep=10).objective for b in range(1, 11)}
    likelihood = {b: np.exp(0.5 * (told.objective - x)) for b, x in best.items()}
    total = sum(likelihood.values())
    share = {r.fit.hypothesis.components[0].place: r.probability for r in odds}
    assert len(share) > 3
    for bead, one in likelihood.items():
        # Fits end within a tenth of their χ², and those below a thousandth are left aside.
        assert share.get(bead, 0.0) == pytest.approx(one / total, rel=0.1, abs=2e-3)


def test_shares_begin_with_what_is_told_and_sum_to_one(faint, odds):
    assert odds[0].fit is faint[2]
    assert sum(r.probability for r in odds) == pytest.approx(1.0, abs=0.01)  # ten that may be left aside


def test_a_strong_effect_is_where_it_is():
    record, _ = made([("mass-defect", {"mass_ratio": 0.8, "bead": 5})], seed=3)
    forward = Forward(experiment(record), 1)
    told = fitted(forward, wide.nominal(forward), "mass-defect", 5, 0.8)
    (one,) = whereabouts.spread(forward, told, setup_of(forward))
    assert (one.fit, one.probability) == (told, 1.0)
    assert whereabouts.unsure([one], told, forward.experiment) == []


def test_every_gauge_is_asked():
    """A gain 0.5 % off, of gauges whose gains are known to 2 %: it may be that of any of them."""
    record, _ = made([("sensor-gain", {"gain_ratio": 1.005, "sensor": 1})], seed=5)
    forward = Forward(experiment(record), 1)
    told = fitted(forward, wide.nominal(forward), "sensor-gain", 1, 1.005)
    found = whereabouts.spread(forward, told, setup_of(forward))
    assert {r.fit.hypothesis.components[0].place for r in found} == {0, 1, 2}
    (line,) = whereabouts.unsure(found, told, forward.experiment)
    assert line.startswith("sensor-gain sits at gauge g7 (")
    assert " or g4 (" in line and " or wall (" in line


def test_the_told_explanation_stands_once_for_each_place(faint, odds):
    forward, null, told = faint
    found = whereabouts.among([Rival(0.6, told), Rival(0.3, null)], forward, told)
    own = [r for r in found if whereabouts.same(r.fit, told)]
    assert [r.probability for r in own] == pytest.approx([0.6 * r.probability for r in odds])
    assert [r.probability for r in found if r.fit is null] == [0.3]
    # Nothing is asked of a model without a place.
    assert whereabouts.among([Rival(0.3, null)], forward, null) == [Rival(0.3, null)]
    alone = whereabouts.among([], forward, told)
    assert sum(r.probability for r in alone) == pytest.approx(1.0, abs=0.01)  # as above


def test_a_place_has_an_error_and_its_draws(faint, odds):
    forward, _, told = faint
    (*_, sits) = posterior.posterior(forward, told, odds)
    assert (sits.effect, sits.parameter, sits.how) == ("mass-defect", "bead", PLACES)
    assert sits.value[0] == 5.0
    assert sits.weight.sum() == pytest.approx(1.0)
    bead = verdict.parameters(told, odds, [sits])["mass-defect"]["bead"]
    assert bead.value == 5.0
    assert bead.sigma == pytest.approx(np.sqrt(sits.weight @ np.square(sits.value - 5.0)))
    assert bead.sigma > 0.5
    assert verdict.parameters(told)["mass-defect"]["bead"].sigma == 0.0


def test_a_strength_holds_what_other_places_make_of_it(faint, odds):
    """Law of total variance about what is told: σ² and the mean square of what the fits differ by."""
    _, _, told = faint
    inside = [(r.probability, r.fit.u[0] - told.u[0]) for r in odds]
    share, off = np.array(inside).T
    wider = np.sqrt(told.sigma[0] ** 2 + (share / share.sum()) @ np.square(off))
    alone, found = (verdict.parameters(told, r)["mass-defect"]["mass_ratio"] for r in ((), odds))
    assert found.sigma == pytest.approx(alone.sigma * wider / told.sigma[0])
    assert found.sigma > 1.2 * alone.sigma


def test_of_several_effects_each_has_its_places(faint, odds):
    _, _, told = faint
    gain = Component(effect("sensor-gain"), variants(effect("sensor-gain"), None)[0], place=1)

    def both(one):
        pair = replace(one.hypothesis, components=(*one.hypothesis.components, gain))
        return replace(one, hypothesis=pair)

    found = whereabouts.of_each([replace(r, fit=both(r.fit)) for r in odds], both(told))
    (bead, at, share), (gauge, of, all_of_it) = found
    assert (bead.id, gauge.id) == ("mass-defect", "sensor-gain")
    assert at.tolist() == [r.fit.hypothesis.components[0].place for r in odds]
    assert share == pytest.approx([r.probability for r in odds], rel=0.01)  # what was left aside is shared
    assert (of.tolist(), all_of_it.tolist()) == ([1], [1.0])
