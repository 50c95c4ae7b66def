"""Long work in named stages, told to whoever listens: a terminal shows them, a log need not.

Work calls `begin` and `step`; without a listener both cost nothing and change nothing. So does `compiling`,
which tells of the one thing that may keep any work from beginning: kernels that this computer has not yet.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

# Called with the name of the stage, steps done, and steps in all (None: not known).
Listener = Callable[[str, int, int | None], None]

_listeners: list[Listener] = []
_now: list = ["", 0, None]
# Of those who hear of compilations the last alone is told: what stands inside knows how to show it.
_compilations: list[Callable[[int], None]] = []


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


@contextmanager
def unheard() -> Iterator[None]:
    """Within this, nobody hears of stages and steps, and the stage stays what it is."""
    listeners, now = _listeners[:], _now[:]
    _listeners.clear()
    try:
        yield
    finally:
        _listeners[:], _now[:] = listeners, now


def silent() -> None:
    """Nobody is told of anything any more."""
    _listeners.clear()
    _compilations.clear()


@contextmanager
def compilations_told_to(listener: Callable[[int], None]) -> Iterator[None]:
    """Within this, `listener` alone gets 1 where kernels begin to be compiled, and -1 where they are."""
    _compilations.append(listener)
    try:
        yield
    finally:
        _compilations.remove(listener)


@contextmanager
def compiling() -> Iterator[None]:
    """Within this, kernels are compiled, or waited for while another process compiles them."""
    tell = _compilations[-1] if _compilations else None
    if tell:
        tell(1)
    try:
        yield
    finally:
        if tell:
            tell(-1)
