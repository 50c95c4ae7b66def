"""The table of all bodies, and what a stepper is compiled for.

All numbers of one body (or of the contact behind it) stand side by side in one row of the *table*,
an array (groups, bodies + 1, columns, lanes) whose last body is the wall, always at rest:

    U, V, INVERSE_MASS          displacement from rest, velocity, 1/mass
    REST, REST_FORCE            compression and force of the contact at rest; only if it may be preloaded
    coefficients, memory        of the law set
    increments, old, blend, turn  work space of the Runge–Kutta stepper and of its samples between steps

A `Composition` (law set, lanes, audit, motion) is part of the type that Numba compiles for. It knows the
columns, so that all addresses are constants of the compiled code.
"""

from dataclasses import dataclass
from functools import cached_property

from llvmlite import ir
from numba import types
from numba.extending import NativeValue, intrinsic, models, register_model, unbox

from sonicvacuum.physics.lanes import LANES
from sonicvacuum.physics.laws import LawSet
from sonicvacuum.physics.registers import FASTMATH, constant, lane

# Options of all that is compiled, and of what is only ever called from compiled code.
OPTIONS = {"fastmath": FASTMATH, "error_model": "numpy", "nogil": True, "_nrt": False}
INLINED = OPTIONS | {"forceinline": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}

U, V, INVERSE_MASS, REST, REST_FORCE = range(5)


@dataclass(frozen=True)
class Composition:
    """What a stepper is compiled for.

    Attributes:
        laws: all terms that act.
        width: chains stepped together, 1 or `LANES`.
        audited: whether the energy and momentum balance is kept.
        watched: whether the motion of bodies is recorded.
    """

    laws: LawSet
    width: int
    audited: bool = False
    watched: bool = False

    @cached_property
    def name(self) -> str:
        """Key of the compiled code."""
        extras = f"{'+audit' if self.audited else ''}{'+motion' if self.watched else ''}"
        return f"{self.laws.name}x{self.width}{extras}"

    @property
    def first_coefficient(self) -> int:
        """Column of the law set's first coefficient."""
        return REST_FORCE + 1 if self.laws.preloaded else REST

    @property
    def memories(self) -> int:
        """Remembered numbers per contact."""
        return len(self.laws.memory_of)

    @property
    def first_memory(self) -> int:
        """Column of the first remembered number."""
        return self.first_coefficient + self.laws.coefficients

    @property
    def first_increment(self) -> int:
        """Column of the increments of displacement, velocity and memory."""
        return self.first_memory + self.memories

    @property
    def first_old(self) -> int:
        """Column of the memory at the step's start, for samples between steps."""
        return self.first_increment + 2 + self.memories

    @property
    def first_blend(self) -> int:
        """Column of the memory at a moment between steps."""
        return self.first_old + self.memories

    @property
    def first_turn(self) -> int:
        """Column of approach and rate at the step's start, kept where a path is to be followed."""
        return self.first_blend + self.memories

    @property
    def columns(self) -> int:
        """Numbers per body."""
        if self.laws.splits:
            return self.first_increment
        return self.first_turn + (2 if self.laws.in_slot("path") else 0)

    @cached_property
    def _numba_type_(self):
        return _types.setdefault(self.name, CompositionType(self))

    def __hash__(self):
        return hash(self.name)


class CompositionType(types.Type):
    """Numba type of a composition."""

    def __init__(self, composition: Composition):
        self.composition = composition
        super().__init__(name=composition.name)

    def __reduce__(self):
        # Compiled code needs the name alone; formulas need not be picklable.
        return _bare_type, (self.name,)


class _BareComposition:
    def __init__(self, name):
        self.name = name


def _bare_type(name):
    return CompositionType(_BareComposition(name))


# Name → type: asking for the type of an argument is part of every call.
_types = {}


@register_model(CompositionType)
class _CompositionModel(models.OpaqueModel):
    pass


@unbox(CompositionType)
def _unbox_composition(kind, obj, c):
    return NativeValue(c.context.get_dummy_value())


def _number_type(composition):
    return lane if composition.composition.width == LANES else types.float64


def _address(context, builder, sig, args, columns):
    """Pointer to the numbers of all lanes at a row (and column) of a contiguous array."""
    kind, array = sig.args[1], args[1]
    width = sig.args[0].composition.width
    data = context.make_array(kind)(context, builder, array).data
    index = builder.mul(args[2], ir.Constant(args[2].type, columns * width), flags=("nsw",))
    if len(args) > 3 and sig.args[3] in types.integer_domain:
        column = builder.mul(args[3], ir.Constant(args[3].type, width), flags=("nsw",))
        index = builder.add(index, column, flags=("nsw",))
    pointer = builder.gep(data, [index], inbounds=True)
    if width == 1:
        return pointer
    return builder.bitcast(pointer, context.get_value_type(lane).as_pointer())


@intrinsic
def load(typing, composition, array, row):
    """The numbers of all lanes in one row of an array (…, lanes)."""

    def generate(context, builder, sig, args):
        return builder.load(_address(context, builder, sig, args, 1), align=8)

    return _number_type(composition)(composition, array, types.intp), generate


@intrinsic
def store(typing, composition, array, row, value):
    """Write the numbers of all lanes in one row of an array (…, lanes)."""
    number = _number_type(composition)

    def generate(context, builder, sig, args):
        builder.store(args[3], _address(context, builder, sig, args, 1), align=8)
        return context.get_dummy_value()

    return types.void(composition, array, types.intp, number), generate


@intrinsic
def get(typing, composition, table, body, column):
    """One number of a body, for all lanes."""

    def generate(context, builder, sig, args):
        columns = sig.args[0].composition.columns
        return builder.load(_address(context, builder, sig, args, columns), align=8)

    return _number_type(composition)(composition, table, types.intp, types.intp), generate


@intrinsic
def put(typing, composition, table, body, column, value):
    """Write one number of a body, for all lanes."""
    number = _number_type(composition)

    def generate(context, builder, sig, args):
        columns = sig.args[0].composition.columns
        builder.store(args[4], _address(context, builder, sig, args, columns), align=8)
        return context.get_dummy_value()

    return types.void(composition, table, types.intp, types.intp, number), generate


@intrinsic
def is_any_positive(typing, x):
    """Whether x > 0 in any lane."""

    def generate(context, builder, sig, args):
        zero = constant(args[0].type, 0.0)
        mask = builder.fcmp_ordered(">", args[0], zero)
        if sig.args[0] is not lane:
            return mask
        bits = builder.bitcast(mask, ir.IntType(LANES))
        return builder.icmp_unsigned("!=", bits, ir.Constant(bits.type, 0))

    return types.boolean(x), generate


@intrinsic
def zero(typing, composition):
    """0 in all lanes."""

    def generate(context, builder, sig, args):
        return constant(context.get_value_type(sig.return_type), 0.0)

    return _number_type(composition)(composition), generate


def _fixed(attribute):
    """A function of the composition that compiles to one of its numbers."""

    @intrinsic
    def number(typing, composition):
        def generate(context, builder, sig, args):
            return context.get_constant(types.intp, getattr(sig.args[0].composition, attribute))

        return types.intp(composition), generate

    return number


first_memory = _fixed("first_memory")
first_increment = _fixed("first_increment")
first_blend = _fixed("first_blend")
