"""What a simulator of balls is here: where its contact laws are documented, which it has, how they are
written.

A simulator is one file with one `Simulator`, as an effect is. Each of its `Law`s belongs to one effect of the
catalogue and says what is the same in both: the whole motion (the same force), or the restitution alone.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

MOTION, RESTITUTION = "motion", "restitution"


@dataclass(frozen=True)
class Ball:
    """One ball before a flat wall, and the impact at which what cannot agree everywhere is made to agree.

    Attributes:
        mass: kg.
        radius: m.
        stiffness: K in N/m^{3/2} of F = K δ^{3/2}.
        poisson: of the ball.
        speed: of the reference impact in m/s.
        restitution: of that impact.
        duration: of that impact in s.
    """

    mass: float
    radius: float
    stiffness: float
    poisson: float
    speed: float
    restitution: float
    duration: float

    @property
    def reduced_modulus(self) -> float:
        """E* in Pa of K = (4/3) E* √R (Johnson, Contact Mechanics, 1985, Eq. 4.23)."""
        return 0.75 * self.stiffness / math.sqrt(self.radius)

    @property
    def modulus(self) -> float:
        """Young's modulus in Pa that ball and wall, if of one material, need for this K: 2 (1 − ν²) E*."""
        return 2.0 * (1.0 - self.poisson**2) * self.reduced_modulus

    @property
    def density(self) -> float:
        """kg/m³ of a homogeneous sphere of this mass."""
        return self.mass / (4.0 / 3.0 * math.pi * self.radius**3)

    def stiffened(self, ratio: float) -> "Ball":
        """The same ball with K times a ratio."""
        return replace(self, stiffness=self.stiffness * ratio)


@dataclass(frozen=True)
class Number:
    """One parameter of a simulator's input, in the unit that the simulator wants with SI units."""

    name: str
    value: float
    unit: str


@dataclass(frozen=True)
class Written:
    """A law in a simulator's own words.

    Attributes:
        numbers: the parameters.
        lines: what stands in the input.
        notes: what must be known besides.
    """

    numbers: tuple[Number, ...]
    lines: tuple[str, ...]
    notes: tuple[str, ...] = ()

    def __getitem__(self, name: str) -> float:
        """The value of a parameter; KeyError where there is none of that name."""
        return {n.name: n.value for n in self.numbers}[name]


@dataclass(frozen=True)
class Law:
    """One contact law of a simulator.

    Attributes:
        effect: id of the effect that it corresponds to; with that effect off it is the elastic contact.
        title: the simulator's name for it.
        equation: the normal force as documented.
        same: `MOTION` or `RESTITUTION`.
        write: (ball, parameters of the effect) → `Written`; ValueError for values that the simulator refuses.
        duration: (ball, parameters, (speeds,) in m/s) → (speeds,) s where only the restitution is the same.
    """

    effect: str
    title: str
    equation: str
    same: str
    write: Callable[[Ball, dict[str, float]], Written]
    duration: Callable[[Ball, dict[str, float], np.ndarray], np.ndarray] | None = None


@dataclass(frozen=True)
class Simulator:
    """One simulator: its header and its laws, the preferred one first.

    Attributes:
        id: as on the command line.
        title: as its makers write it.
        reference: documentation of the laws.
        read: what was read to check the formulas, with its commit where it is in a repository.
        laws: what it has.
        lacks: what it does not have, a few words.
    """

    id: str
    title: str
    reference: str
    read: str
    laws: tuple[Law, ...]
    lacks: str

    def law(self, effect: str) -> Law | None:
        """The law of an effect, None where the simulator has none."""
        return {law.effect: law for law in self.laws}.get(effect)


def shown(value: float) -> str:
    """A number as it stands in an input: nine digits, far more than any coefficient is known to."""
    return f"{value:.9g}"
