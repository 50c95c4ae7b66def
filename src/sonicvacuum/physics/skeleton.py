"""What Numba compiles: the stepper of a frame, its laws left open, and functions that take no laws."""

import ctypes
import re
from collections.abc import Callable

import llvmlite.binding as llvm
from numba import cfunc, njit, types
from numba.extending import intrinsic

from sonicvacuum.physics.compose import PIECES
from sonicvacuum.physics.composition import Frame
from sonicvacuum.physics.kernel import advance
from sonicvacuum.physics.linking import LAW, NUMBERS, STEPPER, object_file
from sonicvacuum.physics.table import OPTIONS, WITHIN, FrameType, array_at

_nowhere = ctypes.c_int64()


def skeleton(frame: Frame, kinds: tuple[str, ...]) -> bytes:
    """LLVM's code of the stepper of a frame, its laws left open; `kinds` of its arguments, see `entry`."""
    # Numba makes it ready to run as well, though nobody calls it, and looks for all that it names.
    for key in (*NUMBERS, *PIECES):
        llvm.add_symbol(LAW + key, ctypes.addressof(_nowhere))
    return _code(*_entry(advance, OPTIONS, kinds, frame), STEPPER).as_bitcode()


def alone(
    function: Callable, options: dict, kinds: tuple[str, ...], name: str, frame: Frame | None = None
) -> bytes:
    """An object file with a function that takes no laws.

    Args:
        function: takes a frame, if one is given, and arguments of these `kinds`, see `entry`.
        options: Numba's.
        kinds: of its arguments.
        name: what it is called.
        frame: see `Frame`.
    """
    return object_file(_code(*_entry(function, options, kinds, frame), name, options), name)


def _entry(function, options, kinds, frame):
    """C's way into a function of a frame and arguments of these kinds, and its signature."""
    namespace = {"function": njit(**options | WITHIN)(function), "array_at": array_at}
    taken, passed, signature = [], [], []
    if frame:
        kind = FrameType(frame)

        @intrinsic
        def the_frame(typing):
            return kind(), lambda context, builder, sig, args: context.get_dummy_value()

        namespace["the_frame"] = the_frame
        passed.append("the_frame()")
    for k, (letter, *axes) in enumerate(kinds):
        number = {"d": types.float64, "q": types.int64}[letter]
        shape = [f"n{k}_{axis}" for axis in range(int(axes[0]))] if axes else []
        taken += [f"a{k}", *shape]
        signature += [types.CPointer(number) if axes else number, *[types.int64] * len(shape)]
        passed.append(f"array_at(a{k}, ({', '.join(shape)},))" if axes else f"a{k}")
    exec(f"def entry({', '.join(taken)}):\n    function({', '.join(passed)})", namespace)
    return namespace["entry"], types.void(*signature)


def _code(function, signature, name, options=OPTIONS):
    """A module of LLVM with a function under a name, as C calls it."""
    made = cfunc(signature, **options)(function)
    # Numba keeps what it compiles out of what calls it from C.
    module = llvm.parse_assembly(re.sub(r"\bnoinline\b", "alwaysinline", made.inspect_llvm()))
    module.get_function(made.native_name).name = name
    return module
