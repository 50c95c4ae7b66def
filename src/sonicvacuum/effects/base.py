"""What an effect is: one thing that the nominal model may lack, with its header and its change of the model.

A `Setup` is what is simulated and what reads it; an effect maps a setup and its parameters to another
setup. Effects act on chains (masses, stiffnesses, force laws, loads) or on sensors, never on results.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from sonicvacuum.effects import whereabouts
from sonicvacuum.effects.catalogue import EMPTY, Catalogue
from sonicvacuum.effects.parameter import Parameter
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.laws import Term

MICRO = 1e-6
PLACES = (None, "bead", "contact", "sensor", "material")


@dataclass(frozen=True)
class Setup:
    """A batch of chains and the sensors that read them.

    Attributes:
        chain: (lanes) chains.
        sensors: the gauges (`gauges.Gauge`); their electronics are floats or (lanes,) arrays.
        catalogue: the effects that the setup may lack; empty where nothing is searched for.
    """

    chain: Chain
    sensors: tuple = ()
    catalogue: Catalogue = EMPTY

    def take(self, lanes: np.ndarray) -> "Setup":
        """Some of the chains, with the sensors that read them: `lanes` (n,) are their numbers, from 0."""
        sensors = tuple(sensor.take(lanes) for sensor in self.sensors)
        return replace(self, chain=self.chain.take(lanes), sensors=sensors)


@dataclass(frozen=True)
class Source:
    """Where an effect that does not come with the project is from: name of its file or package, and the
    SHA-256 digest of the source text.
    """

    name: str
    sha256: str


@dataclass(frozen=True)
class Effect:
    """One effect of the catalogue: the header that every effect fills in, and the change it makes.

    Attributes:
        id: canonical name, never given another meaning.
        title: a few words.
        missing: what the nominal model lacks, one line.
        equation: what is added or replaced, plain text.
        energy: what it stores or takes, per contact or body; v is the rate of delta, u' a body's velocity.
        reference: where the form comes from; says so where a form was chosen.
        parameters: continuous parameters; at least one has an off value.
        places: "bead", "contact", "sensor" or "material" where the effect sits at one of them, else None;
            that word is then one more parameter, a number (or (lanes,) whole numbers): beads and contacts as
            the chain counts them, sensors from 0 in the order of the setup, or by id, materials of the beads
            likewise (`whereabouts.materials_of`).
        of_several: the same word where the effect sits somewhere only in setups that leave it a choice, as a
            material does only where the beads are of several; elsewhere it has no place, and the word may be
            left out of its parameters: its first place is meant then. See `located`.
        signature: what it moves in the readings, and which way.
        when_to_use: what makes it likely.
        when_not: where it means nothing, or where another effect is the better name.
        dissipative: whether it takes mechanical energy.
        change: (setup, **parameters) → setup; parameters arrive checked and are not all off.
        choices: (setup) → possible places, in order.
        lacks: (setup) → what the setup lacks for the effect, a few words ("no coating is stated"), or None
            where the effect may act; not given: it may act everywhere.
        stated: (chain, tolerances of a record) → parameter → `Parameter.known`, what the record itself says
            of the parameters; not given: nothing.
        of_material: whether it belongs to the contact material, so that beads of another size have it too.
        depends_on_orientation: whether its off value is the chain's recorded orientation, so that records
            that hang differently cannot be asked about it together.
        unloaded: whether it is there only while nothing presses on the chain, so that a run under load says
            nothing of it.
        source: where it is from, None for the effects of the project.
    """

    id: str
    title: str
    missing: str
    equation: str
    energy: str
    reference: str
    parameters: tuple[Parameter, ...]
    signature: str
    when_to_use: str
    when_not: str
    dissipative: bool
    change: Callable[..., Setup] = field(repr=False)
    places: str | None = None
    of_several: str | None = None
    choices: Callable[[Setup], tuple[int, ...]] | None = field(default=None, repr=False)
    lacks: Callable[[Setup], str | None] | None = field(default=None, repr=False)
    stated: Callable | None = field(default=None, repr=False)
    of_material: bool = False
    depends_on_orientation: bool = False
    unloaded: bool = False
    source: Source | None = None

    def parameter(self, name: str) -> Parameter:
        """The continuous parameter of that name (KeyError if there is none)."""
        return {p.name: p for p in self.parameters}[name]

    @property
    def sits(self) -> str | None:
        """The parameter that says where the effect sits, in all setups or in some; None without one."""
        return self.places or self.of_several

    @property
    def of_gauges(self) -> bool:
        """Whether it acts on readings only, at one gauge or in the electronics of all."""
        return self.places == "sensor" or all(p.electronic for p in self.parameters)

    def located(self, chain: Chain) -> "Effect":
        """The effect as one that sits somewhere, where a chain leaves it a choice; else the same."""
        choice = self.of_several is not None and len(self._possible(Setup(chain))) > 1
        return replace(self, places=self.of_several) if choice else self

    def informed(self, chain: Chain, tolerances) -> "Effect":
        """The effect with what a record states of its parameters; the same where it states nothing."""
        known = self.stated(chain, tolerances) if self.stated else {}
        if not known:
            return self
        return replace(self, parameters=tuple(replace(p, known=known.get(p.name)) for p in self.parameters))

    def candidates(self, setup: Setup) -> tuple[int, ...]:
        """Places at which the effect can sit in this setup; empty for an effect without place."""
        return self._possible(setup) if self.places else ()

    def _possible(self, setup):
        return self.choices(setup) if self.choices else ()

    def why_not(self, setup: Setup) -> str | None:
        """Why the effect cannot act in this setup, in a few words; None where it can."""
        if self.places and not self.candidates(setup):
            return f"there is no {self.places} where it could sit"
        return self.lacks(setup) if self.lacks else None

    def refused(self, setup: Setup, **parameters) -> str | None:
        """Why an effect that somebody states cannot act in a setup, with its values and the cure; None where
        it can, or is off. `apply` asks for nothing of the kind: a search never tries what cannot act.
        """
        self._check(setup, parameters)
        why = None if self.is_off(setup, **parameters) else self.why_not(setup)
        if why is None:
            return None
        given = ", ".join(
            f"{name} is {value:g}" if isinstance(value, float | int) else f"{name} is {value}"
            for name, value in parameters.items()
        )
        return f"{given}, but {why}; state what it acts on, or leave the effect out"

    def is_off(self, setup: Setup, **parameters) -> bool:
        """Whether every parameter that switches is at its off value in all lanes (absent ones are off)."""
        return all(
            np.all(np.asarray(parameters[p.name]) == p.off_in(setup))
            for p in self.parameters
            if p.switches and p.name in parameters
        )

    def apply(self, setup: Setup, **parameters) -> Setup:
        """The setup with the effect in it, or the same object where the effect is off.

        Parameters are floats or (lanes,) arrays in the units of their names; a setup of one chain is
        repeated to match. Those left out are off, or typical if they only shape.

        Raises:
            ValueError: for an unknown parameter, a value without meaning, a missing or impossible place.
        """
        self._check(setup, parameters)
        if self.is_off(setup, **parameters):
            return setup
        lanes = np.broadcast_shapes(*(np.shape(p) for p in parameters.values()))
        if lanes not in ((), (1,)) and setup.chain.lanes == 1:
            setup = replace(setup, chain=setup.chain.take(np.zeros(lanes[0], dtype=int)))
        given = {
            p.name: parameters.get(p.name, p.off_in(setup) if p.switches else p.scale)
            for p in self.parameters
        }
        if self.places or self.of_several in parameters:
            given[self.sits] = self._place(setup, parameters)
        return self.change(setup, **given)

    def _check(self, setup, parameters):
        names = [p.name for p in self.parameters] + ([self.sits] if self.sits else [])
        for name in parameters:
            if name not in names:
                raise ValueError(f"effect {self.id} has no parameter {name}; it has {', '.join(names)}")
            if np.ndim(parameters[name]) > 1:
                shape = np.shape(parameters[name])
                raise ValueError(f"effect {self.id}: {name} has the shape {shape}; give a number or (lanes,)")
        for p in self.parameters:
            if p.name in parameters:
                p.check(parameters[p.name], self.id)

    def _place(self, setup, parameters):
        if self.sits not in parameters:
            raise ValueError(f"effect {self.id} needs the parameter {self.sits}: where it sits")
        try:
            return whereabouts.place(self.sits, parameters[self.sits], self._possible(setup), setup)
        except ValueError as error:
            raise ValueError(f"effect {self.id}: {error}") from None


def add_term(setup: Setup, term: Term, coefficients: Callable, **parameters) -> Setup:
    """The setup with one more term in its force law; see `Chain.with_action`.

    Raises:
        ValueError: where the chain has that term already.
    """
    if any(a.term.name == term.name for a in setup.chain.actions):
        raise ValueError(
            f"the model has {term.name} already; change its parameters instead of adding it again"
        )
    return replace(setup, chain=setup.chain.with_action(term, coefficients, **parameters))


def depart_at(setup: Setup, what: str, place, value, neutral: float) -> Setup:
    """The setup with `value` at `place` and `neutral` elsewhere; both may differ from lane to lane."""
    chain = setup.chain
    for index in np.unique(place):
        chain = chain.with_defect(what, int(index), np.where(np.asarray(place) == index, value, neutral))
    return replace(setup, chain=chain)


def change_sensors(setup: Setup, change: Callable) -> Setup:
    """The setup with every sensor replaced by change(index, sensor)."""
    return replace(setup, sensors=tuple(change(k, s) for k, s in enumerate(setup.sensors)))


def plain(value):
    """A float where one number suffices, else the array."""
    return float(value) if np.ndim(value) == 0 else value


def beads_of(setup: Setup) -> tuple[int, ...]:
    """All beads of the chain, 1 … beads."""
    return tuple(range(1, setup.chain.beads + 1))


def no_beads(setup: Setup) -> str | None:
    """What one ball on a wall lacks for effects that act on beads."""
    return None if setup.chain.beads else "there are no beads"


def no_gauges(setup: Setup) -> str | None:
    """What a record without gauges lacks for effects on all of them."""
    return None if setup.sensors else "there are no gauges"


def reduced_mass(chain: Chain, mass: np.ndarray) -> np.ndarray:
    """(bodies, lanes) reduced mass in kg of the two bodies of each contact; at the wall, the body's own."""
    bodies = len(mass)
    if bodies == chain.beads + 1:
        ahead = np.vstack([mass[1:], np.full((1, mass.shape[1]), np.inf)])
    else:
        ahead = chain.masses(bodies + 1)[1:]
    return 1.0 / (1.0 / mass + 1.0 / ahead)
