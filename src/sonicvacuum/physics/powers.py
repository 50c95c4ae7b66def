"""x**y for eight lanes at once: 2**(y log2 x) by polynomials, for the laws that need it.

The machine has no such instruction and the mathematics library works on one number at a time.
Relative error below 1e-13 for |y log2 x| < 100, which holds for compressions in metres.
"""

import math

from llvmlite import ir

_FLAGS = ("contract", "nsz")
_MANTISSA_BITS = 52
_ONE = 1023 << _MANTISSA_BITS
_ROOT_HALF = 0x3FE6A09E667F3BCD  # the bits of sqrt(1/2)
# log2(m) = 2/ln 2 artanh(s), s = (m − 1)/(m + 1), |s| < 0.172: the first neglected term is below 1e-17.
_LOG2 = [2.0 / math.log(2.0) / (2 * k + 1) for k in range(11)]
# 2**r = exp(r ln 2), |r| ≤ 1/2: the first neglected term is below 1e-17.
_EXP2 = [math.log(2.0) ** k / math.factorial(k) for k in range(14)]


def call(builder, name, result, *values):
    """The call of a function by its name in LLVM, declared where it is not yet."""
    function = builder.module.globals.get(name)
    if function is None:
        kind = ir.FunctionType(result, [v.type for v in values])
        function = ir.Function(builder.module, kind, name)
    return builder.call(function, values)


def call_intrinsic(builder, name, x):
    """LLVM's own function of one double or one vector of doubles."""
    kind = f"v{x.type.count}f64" if isinstance(x.type, ir.VectorType) else "f64"
    return call(builder, f"{name}.{kind}", x.type, x)


def _numbers(kind, value):
    return ir.Constant(kind, [value] * kind.count)


def _horner(builder, x, coefficients):
    total = _numbers(x.type, coefficients[-1])
    for c in reversed(coefficients[:-1]):
        product = builder.fmul(total, x, flags=_FLAGS)
        total = builder.fadd(product, _numbers(x.type, c), flags=_FLAGS)
    return total


def _emit_log2(builder, x):
    """log2 of positive, normal x."""
    whole = ir.VectorType(ir.IntType(64), x.type.count)
    bits = builder.bitcast(x, whole)
    # Exponent such that the mantissa lies in [sqrt(1/2), sqrt(2)).
    above = builder.sub(bits, _numbers(whole, _ROOT_HALF))
    exponent = builder.ashr(above, _numbers(whole, _MANTISSA_BITS))
    mantissa = builder.bitcast(
        builder.sub(bits, builder.shl(exponent, _numbers(whole, _MANTISSA_BITS))), x.type
    )
    one = _numbers(x.type, 1.0)
    s = builder.fdiv(builder.fsub(mantissa, one), builder.fadd(mantissa, one))
    series = _horner(builder, builder.fmul(s, s), _LOG2)
    return builder.fadd(builder.sitofp(exponent, x.type), builder.fmul(s, series, flags=_FLAGS), flags=_FLAGS)


def _emit_exp2(builder, x):
    """2**x, zero below the range of normal numbers."""
    whole = ir.VectorType(ir.IntType(64), x.type.count)
    low = builder.fcmp_ordered("<", x, _numbers(x.type, -1021.0))
    kept = builder.select(low, _numbers(x.type, -1021.0), x)
    high = builder.fcmp_ordered(">", kept, _numbers(x.type, 1022.0))
    kept = builder.select(high, _numbers(x.type, 1022.0), kept)
    near = call_intrinsic(builder, "llvm.rint", kept)
    fraction = _horner(builder, builder.fsub(kept, near), _EXP2)
    exponent = builder.shl(builder.fptosi(near, whole), _numbers(whole, _MANTISSA_BITS))
    scale = builder.bitcast(builder.add(exponent, _numbers(whole, _ONE)), x.type)
    return builder.select(low, _numbers(x.type, 0.0), builder.fmul(fraction, scale))


def power_of_lanes(builder, x, exponent):
    """LLVM code of x**exponent for vectors, x ≥ 0, exponent > 0; 0 at x = 0."""
    is_zero = builder.fcmp_ordered("==", x, _numbers(x.type, 0.0))
    kept = builder.select(is_zero, _numbers(x.type, 1.0), x)
    value = _emit_exp2(builder, builder.fmul(exponent, _emit_log2(builder, kept)))
    return builder.select(is_zero, x, value)
