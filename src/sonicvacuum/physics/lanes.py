"""Eight chains in one register: a vector number for compiled code.

A *lane* is one independent chain. Eight lanes are stepped together, one per slot of a 512-bit
register (two or four registers on narrower machines). Force laws are written once, in ordinary
arithmetic and the functions below; they then work on floats and numpy arrays (tests, theory), on
scalars in compiled code (one long chain) and on vectors of eight lanes (ensembles), which the
compiler need not discover: the type is explicit.

Arrays that hold lanes carry them in their last axis, of length `LANES`; `get` and `put` move one
row (a float for scalar arrays) between memory and registers.
"""

import operator

import numpy as np
from llvmlite import binding, ir
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, overload, register_jitable, register_model

LANES = 8

_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_INT = ir.IntType(64)
# Contraction to fused multiply-add and ignoring the sign of zero are the only liberties taken.
FASTMATH = {"contract", "nsz"}
_FLAGS = tuple(sorted(FASTMATH))


class LaneType(types.Type):
    """Numba type of `LANES` float64 numbers held in registers."""

    def __init__(self):
        super().__init__(name=f"lanes{LANES}")


lane = LaneType()


@register_model(LaneType)
class _LaneModel(models.PrimitiveModel):
    def __init__(self, manager, fe_type):
        super().__init__(manager, fe_type, _VECTOR)


def _constant(value):
    return ir.Constant(_VECTOR, [float(value)] * LANES)


def _splat(builder, scalar):
    undefined = ir.Constant(_VECTOR, ir.Undefined)
    one = builder.insert_element(undefined, scalar, ir.Constant(ir.IntType(32), 0))
    mask = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.shuffle_vector(one, undefined, mask)


def _operand(builder, kind, value):
    return value if isinstance(kind, LaneType) else _splat(builder, value)


def _register_arithmetic(function, instruction):
    @infer_global(function)
    class _Template(AbstractTemplate):
        def generic(self, args, kws):
            known = (LaneType, types.Float, types.Integer)
            if len(args) == 2 and lane in args and all(isinstance(a, known) for a in args):
                return signature(lane, *[a if a is lane else types.float64 for a in args])

    def lower(context, builder, sig, args):
        values = [_operand(builder, kind, value) for kind, value in zip(sig.args, args, strict=True)]
        return getattr(builder, instruction)(*values, flags=_FLAGS)

    for left, right in ((LaneType, LaneType), (LaneType, types.Float), (types.Float, LaneType)):
        lower_builtin(function, left, right)(lower)


for _function, _instruction in (
    (operator.add, "fadd"),
    (operator.sub, "fsub"),
    (operator.mul, "fmul"),
    (operator.truediv, "fdiv"),
):
    _register_arithmetic(_function, _instruction)


@infer_global(operator.neg)
class _Negation(AbstractTemplate):
    def generic(self, args, kws):
        if args == (lane,):
            return signature(lane, lane)


@lower_builtin(operator.neg, LaneType)
def _lower_negation(context, builder, sig, args):
    return builder.fneg(args[0], flags=_FLAGS)


def _row_pointer(context, builder, array_type, array, indices):
    struct = context.make_array(array_type)(context, builder, array)
    zero = ir.Constant(_INT, 0)
    pointer = cgutils.get_item_pointer(context, builder, array_type, struct, [*indices, zero])
    return builder.bitcast(pointer, _VECTOR.as_pointer())


@intrinsic
def _load_row(typing, array, i):
    def generate(context, builder, sig, args):
        return builder.load(_row_pointer(context, builder, sig.args[0], args[0], [args[1]]), align=8)

    return lane(array, types.intp), generate


@intrinsic
def _load_row2(typing, array, i, j):
    def generate(context, builder, sig, args):
        return builder.load(_row_pointer(context, builder, sig.args[0], args[0], args[1:]), align=8)

    return lane(array, types.intp, types.intp), generate


@intrinsic
def _store_row(typing, array, i, value):
    def generate(context, builder, sig, args):
        builder.store(args[2], _row_pointer(context, builder, sig.args[0], args[0], [args[1]]), align=8)
        return context.get_dummy_value()

    return types.void(array, types.intp, lane), generate


@intrinsic
def _store_row2(typing, array, i, j, value):
    def generate(context, builder, sig, args):
        pointer = _row_pointer(context, builder, sig.args[0], args[0], args[1:3])
        builder.store(args[3], pointer, align=8)
        return context.get_dummy_value()

    return types.void(array, types.intp, types.intp, lane), generate


def get(array, i):
    """Row `i` of a (rows, LANES) array as lanes, or element `i` of a (rows,) array as a float."""
    return array[i]


def get2(array, i, j):
    """Row (i, j) of a (…, …, LANES) array as lanes, or element (i, j) of a matrix as a float."""
    return array[i, j]


def put(array, i, value):
    """Store lanes (or a float) in row `i`."""
    array[i] = value


def put2(array, i, j, value):
    """Store lanes (or a float) in row (i, j)."""
    array[i, j] = value


@overload(get, inline="always")
def _get(array, i):
    if array.ndim == 1:
        return lambda array, i: array[i]
    return lambda array, i: _load_row(array, i)


@overload(get2, inline="always")
def _get2(array, i, j):
    if array.ndim == 2:
        return lambda array, i, j: array[i, j]
    return lambda array, i, j: _load_row2(array, i, j)


@overload(put, inline="always")
def _put(array, i, value):
    if array.ndim == 1:

        def store(array, i, value):
            array[i] = value

        return store
    return lambda array, i, value: _store_row(array, i, value)


@overload(put2, inline="always")
def _put2(array, i, j, value):
    if array.ndim == 2:

        def store(array, i, j, value):
            array[i, j] = value

        return store
    return lambda array, i, j, value: _store_row2(array, i, j, value)


def _has_reciprocal_root():
    """Whether the machine estimates 1/sqrt for a whole 512-bit register (AVX-512F)."""
    return bool(binding.get_host_cpu_features().get("avx512f"))


def _root_of_positive(builder, x):
    """sqrt(x) where x > 0, else 0, for lanes.

    The estimate of 1/sqrt good to 14 bits is improved by one third-order step (relative error below
    2e-13): about half the time of the hardware's square root.
    """
    zero = _constant(0.0)
    positive = builder.fcmp_ordered(">", x, zero)
    if not _has_reciprocal_root():
        kept = builder.select(positive, x, zero)
        name = f"llvm.sqrt.v{LANES}f64"
        root = cgutils.get_or_insert_function(builder.module, ir.FunctionType(_VECTOR, [_VECTOR]), name)
        return builder.call(root, [kept])
    bits = ir.IntType(LANES)
    kind = ir.FunctionType(_VECTOR, [_VECTOR, _VECTOR, bits])
    name = "llvm.x86.avx512.rsqrt14.pd.512"
    estimate = cgutils.get_or_insert_function(builder.module, kind, name)
    y = builder.call(estimate, [x, zero, builder.bitcast(positive, bits)])
    root = builder.fmul(x, y, flags=_FLAGS)
    error = builder.fsub(_constant(1.0), builder.fmul(root, y, flags=_FLAGS), flags=_FLAGS)
    weight = builder.fadd(builder.fmul(error, _constant(0.375), flags=_FLAGS), _constant(0.5), flags=_FLAGS)
    step = builder.fmul(builder.fmul(root, error, flags=_FLAGS), weight, flags=_FLAGS)
    return builder.fadd(root, step, flags=_FLAGS)


@intrinsic
def _lane_root(typing, x):
    return lane(lane), lambda context, builder, sig, args: _root_of_positive(builder, args[0])


@intrinsic
def _lane_select(typing, condition, yes, no):
    """`yes` where condition > 0, else `no`."""

    def generate(context, builder, sig, args):
        x, yes, no = (_operand(builder, k, v) for k, v in zip(sig.args, args, strict=True))
        return builder.select(builder.fcmp_ordered(">", x, _constant(0.0)), yes, no)

    kinds = [a if a is lane else types.float64 for a in (condition, yes, no)]
    return lane(*kinds), generate


@intrinsic
def _lane_largest(typing, x):
    """Largest of the lanes as a float (NaN is larger than all, so that it is seen)."""

    def generate(context, builder, sig, args):
        best = builder.extract_element(args[0], ir.Constant(ir.IntType(32), 0))
        for k in range(1, LANES):
            other = builder.extract_element(args[0], ir.Constant(ir.IntType(32), k))
            best = builder.select(builder.fcmp_unordered(">", other, best), other, best)
        return best

    return types.float64(lane), generate


@intrinsic
def _lane_abs(typing, x):
    def generate(context, builder, sig, args):
        name = f"llvm.fabs.v{LANES}f64"
        absolute = cgutils.get_or_insert_function(builder.module, ir.FunctionType(_VECTOR, [_VECTOR]), name)
        return builder.call(absolute, [args[0]])

    return lane(lane), generate


@intrinsic
def _lane_power(typing, x, exponent):
    def generate(context, builder, sig, args):
        name = f"llvm.pow.v{LANES}f64"
        kind = ir.FunctionType(_VECTOR, [_VECTOR, _VECTOR])
        power = cgutils.get_or_insert_function(builder.module, kind, name)
        base, exponent = (_operand(builder, k, v) for k, v in zip(sig.args, args, strict=True))
        return builder.call(power, [base, exponent])

    return lane(lane, exponent if exponent is lane else types.float64), generate


def root(x):
    """sqrt(x) where x > 0, else 0 (float, array or lanes)."""
    return np.sqrt(np.maximum(x, 0.0))


def select(condition, yes, no):
    """`yes` where condition > 0, else `no` (floats, arrays or lanes)."""
    return np.where(np.asarray(condition) > 0.0, yes, no)


def power(x, exponent):
    """x**exponent where x > 0, else 0 (float, array or lanes); exponent > 0."""
    return np.maximum(x, 0.0) ** exponent


def absolute(x):
    """|x| (float, array or lanes)."""
    return np.abs(x)


def largest(x):
    """Largest lane as a float."""
    return np.max(x)


@overload(root, inline="always")
def _root(x):
    if x is lane:
        return lambda x: _lane_root(x)
    return lambda x: np.sqrt(x) if x > 0.0 else 0.0


@overload(select, inline="always")
def _select(condition, yes, no):
    if condition is lane:
        return lambda condition, yes, no: _lane_select(condition, yes, no)
    return lambda condition, yes, no: yes if condition > 0.0 else no


@overload(power)
def _power(x, exponent):
    if x is lane:
        return lambda x, exponent: _lane_power(_lane_select(x, x, 0.0), exponent)
    return lambda x, exponent: x**exponent if x > 0.0 else 0.0


@overload(absolute, inline="always")
def _absolute(x):
    if x is lane:
        return lambda x: _lane_abs(x)
    return lambda x: abs(x)


@overload(largest, inline="always")
def _largest(x):
    if x is lane:
        return lambda x: _lane_largest(x)
    return lambda x: x


@register_jitable
def positive(x):
    """x where x > 0, else 0 (float, array or lanes)."""
    return select(x, x, 0.0)


@register_jitable
def power_3_2(x):
    """x**(3/2) where x > 0, else 0, by a square root (float, array or lanes)."""
    return x * root(x)
