"""Long work in named stages, told to whoever listens: a terminal shows them, a log need not.

Work calls `begin` and `step`; without a listener both cost nothing and change nothing.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

# Called with the name of the stage, steps done, and steps in all (None: not known).
Listener = Callable[[str, int, int | None], None]

_listeners: list[Listener] = []
_now: list = ["", 0, None]


@contextmanager
def told_to(listener: Listener) -> Iterator[None]:
    """Within this, `listener` hears of each stage and each step."""
    _listeners.append(listener)
    try:
        yield
    finally:
        _listeners.remove(listener)


def begin(name: str, total: int | None = None) -> None:
    """A stage begins; it has so many steps."""
    _now[:] = [name, 0, total]
    _tell()


def step() -> None:
    """One step of the stage is done."""
    _now[1] += 1
    _tell()


def _tell():
    for listener in _listeners:
        listener(*_now)
