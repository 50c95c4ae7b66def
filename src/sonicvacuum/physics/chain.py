"""A batch of chains: what hits what, how stiff each contact is, what it bears at rest.

All chains of a batch have the same number of beads and the same kind of law; every number may differ
from chain to chain (shape `(lanes,)`). Beads within a chain are alike but for the listed departures,
so that a chain of a million beads costs no more memory than the part that the wave reaches.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from sonicvacuum.physics.contact import hertz_constant, reduced_modulus, reduced_radius
from sonicvacuum.physics.laws import HERTZ, LawSet, Term

GRAVITY = 9.81


@dataclass(frozen=True)
class Departure:
    """One number that departs from the uniform chain.

    Attributes:
        what: "mass", "stiffness" (factors on the uniform value) or "gap" (m, open at rest).
        index: body for masses, contact otherwise.
        value: (lanes,) factor or gap.
    """

    what: str
    index: int
    value: np.ndarray


@dataclass(frozen=True)
class Action:
    """A term of the force law with its parameters.

    Attributes:
        term: the formula.
        coefficients: function of (chain, stiffness, mass, **parameters), the first arrays (bodies, lanes),
            that returns a list of `term.coefficients` arrays broadcastable to (bodies, lanes): one number
            per contact, or per body for the slot `body`.
        parameters: name → (lanes,) array.
    """

    term: Term
    coefficients: Callable
    parameters: dict[str, np.ndarray]

    def table(self, chain, stiffness, mass):
        """(bodies, n, lanes) coefficients."""
        columns = self.coefficients(chain, stiffness, mass, **self.parameters)
        return np.stack([np.broadcast_to(c, stiffness.shape) for c in columns], axis=1)


@dataclass(frozen=True)
class Elastic:
    """Elastic constants of a body where it touches.

    Attributes:
        name: of the material; bodies of one name share one modulus.
        modulus: (lanes,) Young's modulus in Pa.
        poisson: Poisson's ratio.
    """

    name: str
    modulus: np.ndarray
    poisson: float


@dataclass(frozen=True)
class Chain:
    """Uniform chains of beads between a striker and a wall; SI units, arrays of shape (lanes,).

    Attributes:
        beads: number of beads, ≥ 1; 0 is one ball (the striker) on the wall.
        bead: elastic constants of the beads' surfaces; of the ball when there are no beads.
        striker, wall: the same of the other bodies.
        bead_radius: m, outer.
        striker_radius: m, `math.inf` for a flat one.
        bead_mass, striker_mass: kg.
        speed: striker's speed at impact in m/s.
        gravity: acceleration towards the wall in m/s², 0 for a horizontal chain.
        static_force: axial preload on bead 1 in N, besides gravity.
        coating: thickness of the beads' coating in m, `math.inf` for solid beads.
        departures: what departs from uniformity.
        actions: force laws beyond (or instead of) Hertz.
    """

    beads: int
    bead: Elastic
    striker: Elastic
    wall: Elastic
    bead_radius: float
    striker_radius: float
    bead_mass: np.ndarray
    striker_mass: np.ndarray
    speed: np.ndarray
    gravity: np.ndarray = 0.0
    static_force: np.ndarray = 0.0
    coating: float = math.inf
    departures: tuple[Departure, ...] = ()
    actions: tuple[Action, ...] = ()

    def __post_init__(self):
        shapes = [np.shape(getattr(self, name)) for name in _NUMBERS]
        shapes += [np.shape(getattr(self, name).modulus) for name in _BODIES]
        lanes = np.broadcast_shapes(*shapes) or (1,)
        for name in _NUMBERS:
            object.__setattr__(self, name, _spread(getattr(self, name), lanes))
        for name in _BODIES:
            body = getattr(self, name)
            object.__setattr__(self, name, replace(body, modulus=_spread(body.modulus, lanes)))
        for name in ("bead_mass", "striker_mass", "speed"):
            _check(name, getattr(self, name) > 0.0, "positive", getattr(self, name))
        for name in ("gravity", "static_force"):
            _check(name, getattr(self, name) >= 0.0, "zero or more", getattr(self, name))
        if self.beads < 0:
            raise ValueError(f"beads is {self.beads}; it must be 0 (one ball on the wall) or more")

    @cached_property
    def stiffness(self) -> np.ndarray:
        """(lanes,) Hertz constant of the contact of two beads, N/m^{3/2}."""
        return self._hertz(self.bead, self.bead, self.bead_radius, self.bead_radius)

    @cached_property
    def striker_stiffness(self) -> np.ndarray:
        """(lanes,) of contact 0: striker on the first bead, or on the wall when there are no beads."""
        if self.beads == 0:
            return self._hertz(self.striker, self.wall, self.striker_radius, math.inf)
        return self._hertz(self.striker, self.bead, self.striker_radius, self.bead_radius)

    @cached_property
    def wall_stiffness(self) -> np.ndarray:
        """(lanes,) of the last contact."""
        if self.beads == 0:
            return self.striker_stiffness
        return self._hertz(self.bead, self.wall, self.bead_radius, math.inf)

    def reduced_radii(self, bodies: int) -> np.ndarray:
        """(bodies, 1) effective radius in m of the contact behind each of the first bodies."""
        radius = np.full((bodies, 1), 0.5 * self.bead_radius)
        radius[0] = reduced_radius(self.striker_radius, self.bead_radius if self.beads else math.inf)
        if bodies == self.beads + 1 and self.beads:
            radius[-1] = self.bead_radius
        return radius

    @staticmethod
    def _hertz(one, other, radius_one, radius_other):
        modulus = reduced_modulus(one.modulus, one.poisson, other.modulus, other.poisson)
        return hertz_constant(modulus, reduced_radius(radius_one, radius_other))

    @property
    def lanes(self) -> int:
        """Number of chains."""
        return len(self.speed)

    def take(self, lanes) -> "Chain":
        """The chains with the given indices."""
        numbers = {name: getattr(self, name)[lanes] for name in _NUMBERS}
        bodies = {
            name: replace(b, modulus=b.modulus[lanes]) for name in _BODIES if (b := getattr(self, name))
        }
        departures = tuple(replace(e, value=e.value[lanes]) for e in self.departures)
        actions = tuple(
            replace(a, parameters={k: np.asarray(p)[lanes] for k, p in a.parameters.items()})
            for a in self.actions
        )
        return replace(self, **numbers, **bodies, departures=departures, actions=actions)

    def with_departure(self, what: str, index: int, value) -> "Chain":
        """This chain with one more departure; `value` broadcasts to (lanes,)."""
        value = np.broadcast_to(np.asarray(value, dtype=float), (self.lanes,))
        return replace(self, departures=(*self.departures, Departure(what, index, value)))

    def with_action(self, term: Term, coefficients: Callable, **parameters) -> "Chain":
        """This chain with one more term; each parameter broadcasts to (lanes,)."""
        arrays = {
            k: np.broadcast_to(np.asarray(p, dtype=float), (self.lanes,)) for k, p in parameters.items()
        }
        return replace(self, actions=(*self.actions, Action(term, coefficients, arrays)))

    def masses(self, bodies: int) -> np.ndarray:
        """(bodies, lanes) masses in kg of the striker and the first beads."""
        mass = np.repeat(self.bead_mass[None, :], bodies, axis=0)
        mass[0] = self.striker_mass
        return self._scaled(mass, "mass")

    def stiffnesses(self, bodies: int) -> np.ndarray:
        """(bodies, lanes) Hertz constants in N/m^{3/2}: of the contact behind each of the first bodies."""
        stiffness = np.repeat(self.stiffness[None, :], bodies, axis=0)
        stiffness[0] = self.striker_stiffness
        if bodies == self.beads + 1:
            stiffness[-1] = self.wall_stiffness
        return self._scaled(stiffness, "stiffness")

    def static_forces(self, bodies: int) -> np.ndarray:
        """(bodies, lanes) force in N that each contact bears at rest; the striker does not press yet.

        An open contact bears none: the holder keeps what lies above it, now and during the run, and the
        contacts below bear the beads below the gap only.
        """
        weight = np.cumsum(self.masses(bodies)[1:] * self.gravity, axis=0)
        rest = np.zeros((bodies, self.lanes))
        rest[1:] = self.static_force + weight
        is_open = self.gaps(bodies) > 0.0
        for contact in np.flatnonzero(is_open.any(axis=1)):
            rest[contact:] -= np.where(is_open[contact], rest[contact], 0.0)
        return rest

    def gaps(self, bodies: int) -> np.ndarray:
        """(bodies, lanes) gap in m of each contact at rest."""
        gap = np.zeros((bodies, self.lanes))
        for e in self.departures:
            if e.what == "gap" and e.index < bodies:
                gap[e.index] = e.value
        return gap

    @cached_property
    def preloaded(self) -> bool:
        """Whether any contact bears a force or has a gap at rest."""
        gap = any(e.what == "gap" for e in self.departures)
        return bool(gap or np.any(self.gravity > 0.0) or np.any(self.static_force > 0.0))

    def laws(self, symplectic: bool = True) -> LawSet:
        """The law set that these chains need."""
        terms = tuple(a.term for a in self.actions)
        if not any(t.slot == "elastic" for t in terms):
            terms = (HERTZ, *terms)
        return _law_set(terms, self.preloaded, symplectic)

    def coefficients(self, laws: LawSet, bodies: int) -> np.ndarray:
        """(bodies, n, lanes) table of the coefficients of all terms, in the order of the law set."""
        stiffness, mass = self.stiffnesses(bodies), self.masses(bodies)
        table = np.empty((bodies, laws.coefficients, self.lanes))
        if HERTZ.name in laws.first_coefficient:
            table[:, laws.first_coefficient[HERTZ.name]] = stiffness
        for action in self.actions:
            start = laws.first_coefficient[action.term.name]
            table[:, start : start + action.term.coefficients] = action.table(self, stiffness, mass)
        return table

    def _scaled(self, values, what):
        for e in self.departures:
            if e.what == what and e.index < len(values):
                values[e.index] = values[e.index] * e.value
        return values


@lru_cache(maxsize=256)
def _law_set(terms, preloaded, symplectic):
    """One object for equal law sets, so that what is derived from it is worked out once."""
    return LawSet(terms, preloaded, symplectic)


_NUMBERS = ("bead_mass", "striker_mass", "speed", "gravity", "static_force")
_BODIES = ("bead", "striker", "wall")


def _spread(value, lanes):
    return np.broadcast_to(np.asarray(value, dtype=float), lanes)


def _check(name, good, must_be, values):
    if not np.all(good):
        raise ValueError(f"{name} is {values[~good][0]:g}; it must be {must_be}")
