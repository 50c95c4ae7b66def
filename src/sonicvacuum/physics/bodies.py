"""What a body of a batch of chains is where it touches: elastic constants, curvature, mass, coating."""

import math
from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Elastic:
    """Elastic constants of a body where it touches.

    Attributes:
        name: of the material; bodies of one name share one modulus.
        modulus: Young's modulus in Pa, one number or (lanes,).
        poisson: Poisson's ratio.
    """

    name: str
    modulus: np.ndarray
    poisson: float

    def mapped(self, change) -> "Elastic":
        """The same material with change(modulus)."""
        return replace(self, modulus=change(self.modulus))


@dataclass(frozen=True)
class Body:
    """A striker, a bead or a wall; numbers or arrays (lanes,) in SI units.

    Attributes:
        surface: elastic constants of what touches: of the coating where there is one.
        mass: kg.
        radius: outer radius in m, `math.inf` for a flat striker or the wall.
        flat: whether its faces are flat though it is so large: a cylinder or a bead with ground faces.
        coating: thickness of the coating in m, `math.inf` for a solid body.
        core: elastic constants under the coating, None for a solid body or where they are not known.
    """

    surface: Elastic
    mass: np.ndarray
    radius: np.ndarray
    flat: bool = False
    coating: float = math.inf
    core: Elastic | None = None

    @property
    def curvature(self) -> np.ndarray:
        """Curvature of the faces in 1/m, () or (lanes,) as the radius is: 0 for flat ones."""
        return np.zeros_like(self.radius, dtype=float) if self.flat else 1.0 / np.asarray(self.radius, float)

    def mapped(self, change) -> "Body":
        """The body with change(number) for each number that may differ from lane to lane."""
        return replace(
            self,
            surface=self.surface.mapped(change),
            mass=change(self.mass),
            radius=change(self.radius),
            core=self.core and self.core.mapped(change),
        )

    def stiffened(self, material: str, ratio) -> "Body":
        """The body with the modulus of one material times a ratio, wherever it has that material."""
        surface, core = (
            e.mapped(lambda modulus: modulus * ratio) if e is not None and e.name == material else e
            for e in (self.surface, self.core)
        )
        return replace(self, surface=surface, core=core)

    def shapes(self) -> list[tuple]:
        """Shapes of those numbers."""
        core = [np.shape(self.core.modulus)] if self.core else []
        return [np.shape(self.surface.modulus), np.shape(self.mass), np.shape(self.radius), *core]
