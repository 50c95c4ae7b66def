"""A batch of chains: what hits what, how stiff each contact is, what it bears at rest.

All chains of a batch have the same number of beads and the same kind of law; every number may differ
from chain to chain (shape `(lanes,)`). Beads repeat a pattern but for exceptions, and tables are made for
the first bodies only, so that a chain of a million beads costs no more memory than the part that the wave
reaches.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.physics.beyond import Action, Defect
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.contact import (
    check_elastic,
    compression_at,
    hertz_constant,
    radius_of_curvature,
    reduced,
)
from sonicvacuum.physics.laws import HERTZ, LawSet, Term, depth_at, law_set


@dataclass(frozen=True)
class Chain:
    """Chains of beads between a striker and a wall; SI units, arrays of shape (lanes,).

    Attributes:
        beads: number of beads, ≥ 1; 0 is one ball (the striker) on the wall.
        bodies: the beads, `physics.bodies.Body` each; a single Body is a uniform chain.
        striker, wall: elastic constants of these.
        striker_radius: m, `math.inf` for a flat one.
        striker_mass: kg.
        speed: striker's speed at impact in m/s.
        gravity: acceleration towards the wall in m/s², 0 for a horizontal chain.
        static_force: axial preload on bead 1 in N, besides gravity.
        defects: numbers that differ from these at single places.
        actions: force laws beyond (or instead of) Hertz.

    Raises:
        ValueError: for a number without meaning; for two flats that touch, once their contact is asked for.
    """

    beads: int
    bodies: Bodies | Body
    striker: Elastic
    wall: Elastic
    striker_radius: float
    striker_mass: np.ndarray
    speed: np.ndarray
    gravity: np.ndarray = 0.0
    static_force: np.ndarray = 0.0
    defects: tuple[Defect, ...] = ()
    actions: tuple[Action, ...] = ()

    def __post_init__(self):
        if isinstance(self.bodies, Body):
            object.__setattr__(self, "bodies", Bodies((self.bodies,)))
        shapes = [np.shape(getattr(self, name)) for name in _NUMBERS]
        shapes += [np.shape(getattr(self, name).modulus) for name in _ENDS]
        shapes += [shape for body in self.bodies.kinds for shape in body.shapes()]
        lanes = np.broadcast_shapes(*shapes) or (1,)
        self._map(lambda value: _broadcast(value, lanes))
        for name in ("striker_mass", "speed"):
            _check(name, getattr(self, name) > 0.0, "positive", getattr(self, name))
        for body in self.bodies.kinds:
            _check("mass of a bead", body.mass > 0.0, "positive", body.mass)
            _check("radius of a bead", body.radius > 0.0, "positive", body.radius)
        for name in ("gravity", "static_force"):
            _check(name, getattr(self, name) >= 0.0, "zero or more", getattr(self, name))
        if self.beads < 0:
            raise ValueError(f"beads is {self.beads}; it must be 0 (one ball on the wall) or more")

    def _with(self, **changes) -> "Chain":
        """The chains with numbers and effects changed that are what they must be already; nothing is checked
        again, and what does not depend on them is not worked out again.
        """
        made = object.__new__(Chain)
        kept = _KEPT if changes.keys() <= _BESIDE_CONTACTS else _FIELDS
        made.__dict__.update({name: own for name, own in self.__dict__.items() if name in kept}, **changes)
        return made

    def _map(self, change):
        """Set change(number) for each number that may differ from lane to lane; only while being made."""
        for name in _NUMBERS:
            object.__setattr__(self, name, change(getattr(self, name)))
        for name in _ENDS:
            object.__setattr__(self, name, getattr(self, name).mapped(change))
        object.__setattr__(self, "bodies", self.bodies.replaced(lambda body: body.mapped(change)))

    @property
    def first(self) -> Body:
        """The first bead; without beads, what the pattern begins with."""
        return self.bodies[1]

    @cached_property
    def solids(self) -> tuple[Body, ...]:
        """The striker, the kinds of beads and the wall."""
        striker = Body(self.striker, self.striker_mass, np.full(self.lanes, self.striker_radius))
        wall = Body(self.wall, np.full(self.lanes, math.inf), np.full(self.lanes, math.inf))
        return (striker, *self.bodies.kinds, wall)

    def touching(self, bodies: int) -> np.ndarray:
        """(2, bodies) places in `solids` of what touches at the contact behind each of the first bodies."""
        line = np.zeros(bodies + 1, dtype=np.int64)
        line[1:] = self.bodies.kinds_of(bodies) + 1
        if bodies == self.beads + 1:
            line[-1] = len(self.solids) - 1
        return np.stack([line[:-1], line[1:]])

    @cached_property
    def _surfaces(self):
        """Modulus (solids, lanes), Poisson's ratio (solids, 1), curvature (solids, lanes) of `solids`."""
        modulus = np.array([s.surface.modulus for s in self.solids])
        poisson = np.array([[s.surface.poisson] for s in self.solids])
        check_elastic(modulus, poisson)
        return modulus, poisson, np.array([s.curvature for s in self.solids])

    @cached_property
    def _hertz(self):
        """(2 + n, lanes) Hertz constants in N/m^{3/2}: of contact 0, of the last one, and of the n contacts
        between neighbouring kinds of beads.
        """
        modulus, poisson, curvature = self._surfaces
        first, last = (1, self.bodies.kind(self.beads) + 1) if self.beads else (-1, 0)
        between = [(i + 1, j + 1) for i, j in self.bodies.neighbours(self.beads)]
        one, other = np.array([(0, first), (last, -1), *between]).T
        shared = reduced(modulus[one], poisson[one], modulus[other], poisson[other])
        return hertz_constant(shared, radius_of_curvature(curvature[one] + curvature[other]))

    @property
    def _between_beads(self):
        return self._hertz[2:]

    @property
    def stiffness(self) -> np.ndarray:
        """(lanes,) Hertz constant in N/m^{3/2} of the stiffest contact of two beads."""
        return self._between_beads.max(axis=0)

    @property
    def softest(self) -> np.ndarray:
        """(lanes,) of the softest contact of two beads."""
        return self._between_beads.min(axis=0)

    @property
    def striker_stiffness(self) -> np.ndarray:
        """(lanes,) of contact 0: striker on the first bead, or on the wall when there are no beads."""
        return self._hertz[0]

    @property
    def wall_stiffness(self) -> np.ndarray:
        """(lanes,) of the last contact."""
        return self._hertz[1]

    @cached_property
    def _bead_masses(self):
        return np.array([body.mass for body in self.bodies.kinds])

    @property
    def lightest(self) -> np.ndarray:
        """(lanes,) mass in kg of the lightest bead."""
        return self._bead_masses.min(axis=0)

    @property
    def heaviest(self) -> np.ndarray:
        """(lanes,) mass in kg of the heaviest bead."""
        return self._bead_masses.max(axis=0)

    @property
    def load(self) -> np.ndarray:
        """(lanes,) force in N that the beads press on the wall with at rest, without its defects."""
        counts = self.bodies.counts(1, self.beads)
        weights = (n * self.bodies.kinds[kind].mass * self.gravity for kind, n in sorted(counts.items()))
        return self.static_force + sum(weights, start=np.zeros(self.lanes))

    def reduced_radii(self, bodies: int) -> np.ndarray:
        """(bodies, lanes) effective radius in m of the contact behind each of the first bodies."""
        radius = np.array([np.where(s.flat, math.inf, s.radius) for s in self.solids])
        one, other = radius[self.touching(bodies)]
        # This form is exact for equal spheres and for a sphere on a flat.
        small, large = np.minimum(one, other), np.maximum(one, other)
        return small / (1.0 + small / large)

    @property
    def lanes(self) -> int:
        """Number of chains."""
        return len(self.speed)

    def take(self, lanes) -> "Chain":
        """The chains with the given indices."""
        defects = tuple(replace(e, value=e.value[lanes]) for e in self.defects)
        actions = tuple(
            replace(a, parameters={k: np.asarray(p)[lanes] for k, p in a.parameters.items()})
            for a in self.actions
        )
        return self._with(
            **{name: getattr(self, name)[lanes] for name in _NUMBERS},
            **{name: getattr(self, name).mapped(lambda value: value[lanes]) for name in _ENDS},
            bodies=self.bodies.replaced(lambda body: body.mapped(lambda value: value[lanes])),
            defects=defects,
            actions=actions,
        )

    def stiffened(self, material: str, ratio) -> "Chain":
        """The chains with the modulus of one material times a ratio, (lanes,) or a number, wherever it is."""
        ends = {
            name: end.mapped(lambda modulus: modulus * ratio)
            for name in _ENDS
            if (end := getattr(self, name)).name == material
        }
        return self._with(bodies=self.bodies.replaced(lambda b: b.stiffened(material, ratio)), **ends)

    def struck_at(self, speed: np.ndarray) -> "Chain":
        """The chains with other speeds of the striker, (lanes,) in m/s.

        Raises:
            ValueError: for one that is not positive.
        """
        _check("speed", speed > 0.0, "positive", speed)
        return self._with(speed=speed)

    def with_defect(self, what: str, index: int, value) -> "Chain":
        """This chain with one more defect; `value` broadcasts to (lanes,)."""
        value = _broadcast(value, (self.lanes,))
        return self._with(defects=(*self.defects, Defect(what, index, value)))

    def with_action(self, term: Term, coefficients: Callable, **parameters) -> "Chain":
        """This chain with one more term; each parameter broadcasts to (lanes,)."""
        arrays = {k: _broadcast(p, (self.lanes,)) for k, p in parameters.items()}
        return self._with(actions=(*self.actions, Action(term, coefficients, arrays)))

    def masses(self, bodies: int) -> np.ndarray:
        """(bodies, lanes) masses in kg of the striker and the first beads."""
        mass = np.empty((bodies, self.lanes))
        mass[0] = self.striker_mass
        own = self._bead_masses
        mass[1:] = own if len(own) == 1 else own[self.bodies.kinds_of(bodies - 1)]
        return self._scaled(mass, "mass")

    def stiffnesses(self, bodies: int) -> np.ndarray:
        """(bodies, lanes) Hertz constants in N/m^{3/2}: of the contact behind each of the first bodies."""
        inner = min(bodies, self.beads)
        stiffness = np.empty((bodies, self.lanes))
        stiffness[0] = self.striker_stiffness
        between = self._between_beads
        stiffness[1:inner] = between if len(between) == 1 else between[self._neighbours(inner)]
        if 0 < self.beads < bodies:
            stiffness[-1] = self.wall_stiffness
        return self._scaled(stiffness, "stiffness")

    def _neighbours(self, beads):
        """(beads − 1,) which pair of touching kinds stands at each contact between the first beads."""
        pairs, kinds = np.array(self.bodies.neighbours(self.beads)), self.bodies.kinds_of(beads)
        many = len(self.bodies.kinds)
        return np.searchsorted(pairs @ (many, 1), kinds[:-1] * many + kinds[1:])

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
        for e in self.defects:
            if e.what == "gap" and e.index < bodies:
                gap[e.index] = e.value
        return gap

    @cached_property
    def preloaded(self) -> bool:
        """Whether any contact bears a force or has a gap at rest."""
        gap = any(e.what == "gap" for e in self.defects)
        return bool(gap or np.any(self.gravity > 0.0) or np.any(self.static_force > 0.0))

    def laws(self, symplectic: bool = True) -> LawSet:
        """The law set that these chains need."""
        terms = tuple(a.term for a in self.actions)
        if not any(t.slot == "elastic" for t in terms):
            terms = (HERTZ, *terms)
        return law_set(terms, self.preloaded, symplectic)

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

    def depth_at(self, contact: int, force) -> np.ndarray:
        """(n, lanes) compression in m at which one contact bears `force` (n, lanes) in N while it is loaded.

        By the loading curve in force, Hertz or not; 0 where the force is not positive.
        """
        force = np.broadcast_to(np.asarray(force, dtype=float), (len(force), self.lanes))
        laws, bodies = self.laws(), contact + 1
        if not laws.in_slot("factor") and HERTZ in laws.in_slot("elastic"):
            return compression_at(np.maximum(force, 0.0), self.stiffnesses(bodies)[contact])
        return depth_at(laws, self.coefficients(laws, bodies)[contact:], force)

    def _scaled(self, values, what):
        for e in self.defects:
            if e.what == what and e.index < len(values):
                values[e.index] = values[e.index] * e.value
        return values


def _broadcast(value, lanes):
    """A number or an array as (lanes,) floats; what is so already as it is, for chains are made often."""
    if isinstance(value, np.ndarray) and value.shape == lanes and value.dtype == float:
        return value
    if np.ndim(value) == 0:
        return np.full(lanes, float(value))
    return np.broadcast_to(np.asarray(value, dtype=float), lanes)


_NUMBERS = ("striker_mass", "speed", "gravity", "static_force")
_ENDS = ("striker", "wall")
_FIELDS = frozenset(field.name for field in fields(Chain))
# What the stiffness of contacts that nothing is wrong with does not depend on, and what is worked out of it.
_BESIDE_CONTACTS = {"speed", "actions", "defects"}
_OF_CONTACTS = {"solids", "_surfaces", "_hertz", "_bead_masses"}
_KEPT = _FIELDS | _OF_CONTACTS


def _check(name, good, must_be, values):
    if not good.all():
        raise ValueError(f"{name} is {values[~good][0]:g}; it must be {must_be}")
