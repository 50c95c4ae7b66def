"""x**y for eight lanes at once: 2**(y log2 x) by polynomials, for the laws that need it.

The machine has no such instruction and the mathematics library works on one number at a time.
Relative error below 1e-13 for |y log2 x| < 100, which holds for compressions in metres.
"""

import math

import numpy as np
from llvmlite import ir
from numpy.polynomial import Chebyshev, Polynomial

_FLAGS = ("contract", "nsz")
_MANTISSA_BITS = 52
_ONE = 1023 << _MANTISSA_BITS
# From here on doubles are whole numbers: exponents become doubles, and back, without a conversion, of which
# machines with 256-bit registers have none for vectors.
_WHOLE, _WHOLE_BITS = 2.0**_MANTISSA_BITS, (1023 + _MANTISSA_BITS) << _MANTISSA_BITS
_LIFT = 1024
_ROOT_HALF = 0x3FE6A09E667F3BCD  # the bits of sqrt(1/2)


def _interpolating(function, degree, low, high):
    """Coefficients of the polynomial through a function at Chebyshev's points."""
    interpolated = Chebyshev.interpolate(function, degree, (low, high))
    return interpolated.convert(kind=Polynomial).coef.tolist()


def _log2_of_square(square):
    """log2 m over s = (m − 1)/(m + 1), a function of s²: 2/ln 2 artanh(s)/s."""
    s = np.sqrt(square)
    return 2.0 / math.log(2.0) * np.arctanh(s) / s


# For mantissas between sqrt(1/2) and sqrt(2), and halves: relative errors of 1e-15 and 1e-14.
_LOG2 = _interpolating(_log2_of_square, 6, 0.0, (math.sqrt(2.0) - 1.0) ** 4)
_EXP2 = _interpolating(np.exp2, 9, -0.5, 0.5)


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


def _polynomial(builder, x, coefficients):
    """By pairs of pairs (Estrin), of which the processor works on several at once; Horner's rule would wait
    for every product.
    """
    terms, step = [_numbers(x.type, c) for c in coefficients], x
    while len(terms) > 1:
        pairs = zip(terms[::2], terms[1::2], strict=False)
        summed = [builder.fadd(builder.fmul(b, step, flags=_FLAGS), a, flags=_FLAGS) for a, b in pairs]
        terms = summed + terms[2 * len(summed) :]
        step = builder.fmul(step, step)
    return terms[0]


def _emit_log2(builder, x):
    """log2 of positive, normal x."""
    whole = ir.VectorType(ir.IntType(64), x.type.count)
    bits = builder.bitcast(x, whole)
    # Exponent such that the mantissa lies in [sqrt(1/2), sqrt(2)), lifted so that none is negative.
    lifted = builder.add(bits, _numbers(whole, (_LIFT << _MANTISSA_BITS) - _ROOT_HALF))
    exponent = builder.lshr(lifted, _numbers(whole, _MANTISSA_BITS))
    whole_part = builder.and_(lifted, _numbers(whole, -1 << _MANTISSA_BITS))
    own = builder.sub(whole_part, _numbers(whole, _LIFT << _MANTISSA_BITS))
    mantissa = builder.bitcast(builder.sub(bits, own), x.type)
    number = builder.bitcast(builder.or_(exponent, _numbers(whole, _WHOLE_BITS)), x.type)
    exponent = builder.fsub(number, _numbers(x.type, _WHOLE + _LIFT))
    one = _numbers(x.type, 1.0)
    s = builder.fdiv(builder.fsub(mantissa, one), builder.fadd(mantissa, one))
    series = _polynomial(builder, builder.fmul(s, s), _LOG2)
    return builder.fadd(exponent, builder.fmul(s, series, flags=_FLAGS), flags=_FLAGS)


def _emit_exp2(builder, x):
    """2**x, zero below the range of normal numbers."""
    whole = ir.VectorType(ir.IntType(64), x.type.count)
    low = builder.fcmp_ordered("<", x, _numbers(x.type, -1021.0))
    kept = builder.select(low, _numbers(x.type, -1021.0), x)
    high = builder.fcmp_ordered(">", kept, _numbers(x.type, 1022.0))
    kept = builder.select(high, _numbers(x.type, 1022.0), kept)
    # A sum so large has no digits behind the point, and the integer in its last bits.
    rounded = builder.fadd(kept, _numbers(x.type, 1.5 * _WHOLE))
    near = builder.fsub(rounded, _numbers(x.type, 1.5 * _WHOLE))
    fraction = _polynomial(builder, builder.fsub(kept, near), _EXP2)
    exponent = builder.shl(builder.bitcast(rounded, whole), _numbers(whole, _MANTISSA_BITS))
    scale = builder.bitcast(builder.add(exponent, _numbers(whole, _ONE)), x.type)
    return builder.select(low, _numbers(x.type, 0.0), builder.fmul(fraction, scale))


def power_of_lanes(builder, x, exponent):
    """LLVM code of x**exponent for vectors, x ≥ 0, exponent > 0; 0 at x = 0."""
    is_zero = builder.fcmp_ordered("==", x, _numbers(x.type, 0.0))
    kept = builder.select(is_zero, _numbers(x.type, 1.0), x)
    value = _emit_exp2(builder, builder.fmul(exponent, _emit_log2(builder, kept)))
    return builder.select(is_zero, x, value)
