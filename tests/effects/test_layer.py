"""The coating in the chain: two layers in contact, layer against flat, and where it is off."""

from dataclasses import replace

import numpy as np
import pytest
from effect_cases import in_lanes, nominal

from sonicvacuum.effects import effect
from sonicvacuum.effects.coating_thickness import coefficients, layer_factor
from sonicvacuum.forward import see
from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.physics.contact import hertz_constant
from sonicvacuum.physics.laws import columns_of, depth_at, elastic_at
from sonicvacuum.physics.layered import Layer, solve
from sonicvacuum.physics.scales import CROSSINGS, passage_of, sampling_of

THICKNESS = 50e-6


def table_of(chain):
    """(columns, bodies, 1) coefficients of the layer's factor."""
    columns = coefficients(chain, chain.stiffnesses(7), None, thickness=np.array([THICKNESS]))
    return np.array([np.broadcast_to(c, (7, 1)) for c in columns])


def layer_of(bead):
    """Plane-strain modulus of a bead's coating, and the layer on its core."""
    plane, core = (e.modulus[0] / (1.0 - e.poisson**2) for e in (bead.surface, bead.core))
    return plane, Layer(bead.surface.poisson, plane / core, bead.core.poisson)


def test_two_coated_spheres_are_each_half_of_a_mirrored_pair():
    chain = nominal().chain
    bead = chain.first
    plane, layer = layer_of(bead)
    for a in (0.5, 2.0):
        exact = solve(layer, a)
        # One sphere against the mirror plane: its layer takes half of the approach.
        half = exact.depth * (a * THICKNESS) ** 2 / bead.radius[0]
        alone = hertz_constant(plane, bead.radius[0]) * half**1.5 * exact.factor
        pair = chain.stiffness[0] * (2 * half) ** 1.5 * layer_factor(2 * half, *table_of(chain)[:, 3, 0])
        assert pair == pytest.approx(alone, rel=3e-4)  # the kernel's form


def test_flat_striker_and_wall_have_one_layer_in_series():
    chain = nominal().chain
    plane, layer = layer_of(chain.first)
    exact = solve(layer, 1.5)
    delta = (exact.width * THICKNESS) ** 2 / chain.first.radius[0]
    for contact, other in ((0, chain.striker), (6, chain.wall)):
        share = plane / (other.modulus[0] / (1.0 - other.poisson**2))
        expected = (1.0 + share) / (1.0 / exact.factor + share)
        assert layer_factor(delta, *table_of(chain)[:, contact, 0]) == pytest.approx(expected, rel=3e-4)


def test_solid_beads_of_a_mixed_chain_have_no_layer():
    chain = nominal().chain
    coated = chain.first
    solid = replace(coated, core=None)
    both, one = (
        layer_factor(4e-6, *table_of(replace(chain, bodies=Bodies(kinds)))[:, 2, 0])
        for kinds in ((coated,), (coated, solid))
    )
    # One of two equal surfaces on a core: its compliance counts half.
    assert 2.0 / one == pytest.approx(1.0 / both + 1.0, rel=1e-12)  # rounding


def test_an_infinitely_thick_layer_is_none_to_the_bit():
    setup = in_lanes(nominal(), 2)
    chain = effect("coating-thickness").apply(setup, layer_thickness_um=np.array([np.inf, 50.0])).chain
    laws = chain.laws()
    table = chain.coefficients(laws, 7)
    (term,) = laws.in_slot("factor")
    factor = layer_factor(np.full((7, 2), 3e-6), *columns_of(laws, term, table))
    assert np.all(factor[:, 0] == 1.0)
    assert np.all(factor[:, 1] > 2.0)


def test_depth_at_rest_is_that_of_the_law_in_force():
    chain = effect("coating-thickness").apply(nominal(), layer_thickness_um=50.0).chain
    laws = chain.laws()
    table = chain.coefficients(laws, 7)
    load = np.full((7, 1), 0.2)
    depth = depth_at(laws, table, load)
    np.testing.assert_allclose(elastic_at(laws, table, depth), load, rtol=1e-12)  # rounding
    hertz = (load / chain.stiffnesses(7)) ** (2.0 / 3.0)
    assert np.all(depth < 0.8 * hertz)


def test_a_chain_is_looked_at_for_as_long_as_its_own_law_asks_for():
    """A thin hard coating is crossed sooner than its soft material alone, and the window goes with it."""
    bare = in_lanes(nominal(), 1)
    coated = effect("coating-thickness").apply(bare, layer_thickness_um=1e6 * THICKNESS)
    windows, arrivals = [], []
    for setup in (bare, coated):
        windows.append(passage_of(setup.chain, CROSSINGS))
        seen = see(setup, windows[-1], sampling_of(setup.chain))
        arrivals.append(seen.history.time[seen.history.of(setup.chain.beads)[:, 0].argmax()])
    assert windows[1] < 0.8 * windows[0]
    assert max(arrival / window for arrival, window in zip(arrivals, windows, strict=True)) < 0.5
