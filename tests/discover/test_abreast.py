"""Hypotheses followed side by side: as one after the other, whatever is ready first, fails or is stopped."""

import time

import numpy as np
import pytest

from sonicvacuum import stages
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model import forward as model
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment


@pytest.fixture
def long_calls(monkeypatch):
    """As if every call took long."""
    monkeypatch.setattr(model, "LONG_CALL", -1.0)


def sampled(forward):
    return forward.sampled(Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))


def ready(hidden, threads):
    """A predictor that was asked once."""
    forward = Forward(experiment(hidden), threads)
    sampled(forward)
    return forward


@pytest.mark.parametrize("threads", [1, 3])
def test_results_and_what_serves_come_in_the_order_of_the_items(hidden, long_calls, threads):
    forward = ready(hidden, threads)
    forward.strengths["kept"] = forward.strengths["both"] = np.zeros(1)

    def work(branch, k):
        time.sleep(0.02 * (3 - k))  # the first is ready last
        sampled(branch)
        assert branch.strengths["both"] == 0.0  # what others found is not known here
        branch.strengths["both"] = np.array([float(k)])
        branch.memory.recalled(Hypothesis(), np.zeros(0), np.zeros(1), k, lambda: k)
        return 10 * k

    before = forward.simulations
    assert abreast.each(forward, work, range(4)) == [0, 10, 20, 30]
    assert forward.simulations == 5 * before and forward.calls == 5
    assert forward.strengths["both"] == 3.0 and forward.strengths["kept"] == 0.0
    known = [forward.memory.recalled(Hypothesis(), np.zeros(0), np.zeros(1), k, lambda: "") for k in range(4)]
    assert known == [0, 1, 2, 3]


def test_threads_and_chains_in_the_memory_are_shared_out(hidden, long_calls):
    forward = ready(hidden, 5)
    shares = abreast.each(forward, lambda branch, k: (branch.threads, branch.chunk), range(2))
    assert shares == [(2, model.CHUNK // 2)] * 2
    (alone,) = abreast.each(forward, lambda branch, k: (branch.threads, branch.chunk), range(1))
    assert alone == (5, model.CHUNK)


def test_predictions_do_not_depend_on_how_many_chains_are_simulated_at_once(hidden):
    forward = ready(hidden, 1)
    nu = np.random.default_rng(np.random.SeedSequence(3)).standard_normal((7, forward.layout.size))
    whole = forward.sampled(Hypothesis(), np.zeros((7, 0)), nu)
    forward.chunk = 4
    parts = forward.sampled(Hypothesis(), np.zeros((7, 0)), nu)
    assert all(np.array_equal(a, b) for a, b in zip(whole, parts, strict=True))


@pytest.mark.parametrize("threads", [1, 2])
def test_one_that_fails_ends_all(hidden, long_calls, threads):
    forward, begun = ready(hidden, threads), []

    def work(branch, k):
        begun.append(k)
        if k == 0:
            raise ZeroDivisionError("of the first")
        for _ in range(100_000):
            sampled(branch)

    with pytest.raises(ZeroDivisionError, match="of the first"):
        abreast.each(forward, work, range(9))
    assert len(begun) <= threads + 1


def test_an_interruption_stops_threads_at_their_next_call(hidden, long_calls):
    forward, ended = ready(hidden, 2), []

    def work(branch, k):
        try:
            for _ in range(100_000 * k):
                sampled(branch)
        finally:
            ended.append(k)

    def interrupted(name, done, total):
        if done:
            raise KeyboardInterrupt

    with stages.told_to(interrupted), pytest.raises(KeyboardInterrupt):
        abreast.each(forward, work, range(2), "a stage")
    assert sorted(ended) == [0, 1]


def test_threads_are_for_long_calls(hidden):
    forward = ready(hidden, 2)
    assert forward.calls == 1 and forward.seconds > 0.0
    forward.calls, forward.seconds = 2, 2.1 * model.LONG_CALL
    assert forward.long_calls
    forward.seconds = 1.9 * model.LONG_CALL
    assert not forward.long_calls
