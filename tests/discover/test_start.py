"""Where time zero is unknown: what suits all runs tells an echo from the pulse."""

import numpy as np
import pytest
from test_gross import made

from sonicvacuum.discover.model import accuracy, start
from sonicvacuum.discover.model.problem import experiment

TIME = np.arange(400.0)


def trace(pulse, echo, late):
    """A pulse and its echo 150 samples later."""
    bump = lambda at: np.exp(-np.square((TIME - at - late) / 8.0))  # noqa: E731
    return pulse * bump(60.0) + echo * bump(210.0)


def test_an_echo_that_looks_more_like_the_pulse_is_not_taken_for_it():
    # A decaying gauge weakens the pulse of the second run until its echo is the larger.
    pairs = {
        0: [(trace(1.0, 0.5, 20.0), trace(1.0, 0.3, 0.0))],
        1: [(trace(0.6, 1.0, 25.0), trace(1.0, 0.3, 0.0))],
    }
    assert start._lags({1: pairs[1]}) == {1: 175}  # alone it is
    assert start._lags(pairs) == {0: 20, 1: 25}


def test_a_run_that_suits_no_other_keeps_its_own_shift():
    pairs = {
        0: [(trace(1.0, 0.0, 10.0), trace(1.0, 0.0, 0.0))],
        1: [(trace(1.0, 0.0, 12.0), trace(1.0, 0.0, 0.0))],
        2: [(trace(1.0, 0.0, 250.0), trace(1.0, 0.0, 0.0))],
    }
    assert start._lags(pairs) == {0: 10, 1: 12, 2: 250}


def test_a_trace_upside_down_lies_where_it_would_the_right_way_up():
    """The gauge that is inverted pushed its run to where its pulse met nothing."""
    upright, inverted = (trace(size, 0.0, 20.0) for size in (1.0, -2.0))
    model = trace(1.0, 0.0, 0.0)
    assert start._lags({0: [(inverted, model), (upright, model)]}) == {0: 20}


@pytest.mark.parametrize("lengths", [(400, 300), (250, 400)])
def test_runs_of_unequal_length_are_held_against_each_other(lengths):
    pairs = {
        k: [(trace(1.0, 0.4, 7.0)[:length], trace(1.0, 0.4, 0.0)[:length])]
        for k, length in enumerate(lengths)
    }
    assert start._lags(pairs) == {0: 7, 1: 7}


def test_starts_are_not_held_against_shorter_steps(monkeypatch):
    """With the gains of another unit no step is short enough."""
    record = made((), 0.0)
    monkeypatch.setattr(accuracy, "LASTING", 0.0)
    monkeypatch.setattr(accuracy, "cut", lambda forward: pytest.fail("the steps were held against others"))
    data = experiment(record)
    # A tenth of a volt a newton; the nominal wall is not the one there is.
    assert data.gauges[0].gain == pytest.approx(0.1, rel=0.5)


def test_a_gain_that_nobody_knows_is_that_of_the_pulse_whichever_way_up():
    """What noise has of the pulse the right way up made the model's too small: no pulse was missed there."""
    noise = 0.05 * np.random.default_rng(np.random.SeedSequence(5)).normal(size=len(TIME))
    model = trace(1.0, 0.4, 0.0)
    for way in (1.0, -1.0):
        assert start._factor([(3.0 * way * trace(1.0, 0.4, 12.0) + noise, model)]) == pytest.approx(
            3.0, rel=0.02
        )
