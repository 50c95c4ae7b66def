"""What the arithmetic of force laws becomes in compiled code: LLVM's, for one double or for eight lanes.

Of the operators of Python and the functions of `physics.lanes`, each writes its code for two kinds of values,
doubles and vectors of doubles. Both ways to compiled code take it from here: Numba, which compiles the
stepper (`registers`), and the laws, which need no compiler but LLVM (`tracing`).
"""

from llvmlite import ir

from sonicvacuum.physics.lanes import LANES
from sonicvacuum.physics.machine import has
from sonicvacuum.physics.powers import call, call_intrinsic, power_of_lanes

# Contraction to fused multiply-add and ignoring the sign of zero are the only liberties taken.
FASTMATH = {"contract", "nsz"}
_FLAGS = tuple(sorted(FASTMATH))

LANES_KIND = ir.VectorType(ir.DoubleType(), LANES)


def splat(builder, scalar):
    """A double in all lanes."""
    undefined = ir.Constant(LANES_KIND, ir.Undefined)
    one = builder.insert_element(undefined, scalar, ir.Constant(ir.IntType(32), 0))
    mask = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.shuffle_vector(one, undefined, mask)


def constant(kind, value):
    """The constant `value` of an LLVM type, double or vector of doubles."""
    if isinstance(kind, ir.VectorType):
        return ir.Constant(kind, [float(value)] * kind.count)
    return ir.Constant(kind, float(value))


def _is_positive(builder, x):
    return builder.fcmp_ordered(">", x, constant(x.type, 0.0))


def emit_add(builder, a, b):
    return builder.fadd(a, b, flags=_FLAGS)


def emit_subtract(builder, a, b):
    return builder.fsub(a, b, flags=_FLAGS)


def emit_multiply(builder, a, b):
    return builder.fmul(a, b, flags=_FLAGS)


def emit_divide(builder, a, b):
    return builder.fdiv(a, b, flags=_FLAGS)


def emit_negate(builder, a):
    return builder.fneg(a, flags=_FLAGS)


def emit_without_fusing(builder, a, b):
    return builder.fsub(call_intrinsic(builder, "llvm.arithmetic.fence", a), b)


def emit_select(builder, condition, yes, no):
    return builder.select(_is_positive(builder, condition), yes, no)


def emit_positive(builder, x):
    return builder.select(_is_positive(builder, x), x, constant(x.type, 0.0))


def emit_absolute(builder, x):
    return call_intrinsic(builder, "llvm.fabs", x)


def emit_power_3_2(builder, x):
    return emit_multiply(builder, x, emit_root(builder, x))


def emit_power(builder, x, exponent):
    base = emit_positive(builder, x)
    if isinstance(x.type, ir.VectorType):
        return power_of_lanes(builder, base, exponent)
    return call(builder, "llvm.pow.f64", x.type, base, exponent)


def emit_root(builder, x):
    """sqrt(x) where x > 0, else 0.

    For lanes, where the machine estimates 1/sqrt for a whole 512-bit register: the estimate, good to 14 bits,
    is improved by one third-order step (relative error below 6e-13), in half the time of its square root.
    """
    if not (isinstance(x.type, ir.VectorType) and has("avx512f")):
        return call_intrinsic(builder, "llvm.sqrt", emit_positive(builder, x))
    mask = builder.bitcast(_is_positive(builder, x), ir.IntType(LANES))
    y = call(builder, "llvm.x86.avx512.rsqrt14.pd.512", x.type, x, constant(x.type, 0.0), mask)
    r = emit_multiply(builder, x, y)
    error = emit_subtract(builder, constant(x.type, 1.0), emit_multiply(builder, r, y))
    weight = emit_multiply(builder, error, constant(x.type, 0.375))
    weight = emit_add(builder, weight, constant(x.type, 0.5))
    step = emit_multiply(builder, emit_multiply(builder, r, error), weight)
    return emit_add(builder, r, step)


def is_any_positive(builder, x):
    """Whether x > 0, in any lane (a bit)."""
    mask = _is_positive(builder, x)
    if not isinstance(x.type, ir.VectorType):
        return mask
    bits = builder.bitcast(mask, ir.IntType(LANES))
    return builder.icmp_unsigned("!=", bits, ir.Constant(bits.type, 0))


# Python's operator (its name in `operator`), or function of `physics.lanes` → what writes its code.
OPERATORS = {
    "add": emit_add,
    "sub": emit_subtract,
    "mul": emit_multiply,
    "truediv": emit_divide,
    "neg": emit_negate,
}
FUNCTIONS = {
    "root": emit_root,
    "select": emit_select,
    "power": emit_power,
    "absolute": emit_absolute,
    "positive": emit_positive,
    "power_3_2": emit_power_3_2,
    "without_fusing": emit_without_fusing,
}
