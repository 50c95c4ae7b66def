"""One contact: Hertz's relations among force, compression, radius and pressure; rates and durations."""

import math

import numpy as np
import pytest

from sonicvacuum.observe.contacts import (
    contact_duration,
    contact_radius,
    max_compression,
    mean_pressure,
    peak_pressure,
    restitution,
    strain_rate,
)
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain

# Two coated beads of 4.86 mm at the 15 GPa that match the speeds of Daraio & Nesterenko (2006).
RADIUS = 4.86e-3 / 4
MODULUS = 15e9 / (2 * (1 - 0.388**2))
COATING = Elastic("coating", 15e9, 0.388)
CHAIN = Chain(
    beads=21, bodies=Body(COATING, 0.44e-3, 2.43e-3), striker=COATING, wall=COATING, striker_radius=math.inf,
    striker_mass=0.47e-3, speed=0.44,
)  # fmt: skip


def test_hertz_relations():
    force = np.array([0.25, 4.8, 12.9])
    depth = max_compression(force, CHAIN, 12)
    radius = contact_radius(depth, RADIUS)
    # Johnson, Contact Mechanics (1985), Eqs. (4.22), (4.24): a³ = 3 F R/(4 E*), p₀ = (6 F E*²/(π³ R²))^(1/3).
    np.testing.assert_allclose(radius**3, 3 * force * RADIUS / (4 * MODULUS), rtol=1e-13)  # rounding
    peak = (6 * force * MODULUS**2 / (math.pi**3 * RADIUS**2)) ** (1 / 3)
    np.testing.assert_allclose(peak_pressure(force, radius), peak, rtol=1e-13)  # rounding
    np.testing.assert_allclose(mean_pressure(force, radius), peak / 1.5, rtol=1e-13)  # rounding


def test_contact_of_the_paper_is_deeper_wider_and_more_strained_than_its_coating_allows():
    depth = max_compression(4.8, CHAIN, 12)
    radius = contact_radius(depth, RADIUS)
    assert depth == pytest.approx(5.2e-6, rel=0.02)  # two digits, worked out by hand
    assert radius == pytest.approx(79e-6, rel=0.01)  # above the coating's 50 µm
    assert mean_pressure(4.8, radius) == pytest.approx(245e6, rel=0.02)  # above its yield strength of 59 MPa


def test_open_contact_is_not_compressed():
    assert max_compression(-1.0, CHAIN, 12) == 0.0
    assert contact_radius(-1e-6, RADIUS) == 0.0


def test_strain_rate_shares_the_compression_among_the_coatings():
    assert strain_rate(-0.05, 50e-6) == pytest.approx(500.0, rel=1e-14)  # rounding
    assert strain_rate(0.05, 50e-6, coatings=1) == pytest.approx(1000.0, rel=1e-14)  # rounding


@pytest.mark.parametrize("start", [0.0, 3.3, 7.9])
def test_contact_duration_between_samples(start):
    # F = sin^(3/2), a Hertz contact at constant frequency; its compression is nearly straight at the ends.
    period = 61.7
    time = np.arange(100.0)
    inside = (time > start) & (time < start + period)
    force = np.where(inside, np.abs(np.sin(math.pi * (time - start) / period)), 0.0) ** 1.5
    # Extrapolated over up to one sample from chords within two samples of the end: sin x = x − x³/6.
    bound = 4 * (math.pi * 2 / period) ** 2
    assert contact_duration(time, force).value == pytest.approx(period, abs=bound)


def test_ends_of_a_contact_lie_within_one_sample():
    # A force that jumps, as with a dashpot: the line through 1.0 and 1.01 meets zero a hundred samples off.
    force = np.array([0, 0, 1.0, 1.01, 1.02, 1.01, 1.0, 0, 0])
    assert contact_duration(np.arange(9.0), force).value == 6.0


def test_first_contact_of_several_counts():
    time = np.arange(60.0)
    force = np.interp(time, [0, 5, 10, 15, 30, 45, 50], [0, 0, 1, 0, 0, 5, 0]) ** 1.5
    assert contact_duration(time, force).value == pytest.approx(
        10.0, abs=1e-9
    )  # a straight compression: exact


def test_contact_that_never_closes_or_does_not_open():
    time = np.arange(10.0)
    assert contact_duration(time, np.zeros(10)).reason.startswith("absent")
    assert contact_duration(time, time).reason.startswith("truncated")
    with pytest.raises(ValueError, match="shape"):
        contact_duration(time, np.zeros(9))


def test_restitution():
    time, push = np.arange(11) * 1e-6, np.array([0, 1, 2, 3, 4, 3, 2, 1, 0, 0, 0]) * 50.0
    impulse = push.sum() * 1e-6
    # An impulse of 1.8 m v turns v into 0.8 v; one of 0.9 m v leaves 0.1 v onwards.
    assert restitution(time, push, impulse / (1.8 * 0.5), 0.5).value == pytest.approx(0.8, rel=1e-14)
    assert restitution(time, push, impulse / (0.9 * 0.5), 0.5).value == pytest.approx(-0.1, rel=1e-13)
    # Gravity has taken 8 us of it when the contact opens.
    heavy = restitution(time, push, impulse / (1.8 * 0.5), 0.5, 9.81).value
    assert heavy == pytest.approx(0.8 - 9.81 * 8e-6 / 0.5, rel=1e-12)
    assert restitution(time, 0.0 * push, 1.0, 0.5).reason.startswith("absent")
    assert restitution(time[:8], push[:8], 1.0, 0.5).reason.startswith("truncated")
    with pytest.raises(ValueError, match="impact speed"):
        restitution(time, push, 1.0, 0.0)
