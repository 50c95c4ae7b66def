"""What acts in a chain: the Hertz contact and whatever is added to it, composed before compilation.

A `LawSet` is a list of terms; each term is one formula in ordinary arithmetic on (compression,
approach rate, elastic force, coefficients). The stepper is compiled once per law set, so that a law
that is absent costs nothing. The order of composition is fixed by the slot of each term:

    elastic   F(delta, c…)             the loading curve; Hertz unless replaced (at most one)
    factor    × f(delta, c…)           corrections to the loading curve
    path      F(delta, F, delta_max, F_max, c…)  unloading unlike loading; remembers the largest
              compression, F_max being the loading curve there
    force     + f(delta, rate, F, c…)  dissipative or other additions, F being the elastic force
    memory    + f(F, s, c…) with ds/dt = g(F, s, c…), s = 0 out of contact
    body      acceleration f(velocity, c…) of a bead (not of the striker)

A contact never pulls: the sum is cut at zero, and is zero where delta <= 0. Each coefficient is one
number per contact (or body) and chain, worked out beforehand from the chain and the parameters.
"""

import inspect
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from itertools import accumulate

import numpy as np

from sonicvacuum.physics.fingerprint import fingerprint
from sonicvacuum.physics.lanes import power_3_2

# The search for compressions at rest ends after a step so short, relative: what the next would still change
# lies below the rounding errors of the law.
SETTLED = 1e-10
# Slot → arguments of its formula besides the coefficients.
SLOTS = {"elastic": 1, "factor": 1, "path": 4, "force": 3, "memory": 2, "body": 1}


@dataclass(frozen=True)
class Term:
    """One ingredient of the law of a chain.

    Attributes:
        name: identifies the term within a law set.
        slot: one of `SLOTS`, see the module's docstring for the arguments of `formula`.
        formula: the law in generic arithmetic (`sonicvacuum.physics.lanes`).
        coefficients: how many coefficients it takes.
        growth: slot `memory` only, ds/dt as a function of (F, s, c…).
        start: slots `path` and `memory`: the memory at rest as a function of (delta, F, c…); None: the
            compression at rest for `path`, zero for `memory`.
        energy: elastic energy stored, a function of (delta, c…) for slot `elastic`; None where the term
            stores none.
        stores: slot `force`: whether it may store energy, nobody knows how much, and not only take it.
    """

    name: str
    slot: str
    formula: Callable
    coefficients: int
    growth: Callable | None = None
    start: Callable | None = None
    energy: Callable | None = None
    stores: bool = False

    def __post_init__(self):
        if self.slot not in SLOTS:
            raise ValueError(f"term {self.name}: slot is {self.slot!r}; use one of {', '.join(SLOTS)}")
        for what, own in (("formula", SLOTS[self.slot]), ("growth", 2), ("start", 2), ("energy", 1)):
            self._check_arguments(what, own)
        if (self.growth is None) != (self.slot != "memory"):
            raise ValueError(f"term {self.name}: slot {self.slot}: growth belongs to the slot memory alone")

    def _check_arguments(self, what, own):
        """Refuse a formula that does not take its slot's arguments and the coefficients."""
        formula = getattr(self, what)
        if formula is None:
            return
        wanted = own + self.coefficients
        try:
            inspect.signature(formula).bind(*[None] * wanted)
        except TypeError:
            raise ValueError(
                f"term {self.name}: {what} {formula.__name__} must take {wanted} arguments: {own} of the "
                f"slot {self.slot} and {self.coefficients} coefficients"
            ) from None

    @cached_property
    def key(self) -> str:
        """Name and fingerprint of the formulas that are compiled."""
        formulas = [f for f in (self.formula, self.growth, self.energy) if f is not None]
        return f"{self.name}:{'.'.join(fingerprint(f) for f in formulas)}"


def hertz_force(delta, stiffness):
    """Hertz force K delta^{3/2} in N (Johnson, Contact Mechanics, Eq. 4.23); delta in m, K in N/m^{3/2}."""
    return stiffness * power_3_2(delta)


def hertz_energy(delta, stiffness):
    """Energy (2/5) K delta^{5/2} in J of a Hertz contact."""
    return 0.4 * delta * stiffness * power_3_2(delta)


HERTZ = Term("hertz", "elastic", hertz_force, 1, energy=hertz_energy)


def _place(term):
    """Order of composition: by slot, then by name, so that equal terms make one law set however they came.

    Sums and products do not care but for rounding; of two path terms the second acts on the first.
    """
    return list(SLOTS).index(term.slot), "" if term.slot == "path" else term.name


@dataclass(frozen=True, eq=False)
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
    _name: str = field(init=False, repr=False, default="")

    def __post_init__(self):
        elastic = [t.name for t in self.terms if t.slot == "elastic"]
        if len(elastic) != 1:
            raise ValueError(f"a law set needs exactly one elastic term, got {elastic or 'none'}")
        names = [t.name for t in self.terms]
        if len(set(names)) < len(names):
            raise ValueError(f"a law set names each term once, got {', '.join(names)}")
        ordered = tuple(sorted(self.terms, key=_place))
        object.__setattr__(self, "terms", ordered)
        flags = ["preloaded" if self.preloaded else "unloaded", "splitting" if self.splits else "runge-kutta"]
        object.__setattr__(self, "_name", "laws[" + ",".join([*(t.key for t in ordered), *flags]) + "]")

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

    @property
    def stores_energy(self) -> bool:
        """Whether the energy stored is known: that of the loading curve, even where the unloading differs."""
        (base,) = self.in_slot("elastic")
        return base.energy is not None and not any(term.stores for term in self.terms)

    @cached_property
    def first_coefficient(self) -> dict[str, int]:
        """Position of each term's first coefficient in the coefficient table."""
        starts = accumulate((t.coefficients for t in self.terms), initial=0)
        return {t.name: start for t, start in zip(self.terms, starts, strict=False)}

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

    def __eq__(self, other):
        return isinstance(other, LawSet) and self._name == other._name


@lru_cache(maxsize=256)
def law_set(terms, preloaded, symplectic):
    """One object for equal law sets, so that what is derived from it is worked out once."""
    return LawSet(terms, preloaded, symplectic)


def columns_of(laws: LawSet, term: Term, coefficients: np.ndarray) -> list[np.ndarray]:
    """The coefficients of one term, each (bodies, lanes), from the (bodies, n, lanes) table of all."""
    start = laws.first_coefficient[term.name]
    return [coefficients[:, start + k] for k in range(term.coefficients)]


def elastic_at(laws: LawSet, coefficients: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """Loading force in N at compression delta (bodies, lanes) in m, outside compiled code.

    `coefficients` is (bodies, n, lanes).
    """
    (base,) = laws.in_slot("elastic")
    force = base.formula(delta, *columns_of(laws, base, coefficients))
    for term in laws.in_slot("factor"):
        force = force * term.formula(delta, *columns_of(laws, term, coefficients))
    return force


def depth_at(laws: LawSet, coefficients: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Compression in m at which each contact bears `load` (bodies, lanes) in N by the loading curve in force.

    `coefficients` is (bodies, n, lanes); 0 where the load is not positive. Secant method on
    ln F(ln δ), which is straight for power laws and nearly so for all contact laws.
    """
    borne = load > 0.0
    if not borne.any():
        return np.zeros_like(load)
    wanted = np.log(np.where(borne, load, 1.0))
    x, slope = np.full_like(load, np.log(1e-6)), np.full_like(load, 1.5)
    miss = np.log(elastic_at(laws, coefficients, np.exp(x))) - wanted
    for _ in range(60):
        step = np.where(borne, -miss / slope, 0.0)
        x = x + step
        if np.all(np.abs(step) <= SETTLED):
            break
        last, miss = miss, np.log(elastic_at(laws, coefficients, np.exp(x))) - wanted
        moved = np.abs(step) > 1e-9
        slope = np.where(moved, np.clip((miss - last) / np.where(moved, step, 1.0), 0.5, 20.0), slope)
    return np.where(borne, np.exp(x), 0.0)


def memory_at_rest(laws: LawSet, coefficients: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """(bodies, memories, lanes) memory of contacts come to rest at compression delta (bodies, lanes)."""
    memory = np.zeros((len(delta), len(laws.memory_of), delta.shape[-1]))
    force = elastic_at(laws, coefficients, delta)
    for term in laws.in_slot("path") + laws.in_slot("memory"):
        columns = columns_of(laws, term, coefficients)
        if term.start is not None:
            memory[:, laws.memory_of[term.name]] = term.start(delta, force, *columns)
        elif term.slot == "path":
            memory[:, laws.memory_of[term.name]] = delta
    return memory
