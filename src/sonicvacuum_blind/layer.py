"""A coating that acts as the layer it is, for hidden-effect data: solved apart from the engine.

The surface of a layer bonded to a half-space under a pressure wave of length 2π/k follows from six amplitudes
of Papkovich and Neuber's solution, found numerically for each k. The contact is then a Galerkin problem: the
density φ of the pressure's transform is a sum of even Legendre polynomials of the radius s, whose cosine
transforms are spherical Bessel functions j_2n (Abramowitz & Stegun 10.1.14), so that, with B_n = (−1)^n j_2n,

    (π/2) b_m/(4m + 1) − (a/t) Σ_n b_n ∫(1 − L(x)) B_n(x a/t) B_m(x a/t) dx = depth δ_m0 − (s², P_2m)

with Σ b_n = 0 (no pressure at the edge) and force π b_0; depth in a²/R, force in E* a³/R. The integrator
takes the ratio of Hertz force to force as a polynomial of u = 1/(1 + χ), χ = √(R δ)/t, by least squares.
"""

from functools import cache, lru_cache

import numpy as np
import scipy

# Highest power of u; contact radii of the least squares in layer thicknesses.
DEGREE = 12
RADII = tuple(np.geomspace(0.015, 24.0, 48))
# Beyond so many thicknesses the points only guide the polynomial to its limit, with this weight.
TOUCHED, GUIDING = 12.0, 0.1
# Range of E1'/E0' of layer and core.
STIFFEST, SOFTEST = 1e-4, 10.0
# Wavenumbers in 1/t, where 1 − L has died out beyond, and their points.
END, POINTS = 20.0, 640


@lru_cache(maxsize=256)
def polynomial(poisson: float, core: float, core_poisson: float) -> np.ndarray:
    """(DEGREE + 1,) coefficients of Hertz force over force in powers of u, a rigid body facing the layer.

    `core` is E1'/E0', the plane-strain modulus of the layer over that of the core.
    """
    core = min(max(core, STIFFEST), SOFTEST)
    width, factor = contacts(poisson, core, core_poisson)
    u = 1.0 / (1.0 + width)
    weight = np.where(np.array(RADII) <= TOUCHED, 1.0, GUIDING) * factor
    # 1 where u = 1 and `core` where u = 0: what is left has both roots.
    powers = u[:, None] ** np.arange(DEGREE - 1) * (u * (1.0 - u))[:, None]
    wanted = 1.0 / factor - core - (1.0 - core) * u
    inner = np.linalg.lstsq(powers * weight[:, None], wanted * weight, rcond=1e-13)[0]
    whole = np.polynomial.polynomial.polymul([0.0, 1.0, -1.0], inner)
    whole[:2] += core, 1.0 - core
    return whole


def contacts(poisson: float, core: float, core_poisson: float) -> tuple[np.ndarray, np.ndarray]:
    """χ and force over Hertz force for contacts of the radii RADII."""
    x, weight = _wavenumbers()
    lack = weight * (1.0 - surface(x, poisson, core, core_poisson))
    found = [_contact(a, lack) for a in RADII]
    depth, force = np.array(found).T
    return np.array(RADII) * np.sqrt(depth), force / (4.0 / 3.0 * depth**1.5)


def _contact(a, lack):
    """Depth in a²/R and force in E* a³/R of the contact of radius a."""
    waves = _waves(a)
    order = np.arange(len(waves))
    matrix = np.diag(0.5 * np.pi / (4.0 * order + 1.0)) - a * (waves * lack) @ waves.T
    bowl = np.zeros(len(order))
    bowl[:2] = 1.0 / 3.0, 2.0 / 15.0
    flat, curved = np.linalg.solve(matrix, np.stack([np.eye(len(order))[0], bowl], axis=1)).T
    depth = curved.sum() / flat.sum()
    return depth, np.pi * (depth * flat[0] - curved[0])


@lru_cache(maxsize=len(RADII))
def _waves(a):
    """(n, points) cosine transforms (−1)^n j_2n(a x) of the even Legendre polynomials."""
    order = np.arange(int(14 + 1.3 * a))[:, None]
    return (-1.0) ** order * scipy.special.spherical_jn(2 * order, a * _wavenumbers()[0])


@cache
def _wavenumbers():
    x, w = scipy.special.roots_legendre(POINTS)
    return 0.5 * END * (x + 1.0), 0.5 * END * w


def surface(x: np.ndarray, poisson: float, core: float, core_poisson: float) -> np.ndarray:
    """L(x) of a layer at x = k t (n,): its surface yielding to a pressure wave, over a half-space of it.

    Unknowns: amplitudes of ∇φ and of (3 − 4ν)ψ e_z − z∇ψ, with φ and ψ as exp(∓z) in the layer (z from the
    surface, growing ones from the core) and exp(−z) in the core; k = 1. Equations: pressure 1 and no shear
    on the surface, displacements and stresses continuous at the core.
    """
    shear = core * (1.0 - poisson) / (1.0 - core_poisson)  # mu1/mu0
    system = np.zeros((len(x), 6, 6))
    for column, sign in ((0, -1.0), (2, 1.0)):
        # Amplitudes at the surface and at the core; the growing wave is 1 at the core.
        top, bottom = (np.ones_like(x), np.exp(-x)) if sign < 0 else (np.exp(-x), np.ones_like(x))
        system[:, :2, column : column + 2] = _state(0.0 * x, sign, poisson)[:, 2:] * top[:, None, None]
        system[:, 2:, column : column + 2] = _state(x, sign, poisson) * bottom[:, None, None]
    below = _state(0.0 * x, -1.0, core_poisson)
    below[:, :2] *= shear
    system[:, 2:, 4:] = -below
    load = np.zeros((len(x), 6, 1))
    load[:, 0] = -1.0
    decaying, growing = np.split(np.linalg.solve(system, load)[:, :4, 0], 2, axis=1)
    sink = _state(0.0 * x, -1.0, poisson)[:, 1], _state(0.0 * x, 1.0, poisson)[:, 1]
    lift = (sink[0] * decaying).sum(1) + np.exp(-x) * (sink[1] * growing).sum(1)
    # A half-space of shear modulus 1/2 sinks by 2 (1 − ν).
    return lift / (2.0 * (1.0 - poisson))


def _state(z, sign, nu):
    """(n, 4, 2) displacements u_x, u_z (times 2 mu), stresses s_zz, s_xz of both solutions at depth z (n,).

    Without the factor exp(sign z); u_x and s_xz are amplitudes of sin x, the others of cos x.
    """
    one = np.ones_like(z)
    gradient = [-one, sign * one, one, -sign * one]
    papkovich = [z, 3.0 - 4.0 * nu - sign * z, 2.0 * (1.0 - nu) * sign - z, 2.0 * nu - 1.0 + sign * z]
    return np.stack([np.stack(gradient, axis=1), np.stack(papkovich, axis=1)], axis=2)
