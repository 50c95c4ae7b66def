"""What effects may still gain by slopes: chosen one beside the other, and held against a rival."""

from dataclasses import replace

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import directions, planes, prospects, screen
from sonicvacuum.discover.search.once import Once
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.effects import CATALOGUE


@pytest.fixture(scope="module")
def scores():
    """What slopes say of a record with two weak effects."""
    hidden = made([("viscous-drag", {"rate_per_s": 60.0}), ("sensor-droop", {"tau_us": 4000.0})])[0]
    forward = Forward(experiment(hidden))
    null = nominal(forward)
    return screen.screen(forward, null, directions.catalogue(setup_of(forward)))


def test_one_effect_gains_the_largest_score(scores):
    assert planes.foreseen(scores, 1) == pytest.approx(float(np.square(scores.z).max()), rel=1e-9)  # algebra


def test_each_further_effect_gains_less_than_all_together(scores):
    gains = [planes.foreseen(scores, count) for count in range(5)]
    assert gains[0] == 0.0
    assert np.all(np.diff(gains) >= 0.0)
    # With no sign held and every direction free nothing can gain more.
    gradient, gram = scores.projected
    whole = float(gradient @ np.linalg.pinv(gram, rcond=1e-12, hermitian=True) @ gradient)
    assert gains[-1] <= whole * (1.0 + 1e-6)  # rounding of nearly parallel directions


def test_a_pair_that_is_chosen_in_turn_gains_no_more_than_the_best_pair(scores):
    assert planes.foreseen(scores, 2) <= planes.promised(scores) * (1.0 + 1e-9)  # the same algebra


def test_prospects_are_evidence(scores):
    gained = planes.foreseen(scores, 3)
    assert prospects.by_slopes(10.0, scores, 3) == 10.0 + 0.5 * prospects.FORESEEN * gained
    assert prospects.by_slopes(10.0, scores, 0) == 10.0
    assert prospects.by_last(40.0, 45.0, 2) == 45.0 + 2 * prospects.HOPED * 5.0


DRAG = [("viscous-drag", {"rate_per_s": 300.0})]


@pytest.mark.parametrize(
    ("effects", "excluded", "room", "remains"),
    [
        ([], (), 0, False),  # noise alone is left already
        (DRAG, (), 1, False),
        (DRAG, (), 0, True),  # nothing may be added
        # Where a gauge sits in its bead does little of what drag does.
        (DRAG, tuple(name for name in CATALOGUE.ids if name != "sensor-offset"), 1, True),
    ],
)
def test_a_misfit_remains_where_slopes_promise_too_little_of_it(effects, excluded, room, remains):
    e = replace(experiment(made(effects, seed=3)[0]), excluded=excluded)
    forward = Forward(e)
    null = nominal(forward)
    assert prospects.remains(forward, null, setup_of(forward), room) == remains
    # The same of a set that has no rival to come to.
    assert prospects.hopeless(forward, null, setup_of(forward), room, 1.0, 0.0) == remains


def test_what_is_known_of_a_fit_is_not_worked_out_again():
    once, one, other = Once(), object(), object()
    asked = []

    def work(names):
        asked.extend(names)
        return [10 * name for name in names]

    assert once.of_each(one, [2, 0], work) == [20, 0]
    assert once.of_each(one, [0, 1, 2], work) == [0, 10, 20]
    assert once.of(one, "beside", lambda: 7) == once.of(one, "beside", lambda: 8) == 7
    assert once.of_each(other, [1], work) == [10]
    assert asked == [2, 0, 1, 1]
