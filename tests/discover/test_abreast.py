"""Hypotheses followed side by side: as one after the other, whatever is ready first, fails or is stopped."""

import multiprocessing
import os
import signal
import time

import numpy as np
import pytest

from sonicvacuum import stages
from sonicvacuum.discover.model import abreast, copies
from sonicvacuum.discover.model import forward as model
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment

needs_copies = pytest.mark.skipif(not copies.possible(), reason="this system makes no copies of a process")


@pytest.fixture
def worth_it(monkeypatch):
    """As if copies always gained."""
    monkeypatch.setattr(abreast, "SAVED", -1.0)


@pytest.fixture
def no_copies_yet():
    """Copies of tests before, which have told all and end by themselves, have ended."""
    for process in multiprocessing.active_children():
        process.join()


def sampled(forward):
    return forward.sampled(Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))


def awaited(path):
    """Wait for a file; for a minute at most, so that a test that has gone wrong fails and does not hang."""
    late = time.monotonic() + 60.0
    while not path.exists() and time.monotonic() < late:
        time.sleep(0.01)


def ready(hidden, threads):
    """A predictor that was asked once."""
    forward = Forward(experiment(hidden), threads)
    sampled(forward)
    return forward


@pytest.mark.parametrize("threads", [1, 3])
def test_results_and_what_serves_come_in_the_order_of_the_items(hidden, worth_it, threads, tmp_path):
    forward = ready(hidden, threads)
    apart = threads > 1 and copies.possible()
    forward.strengths["kept"] = forward.strengths["both"] = np.zeros(1)

    def work(branch, k):
        if apart and k < 2:
            awaited(tmp_path / f"{k + 1}")  # the first is ready last
        sampled(branch)
        assert branch.strengths["both"] == 0.0  # what others found is not known here
        branch.strengths["both"] = np.array([float(k)])
        branch.memory.recalled(Hypothesis(), np.zeros(0), np.zeros(1), k, lambda: k)
        sampled(branch.coarse)
        (tmp_path / f"{k}").touch()
        return 10 * k

    before = forward.simulations
    assert abreast.each(forward, work, range(4)) == [0, 10, 20, 30]
    assert forward.simulations == 5 * before and forward.calls == 5
    assert forward.coarse.simulations == 4 * before
    assert forward.strengths["both"] == 3.0 and forward.strengths["kept"] == 0.0
    known = [forward.memory.recalled(Hypothesis(), np.zeros(0), np.zeros(1), k, lambda: "") for k in range(4)]
    assert known == [0, 1, 2, 3]


def test_threads_are_shared_out(hidden, worth_it):
    forward = ready(hidden, 5)
    assert abreast.each(forward, lambda branch, k: branch.threads, range(2)) == [2, 2]
    assert abreast.each(forward, lambda branch, k: branch.threads, range(1)) == [5]


@pytest.mark.parametrize("threads", [1, 2])
def test_as_many_chains_go_at_once_whatever_the_processors(hidden, worth_it, threads, monkeypatch):
    """The last digits of a chain may depend on those beside it."""
    monkeypatch.setattr(model, "CHUNK", 8)
    forward = ready(hidden, threads)

    def work(branch, k):
        own, simulate = [], branch.simulate
        branch.simulate = lambda batch, setup, *rest: (
            own.append(setup.chain.lanes) or simulate(batch, setup, *rest)
        )
        branch.sampled(Hypothesis(), np.zeros((20, 0)), np.zeros((20, forward.layout.size)))
        return own

    for sizes in abreast.each(forward, work, range(2)):
        assert sum(sizes) == 20 * forward.layout.runs and max(sizes) <= 8


def test_predictions_do_not_depend_on_how_many_chains_are_simulated_at_once(hidden, monkeypatch):
    forward = ready(hidden, 1)
    nu = np.random.default_rng(np.random.SeedSequence(3)).standard_normal((7, forward.layout.size))
    whole = forward.sampled(Hypothesis(), np.zeros((7, 0)), nu)
    monkeypatch.setattr(model, "CHUNK", 4)
    parts = forward.sampled(Hypothesis(), np.zeros((7, 0)), nu)
    assert all(np.array_equal(a, b) for a, b in zip(whole, parts, strict=True))


@pytest.mark.parametrize("threads", [1, 2])
def test_one_that_fails_raises_here(hidden, worth_it, no_copies_yet, threads):
    def work(branch, k):
        if k == 1:
            raise ZeroDivisionError("of the second")

    with pytest.raises(ZeroDivisionError, match="of the second"):
        abreast.each(ready(hidden, threads), work, range(3))
    assert not multiprocessing.active_children()


@needs_copies
def test_an_interruption_ends_all_copies(hidden, worth_it, no_copies_yet):
    here = os.getpid()

    def interrupted(name, done, total):
        if done:
            raise KeyboardInterrupt

    def work(branch, k):
        time.sleep(1000.0 * k if os.getpid() != here else 0.0)

    with stages.told_to(interrupted), pytest.raises(KeyboardInterrupt):
        abreast.each(ready(hidden, 2), work, range(2), "a stage")
    assert not multiprocessing.active_children()


@needs_copies
def test_what_a_copy_cannot_do_or_hand_over_is_done_here(hidden, worth_it, tmp_path):
    """A result that cannot be pickled; a copy that is killed, as for want of memory."""
    forward, here = ready(hidden, 3), os.getpid()
    killed, did = tmp_path / "at which one copy was killed", tmp_path / "the other copy did one"

    def work(branch, k):
        if os.getpid() == here:
            awaited(did)
        elif k > 1:
            try:
                with open(killed, "x") as file:
                    file.write(str(k))
            except FileExistsError:
                did.touch()
            else:
                os.kill(os.getpid(), signal.SIGKILL)
        return (lambda: k) if k == 1 else (k, os.getpid() == here)

    found = abreast.each(forward, work, range(12))
    lost = int(killed.read_text())
    assert found[1]() == 1 and found[lost] == (lost, True)
    assert [k for k, _ in (found[0], *found[2:])] == [0, *range(2, 12)]
    assert not all(by for _, by in found[2:])  # the other copy did some of it


@needs_copies
def test_more_than_a_pipe_holds_is_done_too(monkeypatch):
    monkeypatch.setattr(copies, "_MOST", 3)
    done = []
    assert copies.each(lambda k: k * k, 8, 2, lambda: done.append(1)) == [k * k for k in range(8)]
    assert len(done) == 8


@needs_copies
def test_without_room_for_a_copy_all_is_done_here(monkeypatch):
    def no_room(*_):
        raise BlockingIOError("no more processes")

    monkeypatch.setattr(copies, "_copy", no_room)
    done = []
    assert copies.each(lambda k: os.getpid(), 3, 2, lambda: done.append(1)) == [os.getpid()] * 3
    assert len(done) == 3 and copies.possible()


@needs_copies
def test_who_is_free_takes_the_next(tmp_path):
    """A task that takes long holds up none of the others."""
    here, rest = os.getpid(), tmp_path / "the rest is done"

    def task(k):
        if k == 0:
            awaited(rest)
        if k == 19:
            rest.touch()
        return os.getpid()

    by = copies.each(task, 20, 2, lambda: None)
    assert len(set(by[1:])) == 1 and by[0] not in by[1:] and here in by


@needs_copies
def test_a_copy_tells_nobody_and_makes_no_copies(hidden, worth_it):
    told = []

    def work(branch, k):
        inner = abreast.each(branch, lambda branch, k: os.getpid(), range(2), "an inner stage")
        return {os.getpid(), *inner}

    with stages.told_to(lambda *one: told.append(one)):
        processes = abreast.each(ready(hidden, 4), work, range(2), "a stage")
    assert told == [("a stage", k, 2) for k in range(3)]
    assert [len(own) for own in processes] == [1, 1]


def test_copies_are_for_what_takes_long(hidden):
    forward = ready(hidden, 2)
    assert forward.calls == 1 and forward.seconds_of_call == forward.seconds > 0.0
    forward.seconds = 1.1 * abreast.SAVED / (2 * abreast.FIT)
    assert abreast._beside(forward, 4, abreast.FIT) == (2 if copies.possible() else 1)
    assert abreast._beside(forward, 4, abreast.SLOPES) == abreast._beside(forward, 1, abreast.FIT) == 1
    forward.seconds = 0.9 * abreast.SAVED / (2 * abreast.FIT)
    assert abreast._beside(forward, 4, abreast.FIT) == 1
