"""Results do not depend on how chains are dealt to lanes, groups, threads and tables."""

import numpy as np
import pytest
from engine_cases import DURATION, coated

from sonicvacuum.effects import CATALOGUE
from sonicvacuum.effects.base import Setup
from sonicvacuum.physics import lanes, run
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.composition import Frame
from sonicvacuum.physics.entry import handed_over, kinds_of, prototype
from sonicvacuum.physics.machine import address_of
from sonicvacuum.physics.run import simulate
from sonicvacuum.physics.skeleton import alone
from sonicvacuum.physics.table import OPTIONS, load, store

MODULI = np.linspace(2.76e9, 30e9, 19)
CONTACTS = (0, 12, 21)
# Lanes take square roots by another instruction, good to 6e-13, which a few openings of contacts amplify.
ROUNDING = 1e-11


def ensemble(**changes) -> Chain:
    return coated(MODULI, **changes)


ALL = simulate(ensemble(), CONTACTS, DURATION, 1e-6)


@pytest.mark.parametrize("count", [1, 2, 3, 8, 9])
def test_a_chain_does_not_depend_on_its_company(count):
    h = simulate(ensemble().take(np.arange(count)), CONTACTS, DURATION, 1e-6)
    assert np.array_equal(h.force, ALL.force[..., :count])
    assert np.array_equal(h.step, ALL.step[:count])
    assert np.array_equal(h.striker_speed, ALL.striker_speed[:count])


def test_beside_other_laws_a_chain_is_that_of_the_stepper_of_all():
    """A damping of zero in one lane: bit for bit what the dissipative stepper makes of the chain alone."""
    plain = coated(np.array([15e9, 15e9]))
    effect = CATALOGUE.effect("hunt-crossley")
    mixed = effect.apply(Setup(plain), damping_s_per_m=np.array([0.0, 0.05])).chain
    beside = simulate(mixed, CONTACTS, DURATION, 1e-6).force[..., 0]
    alone = simulate(plain.take([0]), CONTACTS, DURATION, 1e-6)
    same = simulate(plain.take([0]), CONTACTS, DURATION, 1e-6, symplectic=False)
    assert np.array_equal(beside, same.force[..., 0])
    # What `simulate` says: the errors of two steppers.
    assert 0.0 < np.abs(beside - alone.force[..., 0]).max() < 2e-6 * alone.force.max()


@pytest.mark.parametrize("count", [1, 2])
def test_without_lanes_a_chain_differs_by_rounding(count):
    h = simulate(ensemble().take(np.arange(count)), CONTACTS, DURATION, 1e-6, alone=True)
    error = np.abs(h.force - ALL.force[..., :count]).max(axis=(0, 1))
    assert (error < ROUNDING * h.force.max(axis=(0, 1))).all()
    assert np.array_equal(h.step, ALL.step[:count])
    np.testing.assert_allclose(h.striker_speed, ALL.striker_speed[:count], rtol=1e-10)


def test_unequal_companions():
    # A slow, soft and a fast, stiff chain in one group: steps differ thirtyfold.
    modulus, speed = np.array([1e9, 15e9, 200e9]), np.array([0.01, 0.44, 5.0])
    h = simulate(coated(modulus, speed=speed), CONTACTS, 0.2e-3, 1e-6)
    for k in range(3):
        alone = simulate(coated(modulus[k], speed=speed[k]), CONTACTS, 0.2e-3, 1e-6, alone=True)
        assert np.abs(h.force[..., k] - alone.force[..., 0]).max() < ROUNDING * alone.force.max()


@pytest.mark.parametrize("threads", [2, 3])
def test_threads_change_no_bit(threads):
    h = simulate(ensemble(), CONTACTS, DURATION, 1e-6, threads=threads)
    assert np.array_equal(h.force, ALL.force)
    assert np.array_equal(h.striker_speed, ALL.striker_speed)


@pytest.mark.parametrize("changes", [{}, {"gravity": 9.81, "static_force": 1.0, "striker_mass": 1.23e-3}])
def test_stepping_only_the_beads_that_the_wave_has_reached(monkeypatch, changes):
    chain = coated(beads=60, **changes)
    contacts = (0, 10, 30, 60)
    h = simulate(chain, contacts, DURATION, 1e-6)
    # A threshold below zero switches all beads on at the first step.
    monkeypatch.setattr(run, "FRONT", -1.0)
    full = simulate(chain, contacts, DURATION, 1e-6)
    # What is neglected ahead of the wave is slower than 1e-12 of the impact.
    assert np.abs(h.force - full.force).max() < 1e-11 * full.force.max()


def test_reflections_in_a_short_chain_are_those_of_all_beads(monkeypatch):
    chain = coated(beads=5)
    h = simulate(chain, range(6), DURATION, 1e-6)
    monkeypatch.setattr(run, "FRONT", -1.0)
    full = simulate(chain, range(6), DURATION, 1e-6)
    assert np.abs(h.force - full.force).max() < 1e-11 * full.force.max()  # as above


@pytest.mark.parametrize("gravity", [0.0, 9.81])
def test_a_table_too_short_is_extended(monkeypatch, gravity):
    chain = coated(beads=3000, gravity=gravity)
    contacts = (3, 20, 2999)
    h = simulate(chain, contacts, DURATION, 1e-6)
    monkeypatch.setattr(run, "reachable_bodies", lambda chain, duration: 8)
    grown = simulate(chain, contacts, DURATION, 1e-6)
    assert np.array_equal(h.force, grown.force)
    assert h.of(20).max() > 1.0
    assert not h.of(2999).any()


def test_samples_are_the_same_however_dense():
    chain = coated(beads=6)
    coarse = simulate(chain, [0, 3], 2e-4, 1e-5)
    dense = simulate(chain, [3, 0], 2e-4, 1e-8)
    # The moments differ by the rounding of k times the interval.
    np.testing.assert_allclose(coarse.of(3), dense.of(3)[::1000], atol=1e-11)
    np.testing.assert_allclose(coarse.of(0), dense.of(0)[::1000], atol=1e-11)


@pytest.mark.parametrize("width", [1, lanes.LANES])
def test_compiled_arithmetic(width):
    def apply(c, x, y, out):
        for i in range(len(x)):
            a, b = load(c, x, i), load(c, y, i)
            store(c, out, 6 * i, lanes.power(a, b))
            store(c, out, 6 * i + 1, lanes.root(a))
            store(c, out, 6 * i + 2, lanes.power_3_2(a))
            store(c, out, 6 * i + 3, lanes.select(a, b, -1.0))
            store(c, out, 6 * i + 4, lanes.positive(a))
            store(c, out, 6 * i + 5, lanes.absolute(a))

    random = np.random.default_rng(1)
    x = 10.0 ** random.uniform(-16.0, 1.0, (500, width))
    x[::7] *= -1.0
    x[::11] = 0.0
    y = random.uniform(0.2, 3.0, x.shape)
    out = np.empty((len(x), 6, width))
    arguments = (x, y, out.reshape(-1, width))
    kinds, name = kinds_of(arguments), f"arithmetic_of_{width}"
    code = alone(apply, OPTIONS, kinds, name, Frame(width))
    prototype(kinds)(address_of(name, code))(*handed_over(arguments))
    # Polynomials of lanes are good to 1e-13, their square roots to 6e-13.
    for k, expected in enumerate(
        (
            lanes.power(x, y),
            lanes.root(x),
            lanes.power_3_2(x),
            lanes.select(x, y, -1.0),
            lanes.positive(x),
            lanes.absolute(x),
        )
    ):
        np.testing.assert_allclose(out[:, k], expected, rtol=6e-13)


def test_requests_that_make_no_sense():
    chain = coated(beads=2)
    for bad, words in (
        ({"contacts": [3]}, "contact 3 does not exist"),
        ({"duration": 0.0}, "must be positive"),
        ({"interval": -1e-6}, "must be positive"),
        ({"step": 0.0}, "step 0.0 s"),
        ({"refine": 0.0}, "refine 0.0"),
        ({"method": "euler"}, "use one of verlet, blanes-moan"),
        ({"threads": 0}, "threads is 0"),
    ):
        request = {"contacts": [0], "duration": 1e-4, "interval": 1e-6} | bad
        with pytest.raises(ValueError, match=words):
            simulate(chain, **request)


def test_motion_that_overflows_is_an_error_that_names_the_chain():
    chain = coated(np.full(3, 15e9), speed=np.array([0.44, 1e250, 0.44]))
    with pytest.raises(FloatingPointError, match="chain 1: the motion is no longer finite"):
        simulate(chain, [0], 1e-5, 1e-6, step=1e-6)
