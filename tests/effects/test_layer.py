"""The thin coating's factor against the exact solution of a rigid sphere on a bonded elastic layer.

The frictionless contact of radius a is a Fredholm equation (dual integral equations, Lebedev & Ufliand 1958):
with phi the density of the pressure's transform, on 0 < t < a,

    (pi/2) phi(t) − integral of phi(s) M(t, s) ds = d − t²/R,
    M = integral of (1 − L(x h)) cos(x t) cos(x s) dx,   L the layer's surface compliance over a half space's,

phi(a) = 0 fixes the indentation d, and F = pi E' times the integral of phi, E' = E/(1 − nu²).
"""

import numpy as np
import pytest
from effect_cases import nominal

from sonicvacuum.effects import effect
from sonicvacuum.effects.coating_thickness import coefficients, layer_factor, layer_series, tangent_point
from sonicvacuum.physics.contact import hertz_constant

_x, _w = np.polynomial.legendre.leggauss(400)
WAVENUMBER, WEIGHT = 15.0 * (_x + 1.0), 15.0 * _w  # times h; 1 − L has died out by 30


def compliance(x, nu):
    """Surface compliance of a layer on a rigid base over that of a half space, at the wavenumber x/h."""
    k, e = 3.0 - 4.0 * nu, np.exp(-2.0 * x)
    return (k * (1.0 - e * e) - 4.0 * x * e) / (k * (1.0 + e * e) + (1.0 + k * k + 4.0 * x * x) * e)


def exact(nu, a, points=100):
    """chi = sqrt(R d)/h and F/F_Hertz for a contact radius of a layer thicknesses."""
    lack = (1.0 - compliance(WAVENUMBER, nu)) * WEIGHT
    t, w = np.polynomial.legendre.leggauss(points)
    t, w = 0.5 * (t + 1.0), 0.5 * w
    rows = np.append(t, 1.0)[:, None]
    near, far = (np.cos(a * s[..., None] * WAVENUMBER) @ lack for s in (rows - t, rows + t))
    kernel = 0.5 * a * (near + far)
    matrix = 0.5 * np.pi * np.eye(points) - kernel[:-1] * w
    flat, bowl = np.linalg.solve(matrix, np.stack([np.ones(points), t**2], axis=1)).T
    depth = (1.0 + kernel[-1] @ (w * bowl)) / (1.0 + kernel[-1] @ (w * flat))  # d R/a², from phi(a) = 0
    force = np.pi * (depth * (w @ flat) - w @ bowl)  # over E' a³/R
    return a * np.sqrt(depth), force / (4.0 / 3.0 * depth**1.5)


def factor(nu, chi):
    """The package's factor at chi."""
    series = layer_series(nu)
    limit, slope = tangent_point(series)
    return layer_factor(np.square(chi), *series, slope, limit)


@pytest.mark.parametrize("nu", [0.1, 0.2, 0.3, 0.388, 0.45, 0.5])
def test_first_order_is_the_layers_integral(nu):
    # The layer shifts the far field by the integral of 1 − L, which Dimitriadis fits to 4 % (at nu = 0.1).
    shift = np.sum((1.0 - compliance(WAVENUMBER, nu)) * WEIGHT)
    assert layer_series(nu)[0] == pytest.approx(2.0 / np.pi * shift, rel=0.04)


@pytest.mark.parametrize("nu", [0.2, 0.3, 0.388, 0.45])
def test_the_exact_solution_has_its_two_limits(nu):
    chi, g = exact(nu, 0.01)
    assert g == pytest.approx(1.0 + layer_series(nu)[0] * chi, abs=1e-3)  # second order in chi = 0.01
    chi, g = exact(nu, 14.0)
    winkler = 0.75 * np.pi * (1.0 - nu) ** 2 / (1.0 - 2.0 * nu) * chi
    assert g == pytest.approx(
        winkler, rel=0.06
    )  # the next order is chi to the power 0 against 1, larger near 1/2


def test_the_factor_follows_the_exact_layer():
    # Expansion of small chi that underestimates: bounds as measured, stated in the module.
    for a, low in ((0.1, 0.002), (0.3, 0.016), (1.0, 0.10), (2.0, 0.19), (3.0, 0.21)):
        chi, g = exact(0.388, a)
        assert g * (1.0 - low) < factor(0.388, chi) < g
    chi, g = np.array([exact(0.388, a) for a in np.linspace(0.05, 2.0, 9)]).T
    np.testing.assert_allclose(factor(0.388, 1.17 * chi), g, rtol=0.05)  # same shape, layer thinner by 15 %


@pytest.mark.parametrize("nu", [0.0, 0.2, 0.388, 0.46, 0.5])
def test_the_factor_rises_and_is_smooth(nu):
    chi = np.linspace(0.0, 8.0, 8001)
    g = factor(nu, chi)
    slope = np.diff(g) / np.diff(chi)
    assert g[0] == 1.0
    assert np.all(slope > 0.0)
    # Continuous slope: its own steps are those of the curvature, below 30 for nu = 1/2, times the spacing.
    assert np.abs(np.diff(slope)).max() < 30.0 * (chi[1] - chi[0])


def test_two_coated_spheres_are_each_half_of_a_mirrored_pair():
    chain = effect("coating-thickness").apply(nominal(), layer_thickness_um=50.0).chain
    table = np.array(
        [np.broadcast_to(c, (7, 1)) for c in coefficients(chain, chain.stiffnesses(7), None, thickness=50e-6)]
    )[..., 0]
    delta, radius = 5e-6, chain.first.radius[0]
    modulus = chain.first.surface.modulus[0] / (1.0 - chain.first.surface.poisson**2)
    # One sphere against the mirror plane, indented by delta/2.
    alone = (
        hertz_constant(modulus, radius)
        * (delta / 2) ** 1.5
        * factor(0.388, np.sqrt(radius * delta / 2) / 50e-6)
    )
    pair = chain.stiffness[0] * delta**1.5 * layer_factor(delta, *table[:, 3])
    assert pair == pytest.approx(alone, rel=1e-12)  # rounding
    # Flat striker and wall: one layer, indented by all of delta.
    for contact in (0, 6):
        expected = factor(0.388, np.sqrt(radius * delta) / 50e-6)
        assert layer_factor(delta, *table[:, contact]) == pytest.approx(expected, rel=1e-12)  # rounding
