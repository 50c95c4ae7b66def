"""One effect with a place, tried around where it was found: the narrow minimum next door, and what stays."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover import rounds
from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import around, pairs
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.effects import effect


def found(hidden, name, strength, place, seed=3):
    """A predictor, and the fit of one effect that begins at a strength and a place."""
    forward = Forward(experiment(made(hidden, seed=seed)[0]))
    null, setup = wide.nominal(forward), setup_of(forward)
    free = variants(effect(name), setup)[0]
    hypothesis = Hypothesis((Component(effect(name), free),))
    u = np.array([[c.inverse(strength) for c in free]])
    where = None if place is None else np.array([[place]])
    return forward, fit(forward, hypothesis, u, null.nu[None], where), setup


@pytest.mark.parametrize(
    ("name", "key", "hidden", "place", "start", "beside"),
    [
        ("contact-gap", "contact", 0.9, 5, 0.3, 6),
        # The first round leads to the place, with half the width.
        ("contact-gap", "contact", 0.9, 3, 0.27, 5),
        ("mass-defect", "bead", 0.93, 5, 1.04, 6),
        ("mass-defect", "bead", 0.93, 5, 0.97, 3),
    ],
)
def test_a_narrow_minimum_at_another_place_is_found(name, key, hidden, place, start, beside):
    strength = effect(name).parameters[0].name
    forward, one, setup = found([(name, {strength: hidden, key: place})], name, start, beside)
    better = around.refined(forward, one, setup)
    assert better.objective < one.objective - 10.0  # beyond what noise makes of one parameter
    assert better.hypothesis.components[0].place == place
    value = better.hypothesis.values(better.u)[name][strength]
    slope = abs(better.hypothesis.coordinates[0].value(better.u + better.sigma)[0] - value)
    assert abs(value - hidden) < 4.0 * slope  # four standard errors


@pytest.fixture(scope="module")
def one_contact_on():
    """A predictor, the nominal fit, and a gap beside a gauge of another gain where its fit came to rest:
    at the next contact, a third as wide.
    """
    gained = ("sensor-gain", {"gain_ratio": 1.2, "sensor": 1})
    hidden = ("contact-gap", {"gap_um": 0.9, "contact": 5})
    forward = Forward(experiment(made([gained, hidden], seed=3)[0]))
    null, setup = wide.nominal(forward), setup_of(forward)
    gain, gap = (
        Component(effect(name), variants(effect(name), setup)[0], place=place)
        for name, place in (("sensor-gain", 1), ("contact-gap", 6))
    )
    both = Hypothesis((gain,)).with_component(gap)
    u = np.array([[c.inverse(value) for c, value in zip(both.coordinates, (1.2, 0.3), strict=True)]])
    return forward, null, fit(forward, both, u, null.nu[None])


def test_a_gap_beside_another_effect_is_found_where_it_is(one_contact_on):
    forward, _, one = one_contact_on
    better = around.refined(forward, one, setup_of(forward))
    assert [c.place for c in better.hypothesis.components] == [1, 5]
    assert better.objective < one.objective - 10.0  # beyond what noise makes of one parameter
    width, error = one.hypothesis.coordinates[1].value(better.u[1]), better.sigma[1]
    assert abs(np.log(width / 0.9)) < 4.0 * error  # four standard errors of its logarithm


@pytest.mark.parametrize(("behind", "asked"), [(0.0, True), (pairs.NEAR + 1.0, False)])
def test_narrow_minima_are_looked_for_in_pairs_near_the_best(one_contact_on, monkeypatch, behind, asked):
    """A gap and a droop of d′ 50 stood one contact on, a third short of what they gain: all was unknown."""
    forward, null, one = one_contact_on
    own = pairs.Pairs.__new__(pairs.Pairs)
    own.forward, own.null, own.setup, own.found = forward, null, setup_of(forward), {}
    own._note(one)
    (before,) = own.ranked
    monkeypatch.setattr(pairs.places, "placed", lambda fit: fit is one)
    best = replace(before, effects=("sensor-gain", "gravity"), fit=None, log_bayes=before.log_bayes + behind)
    own.found[frozenset(best.effects)] = best
    own._refine()
    after = own.found[frozenset(one.hypothesis.ids)]
    assert (after.gain > before.gain + 10.0) is asked  # beyond what noise makes of one parameter


def test_a_large_gap_is_found_where_a_lighter_bead_was():
    """A gap of 0.61 um was told as a bead 7 % light: slopes had led to one of 0.02 um five contacts on."""
    hidden = [("contact-gap", {"gap_um": 1.5, "contact": 4})]
    forward, one, setup = found(hidden, "contact-gap", 0.02, 9)
    _, lighter, _ = found(hidden, "mass-defect", 0.95, 4)
    null = wide.nominal(forward)
    better = around.beside(forward, null, one, lighter, setup)
    assert better.hypothesis.components[0].place in (3, 4, 5)
    assert better.objective < min(one.objective, lighter.objective)
    better = around.refined(forward, better, setup)
    assert better.hypothesis.components[0].place == 4
    width, error = better.hypothesis.coordinates[0].value(better.u[0]), better.sigma[0]
    assert abs(np.log(width / 1.5)) < 4.0 * error  # four standard errors of its logarithm
    assert around.beside(forward, null, better, lighter, setup) is better


def test_a_fit_at_its_minimum_stays_as_it_is():
    hidden = [("mass-defect", {"mass_ratio": 1.06, "bead": 5})]
    forward, one, setup = found(hidden, "mass-defect", 1.06, 5)
    assert around.refined(forward, one, setup) is one


def test_what_has_no_place_is_not_tried():
    forward, one, setup = found([("viscous-drag", {"rate_per_s": 150.0})], "viscous-drag", 150.0, None)
    before = forward.simulations
    assert around.refined(forward, one, setup) is one
    assert forward.simulations == before


@pytest.mark.parametrize(
    ("gains", "asked"),
    [
        ({"mass-defect": 1762.0, "contact-gap": 412.0, "gravity": 90.0}, ["mass-defect", "contact-gap"]),
        ({"gravity": 1762.0, "mass-defect": 412.0, "contact-gap": 90.0}, []),
        ({"contact-gap": 40.0, "mass-defect": 0.0, "gravity": 30.0}, ["contact-gap"]),
    ],
    ids=["one leads", "none is near the best", "what gains nothing"],
)
def test_all_with_a_place_are_looked_for_where_one_leads(monkeypatch, gains, asked):
    """A gap of d′ 50 gained 412 where its slopes had led it, and a lighter bead 1762; 2539 one contact on."""
    followed, tried = [], []
    fits = {name: SimpleNamespace(name=name) for name in gains}
    monkeypatch.setattr(rounds.singles, "setup_of", lambda forward: None)
    monkeypatch.setattr(rounds.places, "placed", lambda fit: fit.name != "gravity")
    monkeypatch.setattr(
        rounds.places, "settled", lambda forward, fit, setup: followed.append(fit.name) or fit
    )
    monkeypatch.setattr(rounds.around, "refined", lambda forward, fit, setup: fit)
    monkeypatch.setattr(
        rounds.around,
        "beside",
        lambda forward, null, fit, other, setup: tried.append((fit.name, other.name)) or fit,
    )
    monkeypatch.setattr(rounds.enough, "first", lambda forward, found: found)
    monkeypatch.setattr(rounds.evidence, "ranked", lambda found, odds: found)
    monkeypatch.setattr(rounds.abreast, "each", lambda forward, work, ks: [work(forward, k) for k in ks])
    found = [SimpleNamespace(effect=name, gain=gain, fit=fits[name]) for name, gain in gains.items()]
    forward = SimpleNamespace(experiment=SimpleNamespace(prior_odds={}))
    assert rounds._along(forward, None, found) == found
    assert followed == asked
    # Each of the others where the leading one was found.
    assert tried == [(name, asked[0]) for name in asked[1:]]
