"""What stands in the laboratory, in SI units: materials, beads, the specimen that they make, its striker.

Cards and records both come down to these; `physics.assemble` turns them into chains.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from msgspec import UNSET, Meta, Struct, UnsetType
from msgspec.structs import replace

from sonicvacuum.laboratory.bodies import Bodies

# Acceleration of free fall of all cases and records, m/s²: the usual rounded value. The standard one is
# 9.80665; places on Earth differ from it by up to 0.3 %.
GRAVITY = 9.81

Positive = Annotated[float, Meta(gt=0.0)]
NonNegative = Annotated[float, Meta(ge=0.0)]


class Material(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An isotropic elastic material as used."""

    name: str
    modulus_Pa: Positive
    poisson: Annotated[float, Meta(gt=-1.0, le=0.5)]
    density_kg_m3: Positive | None = None
    yield_Pa: Positive | None = None

    def stiffened(self, name: str, ratio: float) -> "Material":
        """The material with its modulus times a ratio where it has that name."""
        return replace(self, modulus_Pa=self.modulus_Pa * ratio) if self.name == name else self


class Bead(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A bead; `surface` is the coating where there is one, `faces` is given for flat ones only."""

    diameter_m: Positive
    mass_kg: Positive
    surface: Material
    coating_m: Positive | None = None
    core: Material | None = None
    faces: Literal["flat"] | UnsetType = UNSET

    @property
    def flat(self) -> bool:
        """Whether its neighbours touch flat faces."""
        return self.faces is not UNSET

    def stiffened(self, name: str, ratio: float) -> "Bead":
        """The bead with the modulus of one material times a ratio, wherever it has that material."""
        core = self.core and self.core.stiffened(name, ratio)
        return replace(self, surface=self.surface.stiffened(name, ratio), core=core)


@dataclass(frozen=True)
class Striker:
    """What hits bead 1 in one run.

    Attributes:
        surface: what touches.
        mass_kg: its mass.
        speed_m_s: at impact.
        speed_rel_sigma: relative standard error of the speed.
        radius_m: infinite for a flat one.
    """

    surface: Material
    mass_kg: float
    speed_m_s: float
    speed_rel_sigma: float = 0.0
    radius_m: float = math.inf


@dataclass(frozen=True)
class Specimen:
    """Beads in a row before a wall.

    Attributes:
        beads: number of beads; 0 is one ball, the striker, on the wall.
        bodies: `Bead` by `Bead`; bead 1 is struck, the last touches the wall.
        wall: material of the flat, fixed wall.
        gravity_m_s2: acceleration towards the wall, 0 for a horizontal chain.
        static_force_N: axial preload on bead 1 besides gravity.
    """

    beads: int
    bodies: Bodies
    wall: Material
    gravity_m_s2: float = 0.0
    static_force_N: float = 0.0

    @property
    def first(self) -> Bead:
        """The first bead; without beads, what the ball's surface is."""
        return self.bodies[1]

    @property
    def diameters(self) -> Bodies:
        """Outer diameters in m."""
        return self.bodies.replaced(lambda bead: bead.diameter_m)

    @property
    def materials(self) -> tuple[Material, ...]:
        """Everything that the beads and the wall are made of, cores included."""
        found = [m for b in self.bodies.kinds for m in (b.surface, b.core) if m is not None]
        return tuple(dict.fromkeys([*found, self.wall]))
