"""From a composition to machine code: the stepper of its frame, with the law set's formulas put in.

Numba takes two seconds for a stepper, most of them in Python. So it is compiled without laws, once for each
frame (`skeleton`); the formulas of a law set are written as LLVM's code (`compose`) and linked in, and LLVM
optimises the whole, in a fifth of a second.
"""

import llvmlite.binding as llvm
from llvmlite import ir

from sonicvacuum.physics.compose import PIECES
from sonicvacuum.physics.composition import Composition
from sonicvacuum.physics.machine import target

# What names begin with that a law set fills in.
LAW = "law_"
# Whole numbers that a law set fills in.
NUMBERS = ("columns", "preloaded", "first_memory", "first_increment", "first_blend")
# What the stepper is called before it has a name of its own.
STEPPER = "stepper"


def linked(composition: Composition, skeleton: bytes, name: str) -> bytes:
    """An object file with the stepper of a composition under a name of its own.

    Args:
        composition: the laws.
        skeleton: see `skeleton.skeleton`, of the composition's frame.
        name: what the function is called.

    Raises:
        tracing.FormulaError: for a formula that cannot be written as code.
    """
    module, laws = llvm.parse_bitcode(skeleton), ir.Module()
    for key in NUMBERS:
        value = ir.Constant(ir.IntType(64), int(getattr(composition, key)))
        number = ir.GlobalVariable(laws, value.type, LAW + key)
        number.global_constant, number.initializer = True, value
    for key, piece in PIECES.items():
        piece.write(laws, LAW + key, composition)
    module.link_in(llvm.parse_assembly(str(laws)))
    module.get_function(STEPPER).name = name
    for function in module.functions:
        if not function.is_declaration and function.name.startswith(LAW):
            function.add_function_attribute("alwaysinline")
    return object_file(module, name)


def object_file(module: llvm.ModuleRef, name: str) -> bytes:
    """An object file with a function that alone is seen by others: names may stand in many of them."""
    for function in module.functions:
        if not function.is_declaration and function.name != name:
            function.linkage = llvm.Linkage.internal
    machine, options = target(), llvm.create_pipeline_tuning_options(speed_level=3)
    options.loop_vectorization, options.slp_vectorization = True, False
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)
    return machine.emit_object(module)
