"""A hypothesis: which effects are in force, which of their parameters are free, where they sit."""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from sonicvacuum.discover.model.parameters import Coordinate, coordinate
from sonicvacuum.effects import Effect, Setup


@dataclass(frozen=True)
class Component:
    """One effect of a hypothesis.

    Attributes:
        effect: of the catalogue.
        free: coordinates of the searched parameters.
        fixed: values of the others (a strength that is left out is off).
        place: bead, contact, sensor or material, None where the effect has none.
    """

    effect: Effect
    free: tuple[Coordinate, ...]
    fixed: dict[str, float] = field(default_factory=dict)
    place: int | None = None

    def parameters(self, u: np.ndarray, places: np.ndarray | None) -> dict[str, np.ndarray]:
        """Arguments of `Effect.apply` for (L, free) coordinates and (L,) places."""
        given = {c.parameter.name: c.value(u[:, k]) for k, c in enumerate(self.free)}
        given |= {name: np.full(len(u), value) for name, value in self.fixed.items()}
        if self.effect.places:
            given[self.effect.places] = np.full(len(u), self.place) if places is None else places
        return given


@dataclass(frozen=True)
class Hypothesis:
    """Effects in force together."""

    components: tuple[Component, ...] = ()

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """All free parameters in order."""
        return tuple(c for component in self.components for c in component.free)

    @property
    def key(self) -> tuple:
        """What tells this hypothesis from others of the same catalogue."""
        return tuple(
            (c.effect.id, c.place, tuple(x.parameter.name for x in c.free), tuple(sorted(c.fixed.items())))
            for c in self.components
        )

    @property
    def columns(self) -> tuple[slice, ...]:
        """Where the free parameters of each effect stand among the coordinates."""
        ends = itertools.accumulate((len(c.free) for c in self.components), initial=0)
        return tuple(slice(*ab) for ab in itertools.pairwise(ends))

    @property
    def ids(self) -> tuple[str, ...]:
        """Ids of the effects in order."""
        return tuple(c.effect.id for c in self.components)

    def strengths(self, u: np.ndarray, error: np.ndarray, shift: np.ndarray | float = 0.0) -> list[float]:
        """Strength over standard error, effect by effect: the largest, where one has several strengths.

        Infinite where the record itself states the strength, which data need not show.

        Args:
            u, error: (p,) coordinates and their standard errors.
            shift: (p,) added to the coordinates.
        """
        ends = [1.0 if c.endless else x for c, x in zip(self.coordinates, u, strict=True)]
        sizes = np.abs(np.asarray(ends) + shift) / error
        told = [math.inf if c.parameter.known else z for c, z in zip(self.coordinates, sizes, strict=True)]
        own = [
            [z for c, z in zip(part.free, told[at], strict=True) if c.parameter.switches]
            for part, at in zip(self.components, self.columns, strict=True)
        ]
        return [float(max(z, default=0.0)) for z in own]

    def inside(self, u: np.ndarray) -> np.ndarray:
        """(L, p) coordinates, those beyond the bounds of the search just within."""
        low, high = np.array([(c.low + 1e-9, c.high - 1e-9) for c in self.coordinates]).T
        return u.clip(low, high)

    def with_component(self, component: Component) -> "Hypothesis":
        """This hypothesis with one effect more."""
        return replace(self, components=(*self.components, component))

    def with_places(self, places) -> "Hypothesis":
        """This hypothesis with its effects at the given places."""
        moved = [
            replace(c, place=int(p)) if c.effect.places else c
            for c, p in zip(self.components, places, strict=True)
        ]
        return replace(self, components=tuple(moved))

    def change(self, u: np.ndarray, places: np.ndarray | None = None) -> Callable:
        """The change (setup, lane index of each chain) → setup for (L, p) coordinates."""
        columns = self.columns

        def changed(setup: Setup, index: np.ndarray) -> Setup:
            for k, component in enumerate(self.components):
                at = None if places is None else places[index, k]
                given = component.parameters(u[index, columns[k]], at)
                setup = component.effect.apply(setup, **given)
            return setup

        return changed

    def values(self, u: np.ndarray) -> dict[str, dict[str, float]]:
        """Effect → parameter → value (places included) at (p,) coordinates."""
        result = {}
        for component, own in zip(self.components, self.columns, strict=True):
            free = {c.parameter.name: float(c.value(x)) for c, x in zip(component.free, u[own], strict=True)}
            place = {component.effect.places: component.place} if component.effect.places else {}
            result[component.effect.id] = {**free, **component.fixed, **place}
        return result


def is_law(effect: Effect, setup: Setup) -> bool:
    """Whether an effect adds to the force law of the chain."""
    return not effect.places and len(typical(effect, setup).chain.actions) > len(setup.chain.actions)


def typical(effect: Effect, setup: Setup) -> Setup:
    """The setup with an effect that sits nowhere, at a typical strength."""
    return effect.apply(setup, **{p.name: p.at(0.3, setup) for p in effect.parameters})


def of_one_strength(free: tuple[Coordinate, ...]) -> bool:
    """Whether one strength is free, whatever shapes are besides."""
    return sum(c.parameter.switches for c in free) == 1


def without(hypothesis: Hypothesis, u: np.ndarray, k: int) -> tuple[Hypothesis, np.ndarray]:
    """A hypothesis and its coordinates with effect k taken away."""
    left = tuple(c for j, c in enumerate(hypothesis.components) if j != k)
    return Hypothesis(left), np.delete(u, np.arange(*hypothesis.columns[k].indices(len(u))))


def variants(effect: Effect, setup: Setup) -> tuple[tuple[Coordinate, ...], ...]:
    """Sets of parameters that may be free together: each strength alone, and all; shapes always."""
    strengths = [coordinate(p, setup) for p in effect.parameters if p.switches]
    shapes = tuple(coordinate(p, setup) for p in effect.parameters if not p.switches)
    if len(strengths) == 1:
        return ((*strengths, *shapes),)
    return (*((s, *shapes) for s in strengths), (*strengths, *shapes))
