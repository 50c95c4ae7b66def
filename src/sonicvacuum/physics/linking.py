"""From a composition to machine code: the stepper, compiled once for each frame, and what its laws fill in.

Numba takes two to three seconds for the stepper, most of them in Python, and a small part of one for the
formulas of a law set. So the stepper is compiled without laws (`skeleton`), to LLVM's code; for a law set its
formulas are compiled, linked in, and the whole is optimised by LLVM (`linked`), in a tenth of that time.
"""

import ctypes
import re
from collections.abc import Callable

import llvmlite.binding as llvm
from llvmlite import ir
from numba import cfunc, njit, types
from numba.core.registry import cpu_target
from numba.extending import intrinsic

from sonicvacuum.physics.compose import PIECES
from sonicvacuum.physics.composition import Composition, Frame
from sonicvacuum.physics.kernel import advance
from sonicvacuum.physics.machine import target
from sonicvacuum.physics.table import LAW, OPTIONS, WITHIN, FrameType, array_at

# Whole numbers that a law set fills in.
_NUMBERS = ("columns", "preloaded", "first_memory", "first_increment", "first_blend")
# What the stepper is called before it has a name of its own.
_STEPPER = "stepper"
_nowhere = ctypes.c_int64()


def skeleton(frame: Frame, kinds: tuple[str, ...]) -> bytes:
    """LLVM's code of the stepper of a frame, its laws left open; `kinds` of its arguments, see `entry`."""
    # Numba makes it ready to run as well, though nobody calls it, and looks for all that it names.
    for key in (*_NUMBERS, *PIECES):
        llvm.add_symbol(LAW + key, ctypes.addressof(_nowhere))
    return _code(*_entry(advance, OPTIONS, kinds, frame), _STEPPER).as_bitcode()


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
    return _object(_code(*_entry(function, options, kinds, frame), name, options), name)


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


def linked(composition: Composition, skeleton: bytes, name: str) -> bytes:
    """An object file with the stepper of a composition under a name of its own.

    Args:
        composition: the laws.
        skeleton: see `skeleton`, of the composition's frame.
        name: what the function is called.
    """
    module = llvm.parse_bitcode(skeleton)
    numbers = ir.Module()
    for key in _NUMBERS:
        value = ir.Constant(ir.IntType(64), int(getattr(composition, key)))
        number = ir.GlobalVariable(numbers, value.type, LAW + key)
        number.global_constant, number.initializer = True, value
    for key, piece in PIECES.items():
        function = piece.function(composition)
        if function is None:
            _add_nothing(numbers, LAW + key, piece.signature(composition))
        else:
            module.link_in(_code(function, piece.signature(composition), LAW + key))
    module.link_in(llvm.parse_assembly(str(numbers)))
    module.get_function(_STEPPER).name = name
    for function in module.functions:
        if not function.is_declaration and function.name.startswith(LAW):
            function.add_function_attribute("alwaysinline")
    return _object(module, name)


def _code(function, signature, name, options=OPTIONS):
    """A module of LLVM with a function under a name, as C calls it."""
    made = cfunc(signature, **options)(function)
    # Numba keeps what it compiles out of what calls it from C.
    module = llvm.parse_assembly(re.sub(r"\bnoinline\b", "alwaysinline", made.inspect_llvm()))
    module.get_function(made.native_name).name = name
    return module


def _add_nothing(module, name, signature):
    """A function that does nothing and returns zero."""
    kind = cpu_target.target_context.get_value_type
    nothing = signature.return_type == types.void
    returned = ir.VoidType() if nothing else kind(signature.return_type)
    function = ir.Function(module, ir.FunctionType(returned, [kind(a) for a in signature.args]), name)
    builder = ir.IRBuilder(function.append_basic_block())
    if nothing:
        builder.ret_void()
    else:
        builder.ret(ir.Constant(returned, None))


def _object(module, name):
    """An object file with a function that alone is seen by others: names may stand in many of them."""
    for function in module.functions:
        if not function.is_declaration and function.name != name:
            function.linkage = llvm.Linkage.internal
    machine, options = target(), llvm.create_pipeline_tuning_options(speed_level=3)
    options.loop_vectorization, options.slp_vectorization = True, False
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)
    return machine.emit_object(module)
