"""Fits at a bound of the search: let go where data ask for more, and left alone where they do not."""

from dataclasses import replace

import numpy as np
import pytest

from sonicvacuum.discover.fit import bounds
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.parameters import coordinate
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import several
from sonicvacuum.effects import CATALOGUE, effect


def restricted(record, setup, **ends):
    """Kuwabara–Kono's damping fitted in a range of its coordinate."""
    forward = Forward(experiment(record))
    ((free,),) = variants(effect("kuwabara-kono"), setup)
    free = replace(free, **ends)
    one = Hypothesis((Component(effect("kuwabara-kono"), (free,)),))
    return (
        forward,
        fit(forward, one, np.array([[0.5 * (free.low + free.high)]]), np.zeros((1, forward.layout.size))),
    )


def test_a_fit_at_a_bound_is_followed_beyond(hidden, setup):
    ((full,),) = variants(effect("kuwabara-kono"), setup)
    forward, one = restricted(hidden, setup, high=full.inverse(0.1))
    assert bounds.stuck(one).all()
    assert one.at_bound().all()
    found, held = bounds.beyond(forward, one)
    assert not held
    assert found.u[0] == pytest.approx(full.inverse(0.3), abs=4.0 * found.sigma[0])  # as hidden
    assert found.objective < one.objective


def test_a_bound_that_is_decades_off_is_left_behind(hidden, setup):
    ((full,),) = variants(effect("kuwabara-kono"), setup)
    forward, one = restricted(hidden, setup, low=full.inverse(1e-4), high=full.inverse(1e-3))
    found, held = bounds.beyond(forward, one)
    assert not held
    assert found.u[0] == pytest.approx(full.inverse(0.3), abs=4.0 * found.sigma[0])  # as hidden


def test_what_has_far_to_go_and_hardly_comes_nearer_is_let_go_no_further(hidden, setup):
    ((full,),) = variants(effect("kuwabara-kono"), setup)
    forward, one = restricted(hidden, setup, low=full.inverse(1e-4), high=full.inverse(1e-3))
    before = forward.simulations
    assert bounds.beyond(forward, one, lowest=one.objective - 1e9) == (one, True)
    asked = forward.simulations - before
    near = bounds.beyond(forward, one, lowest=one.objective)
    assert forward.simulations - before > 2 * asked  # a few steps of the first turn, not all of them
    assert near[0].u == pytest.approx(bounds.beyond(forward, one)[0].u, abs=1e-12)  # the same steps


def test_the_bound_towards_off_is_none(empty, setup):
    """Without damping the fit leads to off: nothing is stuck."""
    forward, one = restricted(empty, setup)
    assert not bounds.stuck(one).any()
    assert bounds.beyond(forward, one) == (one, False)


def test_a_contact_that_forgets_at_once_is_not_followed_further(hidden, setup):
    """Sooner than at the bound makes no difference there; in an impact so short that it does, it is."""
    forward, model = Forward(experiment(hidden)), effect("relaxing-contact")
    (free,) = variants(model, setup)
    fastest = np.array([[c.low if not c.parameter.switches else c.high for c in free]])
    one = fit(
        forward,
        Hypothesis((Component(model, free),)),
        fastest,
        np.zeros((1, forward.layout.size)),
        iterations=0,
        finish=False,
    )
    where = [c.parameter.name for c in free].index("tau_us")
    assert bounds.stuck(one)[where]
    assert bounds.stuck(one, soon=0.1 * free[where].value(free[where].low))[where]
    assert not bounds.stuck(one, soon=free[where].value(free[where].low))[where]


@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.id)
def test_wider_bounds_keep_to_what_values_may_mean(effect, setup):
    for parameter in effect.parameters:
        wide = bounds._wider(coordinate(parameter, setup))
        for u in (wide.low, wide.high):
            parameter.check(wide.value(u), effect.id)
        far = replace(wide, low=wide.low - 50.0, high=wide.high + 50.0)
        for _ in range(3):
            far = bounds._wider(far)
        for u in (far.low, far.high):
            parameter.check(far.value(u), effect.id)


def test_a_bound_is_near_within_a_standard_error_and_never_towards_off(hidden, empty, setup):
    _, one = restricted(hidden, setup)
    assert not bounds.near(one).any()
    _, close = restricted(hidden, setup, high=one.u[0] + 0.5 * one.sigma[0])
    assert bounds.near(close).all()
    _, off = restricted(empty, setup)
    assert not bounds.near(off).any()


def test_a_set_near_a_bound_is_held_against_others_all_over_there(hidden, setup, monkeypatch):
    """Damping beside a striker's speed, held just short of what it should be: every law is tried in its
    place, those of which slopes promise little too.
    """
    forward = Forward(experiment(hidden))
    ((free,),) = variants(effect("kuwabara-kono"), setup)
    speed = next(v for v in variants(effect("striker-error"), setup) if len(v) == 1)
    parts = (
        Component(effect("kuwabara-kono"), (replace(free, high=free.inverse(0.29)),)),
        Component(effect("striker-error"), speed),
    )
    nu = np.zeros((1, forward.layout.size))
    null = fit(forward, Hypothesis(), np.zeros((1, 0)), nu)
    one = fit(forward, Hypothesis(parts), np.array([[0.5 * free.inverse(0.29), 0.0]]), nu)
    asked, instead = [], several.pairs.instead
    monkeypatch.setattr(several.pairs, "instead", lambda *given: asked.append(given[3]) or instead(*given))
    turns = several.Turns(forward, None, 12.0, setup, infer=False)
    turns.null = null
    turns.rivals(one)
    assert asked == [0]
