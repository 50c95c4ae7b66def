"""Work shared out among this process and copies of it (`fork`), which begin with all that it knows.

What was loaded and read need not be handed over, and what is asked need not be written down: only results
are, through pipes. A copy hears of no interruption and tells nobody of stages; it ends when all is done, or
when nobody is there any more to tell.
"""

import multiprocessing
import os
import pickle
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from threading import current_thread, main_thread
from typing import TypeVar

from sonicvacuum import stages
from sonicvacuum.physics import watch

Result = TypeVar("Result")

# Bytes of a number, and how many a pipe takes before anybody reads: 4 kB, the least that Linux gives one.
_BYTES, _MOST = 4, 1024
# Set while there are copies, in them and in the process that made them: none makes more.
_shared_out = False


def possible() -> bool:
    """Whether copies can be made: not on macOS, whose libraries do not survive it, nor on Windows; nor from
    a thread beside the main one, where what others hold would stay held in the copy.
    """
    return sys.platform == "linux" and current_thread() is main_thread() and not _shared_out


def each(task: Callable[[int], Result], count: int, processes: int, done: Callable[[], None]) -> list[Result]:
    """`task(k)` for k from 0 to count - 1, in this order, by so many processes at a time, of which this is
    one: whoever is free takes the next.

    What cannot be done or handed over (an error; a result that cannot be pickled; too little memory) is done
    here once more, when all others are ready, where an error is raised as it would be without copies.

    Args:
        task: what is done.
        count: how often.
        processes: at a time.
        done: called after each.
    """
    global _shared_out
    found: dict[int, Result] = {}
    numbers, begun = _numbers(min(count, _MOST)), []
    _shared_out = True
    try:
        with suppress(OSError):  # the system has no room for another process: these do
            for _ in range(min(processes, count) - 1):
                begun.append(_copy(task, numbers, [pipe for pipe, _ in begun]))
        told = [pipe for pipe, _ in begun]
        while (k := _next(numbers)) is not None:
            try:
                with stages.unheard():
                    found[k] = task(k)
            except Exception:
                continue
            done()
            _hear(told, found, done, 0.0)
        while told:
            _hear(told, found, done, None)
    finally:
        _shared_out = False
        os.close(numbers)
        for pipe, process in begun:
            pipe.close()
            if len(found) < count:
                process.terminate()
        # Those that have told all end by themselves; whoever makes the next one looks after them.
        for _, process in begun if len(found) < count else ():
            process.join()
    for k in range(count):
        if k not in found:
            found[k] = task(k)
            done()
    return [found[k] for k in range(count)]


def _numbers(count):
    """A pipe from which each number below `count` can be read once, by whoever comes first."""
    given, taken = os.pipe()
    os.write(taken, b"".join(k.to_bytes(_BYTES, "little") for k in range(count)))
    os.close(taken)
    return given


def _next(numbers):
    """The next number; None after the last."""
    number = os.read(numbers, _BYTES)
    return int.from_bytes(number, "little") if number else None


def _hear(told: list[Connection], found: dict, done: Callable[[], None], patience: float | None) -> None:
    """Take in what copies tell: `None` for each task that is done, in the end all results."""
    for pipe in wait(told, patience):
        try:
            results = pipe.recv()
        except (EOFError, OSError):
            told.remove(pipe)  # it was ended from outside
            continue
        if results is None:
            done()
            continue
        told.remove(pipe)
        for k, result in results.items():
            try:
                found[k] = pickle.loads(result)
            except Exception:
                continue  # what it wrote cannot be read here


def _copy(task, numbers, others):
    """(our end of a pipe, process): a copy of this process that takes its share of the numbers; `others` are
    our ends of the copies made before, which it must not keep open.
    """
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(task, numbers, [ours, *others], theirs))
    process.start()
    theirs.close()
    return ours, process


def _serve(task, numbers, ours, theirs):
    """What a copy does."""
    for pipe in ours:
        pipe.close()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    stages.silent()
    watch.silent()
    results = {}
    try:
        while (k := _next(numbers)) is not None:
            try:
                results[k] = pickle.dumps(task(k), pickle.HIGHEST_PROTOCOL)
            except Exception:
                continue
            theirs.send(None)
        theirs.send(results)
    except OSError:
        pass  # nobody asks any more
