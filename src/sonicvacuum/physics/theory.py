"""Long-wave theory of a chain of equal coated beads: Eqs. (1)–(7) of Daraio and Nesterenko (2006), their
inverses, and the linear waves of a precompressed chain.

The paper is C. Daraio, V. F. Nesterenko, "Strongly nonlinear wave dynamics in a chain of polymer coated
beads", Phys. Rev. E 73, 026612 (2006); its wave equation comes from V. F. Nesterenko, "Dynamics of
Heterogeneous Materials" (Springer, 2001), chapter 1.  The shape of the solitary wave stands in `solitary`.

Conventions.  SI units.  ``modulus`` is E of the coating [Pa], ``poisson`` its ν, ``diameter`` the outer
diameter a = 2(R' + Δ) [m], ``mass`` the bead's M [kg].  Strain ξ is approach/a; a force [N] is that of one
contact, positive in compression.  Arguments broadcast against each other; the result has the broadcast
shape.  ValueError is raised for a modulus, diameter or mass that is not above zero, ν outside (−1, 0.5], a
negative or non-finite amplitude, and where a docstring says so.
"""

import numpy as np
from numpy.typing import NDArray

Num = float | NDArray[np.float64]
Real = Num


def require(holds: bool | NDArray[np.bool_], name: str, value: Num, demand: str) -> None:
    """Raise ValueError "name must be demand, got value" with the first value for which ``holds`` is False."""
    broken = ~np.broadcast_to(holds, np.broadcast_shapes(np.shape(holds), np.shape(value)))
    if broken.any():
        culprit = np.broadcast_to(value, broken.shape)[broken].flat[0]
        raise ValueError(f"{name} must be {demand}, got {culprit:g}")


def require_positive(**values: Num) -> None:
    """Raise ValueError for the first named value that is not finite and above zero."""
    for name, value in values.items():
        require(np.isfinite(value) & (np.asarray(value) > 0), name, value, "finite and above zero")


def require_not_negative(**values: Num) -> None:
    """Raise ValueError for the first named value that is negative or not finite."""
    for name, value in values.items():
        require(np.isfinite(value) & (np.asarray(value) >= 0), name, value, "finite and not negative")


def hertz_stiffness(modulus: Num, poisson: Num, diameter: Num) -> Real:
    """Constant k [N/m^1.5] of Eq. (1) written as F = k δ^{3/2}: k = E √a / (3(1 − ν²)) = A M."""
    require_positive(modulus=modulus, diameter=diameter)
    nu = np.asarray(poisson, dtype=float)
    require((nu > -1) & (nu <= 0.5), "poisson", nu, "above -1 and at most 0.5")
    return np.asarray(modulus, dtype=float) * np.sqrt(diameter) / (3 * (1 - nu**2))


def contact_force(approach: Num, modulus: Num, poisson: Num, diameter: Num) -> Real:
    """Eq. (1): force [N] between equal beads whose centres came closer by ``approach`` [m] since first touch.

    Zero for a negative approach, as contacts never pull.
    """
    return hertz_stiffness(modulus, poisson, diameter) * np.maximum(approach, 0.0) ** 1.5


def contact_approach(force: Num, modulus: Num, poisson: Num, diameter: Num) -> Real:
    """Inverse of Eq. (1): approach [m] under a compressive force [N]."""
    require_not_negative(force=force)
    return np.cbrt(np.asarray(force) / hertz_stiffness(modulus, poisson, diameter)) ** 2


def bead_mass(core_radius: Num, coating: Num, core_density: Num, coating_density: Num) -> Real:
    """Eq. (2): mass M [kg] of a core of radius R' [m] under a coating of thickness Δ [m]; densities [kg/m³].

    Δ = 0 is a bare bead.  The shell is written as a product, (R' + Δ)³ − R'³ = Δ(3R'² + 3R'Δ + Δ²), so that
    a thin one does not drown in the difference of two cubes.
    """
    require_positive(core_radius=core_radius, core_density=core_density, coating_density=coating_density)
    require_not_negative(coating=coating)
    r, d = np.asarray(core_radius, dtype=float), np.asarray(coating, dtype=float)
    shell = d * (3 * r**2 + 3 * r * d + d**2)
    return 4 / 3 * np.pi * (r**3 * np.asarray(core_density) + shell * np.asarray(coating_density))


def acceleration_constant(modulus: Num, poisson: Num, diameter: Num, mass: Num) -> Real:
    """Eq. (2): A = E √a / (3(1 − ν²) M) [m^{-1/2} s^{-2}], acceleration per approach to the power 3/2."""
    require_positive(mass=mass)
    return hertz_stiffness(modulus, poisson, diameter) / np.asarray(mass)


def chain_accelerations(
    displacements: Num, constant: float, precompression: float = 0.0
) -> NDArray[np.float64]:
    """Eq. (2): accelerations [m/s²], shape (..., N), of N beads displaced by u [m], shape (..., N).

    ``constant`` is A, ``precompression`` is δ₀ [m], the approach at rest.  The paper gives no equation for
    the two end beads: here the constant force of δ₀ acts on them from outside, so they are free if δ₀ = 0.
    """
    require_positive(constant=constant)
    require_not_negative(precompression=precompression)
    u = np.asarray(displacements, dtype=float)
    at_rest = np.full((*u.shape[:-1], 1), float(precompression))
    approach = np.concatenate((at_rest, precompression + (u[..., :-1] - u[..., 1:]), at_rest), axis=-1)
    push = constant * np.maximum(approach, 0.0) ** 1.5
    return push[..., :-1] - push[..., 1:]


def wave_constant(modulus: Num, poisson: Num, diameter: Num, mass: Num) -> Real:
    """Eq. (3): c = √(E a³ / (3(1 − ν²) M)) [m/s]; the sound speed is not c but c₀, below."""
    return np.sqrt(acceleration_constant(modulus, poisson, diameter, mass) * np.asarray(diameter) ** 2.5)


def sound_speed_from_strain(
    initial_strain: Num, modulus: Num, poisson: Num, diameter: Num, mass: Num
) -> Real:
    """Below Eq. (3): long-wave sound speed c₀ = √(3/2) c ξ₀^{1/4} [m/s] at the initial strain ξ₀."""
    require_not_negative(initial_strain=initial_strain)
    c = wave_constant(modulus, poisson, diameter, mass)
    return np.sqrt(1.5) * c * np.asarray(initial_strain, dtype=float) ** 0.25


def force_from_strain(strain: Num, modulus: Num, poisson: Num, diameter: Num) -> Real:
    """Eq. (4): force [N] at strain ξ, F = 4E/(3(1 − ν²)) (R' + Δ)² ξ^{3/2}, which is Eq. (1) at δ = ξ a."""
    require_not_negative(strain=strain)
    scale = hertz_stiffness(modulus, poisson, diameter) * np.asarray(diameter) ** 1.5
    return scale * np.asarray(strain, dtype=float) ** 1.5


def strain_from_force(force: Num, modulus: Num, poisson: Num, diameter: Num) -> Real:
    """Inverse of Eq. (4): strain ξ under a contact force [N]."""
    return contact_approach(force, modulus, poisson, diameter) / np.asarray(diameter)


def speed_from_strain(peak_strain: Num, modulus: Num, poisson: Num, diameter: Num, mass: Num) -> Real:
    """Eq. (5): speed [m/s] of the long-wave solitary wave in sonic vacuum, V = (2/√5) c ξ_m^{1/4}."""
    require_not_negative(peak_strain=peak_strain)
    c = wave_constant(modulus, poisson, diameter, mass)
    return 2 / np.sqrt(5) * c * np.asarray(peak_strain, dtype=float) ** 0.25


def _speed_per_force(modulus: Num, poisson: Num, diameter: Num, mass: Num) -> Real:
    """B = (E a^{7/2} / (3(1 − ν²)))^{1/3} / √M, the factor [m/s/N^{1/6}] that Eqs. (6) and (7) share."""
    require_positive(mass=mass)
    return np.cbrt(hertz_stiffness(modulus, poisson, diameter)) * np.asarray(diameter) / np.sqrt(mass)


def _root_of_forces(peak_force: Num, static_force: Num) -> Real:
    """V/B of Eq. (7) [N^{1/6}] without its 0/0 at F_m = F₀ and at F₀ = 0; see `speed_with_precompression`."""
    require_not_negative(static_force=static_force)
    holds = np.isfinite(peak_force) & np.greater_equal(peak_force, static_force)
    require(holds, "peak_force", peak_force, "finite and at least the static force, which it includes")
    return _root_of_cube_roots(np.cbrt(peak_force), np.cbrt(static_force))


def _root_of_cube_roots(q: Num, p: Num) -> Real:
    """V/B of Eq. (7) [N^{1/6}] from q = F_m^{1/3} ≥ p = F₀^{1/3}."""
    polynomial = 2 * q**3 + 4 * q**2 * p + 6 * q * p**2 + 3 * p**3
    return np.sqrt(0.4 * polynomial) / np.where(q > 0, q + p, 1.0)


def speed_from_force(peak_force: Num, modulus: Num, poisson: Num, diameter: Num, mass: Num) -> Real:
    """Eq. (6): speed [m/s] of the long-wave solitary wave in sonic vacuum with contact-force peak F_m [N].

    V = (2/√5) (E a^{7/2} / (3(1 − ν²)))^{1/3} F_m^{1/6} / √M.
    """
    require_not_negative(peak_force=peak_force)
    scale = _speed_per_force(modulus, poisson, diameter, mass)
    return 2 / np.sqrt(5) * scale * np.asarray(peak_force, dtype=float) ** (1 / 6)


def speed_with_precompression(
    peak_force: Num,
    static_force: Num,
    modulus: Num,
    poisson: Num,
    diameter: Num,
    mass: Num,
) -> Real:
    """Eq. (7): speed [m/s] of the long-wave solitary wave in a chain under the static force F₀ [N].

    F_m = ``peak_force`` is the total contact force at the peak, static part included.  Proof: for a wave
    ξ(x − Vt) Eq. (3) is, in y = ξ^{5/4}, the motion of a point in a potential (Nesterenko 2001, ch. 1), which
    has an energy integral.  Leaving rest at the strain ξ₀ and turning at the total strain ξ_m, it gives

        (5/8)(V/c)² (ξ_m − ξ₀)² = (ξ_m^{5/2} − ξ₀^{5/2})/2 − (5/4) ξ₀^{3/2} (ξ_m − ξ₀),

    which is Eq. (7) with f_r = (ξ_m/ξ₀)^{3/2} = F_m/F₀.  Only so does V tend to c₀ as f_r → 1.  To the
    reading of a gauge that shows the dynamic part alone F₀ must be added first.

    As printed the formula is 0/0 at f_r = 1 and at F₀ = 0.  With s = f_r^{1/3} both (s − 1)² cancel exactly,
    3 + 2s⁵ − 5s² = (s − 1)² (2s³ + 4s² + 6s + 3), and with q = F_m^{1/3}, p = F₀^{1/3} there remains

        V = B √(2/5) √(2q³ + 4q²p + 6qp² + 3p³) / (q + p),    B = (E a^{7/2} / (3(1 − ν²)))^{1/3} / √M,

    accurate to rounding everywhere: c₀ at F_m = F₀, Eq. (6) at F₀ = 0.  V grows with F_m and with F₀.
    ValueError if F_m < F₀.
    """
    return _speed_per_force(modulus, poisson, diameter, mass) * _root_of_forces(peak_force, static_force)


def force_from_speed(speed: Num, modulus: Num, poisson: Num, diameter: Num, mass: Num) -> Real:
    """Inverse of Eq. (6): contact-force peak [N] of the sonic-vacuum solitary wave of that speed [m/s]."""
    require_not_negative(speed=speed)
    scale = _speed_per_force(modulus, poisson, diameter, mass)
    return (np.sqrt(5) / 2 * np.asarray(speed) / scale) ** 6


def force_from_speed_with_precompression(
    speed: Num,
    static_force: Num,
    modulus: Num,
    poisson: Num,
    diameter: Num,
    mass: Num,
) -> Real:
    """Inverse of Eq. (7): total contact-force peak [N] of the solitary wave of that speed [m/s] under F₀ [N].

    ValueError for a speed below the long-wave sound speed c₀, at which no compressive solitary wave travels.
    """
    target = np.asarray(speed, dtype=float) / _speed_per_force(modulus, poisson, diameter, mass)
    require_not_negative(speed=speed, static_force=static_force)
    slowest = _root_of_forces(static_force, static_force)
    # One part in 10^14 forgives the rounding of a speed that was itself computed as c₀.
    require(
        target >= slowest * (1 - 1e-14), "speed", speed, "at least the sound speed of the precompressed chain"
    )
    return np.vectorize(_peak_force_root, otypes=[float])(target, static_force)[()]


def _peak_force_root(target: float, static_force: float) -> float:
    """F_m at which V/B of Eq. (7) is ``target``: from F₀ up to Eq. (6), as precompression adds speed."""
    from scipy.optimize import brentq

    p, highest = np.cbrt(static_force), 1.25 * target**2 * (1 + 1e-12)
    if _root_of_cube_roots(p, p) >= target:
        return static_force
    # A tolerance in proportion to the root: forces may be of any size.
    q = brentq(lambda q: _root_of_cube_roots(q, p) - target, p, highest, xtol=1e-16 * highest, rtol=1e-15)
    return q**3


def modulus_from_speed(
    speed: Num,
    peak_force: Num,
    poisson: Num,
    diameter: Num,
    mass: Num,
    static_force: Num = 0.0,
) -> Real:
    """Modulus E [Pa] with which Eq. (7), or Eq. (6) when F₀ = 0, passes through the point (F_m [N], V [m/s]).

    Closed form, since V is proportional to E^{1/3}.  F_m includes F₀.
    """
    require_positive(speed=speed, peak_force=peak_force)
    at_one_pascal = speed_with_precompression(peak_force, static_force, 1.0, poisson, diameter, mass)
    return (np.asarray(speed) / at_one_pascal) ** 3


def contact_stiffness(static_force: Num, modulus: Num, poisson: Num, diameter: Num) -> Real:
    """Slope dF/dδ = (3/2) k^{2/3} F₀^{1/3} [N/m] of Eq. (1) at the static force F₀ [N]."""
    require_not_negative(static_force=static_force)
    return 1.5 * np.cbrt(hertz_stiffness(modulus, poisson, diameter) ** 2 * np.asarray(static_force))


def linear_frequency(
    wavenumber: Num,
    static_force: Num,
    modulus: Num,
    poisson: Num,
    diameter: Num,
    mass: Num,
) -> Real:
    """Frequency [Hz] of the small wave of ``wavenumber`` [rad/m] in the discrete chain under F₀ [N].

    Linear limit of Eq. (2), exact for small amplitude: ω = 2 √(K/M) |sin(κ a/2)|, K the `contact_stiffness`.
    """
    half_phase = np.asarray(wavenumber) * np.asarray(diameter) / 2
    return cutoff_frequency(static_force, modulus, poisson, diameter, mass) * np.abs(np.sin(half_phase))


def linear_sound_speed(static_force: Num, modulus: Num, poisson: Num, diameter: Num, mass: Num) -> Real:
    """Sound speed [m/s] of Eq. (2) under F₀ [N], a √(K/M): dω/dκ at κ = 0, and c₀ of the paper."""
    return np.pi * np.asarray(diameter) * cutoff_frequency(static_force, modulus, poisson, diameter, mass)


def cutoff_frequency(static_force: Num, modulus: Num, poisson: Num, diameter: Num, mass: Num) -> Real:
    """Highest frequency [Hz] that Eq. (2) carries under F₀ [N], √(K/M)/π; zero in sonic vacuum."""
    require_positive(mass=mass)
    return np.sqrt(contact_stiffness(static_force, modulus, poisson, diameter) / np.asarray(mass)) / np.pi
