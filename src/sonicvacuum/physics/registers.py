"""Eight chains in one register: a vector number for compiled code.

Numba is taught the type, and what the functions of `physics.lanes` and Python's operators are for it: the
compiler need not discover the vectors, the type is explicit. Whatever compiles a law imports this first
(`physics.table` does).
"""

import operator

from llvmlite import binding, ir
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin, models, register_model

from sonicvacuum.physics.lanes import (
    LANES,
    absolute,
    positive,
    power,
    power_3_2,
    root,
    select,
    without_fusing,
)
from sonicvacuum.physics.powers import call_intrinsic, emit_power

# Contraction to fused multiply-add and ignoring the sign of zero are the only liberties taken.
FASTMATH = {"contract", "nsz"}
_FLAGS = tuple(sorted(FASTMATH))


class LaneType(types.Type):
    """Numba type of `LANES` float64 numbers held in registers."""

    def __init__(self):
        super().__init__(name=f"lanes{LANES}")


lane = LaneType()
_NUMBERS = (LaneType, types.Float, types.Integer)


@register_model(LaneType)
class _LaneModel(models.PrimitiveModel):
    def __init__(self, manager, fe_type):
        super().__init__(manager, fe_type, ir.VectorType(ir.DoubleType(), LANES))


def _splat(builder, scalar):
    kind = ir.VectorType(ir.DoubleType(), LANES)
    undefined = ir.Constant(kind, ir.Undefined)
    one = builder.insert_element(undefined, scalar, ir.Constant(ir.IntType(32), 0))
    mask = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.shuffle_vector(one, undefined, mask)


def _teach(function, emit, among=_NUMBERS):
    """Make `function` known to Numba: `emit(builder, *values)` writes its code for doubles or lanes alike."""
    arity = emit.__code__.co_argcount - 1

    class Template(AbstractTemplate):
        def generic(self, args, kws):
            if len(args) == arity and not kws and all(isinstance(a, _NUMBERS) for a in args):
                kinds = [a if a is lane else types.float64 for a in args]
                if lane in args or among is _NUMBERS:
                    return signature(lane if lane in args else types.float64, *kinds)
            return None

    infer_global(function)(Template)

    def lower(context, builder, sig, args):
        if sig.return_type is lane:
            pairs = zip(sig.args, args, strict=True)
            args = [value if kind is lane else _splat(builder, value) for kind, value in pairs]
        return emit(builder, *args)

    if among is _NUMBERS:
        lower_builtin(function, *[types.Any] * arity)(lower)
    elif arity == 1:
        lower_builtin(function, LaneType)(lower)
    else:
        for kinds in ((LaneType, LaneType), (LaneType, types.Float), (types.Float, LaneType)):
            lower_builtin(function, *kinds)(lower)


def constant(kind, value):
    """The constant `value` of an LLVM type, double or vector of doubles."""
    if isinstance(kind, ir.VectorType):
        return ir.Constant(kind, [float(value)] * kind.count)
    return ir.Constant(kind, float(value))


def _is_positive(builder, x):
    return builder.fcmp_ordered(">", x, constant(x.type, 0.0))


def _emit_add(builder, a, b):
    return builder.fadd(a, b, flags=_FLAGS)


def _emit_subtract(builder, a, b):
    return builder.fsub(a, b, flags=_FLAGS)


def _emit_multiply(builder, a, b):
    return builder.fmul(a, b, flags=_FLAGS)


def _emit_divide(builder, a, b):
    return builder.fdiv(a, b, flags=_FLAGS)


def _emit_negate(builder, a):
    return builder.fneg(a, flags=_FLAGS)


def _emit_without_fusing(builder, a, b):
    return builder.fsub(call_intrinsic(builder, "llvm.arithmetic.fence", a), b)


def _emit_select(builder, condition, yes, no):
    return builder.select(_is_positive(builder, condition), yes, no)


def _emit_positive(builder, x):
    return builder.select(_is_positive(builder, x), x, constant(x.type, 0.0))


def _emit_absolute(builder, x):
    return call_intrinsic(builder, "llvm.fabs", x)


def _emit_power_3_2(builder, x):
    return _emit_multiply(builder, x, _emit_root(builder, x))


def _emit_power(builder, x, exponent):
    base = _emit_positive(builder, x)
    if isinstance(x.type, ir.VectorType):
        return emit_power(builder, base, exponent)
    kind = ir.FunctionType(x.type, [x.type, x.type])
    return builder.call(
        cgutils.get_or_insert_function(builder.module, kind, "llvm.pow.f64"), [base, exponent]
    )


def _has_reciprocal_root():
    """Whether the machine estimates 1/sqrt for a whole 512-bit register (AVX-512F)."""
    return bool(binding.get_host_cpu_features().get("avx512f"))


def _emit_root(builder, x):
    """sqrt(x) where x > 0, else 0.

    For lanes, where the machine can: its estimate of 1/sqrt, good to 14 bits, is improved by one
    third-order step (relative error below 6e-13), in half the time of its square root.
    """
    if not (isinstance(x.type, ir.VectorType) and _has_reciprocal_root()):
        return call_intrinsic(builder, "llvm.sqrt", _emit_positive(builder, x))
    bits = ir.IntType(LANES)
    kind = ir.FunctionType(x.type, [x.type, x.type, bits])
    name = "llvm.x86.avx512.rsqrt14.pd.512"
    estimate = cgutils.get_or_insert_function(builder.module, kind, name)
    mask = builder.bitcast(_is_positive(builder, x), bits)
    y = builder.call(estimate, [x, constant(x.type, 0.0), mask])
    r = _emit_multiply(builder, x, y)
    error = _emit_subtract(builder, constant(x.type, 1.0), _emit_multiply(builder, r, y))
    weight = _emit_multiply(builder, error, constant(x.type, 0.375))
    weight = _emit_add(builder, weight, constant(x.type, 0.5))
    step = _emit_multiply(builder, _emit_multiply(builder, r, error), weight)
    return _emit_add(builder, r, step)


for _function, _emit in (
    (operator.add, _emit_add),
    (operator.sub, _emit_subtract),
    (operator.mul, _emit_multiply),
    (operator.truediv, _emit_divide),
    (operator.neg, _emit_negate),
):
    # Python's own operators are new only where a lane is among the operands.
    _teach(_function, _emit, among=(LaneType,))

for _function, _emit in (
    (root, _emit_root),
    (select, _emit_select),
    (power, _emit_power),
    (absolute, _emit_absolute),
    (positive, _emit_positive),
    (power_3_2, _emit_power_3_2),
    (without_fusing, _emit_without_fusing),
):
    _teach(_function, _emit)
