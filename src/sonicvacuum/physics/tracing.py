"""Force laws become LLVM's code by being run once, with numbers that write down what is done to them.

A law is plain arithmetic without branches (`physics.lanes`), so that one run tells all of it. It takes a
millisecond, where a compiler of Python takes a tenth of a second and more.
"""

from collections.abc import Callable
from numbers import Real

from llvmlite import ir

from sonicvacuum.physics import lanes
from sonicvacuum.physics.arithmetic import (
    FUNCTIONS,
    constant,
    emit_add,
    emit_divide,
    emit_multiply,
    emit_negate,
    emit_subtract,
)


class FormulaError(TypeError):
    """A formula that cannot be written as code: it is no plain arithmetic."""


def _operator(emit):
    def worked_out(self, other):
        return self.made(emit, self, other)

    return worked_out


def _turned(emit):
    """The same where the other number stands before this one."""

    def worked_out(self, other):
        return self.made(emit, other, self)

    return worked_out


def _no_branch(self, *others):
    raise TypeError("numbers cannot be compared, nor tell which way to go: see select")


class Number(lanes.Written):
    """A number of one chain, or of all lanes, in the code that a builder writes.

    Attributes:
        builder: LLVM's, at the place where code is written.
        value: LLVM's name of the number.
    """

    # Numbers of numpy leave the arithmetic to this one.
    __array_ufunc__ = None
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, builder: ir.IRBuilder, value: ir.Value):
        self.builder, self.value = builder, value

    def made(self, emit: Callable, *values) -> "Number":
        """What the code that `emit` writes makes of numbers."""
        return Number(self.builder, emit(self.builder, *(self.like(v).value for v in values)))

    def like(self, value) -> "Number":
        """A number as one of this code; constants are alike in all lanes."""
        if isinstance(value, Number):
            return value
        if isinstance(value, Real):
            return Number(self.builder, constant(self.value.type, value))
        raise TypeError(f"{type(value).__name__} where a number belongs")

    def work_out(self, function: str, values: tuple) -> "Number":
        """See `lanes.Written`."""
        return self.made(FUNCTIONS[function], *values)

    __add__, __radd__ = _operator(emit_add), _turned(emit_add)
    __sub__, __rsub__ = _operator(emit_subtract), _turned(emit_subtract)
    __mul__, __rmul__ = _operator(emit_multiply), _turned(emit_multiply)
    __truediv__, __rtruediv__ = _operator(emit_divide), _turned(emit_divide)
    __bool__ = __eq__ = __ne__ = __lt__ = __le__ = __gt__ = __ge__ = _no_branch

    def __neg__(self):
        return self.made(emit_negate, self)


def worked_out(formula: Callable, *arguments: Number) -> Number:
    """What a formula makes of numbers, its code now written.

    Raises:
        FormulaError: for one that is no plain arithmetic; naming it.
    """
    try:
        return arguments[0].like(formula(*arguments))
    except Exception as error:
        told = " ".join(str(error).split())
        cure = f"use plain arithmetic and the functions of {lanes.__name__}"
        raise FormulaError(f"{formula.__name__}: {type(error).__name__}: {told}; {cure}") from error
