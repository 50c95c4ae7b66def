"""The exact contact of a sphere on an elastic layer on an elastic half-space: the reference solution.

Frictionless, axisymmetric, small strains; a layer of thickness t, on a core to which it is bonded or on which
it slips, is touched over a circle of radius a by a sphere of radius R or by the flat end of a cylinder. Under
a pressure of wavenumber k the surface sinks by 2 L(kt)/(E1' k) times that pressure, E' = E/(1 − nu²), with
L(∞) = 1 (half-space of the layer) and L(0) = E1'/E0' (half-space of the core). Dual integral equations with
this L reduce to a Fredholm equation of the second kind (Lebedev & Ufliand, J. Appl. Math. Mech. 22, 442
(1958); in other words Perriot & Barthel, J. Mater. Res. 19, 600 (2004)). In units of a, on 0 < s < 1:

    (pi/2) phi(s) − integral of phi(r) M(s, r) dr = depth − s²,
    M(s, r) = (a/t) integral of (1 − L(x)) cos(x s a/t) cos(x r a/t) dx,

depth in a²/R, force = pi times the integral of phi, in E* a³/R. The pressure of a sphere vanishes at the
edge, which is phi(1) = 0 and fixes the depth. A flat punch has the right-hand side 1. Solved by Nyström's
method with Gauss's rule, which converges faster than any power.

An elastic body facing the layer adds its own compliance, constant in k: L and 1/E1' then stand for the sum of
both. Two equal coated spheres mirror each other: each is a layer indented by half the approach by a rigid
flat, and a rigid flat on a coated sphere and a rigid sphere on a flat layer have the same gap r²/2R.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

# In 1/t: 1 − L, which falls as x² exp(−2x), is below rounding beyond.
HIGHEST = 22.0
# Gauss points for each unit of a/t, and at least: the layer's thickness is the scale of the kernel.
POINTS_PER_RADIUS, FEWEST_POINTS = 5, 40
# Wavenumbers are integrated panel by panel, so many points each.
PANEL = 16


@dataclass(frozen=True)
class Layer:
    """Elastic constants of a layer, its core and what faces it, as far as a contact feels them.

    Attributes:
        poisson: Poisson's ratio of the layer.
        core: E1'/E0', plane-strain modulus of the layer over that of the core; 0 for a rigid core.
        core_poisson: Poisson's ratio of the core.
        bonded: whether the layer sticks to the core; else it slips without friction, never lifting off.
        facing: E1'/E', plane-strain modulus of the layer over that of the other body; 0 for a rigid one.
    """

    poisson: float
    core: float = 0.0
    core_poisson: float = 0.3
    bonded: bool = True
    facing: float = 0.0

    def __post_init__(self):
        for name in ("poisson", "core_poisson"):
            if not -1.0 < getattr(self, name) <= 0.5:
                raise ValueError(f"{name} is {getattr(self, name)}; it must lie between −1 and 0.5")
        for name in ("core", "facing"):
            if not getattr(self, name) >= 0.0:
                raise ValueError(f"{name} is {getattr(self, name)}; it must be zero (rigid) or more")

    @property
    def deep(self) -> float:
        """L at long waves: E* of the bare core over that of the half-space of the layer, inverted."""
        return (self.core + self.facing) / (1.0 + self.facing)

    def compliance(self, x: np.ndarray) -> np.ndarray:
        """L(x) at wavenumbers x (any shape, in 1/t), the facing body included."""
        own = _bonded(x, self) if self.bonded else _slipping(x, self)
        return (own + self.facing) / (1.0 + self.facing)


def _bonded(x, layer):
    """Layer that sticks to its core (Burmister, J. Appl. Phys. 16, 89 (1945); Perriot & Barthel 2004)."""
    shear = layer.core * (1.0 - layer.poisson) / (1.0 - layer.core_poisson)  # mu1/mu0
    own, other = 3.0 - 4.0 * layer.poisson, 3.0 - 4.0 * layer.core_poisson
    a, b = (shear * other - own) / (1.0 + shear * other), (shear - 1.0) / (shear + own)
    e = np.exp(-2.0 * x)
    return (1.0 + 4.0 * b * x * e - a * b * e * e) / (1.0 - (a + b + 4.0 * b * x * x) * e + a * b * e * e)


def _slipping(x, layer):
    """Layer that slips on its core: sinh, cosh and x times 4 exp(−2x), from plates bent and squeezed.

    A plate without shear on its faces answers equal pressures on both with (cosh x − 1)/(sinh x + x),
    opposite ones with (cosh x + 1)/(sinh x − x); the lower face follows the core (Sneddon, Fourier
    Transforms, 1951).
    """
    e = np.exp(-2.0 * x)
    squared, product = (1.0 - e) ** 2, 1.0 - e * e + 4.0 * x * e
    thin = squared - 4.0 * x * x * e
    return (layer.core * product + squared) / (layer.core * thin + product)


@dataclass(frozen=True)
class Solution:
    """Contacts of given radii; arrays as the radii given.

    Attributes:
        radius: a/t.
        depth: indentation in a²/R, 1 for Hertz.
        force: in E* a³/R, 4/3 for Hertz.
        flat: force on a flat punch over that on a half-space at the same depth (the factor kappa of Hayes et
            al., J. Biomech. 5, 541 (1972)).
        peak: pressure at the centre in E* a/R, 2/π for Hertz.
    """

    radius: np.ndarray
    depth: np.ndarray
    force: np.ndarray
    flat: np.ndarray
    peak: np.ndarray

    @property
    def width(self) -> np.ndarray:
        """chi = √(R × indentation)/t."""
        return self.radius * np.sqrt(self.depth)

    @property
    def factor(self) -> np.ndarray:
        """Force over Hertz force at the same indentation."""
        return self.force / (4.0 / 3.0 * self.depth**1.5)

    @property
    def concentration(self) -> np.ndarray:
        """Pressure at the centre over the mean one: 3/2 for Hertz, 2 for a thin compressible layer."""
        return np.pi * self.peak / self.force


def solve(layer: Layer, radius, refine: float = 1.0) -> Solution:
    """The contacts of radii `radius` (float or array, in layer thicknesses, positive).

    `refine` multiplies the number of points, to measure the error or to trade it for time.

    Raises:
        ValueError: for a radius that is not positive.
    """
    radius = np.asarray(radius, dtype=float)
    if not np.all(radius > 0.0):
        raise ValueError(f"radius is {radius.min()}; it must be positive")
    found = np.array([_contact(layer, float(a), refine) for a in radius.ravel()])
    return Solution(radius, *(column.reshape(radius.shape) for column in found.T))


def _contact(layer, radius, refine):
    """Depth, force, flat-punch factor and central pressure of one contact.

    The pressure at the centre is minus half the integral of phi'(s)/s, phi' following from the equation.
    """
    s, weight, x, step, waves = _rules(radius, refine)
    kernel = (waves * (radius * step * (1.0 - layer.compliance(x)))) @ waves[:-1].T * weight
    matrix = 0.5 * np.pi * np.eye(len(s)) - kernel[:-1]
    flat, bowl = np.linalg.solve(matrix, np.stack([np.ones(len(s)), s * s], axis=1)).T
    depth = (1.0 + kernel[-1] @ bowl) / (1.0 + kernel[-1] @ flat)
    phi = depth * flat - bowl
    bend = np.sinc(radius * np.outer(s, x) / np.pi) * (radius * x) ** 2  # of cos(x s a/t) over −s
    less = (bend * (radius * step * (1.0 - layer.compliance(x)))) @ (waves[:-1].T @ (weight * phi))
    peak = weight @ (2.0 + less) / np.pi
    return depth, np.pi * (weight @ phi), 0.5 * np.pi * (weight @ flat), peak


@lru_cache(maxsize=64)
def _rules(radius, refine):
    """Points and weights on the radius and in wavenumbers, cosines of both: the same for all layers."""
    s, weight = _gauss(int(refine * (FEWEST_POINTS + POINTS_PER_RADIUS * radius)), 1.0)
    # Products of cosines turn by 2 a/t HIGHEST radians: a point for two, and some for the shape of L itself.
    x, step = _panels(int(max(refine, 1.0) * (100 + 1.2 * HIGHEST * radius)) // PANEL + 1, HIGHEST)
    return s, weight, x, step, np.cos(radius * np.outer(np.append(s, 1.0), x))


def _gauss(points, end):
    """Points and weights of Gauss's rule on 0 to `end`."""
    from scipy.special import roots_legendre

    x, w = roots_legendre(points)
    return 0.5 * end * (x + 1.0), 0.5 * end * w


def _panels(count, end):
    """Points and weights of Gauss's rule on each of `count` equal parts of 0 to `end`."""
    x, w = _gauss(PANEL, end / count)
    starts = np.arange(count)[:, None] * (end / count)
    return (starts + x).ravel(), np.tile(w, count)
