"""Many records searched side by side, each in a process of its own.

Records have nothing in common, while much of one search waits for what came before: so each processor takes
a record, and shares one out only where there are more processors than records. What is found does not depend
on how many there are.
"""

import multiprocessing
import os
import signal
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from threading import Thread

from sonicvacuum import stages
from sonicvacuum.cli.ended import GRACE, code_of, once
from sonicvacuum.files import InputError


def side_by_side(work: Callable, tasks: Iterable[tuple], processes: int) -> Iterator:
    """work(*task) for each task, in their order; of each that is done a step of the present stage is told.

    Args:
        work: a function of a module; its arguments and results can be pickled.
        tasks: arguments of each call.
        processes: so many at a time.

    Raises:
        InputError: where a process was ended from outside, as for want of memory.
        Exception: what a call raises; calls after it are given up.
    """
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(processes, context, _deaf) as pool:
        try:
            for call in [pool.submit(work, *task) for task in tasks]:
                yield call.result()
                stages.step()
        except BrokenProcessPool:
            raise InputError(
                "a search was ended from outside, perhaps for want of memory; give --threads 1"
            ) from None
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for process in multiprocessing.active_children():
                process.terminate()
            raise


def _deaf():
    """An interruption is the first process's affair; ended by that, this one leaves nothing half-written."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, once(lambda number: sys.exit(code_of(number))))
    Thread(target=_end_with_the_first, daemon=True).start()


def _end_with_the_first():
    """However the first process ends, killed for instance, none that it began goes on without it.

    The pool takes the exit for the result of its call, and would wait for another one.
    """
    multiprocessing.parent_process().join()
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(GRACE)
    os._exit(code_of(signal.SIGTERM))
