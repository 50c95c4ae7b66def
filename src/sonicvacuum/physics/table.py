"""The table of all bodies as compiled code reads and writes it, and the stepper's way into the laws.

The stepper is compiled for a `Frame`, its first argument `c`: without laws. What depends on them is left
open, functions of a body's row (`push` and those after it) and whole numbers (the table's columns,
`preloaded` and those after it). They go by LAW and their name until `linking` puts them in.
"""

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, models, register_model
from numba.np.arrayobj import populate_array

from sonicvacuum.physics import arithmetic
from sonicvacuum.physics.arithmetic import FASTMATH, constant
from sonicvacuum.physics.composition import Frame
from sonicvacuum.physics.lanes import LANES
from sonicvacuum.physics.linking import LAW
from sonicvacuum.physics.registers import lane

# Options of all that is compiled, and of what is only ever called from compiled code.
OPTIONS = {"fastmath": FASTMATH, "error_model": "numpy", "nogil": True, "_nrt": False}
WITHIN = {"forceinline": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
INLINED = OPTIONS | WITHIN


class FrameType(types.Type):
    """Numba type of a frame."""

    def __init__(self, frame: Frame):
        self.frame = frame
        super().__init__(name=frame.name)


@register_model(FrameType)
class _FrameModel(models.OpaqueModel):
    pass


def number_type(width: int) -> types.Type:
    """Numba type of one number of all lanes."""
    return lane if width == LANES else types.float64


def _number_type(c):
    return number_type(c.frame.width)


def _address(context, builder, sig, args, columns):
    """Pointer to the numbers of all lanes at a row (and column) of a contiguous array."""
    kind, width = sig.args[1], sig.args[0].frame.width
    data = context.make_array(kind)(context, builder, args[1]).data
    index = builder.mul(args[2], columns, flags=("nsw",))
    if len(args) > 3 and sig.args[3] in types.integer_domain:
        index = builder.add(index, args[3], flags=("nsw",))
    index = builder.mul(index, ir.Constant(index.type, width), flags=("nsw",))
    pointer = builder.gep(data, [index], inbounds=True)
    return builder.bitcast(pointer, context.get_value_type(_number_type(sig.args[0])).as_pointer())


def _law_number(builder, name):
    """A whole number that the laws fill in."""
    module, kind = builder.module, ir.IntType(64)
    if LAW + name not in module.globals:
        ir.GlobalVariable(module, kind, LAW + name).global_constant = True
    return builder.load(module.globals[LAW + name])


@intrinsic
def array_at(typing, pointer, shape):
    """The array of a shape that begins at a pointer, in C's order; `numba.carray` counts references."""
    kind = types.Array(pointer.dtype, len(shape), "C")

    def generate(context, builder, sig, args):
        sizes = cgutils.unpack_tuple(builder, args[1])
        size = context.get_abi_sizeof(context.get_value_type(kind.dtype))
        strides = [context.get_constant(types.intp, size)]
        for n in reversed(sizes[1:]):
            strides.insert(0, builder.mul(strides[0], n))
        array = context.make_array(kind)(context, builder)
        populate_array(array, args[0], sizes, strides, strides[-1], None)
        return array._getvalue()

    return kind(pointer, shape), generate


@intrinsic
def load(typing, c, array, row):
    """The numbers of all lanes in one row of an array (…, lanes)."""

    def generate(context, builder, sig, args):
        return builder.load(_address(context, builder, sig, args, ir.Constant(args[2].type, 1)), align=8)

    return _number_type(c)(c, array, types.intp), generate


@intrinsic
def store(typing, c, array, row, value):
    """Write the numbers of all lanes in one row of an array (…, lanes)."""

    def generate(context, builder, sig, args):
        one = ir.Constant(args[2].type, 1)
        builder.store(args[3], _address(context, builder, sig, args, one), align=8)
        return context.get_dummy_value()

    return types.void(c, array, types.intp, _number_type(c)), generate


@intrinsic
def get(typing, c, table, body, column):
    """One number of a body, for all lanes."""

    def generate(context, builder, sig, args):
        columns = _law_number(builder, "columns")
        return builder.load(_address(context, builder, sig, args, columns), align=8)

    return _number_type(c)(c, table, types.intp, types.intp), generate


@intrinsic
def put(typing, c, table, body, column, value):
    """Write one number of a body, for all lanes."""

    def generate(context, builder, sig, args):
        columns = _law_number(builder, "columns")
        builder.store(args[4], _address(context, builder, sig, args, columns), align=8)
        return context.get_dummy_value()

    return types.void(c, table, types.intp, types.intp, _number_type(c)), generate


@intrinsic
def is_any_positive(typing, x):
    """Whether x > 0 in any lane."""

    def generate(context, builder, sig, args):
        return arithmetic.is_any_positive(builder, args[0])

    return types.boolean(x), generate


@intrinsic
def zero(typing, c):
    """0 in all lanes."""

    def generate(context, builder, sig, args):
        return constant(context.get_value_type(sig.return_type), 0.0)

    return _number_type(c)(c), generate


def _number(name):
    """A function of the frame that compiles to a whole number of the laws."""

    @intrinsic
    def number(typing, c):
        def generate(context, builder, sig, args):
            return _law_number(builder, name)

        return types.intp(c), generate

    return number


preloaded = _number("preloaded")
first_memory = _number("first_memory")
first_increment = _number("first_increment")
first_blend = _number("first_blend")


def _law(name, c, table, *kinds, returns=types.void):
    """Signature of a function of the laws and what generates its call: a body of the table, then `kinds`."""

    def generate(context, builder, sig, args):
        row = _address(context, builder, sig, args[:3], _law_number(builder, "columns"))
        values = [row, *args[3:]]
        empty = sig.return_type == types.void
        result = ir.VoidType() if empty else context.get_value_type(sig.return_type)
        kind = ir.FunctionType(result, [v.type for v in values])
        found = builder.call(cgutils.get_or_insert_function(builder.module, kind, LAW + name), values)
        return context.get_dummy_value() if empty else found

    return returns(c, table, types.intp, *kinds), generate


@intrinsic
def push(typing, c, table, body, approach, rate, first_memory):
    """Force in N, beyond the static one, between a body and the next.

    `approach` of the two since rest in m, its `rate` in m/s; `first_memory`: column of the memory to use.
    """
    n = _number_type(c)
    return _law("push", c, table, n, n, types.intp, returns=n)


@intrinsic
def advance_memory(typing, c, table, body, approach, keep, gain, step):
    """One low-storage Runge–Kutta stage of the memory of the contact behind a body."""
    n = _number_type(c)
    return _law("advance_memory", c, table, n, types.float64, types.float64, n)


@intrinsic
def follow_path(typing, c, table, body, step):
    """After a step, keep the largest compression that the contact behind a body had during it."""
    return _law("follow_path", c, table, _number_type(c))


@intrinsic
def body_acceleration(typing, c, table, body, velocity):
    """Acceleration in m/s² of a bead by drag and friction."""
    n = _number_type(c)
    return _law("body_acceleration", c, table, n, returns=n)


@intrinsic
def stored_energy(typing, c, table, body, approach):
    """Elastic energy in J of a contact beyond that at rest, less the work of its static force."""
    n = _number_type(c)
    return _law("stored_energy", c, table, n, returns=n)


@intrinsic
def keep_memory(typing, c, table, body, step):
    """Before a step, copy the memory of a contact to the columns `old`, and keep its rate."""
    return _law("keep_memory", c, table, _number_type(c))


@intrinsic
def end_memory(typing, c, table, body, step):
    """After a step, keep the rate of the memory of a contact."""
    return _law("end_memory", c, table, _number_type(c))


@intrinsic
def blend_memory(typing, c, table, body, fraction, approach, rate):
    """Leave the memory at a fraction of the step in the columns `blend`.

    `approach` and `rate` at that moment: the largest compression is the present one while it grows beyond the
    old.
    """
    n = _number_type(c)
    return _law("blend_memory", c, table, n, n, n)
