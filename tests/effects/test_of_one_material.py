"""A modulus off in one of several materials: where it may be, what it moves, what leaves all as it is."""

from dataclasses import replace

import numpy as np
import pytest
from effect_cases import nominal

from sonicvacuum.effects import CATALOGUE, Setup, effect
from sonicvacuum.effects.whereabouts import materials_of
from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.physics.chain import Body, Elastic
from sonicvacuum.records.record import Tolerances

MODULUS = effect("dynamic-modulus")
HARD, SOFT = Elastic("steel", 2e11, 0.3), Elastic("polymer", 2e9, 0.4)


def dimer(wall=None) -> Setup:
    """The chain of the contract with every other bead of another material."""
    setup = nominal()
    first = setup.chain.first
    pattern = tuple(Body(surface, first.mass[0], first.radius[0]) for surface in (HARD, SOFT))
    return replace(setup, chain=replace(setup.chain, bodies=Bodies(pattern), wall=wall or setup.chain.wall))


def moduli(setup: Setup) -> dict[str, list[float]]:
    """Material → modulus of all bodies that are made of it."""
    found: dict[str, list[float]] = {}
    for solid in setup.chain.solids:
        found.setdefault(solid.surface.name, []).append(float(solid.surface.modulus[0]))
    return found


def stiffnesses(setup: Setup) -> np.ndarray:
    """(contacts, lanes) Hertz constants in N/m^{3/2} of all contacts."""
    return setup.chain.stiffnesses(setup.chain.beads + 1)


def test_the_materials_of_a_chain_are_those_of_its_beads_in_their_order():
    chain = dimer().chain
    assert materials_of(chain) == ("steel", "polymer")
    assert materials_of(nominal().chain) == ("soft",)
    assert materials_of(replace(chain, beads=1)) == ("steel",)
    other = Bodies(chain.bodies.pattern, {1: chain.bodies.pattern[1]})
    assert materials_of(replace(chain, bodies=other)) == ("polymer", "steel")
    assert materials_of(replace(chain, beads=0)) == ("steel",)


def test_only_a_chain_of_several_materials_leaves_a_choice():
    one, several = nominal().chain, dimer().chain
    assert MODULUS.located(one) is MODULUS
    located = MODULUS.located(several)
    assert (located.places, located.candidates(dimer())) == ("material", (0, 1))
    assert located.located(several) == located
    assert MODULUS.candidates(dimer()) == ()
    known = CATALOGUE.informed(several, Tolerances())
    assert known.effect(MODULUS.id) == located
    assert CATALOGUE.informed(one, Tolerances()).effect(MODULUS.id) is MODULUS


@pytest.mark.parametrize("one", [MODULUS, MODULUS.located(dimer().chain)], ids=["anywhere", "located"])
def test_off_is_the_nominal_model_in_every_material(one):
    setup = dimer()
    for material in (0, 1, "steel", "polymer"):
        assert one.apply(setup, modulus_ratio=1.0, material=material) is setup
        lanes = one.apply(setup, modulus_ratio=np.array([1.0, 2.0]), material=material)
        np.testing.assert_array_equal(stiffnesses(lanes)[:, :1], stiffnesses(setup))


def test_a_material_moves_wherever_it_is_and_no_other():
    setup = dimer(wall=SOFT)
    changed = moduli(MODULUS.apply(setup, modulus_ratio=3.0, material="polymer"))
    assert changed == moduli(setup) | {"polymer": [6e9, 6e9]}  # bead and wall
    assert changed == moduli(MODULUS.apply(setup, modulus_ratio=3.0, material=1))
    assert moduli(MODULUS.apply(setup, modulus_ratio=3.0)) == moduli(setup) | {"steel": [6e11]}


def test_each_chain_of_a_batch_has_its_own_material():
    setup = dimer()
    both = MODULUS.apply(setup, modulus_ratio=np.array([2.0, 5.0]), material=np.array([1, 0]))
    for lane, (ratio, material) in enumerate([(2.0, 1), (5.0, 0)]):
        single = MODULUS.apply(setup, modulus_ratio=ratio, material=material)
        np.testing.assert_array_equal(stiffnesses(both)[:, lane : lane + 1], stiffnesses(single))


def test_a_material_that_no_bead_is_made_of_is_refused_with_those_that_are():
    with pytest.raises(ValueError, match="material is brass; possible here: steel, polymer"):
        MODULUS.apply(dimer(), modulus_ratio=2.0, material="brass")
    with pytest.raises(ValueError, match="material is 2; possible here"):
        MODULUS.apply(dimer(), modulus_ratio=2.0, material=2)
    with pytest.raises(ValueError, match="needs the parameter material"):
        MODULUS.located(dimer().chain).apply(dimer(), modulus_ratio=2.0)
