"""What acts in a chain: the Hertz contact and whatever is added to it, composed before compilation.

A `LawSet` is a list of terms; each term is one formula in ordinary arithmetic on (compression,
approach rate, elastic force, coefficients). The stepper is compiled once per law set, so that a law
that is absent costs nothing. The order of composition is fixed by the slot of each term:

    elastic   F(delta, c…)             the loading curve; Hertz unless replaced (at most one)
    factor    × f(delta, c…)           corrections to the loading curve
    path      F(delta, F, delta_max, c…)  unloading that differs from loading; remembers the largest compression
    force     + f(delta, rate, F, c…)  dissipative or other additions, F being the elastic force
    memory    + f(F, s, c…) with ds/dt = g(F, s, c…), s = 0 out of contact
    body      acceleration f(velocity, c…) of a bead (not of the striker)

A contact never pulls: the sum is cut at zero, and is zero where delta <= 0. Each coefficient is one
number per contact (or body) and chain, worked out beforehand from the chain and the parameters.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numba import njit, types
from numba.extending import NativeValue, models, overload, register_model, typeof_impl, unbox

from sonicvacuum.physics import lanes
from sonicvacuum.physics.lanes import FASTMATH, get, power_3_2

SLOTS = ("elastic", "factor", "path", "force", "memory", "body")


@dataclass(frozen=True)
class Term:
    """One ingredient of the law of a chain.

    Attributes:
        name: identifies the formula; two terms of one name must have the same formula.
        slot: one of `SLOTS`, see the module's docstring for the arguments of `formula`.
        formula: the law in generic arithmetic (`sonicvacuum.physics.lanes`).
        coefficients: how many coefficients it takes.
        growth: slot `memory` only, ds/dt as a function of (F, s, c…).
        start: slots `path` and `memory`: the memory at rest as a function of (delta, F, c…); None: the
            compression at rest for `path`, zero for `memory`.
        energy: elastic energy stored, a function of (delta, c…) for slot `elastic`; None where the term
            stores none.
    """

    name: str
    slot: str
    formula: Callable
    coefficients: int
    growth: Callable | None = None
    start: Callable | None = None
    energy: Callable | None = None

    def __post_init__(self):
        if self.slot not in SLOTS:
            raise ValueError(f"term {self.name}: slot is {self.slot!r}; use one of {', '.join(SLOTS)}")


def hertz_force(delta, stiffness):
    """Hertz contact force K delta^{3/2} in N (Johnson, Contact Mechanics, Eq. 4.23); delta in m, K in N/m^{3/2}."""
    return stiffness * power_3_2(delta)


def hertz_energy(delta, stiffness):
    """Energy (2/5) K delta^{5/2} in J of a Hertz contact."""
    return 0.4 * delta * stiffness * power_3_2(delta)


HERTZ = Term("hertz", "elastic", hertz_force, 1, energy=hertz_energy)


@dataclass(frozen=True)
class LawSet:
    """The terms that act in every contact and bead of a chain, in order of composition.

    Attributes:
        terms: see `Term`; the slot `elastic` is filled with Hertz where no term claims it.
        preloaded: whether contacts may bear a static force or have a gap at rest.
        symplectic: whether to use a splitting method where the laws allow it.
    """

    terms: tuple[Term, ...] = (HERTZ,)
    preloaded: bool = False
    symplectic: bool = True
    _name: str = field(init=False, repr=False, compare=False, default="")

    def __post_init__(self):
        elastic = [t.name for t in self.terms if t.slot == "elastic"]
        if len(elastic) != 1:
            raise ValueError(f"a law set needs exactly one elastic term, got {elastic or 'none'}")
        ordered = tuple(sorted(self.terms, key=lambda t: SLOTS.index(t.slot)))
        object.__setattr__(self, "terms", ordered)
        flags = ["preloaded" if self.preloaded else "unloaded", "splitting" if self.splits else "runge-kutta"]
        object.__setattr__(self, "_name", "laws[" + ",".join([*(t.name for t in ordered), *flags]) + "]")

    @property
    def name(self) -> str:
        """Unique name of this composition: the key of its compiled code."""
        return self._name

    @property
    def is_positional(self) -> bool:
        """Whether forces depend on positions alone (no rates, no memory)."""
        return all(t.slot in ("elastic", "factor") for t in self.terms)

    @property
    def splits(self) -> bool:
        """Whether the symplectic splitting stepper is used."""
        return self.symplectic and self.is_positional

    @cached_property
    def first_coefficient(self) -> dict[str, int]:
        """Position of each term's first coefficient in the coefficient table."""
        starts = np.cumsum([0, *(t.coefficients for t in self.terms)])
        return {t.name: int(start) for t, start in zip(self.terms, starts[:-1], strict=True)}

    @property
    def coefficients(self) -> int:
        """Number of coefficients per contact."""
        return sum(t.coefficients for t in self.terms)

    @cached_property
    def memory_of(self) -> dict[str, int]:
        """Position of each remembering term's variable in the memory table."""
        return {t.name: k for k, t in enumerate(t for t in self.terms if t.slot in ("path", "memory"))}

    def in_slot(self, slot: str) -> list[Term]:
        """The terms of one slot, in order."""
        return [t for t in self.terms if t.slot == slot]

    def __hash__(self):
        return hash(self._name)


def elastic_at(laws: LawSet, coefficients: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """Loading force in N at compression delta (bodies, lanes) in m, outside compiled code.

    `coefficients` is (bodies, n, lanes).
    """

    def columns(term):
        start = laws.first_coefficient[term.name]
        return [coefficients[:, start + k] for k in range(term.coefficients)]

    (base,) = laws.in_slot("elastic")
    force = base.formula(delta, *columns(base))
    for term in laws.in_slot("factor"):
        force = force * term.formula(delta, *columns(term))
    return force


def rest_compression(laws: LawSet, coefficients: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Compression in m at which each contact bears its static `load` (bodies, lanes) in N, by the law in force."""
    low = np.zeros_like(load)
    high = np.full_like(load, 1e-9)
    while np.any(short := elastic_at(laws, coefficients, high) < load):
        high = np.where(short, 4.0 * high, high)
    for _ in range(200):
        middle = 0.5 * (low + high)
        short = elastic_at(laws, coefficients, middle) < load
        low, high = np.where(short, middle, low), np.where(short, high, middle)
        if np.all(high - low <= 4e-16 * high):
            break
    return np.where(load > 0.0, 0.5 * (low + high), 0.0)


def memory_at_rest(laws: LawSet, coefficients: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """(bodies, memories, lanes) memory of contacts that have come to rest at compression delta (bodies, lanes)."""
    memory = np.zeros((len(delta), len(laws.memory_of), delta.shape[-1]))
    force = elastic_at(laws, coefficients, delta)
    for term in laws.in_slot("path") + laws.in_slot("memory"):
        start = laws.first_coefficient[term.name]
        columns = [coefficients[:, start + k] for k in range(term.coefficients)]
        if term.start is not None:
            memory[:, laws.memory_of[term.name]] = term.start(delta, force, *columns)
        elif term.slot == "path":
            memory[:, laws.memory_of[term.name]] = delta
    return memory


class LawSetType(types.Type):
    """Numba type of a law set: the composition is part of the compiled code's signature."""

    def __init__(self, laws: LawSet):
        self.laws = laws
        super().__init__(name=laws.name)


@typeof_impl.register(LawSet)
def _typeof_laws(laws, context):
    return LawSetType(laws)


@register_model(LawSetType)
class _LawSetModel(models.OpaqueModel):
    pass


@unbox(LawSetType)
def _unbox_laws(kind, obj, c):
    return NativeValue(c.context.get_dummy_value())


def _compiled(formula):
    return njit(inline="always", fastmath=FASTMATH, error_model="numpy")(formula)


def _call(laws, term, formula, namespace, *arguments):
    """Source text of one formula's call, its coefficients read from the table; registers it in `namespace`."""
    key = f"_{term.name.replace('-', '_')}_{formula}"
    namespace[key] = _compiled(getattr(term, formula))
    start = laws.first_coefficient[term.name]
    read = (f"get2(coefficients, c, {start + k})" for k in range(term.coefficients))
    return f"{key}({', '.join([*arguments, *read])})"


def _define(name, arguments, lines, namespace):
    source = f"def {name}({arguments}):\n" + "".join(f"    {line}\n" for line in lines)
    exec(source, namespace)
    return namespace[name]


def _namespace():
    return {name: getattr(lanes, name) for name in ("get2", "put2", "select", "positive")}


def _elastic_lines(laws, namespace):
    """Source lines that leave the elastic force, before and after path dependence, in `loading` and `elastic`."""
    (base,) = laws.in_slot("elastic")
    lines = [f"loading = {_call(laws, base, 'formula', namespace, 'delta')}"]
    for term in laws.in_slot("factor"):
        lines.append(f"loading = loading * {_call(laws, term, 'formula', namespace, 'delta')}")
    lines.append("elastic = loading")
    for term in laws.in_slot("path"):
        largest = f"get2(memory, c, {laws.memory_of[term.name]})"
        call = _call(laws, term, "formula", namespace, "delta", "loading", largest)
        lines.append(f"elastic = {call}")
    return lines


def elastic_force(laws, coefficients, memory, c, delta):
    """Elastic force in N of contact `c` at compression `delta` (compiled code only)."""
    raise TypeError("elastic_force exists in compiled code only; see `evaluate`")


def contact_force(laws, coefficients, memory, c, delta, rate):
    """Force in N of contact `c` at compression `delta` (m) and approach rate (m/s) (compiled code only)."""
    raise TypeError("contact_force exists in compiled code only; see `evaluate`")


def contact_energy(laws, coefficients, c, delta):
    """Elastic energy in J of contact `c` (compiled code only)."""
    raise TypeError("contact_energy exists in compiled code only")


def advance_memory(laws, coefficients, memory, increments, c, delta, keep, gain, step):
    """One low-storage Runge–Kutta stage of the memory of contact `c` (compiled code only)."""
    raise TypeError("advance_memory exists in compiled code only")


def body_acceleration(laws, coefficients, c, velocity):
    """Acceleration in m/s² of body `c` by drag and friction (compiled code only)."""
    raise TypeError("body_acceleration exists in compiled code only")


def compression(laws, rest, c, difference):
    """Compression in m of contact `c`, given the approach of its bodies since rest (compiled code only)."""
    raise TypeError("compression exists in compiled code only")


def dynamic(laws, rest_force, c, force):
    """Force beyond the static one in N (compiled code only)."""
    raise TypeError("dynamic exists in compiled code only")


def static_work(laws, rest_force, c, approach):
    """Work in J of the static force over the approach of the contact's bodies (compiled code only)."""
    raise TypeError("static_work exists in compiled code only")


@overload(static_work, inline="always")
def _static_work(laws, rest_force, c, approach):
    if laws.laws.preloaded:
        return lambda laws, rest_force, c, approach: approach * get(rest_force, c)
    return lambda laws, rest_force, c, approach: 0.0 * approach


@overload(compression, inline="always")
def _compression(laws, rest, c, difference):
    if laws.laws.preloaded:
        return lambda laws, rest, c, difference: difference + get(rest, c)
    return lambda laws, rest, c, difference: difference


@overload(dynamic, inline="always")
def _dynamic(laws, rest_force, c, force):
    if laws.laws.preloaded:
        return lambda laws, rest_force, c, force: force - get(rest_force, c)
    return lambda laws, rest_force, c, force: force


@overload(elastic_force)
def _elastic_force(laws, coefficients, memory, c, delta):
    namespace = _namespace()
    lines = [*_elastic_lines(laws.laws, namespace), "return elastic"]
    return _define("elastic_force", "laws, coefficients, memory, c, delta", lines, namespace)


@overload(contact_force)
def _contact_force(laws, coefficients, memory, c, delta, rate):
    laws = laws.laws
    namespace = _namespace()
    lines = [*_elastic_lines(laws, namespace), "force = elastic"]
    for term in laws.in_slot("force"):
        call = _call(laws, term, "formula", namespace, "delta", "rate", "elastic")
        lines.append(f"force = force + {call}")
    for term in laws.in_slot("memory"):
        state = f"get2(memory, c, {laws.memory_of[term.name]})"
        lines.append(f"force = force + {_call(laws, term, 'formula', namespace, 'elastic', state)}")
    # A lone elastic force is already zero out of contact and never negative.
    lines.append("return force" if laws.is_positional else "return select(delta, positive(force), 0.0)")
    return _define("contact_force", "laws, coefficients, memory, c, delta, rate", lines, namespace)


@overload(contact_energy)
def _contact_energy(laws, coefficients, c, delta):
    laws = laws.laws
    namespace = _namespace()
    (base,) = laws.in_slot("elastic")
    lines = [f"return {_call(laws, base, 'energy', namespace, 'delta')}"]
    return _define("contact_energy", "laws, coefficients, c, delta", lines, namespace)


@overload(advance_memory)
def _advance_memory(laws, coefficients, memory, increments, c, delta, keep, gain, step):
    laws = laws.laws
    namespace = _namespace()
    lines = _elastic_lines(laws, namespace)
    for term in laws.in_slot("path"):
        k = laws.memory_of[term.name]
        lines.append(f"largest = get2(memory, c, {k})")
        lines.append(f"put2(memory, c, {k}, select(delta - largest, delta, largest))")
    for term in laws.in_slot("memory"):
        k = laws.memory_of[term.name]
        growth = _call(laws, term, "growth", namespace, "elastic", "state")
        lines += [
            f"state = get2(memory, c, {k})",
            f"change = keep * get2(increments, c, {k}) + step * {growth}",
            f"put2(increments, c, {k}, select(delta, change, 0.0))",
            f"put2(memory, c, {k}, select(delta, state + gain * change, 0.0))",
        ]
    arguments = "laws, coefficients, memory, increments, c, delta, keep, gain, step"
    return _define("advance_memory", arguments, [*lines, "return None"], namespace)


@overload(body_acceleration)
def _body_acceleration(laws, coefficients, c, velocity):
    laws = laws.laws
    namespace = _namespace()
    calls = [_call(laws, t, "formula", namespace, "velocity") for t in laws.in_slot("body")]
    lines = [f"return {' + '.join(calls) if calls else '0.0 * velocity'}"]
    return _define("body_acceleration", "laws, coefficients, c, velocity", lines, namespace)
