"""Hertz contact of two bodies: from elastic constants and radii to the constant K of F = K delta^{3/2}."""

import numpy as np


def reduced_modulus(modulus_a, poisson_a, modulus_b, poisson_b):
    """Effective modulus E* in Pa of two materials: 1/E* = (1−ν_a²)/E_a + (1−ν_b²)/E_b.

    Johnson, Contact Mechanics (1985), Eq. (4.10). Moduli in Pa, any broadcastable shapes.

    Raises:
        ValueError: for a modulus that is not positive or a Poisson's ratio outside (−1, 0.5].
    """
    check_elastic(modulus_a, poisson_a)
    check_elastic(modulus_b, poisson_b)
    return reduced(modulus_a, poisson_a, modulus_b, poisson_b)


def check_elastic(modulus, poisson):
    """ValueError for a modulus that is not positive, a Poisson's ratio outside (−1, 0.5], or for NaN."""
    if not np.all(np.asarray(modulus) > 0.0):
        raise ValueError(f"modulus is {modulus} Pa; it must be positive")
    poisson = np.asarray(poisson)
    if not np.all((poisson > -1.0) & (poisson <= 0.5)):
        raise ValueError(f"Poisson's ratio is {poisson}; it must lie between −1 and 0.5")


def reduced(modulus_a, poisson_a, modulus_b, poisson_b):
    """The same as `reduced_modulus` of constants that were checked before."""
    return 1.0 / ((1.0 - np.square(poisson_a)) / modulus_a + (1.0 - np.square(poisson_b)) / modulus_b)


def reduced_radius(radius_a, radius_b):
    """Effective radius R* in m of two spheres, 1/R* = 1/R_a + 1/R_b; `math.inf` stands for a flat.

    Johnson, Contact Mechanics (1985), Eq. (4.3).

    Raises:
        ValueError: when a radius is not positive, or both bodies are flat.
    """
    if not (radius_a > 0.0 and radius_b > 0.0):
        raise ValueError(f"radii are {radius_a} and {radius_b} m; they must be positive")
    return radius_of_curvature(1.0 / radius_a + 1.0 / radius_b)


def radius_of_curvature(curvature):
    """Effective radius R* in m of two faces whose curvatures (1/R, 0 for a flat) add up to `curvature`.

    Raises:
        ValueError: when both are flat.
    """
    if not np.all(np.asarray(curvature) > 0.0):
        raise ValueError("two flats have no Hertz contact; at least one body must be a sphere")
    return 1.0 / curvature


def hertz_constant(reduced_modulus, radius):
    """K = (4/3) E* √R* in N/m^{3/2}, so that F = K delta^{3/2} (Johnson 1985, Eq. 4.23)."""
    return 4.0 / 3.0 * reduced_modulus * np.sqrt(radius)


def compression_at(force, stiffness):
    """Compression in m at which a Hertz contact bears `force` (N): (F/K)^{2/3}."""
    return np.cbrt(np.square(np.asarray(force) / stiffness))


def contact_time(mass, stiffness, speed):
    """The time (m²/(K² v))^{1/5} in s that sets the duration of a Hertz impact.

    Johnson, Contact Mechanics (1985), Sec. 11.4: an impact of reduced mass m at speed v lasts
    3.218 times this (2.943 (5/4)^{2/5}).
    """
    return (mass**2 / (stiffness**2 * speed)) ** 0.2
