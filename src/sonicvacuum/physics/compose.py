"""From a law set to functions of a body's row: the formulas of a composition, chained into one function each.

They fill what the stepper leaves open (see `table`), and are written as LLVM's code right away (`tracing`).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from llvmlite import ir

from sonicvacuum.physics.arithmetic import LANES_KIND, constant, splat
from sonicvacuum.physics.composition import REST, REST_FORCE, Composition, U, V
from sonicvacuum.physics.cubic import hermite, highest
from sonicvacuum.physics.lanes import LANES, positive, select, without_fusing
from sonicvacuum.physics.laws import Term
from sonicvacuum.physics.tracing import Number, worked_out

# Gauss's rule on −1 to 1, moved to 0 to 1; exact where a correction is a polynomial in √compression up to the
# eleventh power.
_X, _W = np.polynomial.legendre.leggauss(8)
_NODES, _WEIGHTS = (0.5 * (_X + 1.0)).tolist(), (0.5 * _W).tolist()

_WHOLE = ir.IntType(64)


class _Code:
    """The code of one function, written at the row of a body."""

    def __init__(self, composition, function):
        self.composition, self.laws = composition, composition.laws
        self.builder, self.row = ir.IRBuilder(function.append_basic_block()), function.args[0]
        self.kind = self.row.type.pointee

    def number(self, value):
        """A number of all lanes, from one or from what is alike in all."""
        scalar = value.type != self.kind
        return Number(self.builder, splat(self.builder, value) if scalar else value)

    def _at(self, column, more=0):
        if isinstance(column, int):
            column = ir.Constant(_WHOLE, column + more)
        elif more:
            column = self.builder.add(column, ir.Constant(_WHOLE, more))
        return self.builder.gep(self.row, [column], inbounds=True)

    def read(self, column, more=0):
        """The number in a column, or `more` columns behind it."""
        return Number(self.builder, self.builder.load(self._at(column, more), align=8))

    def write(self, column, number):
        self.builder.store(number.value, self._at(column), align=8)

    def call(self, term: Term, what: str, *arguments: Number) -> Number:
        """One formula of a term, its coefficients read from the table."""
        start = self._first(term)
        own = [self.read(start + k) for k in range(term.coefficients)]
        return worked_out(getattr(term, what), *arguments, *own)

    def _first(self, term):
        return self.composition.first_coefficient + self.laws.first_coefficient[term.name]

    def with_terms(self, slot: str, total: Number, *arguments: Number) -> Number:
        """A total with what all terms of a slot add to it."""
        for term in self.laws.in_slot(slot):
            total = total + self.call(term, "formula", *arguments)
        return total

    def depth(self, approach: Number) -> Number:
        """Compression of the contact, by what it approached since rest."""
        return approach + self.read(REST) if self.laws.preloaded else approach

    def elastic(self, delta: Number, first_memory) -> Number:
        """The elastic force: the loading curve, or what paths make of it."""
        loading = elastic = self.loading(delta)
        for term in self.laws.in_slot("path"):
            largest = self.memory(term, first_memory)
            elastic = self.call(term, "formula", delta, loading, largest, self.loading(largest))
        return elastic

    def memory(self, term: Term, first_memory) -> Number:
        """What a term remembers, in columns from `first_memory` on."""
        return self.read(first_memory, self.laws.memory_of[term.name])

    def loading(self, delta: Number) -> Number:
        """The loading curve at a compression."""
        (base,) = self.laws.in_slot("elastic")
        force = self.call(base, "formula", delta)
        for term in self.laws.in_slot("factor"):
            force = force * self.call(term, "formula", delta)
        return force

    def energy(self, delta: Number) -> Number:
        """Work of the loading curve up to a compression.

        Corrected curves by Gauss's rule in √compression, in which they are smooth: ∫F dδ = ∫F(δt²) 2δt dt.
        """
        (base,) = self.laws.in_slot("elastic")
        if not self.laws.in_slot("factor"):
            return self.call(base, "energy", delta)
        total = 0.0 * delta
        for t, weight in zip(_NODES, _WEIGHTS, strict=True):
            total = total + 2.0 * t * weight * delta * self.loading(t * t * delta)
        return total


@dataclass(frozen=True)
class Piece:
    """One function of the laws.

    Attributes:
        arguments: names of what it takes beside `row`, a pointer to the row of a body; numbers of all lanes.
        work: writes its code, given that and the arguments; what it returns, if anything.
        scalars: names of arguments that are alike in all lanes.
        columns: names of arguments that are columns of the table.
        returns: whether it returns a number of all lanes: zero, where `work` has none.
    """

    arguments: tuple[str, ...]
    work: Callable[..., Number | None]
    scalars: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    returns: bool = False

    def write(self, module: ir.Module, name: str, composition: Composition) -> None:
        """Add the function for a composition to a module.

        Raises:
            FormulaError: for a formula that cannot be written as code.
        """
        kind = LANES_KIND if composition.width == LANES else ir.DoubleType()
        others = dict.fromkeys(self.scalars, ir.DoubleType()) | dict.fromkeys(self.columns, _WHOLE)
        taken = [kind.as_pointer(), *(others.get(name, kind) for name in self.arguments)]
        returned = kind if self.returns else ir.VoidType()
        code = _Code(composition, ir.Function(module, ir.FunctionType(returned, taken), name))
        given = code.builder.function.args[1:]
        numbers = [a if a.type == _WHOLE else code.number(a) for a in given]
        result = self.work(code, *numbers)
        if not self.returns:
            code.builder.ret_void()
        else:
            code.builder.ret(constant(kind, 0.0) if result is None else result.value)


def _push(code, approach, rate, first_memory):
    laws = code.laws
    delta = code.depth(approach)
    elastic = code.elastic(delta, first_memory)
    force = code.with_terms("force", elastic, delta, rate, elastic)
    for term in laws.in_slot("memory"):
        force = force + code.call(term, "formula", elastic, code.memory(term, first_memory))
    if not laws.is_positional:
        # A lone elastic force is already zero out of contact and never negative.
        force = select(delta, positive(force), 0.0)
    return without_fusing(force, code.read(REST_FORCE)) if laws.preloaded else force


def _advance_memory(code, approach, keep, gain, step):
    laws, composition = code.laws, code.composition
    if not laws.in_slot("memory"):
        return
    delta = code.depth(approach)
    elastic = code.elastic(delta, composition.first_memory)
    for term in laws.in_slot("memory"):
        k = laws.memory_of[term.name]
        column, increment = composition.first_memory + k, composition.first_increment + 2 + k
        state = code.read(column)
        change = keep * code.read(increment) + step * code.call(term, "growth", elastic, state)
        code.write(increment, select(delta, change, 0.0))
        code.write(column, select(delta, state + gain * change, 0.0))


def _follow_path(code, step):
    """The largest compression of the step is that of the cubic Hermite polynomial.

    The stages of a step stray from the motion, and a largest compression once too large would stay so.
    """
    laws, composition = code.laws, code.composition
    if not laws.in_slot("path"):
        return
    start = composition.first_turn
    x, v = code.read(start), step * code.read(start + 1)
    approach, rate = _approach(code), _rate(code)
    code.write(start, approach)
    code.write(start + 1, rate)
    delta = code.depth(x + highest(v, step * rate, approach - x))
    for term in laws.in_slot("path"):
        largest = code.memory(term, composition.first_memory)
        column = composition.first_memory + laws.memory_of[term.name]
        code.write(column, select(delta - largest, delta, largest))


def _approach(code):
    """Of a body and the next, since rest."""
    return code.read(U) - code.read(code.composition.columns + U)


def _rate(code):
    return code.read(V) - code.read(code.composition.columns + V)


def _body_acceleration(code, velocity):
    return code.with_terms("body", 0.0 * velocity, velocity) if code.laws.in_slot("body") else None


def _stored_energy(code, approach):
    if not (code.composition.audited and code.laws.stores_energy):
        return None
    energy = code.energy(code.depth(approach))
    if code.laws.preloaded:
        energy = energy - code.energy(code.read(REST)) - code.read(REST_FORCE) * approach
    return energy


def _keep_memory(code, step):
    composition = code.composition
    for k in range(composition.memories):
        code.write(composition.first_old + k, code.read(composition.first_memory + k))
    _keep_slopes(code, step, composition.first_slope)


def _end_memory(code, step):
    _keep_slopes(code, step, code.composition.first_slope + code.composition.memories)


def _keep_slopes(code, step, first):
    """Leave what memories change by in a step at their present rate in columns from `first` on."""
    laws, first_memory = code.laws, code.composition.first_memory
    if not laws.in_slot("memory"):
        return
    delta = code.depth(_approach(code))
    elastic = code.elastic(delta, first_memory)
    for term in laws.in_slot("memory"):
        growth = code.call(term, "growth", elastic, code.memory(term, first_memory))
        code.write(first + laws.memory_of[term.name], select(delta, step * growth, 0.0))


def _blend_memory(code, fraction, approach, rate):
    laws, composition = code.laws, code.composition
    slope, paths = composition.first_slope, [t.name for t in laws.in_slot("path")]
    for name, k in laws.memory_of.items():
        old, new = code.read(composition.first_old + k), code.read(composition.first_memory + k)
        if name in paths:
            delta = code.depth(approach)
            blend = select(rate, select(delta - old, delta, old), new)
        else:
            v, w = code.read(slope + k), code.read(slope + composition.memories + k)
            blend = hermite(old, v, new, w, fraction)
        code.write(composition.first_blend + k, blend)


# What `table` says of each of these names.
PIECES = {
    "push": Piece(("approach", "rate", "first_memory"), _push, columns=("first_memory",), returns=True),
    "advance_memory": Piece(("approach", "keep", "gain", "step"), _advance_memory, scalars=("keep", "gain")),
    "follow_path": Piece(("step",), _follow_path),
    "body_acceleration": Piece(("velocity",), _body_acceleration, returns=True),
    "stored_energy": Piece(("approach",), _stored_energy, returns=True),
    "keep_memory": Piece(("step",), _keep_memory),
    "end_memory": Piece(("step",), _end_memory),
    "blend_memory": Piece(("fraction", "approach", "rate"), _blend_memory),
}
