"""What leaves the range of its physics says so: each condition provoked, and none where all is well."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from engine_cases import DURATION, coated

import sonicvacuum as sv
from sonicvacuum.effects import CATALOGUE, Setup, effect
from sonicvacuum.physics import validity
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.run import simulate

ALL = range(22)


def told(chain, yields=None, duration=DURATION, **options):
    return validity.warnings(chain, simulate(chain, ALL, duration, 1e-6, audit=True, **options), yields)


def test_an_ordinary_impact_is_not_doubtful():
    assert told(coated(), {"coating": 59e6}) == []


def test_an_overlap_beyond_the_law_is_told_with_its_size():
    # δ of an impact goes as K^(-2/5): at 15 GPa 1/150 of R*, at 10 MPa 1/8 of it.
    (warning,) = told(coated(modulus=1e7), duration=6e-3)
    assert "of its effective radius: contact laws hold for less than 0.1" in warning


def test_an_overlap_of_a_radius_is_refused():
    with pytest.raises(validity.MeaninglessError, match="times its effective radius"):
        told(coated(modulus=1e4, speed=5.0), duration=6e-3)


def test_a_step_too_long_and_energy_from_nothing_are_told():
    warnings = told(coated(), step=1e-5, method="verlet")
    assert any("radians of the fastest" in w for w in warnings)
    assert any("energy is off by" in w for w in warnings)


def test_forces_that_are_no_numbers_are_refused():
    chain = coated()
    history = simulate(chain, ALL, DURATION, 1e-6)
    force = history.force.copy()
    force[100, 3] = np.nan
    with pytest.raises(validity.MeaninglessError, match="contact 3 in run 0"):
        validity.warnings(chain, replace(history, force=force))


def test_yielding_is_told_unless_the_law_yields():
    (warning,) = told(coated(modulus=193e9), {"coating": 50e6})
    assert "times the yield strength" in warning
    plastic = effect("plastic-contact").apply(Setup(coated(modulus=193e9)), residual_fraction=0.1).chain
    assert told(plastic, {"coating": 50e6}) == []


def test_a_coating_pressed_through_is_told():
    thin = Body(Elastic("coating", 1e8, 0.388), 0.44e-3, 2.43e-3, coating=1e-6)
    assert any("coatings of 2 um" in w for w in told(coated(modulus=1e8, bodies=thin), duration=2e-3))


def test_a_coating_that_is_felt_through_is_told_unless_it_acts_as_a_layer():
    core = Elastic("steel", 193e9, 0.29)
    bead = Body(Elastic("coating", 2.76e9, 0.388), 0.44e-3, 2.43e-3, coating=50e-6, core=core)
    chain = coated(modulus=2.76e9, bodies=bead)
    (warning,) = told(chain)
    assert "times the thickness of its coating (50 um)" in warning
    assert told(effect("coating-thickness").apply(Setup(chain), layer_thickness_um=50.0).chain) == []
    assert told(coated(modulus=2.76e9, bodies=replace(bead, coating=1e-3))) == []


def test_only_the_bodies_that_touch_count():
    """One PTFE bead in steel: contacts of steel on steel bear what would squash it, its own do not."""
    steel, soft = (sv.bead(diameter_mm=10.0, material=m) for m in ("bearing-steel", "ptfe"))
    chain = sv.chain(pattern=[*[steel] * 8, soft, *[steel] * 3], beads=12)
    case = sv.case(chain, sv.striker(steel, speed_m_s=0.5), [sv.gauge("embedded", bead=5)], duration_us=600)
    told = [w for w in sv.simulate(case).warnings if "yield" in w]
    forces = {w.split()[4] for w in told}
    assert forces <= {"8", "9"}, told


@pytest.mark.parametrize(
    ("reach", "warned"),
    [
        ({}, False),
        ({"deepest_um": 1e3, "fastest_m_s": 1e2}, False),
        ({"deepest_um": 1e-3, "fastest_m_s": 1e2}, True),
        ({"deepest_um": 1e3, "fastest_m_s": 1e-2}, True),
    ],
)
def test_a_fitted_law_is_told_of_beyond_its_data(reach, warned):
    chain = CATALOGUE.effect("free-form").apply(Setup(coated()), a0=0.01, **reach).chain
    assert any("free-form was fitted to data of up to" in w for w in told(chain)) is warned


def test_energy_that_a_law_stores_uncounted_is_no_error():
    """A law of no form is stiffer by a share here: the energy of that is in no balance."""
    chain = CATALOGUE.effect("free-form").apply(Setup(coated()), a0=0.05).chain
    assert not simulate(chain, ALL, DURATION, 1e-6, audit=True).energy.size
    assert told(chain) == []


def test_a_window_that_ends_too_soon_is_told():
    rise = np.linspace(0.0, 1.0, 50)[:, None]
    assert "before the pulse has passed g" in validity.unseen("g", rise, 1e-6)
    assert "ends after 49 us" in validity.unseen("g", np.zeros((50, 1)), 1e-6)
    assert validity.unseen("g", np.sin(np.pi * rise), 1e-6) == ""


def test_a_contact_is_named_by_what_touches_there():
    names = [
        validity._named(k, SimpleNamespace(beads=beads)) for k, beads in ((0, 0), (0, 5), (2, 5), (5, 5))
    ]
    assert names == [
        "the contact of ball and wall", "contact 0 (striker and bead 1)", "contact 2 (beads 2 and 3)",
        "contact 5 (bead 5 and wall)",
    ]  # fmt: skip
