"""From a law set to functions of a body's row: the formulas of a composition, chained into one function each.

They fill what the stepper leaves open (see `table`). Each is made as a source text that calls the formulas of
the terms and nothing else, with which `linking` goes on.
"""

from collections.abc import Callable
from dataclasses import dataclass
from types import FunctionType

import numpy as np
from numba import njit, types

from sonicvacuum.physics import lanes
from sonicvacuum.physics.composition import REST, REST_FORCE, Composition, U, V
from sonicvacuum.physics.lanes import positive, root, select
from sonicvacuum.physics.sampling import hermite
from sonicvacuum.physics.table import INLINED, is_any_positive, number_type, read, write

# Gauss's rule on −1 to 1, moved to 0 to 1; exact where a correction is a polynomial in √compression up to the
# eleventh power.
_X, _W = np.polynomial.legendre.leggauss(8)
_NODES, _WEIGHTS = (0.5 * (_X + 1.0)).tolist(), (0.5 * _W).tolist()


def _compiled(function):
    """A formula, with the functions that it calls; those of `lanes` Numba is taught."""
    known = function.__globals__
    called = {name: known[name] for name in function.__code__.co_names if _is_formula(known.get(name))}
    if called:
        own = known | {name: _compiled(one) for name, one in called.items()}
        function = FunctionType(function.__code__, own, function.__name__, function.__defaults__)
    return njit(**INLINED)(function)


def _is_formula(value):
    return isinstance(value, FunctionType) and value.__module__ != lanes.__name__


@_compiled
def highest(v, w, gain):
    """Largest value during a step of the cubic that goes from 0 to `gain`, first at the rate v, last at w.

    Rates per step. Only the maximum of a curve that rises first and falls last counts.
    """
    square = 3.0 * gain - 2.0 * v - w
    cube = v + w - 2.0 * gain
    turns = select(v, select(-w, 1.0, 0.0), 0.0)
    below = root(square * square - 3.0 * cube * v) - square
    moment = v / select(turns, below, 1.0)
    top = moment * (v + moment * (square + moment * cube))
    return select(turns, top, positive(gain))


class _Source:
    """Source text of one function that evaluates formulas of a law set at a row of the table."""

    def __init__(self, composition, signature):
        self.composition, self.laws = composition, composition.laws
        self.lines = [f"def composed({signature}):"]
        self.namespace = {name: getattr(lanes, name) for name in ("select", "positive", "without_fusing")}
        self.namespace |= {"read": read, "write": write, "highest": highest, "hermite": hermite}
        self.namespace |= {"absolute": lanes.absolute, "is_any_positive": is_any_positive}

    def call(self, term, what, *arguments):
        """The call of one formula of a term, its coefficients read from the table."""
        key = f"{what}_{self.laws.terms.index(term)}"
        if key not in self.namespace:
            self.namespace[key] = _compiled(getattr(term, what))
        start = self.composition.first_coefficient + self.laws.first_coefficient[term.name]
        read = [f"read(row, {start + k})" for k in range(term.coefficients)]
        return f"{key}({', '.join([*arguments, *read])})"

    def add(self, *lines):
        self.lines += [f"    {line}" for line in lines]

    def add_acting(self, term, line):
        """A line that works a term out, passed over where its strengths are zero in all lanes.

        A term that has the law set to itself (beside the elastic one) is there because it acts.
        """
        if not term.strengths or len(self.laws.terms) < 3:
            self.add(line)
            return
        start = self.composition.first_coefficient + self.laws.first_coefficient[term.name]
        sizes = " + ".join(f"absolute(read(row, {start + k}))" for k in term.strengths)
        self.add(f"if is_any_positive({sizes}):", f"    {line}")

    def add_elastic(self, first_memory):
        """Leave the elastic force before and after path dependence in `loading` and `elastic`."""
        self.add(f"loading = {self.loading('delta')}", "elastic = loading")
        for term in self.laws.in_slot("path"):
            largest = f"read(row, {first_memory} + {self.laws.memory_of[term.name]})"
            unloading = self.call(term, "formula", "delta", "loading", largest, self.loading(largest))
            self.add_acting(term, f"elastic = {unloading}")

    def loading(self, delta):
        """The loading curve at a compression."""
        terms = (*self.laws.in_slot("elastic"), *self.laws.in_slot("factor"))
        return " * ".join(self.call(term, "formula", delta) for term in terms)

    def add_energy(self, name, delta):
        """Leave the work of the loading curve up to a compression in a variable.

        Corrected curves by Gauss's rule in √compression, in which they are smooth: ∫F dδ = ∫F(δt²) 2δt dt.
        """
        (base,) = self.laws.in_slot("elastic")
        factors = self.laws.in_slot("factor")
        if not factors:
            self.add(f"{name} = {self.call(base, 'energy', delta)}")
            return
        self.add(f"{name} = 0.0 * {delta}")
        for t, weight in zip(_NODES, _WEIGHTS, strict=True):
            self.add(f"part = {t * t!r} * {delta}")
            self.add(f"{name} = {name} + {2.0 * t * weight!r} * {delta} * {self.loading('part')}")

    def function(self):
        """The finished Python function."""
        exec("\n".join(self.lines), self.namespace)
        return self.namespace["composed"]


@dataclass(frozen=True)
class Piece:
    """One function of the laws.

    Attributes:
        arguments: names of what it takes beside `row`, a pointer to the row of a body; numbers of all lanes.
        write: adds lines to a source; whether there is anything to do: if not, zero is returned.
        scalars: names of arguments that are alike in all lanes.
        columns: names of arguments that are columns of the table.
        returns: whether it returns a number of all lanes.
    """

    arguments: tuple[str, ...]
    write: Callable[[Composition, _Source], bool]
    scalars: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    returns: bool = False

    def signature(self, composition: Composition):
        """Types of all arguments and of what is returned, for Numba."""
        number = number_type(composition.width)
        kinds = dict.fromkeys(self.scalars, types.float64) | dict.fromkeys(self.columns, types.intp)
        arguments = [kinds.get(name, number) for name in self.arguments]
        return (number if self.returns else types.void)(types.CPointer(number), *arguments)

    def function(self, composition: Composition) -> Callable | None:
        """Python function of `row` and the arguments; None where it does nothing."""
        source = _Source(composition, ", ".join(("row", *self.arguments)))
        return source.function() if self.write(composition, source) else None


def _push(composition, source):
    laws = composition.laws
    source.add(_delta(laws))
    source.add_elastic("first_memory")
    source.add("force = elastic")
    for term in laws.in_slot("force"):
        source.add_acting(term, f"force = force + {source.call(term, 'formula', 'delta', 'rate', 'elastic')}")
    for term in laws.in_slot("memory"):
        state = f"read(row, first_memory + {laws.memory_of[term.name]})"
        source.add(f"force = force + {source.call(term, 'formula', 'elastic', state)}")
    if not laws.is_positional:
        # A lone elastic force is already zero out of contact and never negative.
        source.add("force = select(delta, positive(force), 0.0)")
    if laws.preloaded:
        source.add(f"force = without_fusing(force, read(row, {REST_FORCE}))")
    source.add("return force")
    return True


def _delta(laws):
    rest = f" + read(row, {REST})" if laws.preloaded else ""
    return f"delta = approach{rest}"


def _advance_memory(composition, source):
    laws = composition.laws
    if not laws.in_slot("memory"):
        return False
    source.add(_delta(laws))
    source.add_elastic(composition.first_memory)
    for term in laws.in_slot("memory"):
        k = laws.memory_of[term.name]
        column, increment = composition.first_memory + k, composition.first_increment + 2 + k
        growth = source.call(term, "growth", "elastic", "state")
        source.add(
            f"state = read(row, {column})",
            f"change = keep * read(row, {increment}) + step * {growth}",
            f"write(row, {increment}, select(delta, change, 0.0))",
            f"write(row, {column}, select(delta, state + gain * change, 0.0))",
        )
    return True


def _follow_path(composition, source):
    """The largest compression of the step is that of the cubic Hermite polynomial.

    The stages of a step stray from the motion, and a largest compression once too large would stay so.
    """
    laws = composition.laws
    if not laws.in_slot("path"):
        return False
    start, ahead = composition.first_turn, composition.columns
    source.add(
        f"x, v = read(row, {start}), step * read(row, {start + 1})",
        f"rate = read(row, {V}) - read(row, {ahead + V})",
        f"approach = read(row, {U}) - read(row, {ahead + U})",
        f"write(row, {start}, approach)",
        f"write(row, {start + 1}, rate)",
        "approach = x + highest(v, step * rate, approach - x)",
        _delta(laws),
    )
    for term in laws.in_slot("path"):
        column = composition.first_memory + laws.memory_of[term.name]
        source.add(f"largest = read(row, {column})")
        source.add(f"write(row, {column}, select(delta - largest, delta, largest))")
    return True


def _body_acceleration(composition, source):
    if not composition.laws.in_slot("body"):
        return False
    source.add("total = 0.0 * velocity")
    for term in composition.laws.in_slot("body"):
        source.add_acting(term, f"total = total + {source.call(term, 'formula', 'velocity')}")
    source.add("return total")
    return True


def _stored_energy(composition, source):
    laws = composition.laws
    if not (composition.audited and laws.stores_energy):
        return False
    source.add(_delta(laws))
    source.add_energy("energy", "delta")
    if laws.preloaded:
        source.add(f"rest = read(row, {REST})", f"force = read(row, {REST_FORCE})")
        source.add_energy("before", "rest")
        source.add("energy = energy - before - force * approach")
    source.add("return energy")
    return True


def _keep_memory(composition, source):
    for k in range(composition.memories):
        source.add(f"write(row, {composition.first_old + k}, read(row, {composition.first_memory + k}))")
    _add_slopes(composition, source, composition.first_slope)
    return composition.memories > 0


def _end_memory(composition, source):
    _add_slopes(composition, source, composition.first_slope + composition.memories)
    return bool(composition.laws.in_slot("memory"))


def _add_slopes(composition, source, first):
    """Leave what memories change by in a step at their present rate in columns from `first` on."""
    laws, ahead = composition.laws, composition.columns
    if not laws.in_slot("memory"):
        return
    source.add(f"approach = read(row, {U}) - read(row, {ahead + U})", _delta(laws))
    source.add_elastic(composition.first_memory)
    for term in laws.in_slot("memory"):
        k = laws.memory_of[term.name]
        source.add(f"state = read(row, {composition.first_memory + k})")
        growth = source.call(term, "growth", "elastic", "state")
        source.add(f"write(row, {first + k}, select(delta, step * {growth}, 0.0))")


def _blend_memory(composition, source):
    laws, slope = composition.laws, composition.first_slope
    if laws.in_slot("path"):
        source.add(_delta(laws))
    for name, k in laws.memory_of.items():
        source.add(
            f"old = read(row, {composition.first_old + k})",
            f"new = read(row, {composition.first_memory + k})",
        )
        if name in [t.name for t in laws.in_slot("path")]:
            source.add("blend = select(rate, select(delta - old, delta, old), new)")
        else:
            source.add(
                f"v, w = read(row, {slope + k}), read(row, {slope + composition.memories + k})",
                "blend = hermite(old, v, new, w, fraction)",
            )
        source.add(f"write(row, {composition.first_blend + k}, blend)")
    return composition.memories > 0


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
