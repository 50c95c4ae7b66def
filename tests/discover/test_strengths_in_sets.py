"""Which strength of an effect acts in a set: a lighter striker told as a slower one beside another effect."""

from types import SimpleNamespace

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover import posterior
from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.judge import whereabouts
from sonicvacuum.discover.judge.rivals import Rival
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import pairs, strengths
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.effects import effect

LIGHT, OFFSET = 0.9, 0.01
SPEED, MASS, BOTH = ("speed_ratio",), ("mass_ratio",), ("speed_ratio", "mass_ratio")


def free(one):
    """Names of the striker's strengths that are free in a fit."""
    (own,) = (c.free for c in one.hypothesis.components if c.effect.id == "striker-error")
    return tuple(x.parameter.name for x in own)


def objectives(fits):
    return {free(one): one.objective for one in fits}


@pytest.fixture(scope="module")
def told_as_slower():
    """Predictor, nominal fit, and a fit of the offset with the striker's speed free in place of its mass."""
    hidden = [
        ("sensor-offset", {"offset_fraction": OFFSET, "sensor": 1}),
        ("striker-error", {"speed_ratio": 1.0, "mass_ratio": LIGHT}),
    ]
    forward = Forward(experiment(made(hidden, seed=4, speeds=(0.6,))[0]), 1)
    null, setup = wide.nominal(forward), setup_of(forward)
    offset, striker = effect("sensor-offset"), effect("striker-error")
    hypothesis = Hypothesis(
        (
            Component(offset, variants(offset, setup)[0], place=1),
            Component(striker, variants(striker, setup)[0]),
        )
    )
    start = np.array([[OFFSET, -0.05]])
    return forward, null, fit(forward, hypothesis, start, null.nu[None])


@pytest.fixture(scope="module")
def others(told_as_slower):
    forward, _, one = told_as_slower
    return strengths.others(forward, one, setup_of(forward))


def test_each_other_strength_is_fitted_beside_the_rest(told_as_slower, others):
    """Against fits from twelve starts each, by themselves."""
    forward, null, one = told_as_slower
    assert free(one) == SPEED and {free(f) for f in others} == {MASS, BOTH}
    for found in others:
        rows = [[OFFSET, *row] for row in np.linspace(-0.2, 0.2, 12)[:, None] * np.ones(len(free(found)))]
        best = fit(forward, found.hypothesis, np.array(rows), np.repeat(null.nu[None], 12, axis=0), keep=12)
        assert found.objective == pytest.approx(
            best.objective, abs=0.3
        )  # where fits end in the valley of both
        assert [c.place for c in found.hypothesis.components] == [1, None]


def test_more_strengths_leave_no_more(told_as_slower, others):
    left = objectives([told_as_slower[2], *others])
    assert left[BOTH] < min(left[SPEED], left[MASS]) + 0.1  # where fits end


def test_the_likeliest_is_told_and_stays(told_as_slower):
    forward, null, one = told_as_slower
    setup = setup_of(forward)
    likeliest = strengths.settled(forward, null, one, setup)
    assert free(likeliest) == MASS
    value, sigma = likeliest.u[1], likeliest.sigma[1]
    assert abs(value - np.log(LIGHT)) < 4.0 * sigma
    assert strengths.settled(forward, null, likeliest, setup) is likeliest


def test_leading_pairs_are_told_with_their_likeliest_strengths(told_as_slower):
    forward, null, one = told_as_slower
    search = object.__new__(pairs.Pairs)
    search.forward, search.null, search.setup = forward, null, setup_of(forward)
    search.found, search.likeliest = {}, {}
    search._note(one)
    search._with_other_strengths()
    (found,) = search.ranked
    assert free(found.fit) == MASS and found.log_bayes > pairs.combination(null, one, search.setup).log_bayes
    search._with_other_strengths()
    assert search.ranked[0] is found


def test_an_interval_holds_what_the_other_strength_makes_of_it(told_as_slower):
    """The posterior of the mass: as it is where it acts, and none at all where the speed does it."""
    forward, null, one = told_as_slower
    told = strengths.settled(forward, null, one, setup_of(forward))
    odds = whereabouts.among([Rival(1.0, told)], forward, told)
    shares = {free(r.fit): r.probability for r in odds if r.fit.hypothesis.components[0].place == 1}
    assert sum(r.probability for r in odds) == pytest.approx(1.0)
    draws = {d.parameter: d for d in posterior.posterior(forward, told, odds)}["mass_ratio"]
    off = draws.weight[draws.value > 0.5 * (1.0 + LIGHT)].sum() / draws.weight.sum()
    assert off == pytest.approx(shares.get(SPEED, 0.0), abs=0.05)  # both free lies on either side


def test_it_is_said_where_another_strength_may_act():
    def rival(p, **values):
        names = [SimpleNamespace(parameter=SimpleNamespace(name=n)) for n in values]
        striker = SimpleNamespace(effect=SimpleNamespace(id="striker-error"), free=names)
        gauge = SimpleNamespace(effect=SimpleNamespace(id="sensor-offset"), free=[])
        hypothesis = SimpleNamespace(
            components=(gauge, striker),
            ids=("sensor-offset", "striker-error"),
            values=lambda u: {"striker-error": values, "sensor-offset": {}},
        )
        return Rival(p, SimpleNamespace(hypothesis=hypothesis, u=None))

    told = rival(0.6, mass_ratio=0.53)
    lines = whereabouts.instead([told, rival(0.18, speed_ratio=0.66), rival(0.02, speed_ratio=0.9)], told.fit)
    assert lines == ["striker-error: speed_ratio 0.66 instead of mass_ratio 0.53, with probability 0.22"]
