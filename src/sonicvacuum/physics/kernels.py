"""Compiled code ready to be called: kept in files, loaded once for each process.

Numba is imported where a stepper or another function must be compiled, and nowhere else: it takes longer to
load than most calls. A law set is put into a stepper without it.
"""

import hashlib
from collections.abc import Callable
from pathlib import Path

from sonicvacuum.physics import compiled
from sonicvacuum.physics.composition import Composition
from sonicvacuum.physics.entry import handed_over, kinds_of, prototype
from sonicvacuum.physics.machine import address_of

# Name of what is compiled → its function.
_ready: dict = {}


class Compiled:
    """A function of numbers and arrays that returns nothing, compiled for what it is first called with.

    Args:
        make: gives the function as Numba takes it, and Numba's options; called where it must be compiled.
        name: unique in this package.
        sources: files outside `sonicvacuum.physics` with whose code it is compiled.
    """

    def __init__(self, make: Callable[[], tuple[Callable, dict]], name: str, sources: tuple[Path, ...] = ()):
        self._make, self._sources = make, sources
        self._name = name

    def __call__(self, *arguments) -> None:
        function = _ready.get(self._name) or _made_ready(self._name, arguments, self._loaded)
        function(*handed_over(arguments))

    def _loaded(self, kinds):
        def alone():
            from sonicvacuum.physics import skeleton

            return skeleton.alone(*self._make(), kinds, self._name)

        sources = (compiled.files_digest((file,)) for file in self._sources)
        return _function(self._name, kinds, compiled.kept(" ".join((self._name, *kinds, *sources)), alone))


def advance(composition: Composition, *arguments) -> None:
    """Integrate groups of chains in place; arguments after the frame as in `kernel.advance`."""
    prepare(composition, *arguments)(*handed_over(arguments))


def prepare(composition: Composition, *arguments) -> Callable:
    """Load or compile what `advance` needs for such arguments."""
    name = composition.name
    return _ready.get(name) or _made_ready(name, arguments, lambda kinds: _stepper(composition, kinds))


def _made_ready(name, arguments, load):
    """What goes by a name, loaded or compiled by one of several threads."""
    with compiled.preparing:
        if name not in _ready:
            _ready[name] = load(kinds_of(arguments))
        return _ready[name]


def _function(symbol, kinds, code):
    if b"numba_" in code:
        # A name that the code does not know itself, as of what raises an exception: Numba has it.
        from numba.core.registry import cpu_target

        assert cpu_target.target_context
    return prototype(kinds)(address_of(symbol, code))


def _stepper(composition, kinds):
    """The stepper of a composition, whose laws are put into that of its frame."""
    symbol = f"stepper_{hashlib.sha256(composition.name.encode()).hexdigest()[:16]}"

    def of_frame():
        from sonicvacuum.physics import skeleton

        return skeleton.skeleton(composition.frame, kinds)

    def linked():
        from sonicvacuum.physics import linking

        return linking.linked(composition, compiled.kept(composition.frame.name, of_frame), symbol)

    return _function(symbol, kinds, compiled.kept(composition.name, linked))
