"""From a law set to machine code: the formulas of a composition, chained into one function each.

The functions without a body here exist in compiled code only: `@overload` gives Numba, for each
`Composition`, a source text that calls the formulas of its terms and nothing else.
"""

import numpy as np
from numba import njit
from numba.extending import overload

from sonicvacuum.physics import lanes
from sonicvacuum.physics.lanes import absolute, positive, root, select
from sonicvacuum.physics.table import (
    INLINED,
    REST,
    REST_FORCE,
    U,
    V,
    first_memory,
    get,
    is_any_positive,
    put,
    zero,
)

# Gauss's rule on −1 to 1, moved to 0 to 1; exact where a correction is a polynomial in √compression up to the
# eleventh power.
_X, _W = np.polynomial.legendre.leggauss(8)
_NODES, _WEIGHTS = (0.5 * (_X + 1.0)).tolist(), (0.5 * _W).tolist()

COMPILED_ONLY = "this function exists in compiled code only: it takes a composition that Numba knows"


def _compiled(function):
    return njit(**INLINED)(function)


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
        self.namespace |= {"get": get, "put": put, "highest": highest}
        self.namespace |= {"absolute": absolute, "is_any_positive": is_any_positive}

    def call(self, term, what, *arguments):
        """The call of one formula of a term, its coefficients read from the table."""
        key = f"{what}_{len(self.namespace)}"
        self.namespace[key] = _compiled(getattr(term, what))
        start = self.composition.first_coefficient + self.laws.first_coefficient[term.name]
        read = [f"get(c, table, body, {start + k})" for k in range(term.coefficients)]
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
        sizes = " + ".join(f"absolute(get(c, table, body, {start + k}))" for k in term.strengths)
        self.add(f"if is_any_positive({sizes}):", f"    {line}")

    def add_elastic(self, first_memory):
        """Leave the elastic force before and after path dependence in `loading` and `elastic`."""
        (base,) = self.laws.in_slot("elastic")
        self.add(f"loading = {self.call(base, 'formula', 'delta')}")
        for term in self.laws.in_slot("factor"):
            self.add(f"loading = loading * {self.call(term, 'formula', 'delta')}")
        self.add("elastic = loading")
        for term in self.laws.in_slot("path"):
            largest = f"get(c, table, body, {first_memory} + {self.laws.memory_of[term.name]})"
            self.add_acting(term, f"elastic = {self.call(term, 'formula', 'delta', 'loading', largest)}")

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
            force = " * ".join(self.call(term, "formula", "part") for term in (base, *factors))
            self.add(f"{name} = {name} + {2.0 * t * weight!r} * {delta} * {force}")

    def function(self):
        """The finished Python function."""
        exec("\n".join(self.lines), self.namespace)
        return self.namespace["composed"]


def push(c, table, body, approach, rate, first_memory):
    """Force in N, beyond the static one, between a body and the next.

    `approach` of the two since rest in m, its `rate` in m/s; `first_memory`: column of the memory to use.
    """
    raise TypeError(COMPILED_ONLY)


@overload(push, jit_options=INLINED)
def _push(c, table, body, approach, rate, first_memory):
    laws = c.composition.laws
    source = _Source(c.composition, "c, table, body, approach, rate, first_memory")
    source.add(_delta(laws))
    source.add_elastic("first_memory")
    source.add("force = elastic")
    for term in laws.in_slot("force"):
        source.add_acting(term, f"force = force + {source.call(term, 'formula', 'delta', 'rate', 'elastic')}")
    for term in laws.in_slot("memory"):
        state = f"get(c, table, body, first_memory + {laws.memory_of[term.name]})"
        source.add(f"force = force + {source.call(term, 'formula', 'elastic', state)}")
    if not laws.is_positional:
        # A lone elastic force is already zero out of contact and never negative.
        source.add("force = select(delta, positive(force), 0.0)")
    if laws.preloaded:
        source.add(f"force = without_fusing(force, get(c, table, body, {REST_FORCE}))")
    source.add("return force")
    return source.function()


def set_rest_force(c, table, body):
    """Keep the static force of a contact.

    By the law itself: what is at rest then stays so to the bit.
    """
    raise TypeError(COMPILED_ONLY)


@overload(set_rest_force, jit_options=INLINED)
def _set_rest_force(c, table, body):
    if not c.composition.laws.preloaded:
        return lambda c, table, body: None

    def set_rest_force(c, table, body):
        put(c, table, body, REST_FORCE, zero(c))
        put(c, table, body, REST_FORCE, push(c, table, body, zero(c), zero(c), first_memory(c)))

    return set_rest_force


def _delta(laws):
    rest = f" + get(c, table, body, {REST})" if laws.preloaded else ""
    return f"delta = approach{rest}"


def advance_memory(c, table, body, approach, keep, gain, step):
    """One low-storage Runge–Kutta stage of the memory of the contact behind a body."""
    raise TypeError(COMPILED_ONLY)


@overload(advance_memory, jit_options=INLINED)
def _advance_memory(c, table, body, approach, keep, gain, step):
    composition, laws = c.composition, c.composition.laws
    source = _Source(composition, "c, table, body, approach, keep, gain, step")
    if laws.in_slot("memory"):
        source.add(_delta(laws))
        source.add_elastic(composition.first_memory)
    for term in laws.in_slot("memory"):
        k = laws.memory_of[term.name]
        column, increment = composition.first_memory + k, composition.first_increment + 2 + k
        growth = source.call(term, "growth", "elastic", "state")
        source.add(
            f"state = get(c, table, body, {column})",
            f"change = keep * get(c, table, body, {increment}) + step * {growth}",
            f"put(c, table, body, {increment}, select(delta, change, 0.0))",
            f"put(c, table, body, {column}, select(delta, state + gain * change, 0.0))",
        )
    source.add("return None")
    return source.function()


def follow_path(c, table, body, step):
    """After a step, keep the largest compression that the contact behind a body had during it.

    That of the cubic Hermite polynomial: the stages of a step stray from the motion, and a largest
    compression once too large would stay so.
    """
    raise TypeError(COMPILED_ONLY)


@overload(follow_path, jit_options=INLINED)
def _follow_path(c, table, body, step):
    composition, laws = c.composition, c.composition.laws
    source = _Source(composition, "c, table, body, step")
    if laws.in_slot("path"):
        start = composition.first_turn
        source.add(
            f"x, v = get(c, table, body, {start}), step * get(c, table, body, {start + 1})",
            f"rate = get(c, table, body, {V}) - get(c, table, body + 1, {V})",
            f"approach = get(c, table, body, {U}) - get(c, table, body + 1, {U})",
            f"put(c, table, body, {start}, approach)",
            f"put(c, table, body, {start + 1}, rate)",
            "approach = x + highest(v, step * rate, approach - x)",
            _delta(laws),
        )
    for term in laws.in_slot("path"):
        column = composition.first_memory + laws.memory_of[term.name]
        source.add(f"largest = get(c, table, body, {column})")
        source.add(f"put(c, table, body, {column}, select(delta - largest, delta, largest))")
    source.add("return None")
    return source.function()


def body_acceleration(c, table, body, velocity):
    """Acceleration in m/s² of a bead by drag and friction."""
    raise TypeError(COMPILED_ONLY)


@overload(body_acceleration, jit_options=INLINED)
def _body_acceleration(c, table, body, velocity):
    source = _Source(c.composition, "c, table, body, velocity")
    source.add("total = 0.0 * velocity")
    for term in c.composition.laws.in_slot("body"):
        source.add_acting(term, f"total = total + {source.call(term, 'formula', 'velocity')}")
    source.add("return total")
    return source.function()


def stored_energy(c, table, body, approach):
    """Elastic energy in J of a contact beyond that at rest, less the work of its static force."""
    raise TypeError(COMPILED_ONLY)


@overload(stored_energy, jit_options=INLINED)
def _stored_energy(c, table, body, approach):
    laws = c.composition.laws
    source = _Source(c.composition, "c, table, body, approach")
    if not laws.stores_energy:
        source.add("return 0.0 * approach")
        return source.function()
    source.add(_delta(laws))
    source.add_energy("energy", "delta")
    if laws.preloaded:
        source.add(f"rest = get(c, table, body, {REST})", f"force = get(c, table, body, {REST_FORCE})")
        source.add_energy("before", "rest")
        source.add("energy = energy - before - force * approach")
    source.add("return energy")
    return source.function()


def keep_memory(c, table, body):
    """Copy the memory of a contact to the columns `old`."""
    raise TypeError(COMPILED_ONLY)


@overload(keep_memory, jit_options=INLINED)
def _keep_memory(c, table, body):
    composition = c.composition
    source = _Source(composition, "c, table, body")
    for k in range(composition.memories):
        memory = f"get(c, table, body, {composition.first_memory + k})"
        source.add(f"put(c, table, body, {composition.first_old + k}, {memory})")
    source.add("return None")
    return source.function()


def blend_memory(c, table, body, fraction, approach, rate):
    """Leave the memory at a fraction of the step in the columns `blend`.

    `approach` and `rate` at that moment: the largest compression is the present one while it grows beyond the
    old.
    """
    raise TypeError(COMPILED_ONLY)


@overload(blend_memory, jit_options=INLINED)
def _blend_memory(c, table, body, fraction, approach, rate):
    composition, laws = c.composition, c.composition.laws
    source = _Source(composition, "c, table, body, fraction, approach, rate")
    if laws.in_slot("path"):
        source.add(_delta(laws))
    for name, k in laws.memory_of.items():
        source.add(
            f"old = get(c, table, body, {composition.first_old + k})",
            f"new = get(c, table, body, {composition.first_memory + k})",
        )
        if name in [t.name for t in laws.in_slot("path")]:
            source.add("blend = select(rate, select(delta - old, delta, old), new)")
        else:
            source.add("blend = old * (1.0 - fraction) + new * fraction")
        source.add(f"put(c, table, body, {composition.first_blend + k}, blend)")
    source.add("return None")
    return source.function()
