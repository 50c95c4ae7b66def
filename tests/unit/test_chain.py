"""Masses, Hertz constants and static forces of a chain, against the textbook and Eq. 2 of the paper."""

import math

import numpy as np
import pytest

from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.contact import (
    compression_at,
    contact_time,
    hertz_constant,
    reduced_modulus,
    reduced_radius,
)
from sonicvacuum.physics.theory import hertz_stiffness

POLYMER = Elastic("polymer", 2.76e9, 0.388)
STEEL = Elastic("steel", 193e9, 0.3)


def chain(bead_mass=0.44e-3, **changes):
    values = {
        "beads": 4,
        "bodies": Body(POLYMER, bead_mass, 2.43e-3),
        "striker": STEEL,
        "wall": STEEL,
        "striker_radius": math.inf,
        "striker_mass": 0.47e-3,
        "speed": 0.44,
    }
    return Chain(**(values | changes))


def test_equal_beads_have_the_stiffness_of_eq_2():
    expected = hertz_stiffness(2.76e9, 0.388, 4.86e-3)
    assert chain().stiffness[0] == pytest.approx(expected, rel=1e-14)  # same formula, rounding only


def test_a_rigid_flat_is_stiffer_by_two_root_two():
    # E* doubles against a rigid body, R* doubles against a flat: K grows by 2 √2 (Johnson 1985, Eq. 4.23).
    rigid = Elastic("rigid", 1e30, 0.3)
    c = chain(striker=rigid, wall=rigid)
    assert c.wall_stiffness / c.stiffness == pytest.approx(2 * math.sqrt(2), rel=1e-14)  # rounding only
    assert c.striker_stiffness == pytest.approx(c.wall_stiffness, rel=1e-14)  # the same contact


def test_reduced_values_are_symmetric_and_reject_what_is_not_physical():
    assert reduced_modulus(1e9, 0.3, 2e9, 0.4) == reduced_modulus(2e9, 0.4, 1e9, 0.3)
    assert reduced_radius(math.inf, 2.0) == 2.0
    with pytest.raises(ValueError, match="modulus is -1"):
        reduced_modulus(-1.0, 0.3, 1e9, 0.3)
    with pytest.raises(ValueError, match="Poisson"):
        reduced_modulus(1e9, 0.7, 1e9, 0.3)
    with pytest.raises(ValueError, match="modulus is nan"):
        reduced_modulus(math.nan, 0.3, 1e9, 0.3)
    with pytest.raises(ValueError, match="Poisson's ratio is nan"):
        reduced_modulus(1e9, math.nan, 1e9, 0.3)
    with pytest.raises(ValueError, match="two flats"):
        reduced_radius(math.inf, math.inf)
    with pytest.raises(ValueError, match="radii"):
        reduced_radius(-1.0, 1.0)


def test_compression_inverts_the_law():
    stiffness = hertz_constant(1e9, 1e-3)
    force = np.geomspace(1e-6, 1e3, 50)
    assert stiffness * compression_at(force, stiffness) ** 1.5 == pytest.approx(
        force, rel=1e-13
    )  # rounding of powers


def test_contact_time_scales_as_hertz_found():
    # Johnson 1985, Sec. 11.4: the duration goes as m^(2/5), K^(−2/5), v^(−1/5).
    base = contact_time(1.0, 1.0, 1.0)
    assert contact_time(32.0, 1.0, 1.0) / base == pytest.approx(4.0)
    assert contact_time(1.0, 32.0, 1.0) / base == pytest.approx(0.25)
    assert contact_time(1.0, 1.0, 32.0) / base == pytest.approx(0.5)


def test_static_forces_carry_the_beads_above():
    c = chain(gravity=9.81, static_force=2.0)
    weight = 0.44e-3 * 9.81
    expected = [0.0, *(2.0 + weight * k for k in range(1, 5))]
    assert c.static_forces(5)[:, 0] == pytest.approx(expected, rel=1e-14)  # sums of five terms


def test_deviations_change_one_body_or_contact():
    c = chain().with_defect("mass", 2, 1.5).with_defect("stiffness", 4, 0.5).with_defect("gap", 1, 1e-6)
    plain = chain()
    assert c.masses(5)[:, 0] / plain.masses(5)[:, 0] == pytest.approx([1, 1, 1.5, 1, 1])
    assert c.stiffnesses(5)[:, 0] / plain.stiffnesses(5)[:, 0] == pytest.approx([1, 1, 1, 1, 0.5])
    assert c.gaps(5)[:, 0] == pytest.approx([0, 1e-6, 0, 0, 0])
    assert c.preloaded and not plain.preloaded


def test_lanes_can_be_taken_apart():
    c = chain(speed=np.array([0.1, 0.2, 0.3])).with_defect("mass", 1, [1.0, 2.0, 3.0])
    part = c.take(np.array([2, 0]))
    assert part.speed.tolist() == [0.3, 0.1]
    assert part.masses(5)[1] / 0.44e-3 == pytest.approx([3.0, 1.0])
    assert part.first.surface.modulus.shape == (2,)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"speed": 0.0}, "speed is 0"),
        ({"bead_mass": -1.0}, "mass of a bead is -1"),
        ({"gravity": -9.81}, "gravity is -9.81"),
        ({"beads": -1}, "beads is -1"),
    ],
)
def test_unphysical_chains_are_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        chain(**changes)
