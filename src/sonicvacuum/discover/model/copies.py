"""Work shared out among copies of this process (`fork`), which begin with all that it knows.

What was loaded and read need not be handed over, and what is asked need not be written down: only results
are, through pipes. A copy hears of no interruption and tells nobody of stages; it ends when its pipe does.
"""

import multiprocessing
import signal
import sys
from collections import deque
from collections.abc import Callable
from multiprocessing.connection import wait
from threading import current_thread, main_thread
from typing import TypeVar

from sonicvacuum import stages
from sonicvacuum.physics import watch

Result = TypeVar("Result")

# Set in a copy, which makes none itself.
_is_copy = False


def possible() -> bool:
    """Whether copies can be made: not on macOS, whose libraries do not survive it, nor on Windows; nor from
    a thread beside the main one, where what others hold would stay held in the copy.
    """
    return sys.platform == "linux" and current_thread() is main_thread() and not _is_copy


def each(task: Callable[[int], Result], count: int, processes: int, done: Callable[[], None]) -> list[Result]:
    """`task(k)` for k from 0 to count - 1, in this order, by so many copies at a time.

    What a copy cannot do or hand over (an error; a result that cannot be pickled; too little memory) is done
    here, once the others are ready, where an error is raised as it would be without copies.

    Args:
        task: what is done.
        count: how often.
        processes: copies at a time.
        done: called after each.
    """
    found: dict[int, Result] = {}
    asked: dict = {}
    left = deque(range(count))
    begun = []
    try:
        for _ in range(min(processes, count)):
            pipe, process = _copy(task)
            begun.append((pipe, process))
            _ask(pipe, left, asked)
        while asked:
            for pipe in wait(list(asked)):
                k = asked.pop(pipe)
                try:
                    able, result = pipe.recv()
                except (EOFError, OSError):
                    continue  # it was ended from outside
                except Exception:
                    able = False  # what it wrote cannot be read here
                if able:
                    found[k] = result
                    done()
                _ask(pipe, left, asked)
    finally:
        # All pipes first: the copies made later hold our ends of the earlier ones too.
        for pipe, process in begun:
            pipe.close()
            if len(found) < count:
                process.terminate()
        for _, process in begun:
            process.join()
    for k in range(count):
        if k not in found:
            found[k] = task(k)
            done()
    return [found[k] for k in range(count)]


def _ask(pipe, left, asked):
    """Give a copy the next that is left, if there is one."""
    if left:
        k = left.popleft()
        try:
            pipe.send(k)
        except OSError:
            return  # it was ended from outside
        asked[pipe] = k


def _copy(task):
    """(our end of a pipe, process): a copy of this process that does what it is asked through the pipe."""
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(task, ours, theirs))
    process.start()
    theirs.close()
    return ours, process


def _serve(task, ours, theirs):
    """What a copy does."""
    global _is_copy
    _is_copy = True
    ours.close()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    stages.silent()
    watch.silent()
    try:
        while True:
            k = theirs.recv()
            try:
                theirs.send((True, task(k)))
            except OSError:
                raise
            except Exception:
                theirs.send((False, None))
    except (EOFError, OSError):
        pass  # nobody asks any more
