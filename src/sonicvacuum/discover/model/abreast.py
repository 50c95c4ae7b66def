"""Hypotheses that do not ask for one another, followed side by side.

Each is followed on a branch of the predictor, which knows what was known when all began, and learns nothing
of the others: what is found depends neither on the number of processes nor on which was ready first. Much of
the time is spent in the interpreter, which runs one thread at a time: so they are followed by copies of this
process, where that is known to be safe and gains more than copies cost.
"""

from collections.abc import Callable, Iterable
from numbers import Integral
from typing import TypeVar

from sonicvacuum import stages
from sonicvacuum.discover.model import copies
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.files import InputError
from sonicvacuum.physics.run import available_threads

Item = TypeVar("Item")
Result = TypeVar("Result")

# Calls of the predictor that following one item takes, about: slopes along one direction; a fit; a valley.
SLOPES, FIT, VALLEY = 1, 20, 30
# What side by side has to save, in s; a copy of the process takes as long.
SAVED = 0.01


def processors(threads: int | None, place: str) -> int:
    """How many processors a function called `place` is to use; InputError for what is no number of them."""
    if threads is None:
        return available_threads()
    if not isinstance(threads, Integral) or isinstance(threads, bool) or threads < 1:
        raise InputError(
            f"{place}: threads: is {threads!r:.100}; give a whole number from 1 on, or None for all"
        )
    return int(threads)


def each(
    forward: Forward,
    work: Callable[[Forward, Item], Result],
    items: Iterable[Item],
    stage: str = "",
    calls: int = FIT,
) -> list[Result]:
    """`work(branch, item)` for every item, in their order.

    Args:
        forward: the predictor; up to `forward.threads` items at a time.
        work: follows one item on a branch of the predictor; it changes nothing else, and returns what can be
            handed from process to process, else it is followed here.
        items: what is followed.
        stage: what is told to be done, a step for each item; nothing is told without.
        calls: of the predictor that an item takes, about.
    """
    items = list(items)
    if stage and items:
        stages.begin(stage, len(items))
    done = stages.step if stage else lambda: None
    beside = _beside(forward, len(items), calls)

    def followed(k):
        branch = forward.branch(beside)
        return work(branch, items[k]), forward.learned(branch)

    if beside > 1:
        found = copies.each(followed, len(items), beside, done)
    else:
        found = []
        for k in range(len(items)):
            found.append(followed(k))
            done()
    forward.join([learned for _, learned in found])
    return [result for result, _ in found]


def _beside(forward, count, calls):
    """How many items are followed at a time."""
    most = min(forward.threads, count)
    if most < 2 or not copies.possible():
        return 1
    saved = count - -(-count // most)
    return most if saved * calls * forward.seconds_of_call > SAVED else 1
