"""An end that is asked for from outside: by `kill`, `timeout`, `scancel` or a terminal that closes.

Left to itself Python ends at once then, and leaves behind what is half-written. Here it is an interruption as
from the keyboard: what was begun is put away first.
"""

import math
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread

SIGNALS = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
# Time in s in which whoever is asked puts away what is half-written. `timeout` asks twice at once, and a
# second interruption would leave there what the first one puts away.
GRACE = 5.0


def once(action: Callable[[int], None]) -> Callable:
    """A handler of signals that calls action(number), but passes over those that come soon after."""
    last = -math.inf

    def handler(number, frame):
        nonlocal last
        now = time.monotonic()
        if now - last > GRACE:
            last = now
            action(number)

    return handler


def code_of(number: int) -> int:
    """Exit code of a command that a signal has ended, as shells count."""
    return 128 + number


@contextmanager
def heard() -> Iterator[list[int]]:
    """Within this, such a signal interrupts; gives a list that fills with the numbers of those that came.

    Those that were ignored before, as under `nohup`, still are.
    """
    came: list[int] = []
    process = os.getpid()

    def interrupt(number):
        if os.getpid() != process:  # a copy that has not yet its own ways: nothing in it is its to put away
            os._exit(code_of(number))
        came.append(number)
        raise KeyboardInterrupt

    own = current_thread() is main_thread()  # no other one may say what signals do
    mine = [n for n in SIGNALS if own and signal.getsignal(n) == signal.SIG_DFL]
    handler = once(interrupt)
    for number in mine:
        signal.signal(number, handler)
    try:
        yield came
    finally:
        for number in mine:
            signal.signal(number, signal.SIG_DFL)


def blamed(error: Exception) -> str | None:
    """What is said of an error in the code of a user's own effect, None for any other; see `plugins.blamed`.

    Not imported: verbs without such effects do not depend on the engine.
    """
    plugins = sys.modules.get("sonicvacuum.plugins")
    return plugins.blamed(error) if plugins else None
