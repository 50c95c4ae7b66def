"""Long work that yields: it can be interrupted, and tells how far it is.

Compiled code does not hear signals. Work that may take long runs in threads of its own, while the main thread
waits in short turns, in which an interruption is raised and progress is told.
"""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import contextmanager
from threading import Thread

# Time in s between two looks.
TURN = 0.1

_listeners: list[Callable[[float], None]] = []


@contextmanager
def told_to(listener: Callable[[float], None]) -> Iterator[None]:
    """Within this, `listener` gets the finished part, from 0 to 1, of each long computation."""
    _listeners.append(listener)
    try:
        yield
    finally:
        _listeners.remove(listener)


def tell(part: float) -> None:
    """Tell all listeners which part is finished."""
    for listener in _listeners:
        listener(part)


def silent() -> None:
    """Nobody is told of anything any more."""
    _listeners.clear()


def run(work: Callable, shares: Iterable[tuple], threads: int, stop: Callable, part: Callable) -> None:
    """Call work(*share) for each share, in threads, so that the caller can be interrupted.

    Args:
        work: what takes long; it lets other threads run, and returns soon after `stop`.
        shares: arguments of each call.
        threads: so many at a time.
        stop: called when the caller is interrupted.
        part: gives the finished part, from 0 to 1.
    """
    with ThreadPoolExecutor(threads) as pool:
        calls = [pool.submit(work, *share) for share in shares]
        try:
            while wait(calls, TURN).not_done:
                tell(part())
        except BaseException:
            stop()
            pool.shutdown(cancel_futures=True)
            raise
    for call in calls:
        call.result()
    tell(1.0)


def aside(work: Callable, *arguments) -> None:
    """Call something that cannot be stopped (the compiler); an interrupted caller goes on without it."""
    failed = []

    def guarded():
        try:
            work(*arguments)
        except BaseException as error:
            failed.append(error)

    thread = Thread(target=guarded, daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(TURN)
    if failed:
        raise failed[0]
