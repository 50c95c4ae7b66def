"""Processes that draw: they load matplotlib while a search is still going on, and draw side by side.

Loading and drawing take longer than many a search. Nothing depends on whether they are used.
"""

import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import active_children, get_context, parent_process


@contextmanager
def painters(count: int) -> Iterator[Executor | None]:
    """A pool of so many processes that have begun to load what pictures need; None for less than two."""
    if count < 2:
        yield None
        return
    with ProcessPoolExecutor(count, get_context("spawn"), _leave_with_parent) as pool:
        try:
            with _deaf():
                for _ in range(count):
                    pool.submit(load)
            yield pool
        except BaseException:
            # Whoever interrupts does not wait for what is being loaded or drawn.
            for process in active_children():
                process.kill()
            pool.shutdown(cancel_futures=True)
            raise


def load() -> None:
    """Import what pictures are drawn with."""
    import sonicvacuum.figures.discovery  # noqa: F401


def _leave_with_parent() -> None:
    """End this process when the one that started it is gone, however it went."""

    def wait():
        parent_process().join()
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()


@contextmanager
def _deaf():
    """Processes started within this do not hear an interruption: who waits for them ends them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
