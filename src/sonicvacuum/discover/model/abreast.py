"""Hypotheses that do not ask for one another, followed side by side.

Each is followed on a branch of the predictor, which knows what was known when all began, and learns nothing
of the others: what is found depends neither on the number of threads nor on which was ready first. Most of
the time of a large record is spent in compiled code, which lets other threads run.
"""

from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from threading import Event
from typing import TypeVar

from sonicvacuum import stages
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.physics import watch

Item = TypeVar("Item")
Result = TypeVar("Result")


def each(
    forward: Forward, work: Callable[[Forward, Item], Result], items: Iterable[Item], stage: str = ""
) -> list[Result]:
    """`work(branch, item)` for every item, in their order.

    Args:
        forward: the predictor; `forward.threads` items at a time where its calls are long.
        work: follows one item on a branch of the predictor.
        items: what is followed.
        stage: what is told to be done, a step for each item; nothing is told without.
    """
    items, stop = list(items), forward.stop or Event()
    if stage and items:
        stages.begin(stage, len(items))
    done = stages.step if stage else lambda: None
    abreast = min(forward.threads, len(items)) if forward.long_calls else 1
    branches = [forward.branch(stop, abreast) for _ in items]
    if abreast > 1:
        results = _abreast(abreast, work, branches, items, stop, done)
    else:
        results = []
        for branch, item in zip(branches, items, strict=True):
            results.append(work(branch, item))
            done()
    forward.join(branches)
    return results


def _abreast(threads, work, branches, items, stop, told):
    """The results by threads; where one fails, or the caller is interrupted, all stop at their next call."""
    with ThreadPoolExecutor(threads) as pool:
        calls = [pool.submit(work, *one) for one in zip(branches, items, strict=True)]
        try:
            left = set(calls)
            while left:
                done, left = wait(left, watch.TURN, FIRST_EXCEPTION)
                for call in done:
                    call.result()
                    told()
        except BaseException:
            stop.set()
            pool.shutdown(cancel_futures=True)
            raise
    return [call.result() for call in calls]
