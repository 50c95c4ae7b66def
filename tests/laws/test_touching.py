"""What a contact on a layer touches: limits of radius and central pressure, and the paper's contact."""

import math
from dataclasses import replace

import numpy as np
import pytest
from engine_cases import coated

from sonicvacuum.effects import Setup, effect
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.layered import Layer, solve
from sonicvacuum.physics.touching import relative, touched

STEEL = Elastic("steel", 193e9, 0.3)
SOFT = Elastic("coating", 2.76e9, 0.388)


def test_a_narrow_contact_is_hertz():
    found = solve(Layer(0.388, 0.015), [1e-4])
    assert found.concentration == pytest.approx(1.5, rel=1e-6)
    assert found.peak == pytest.approx(2.0 / math.pi, rel=1e-4)  # departs by a/t
    wider, steeper = relative(Layer(0.388, 0.015), 1e-6)
    assert (wider, steeper) == (pytest.approx(1.0, abs=1e-3), pytest.approx(1.5, rel=1e-6))


@pytest.mark.parametrize(
    ("poisson", "steeper", "wider"),
    # Johnson, Contact Mechanics (1985), Sec. 5.8: pressure ~ a² − r² of a Winkler bed, ~ (a² − r²)² of an
    # incompressible layer; approaches a²/2R and a²/4R.
    [(0.0, 2.0, math.sqrt(2.0)), (0.3, 2.0, math.sqrt(2.0)), (0.5, 3.0, 2.0)],
)
def test_a_thin_layer_is_wider_and_its_pressure_steeper(poisson, steeper, wider):
    near, far = (solve(Layer(poisson), [a]) for a in (60.0, 120.0))
    # The edge adds terms of order t/a: extrapolated; the next order is left.
    assert 2.0 * far.concentration - near.concentration == pytest.approx(steeper, rel=0.003)
    ratio = [one.radius / one.width for one in (near, far)]
    assert 2.0 * ratio[1] - ratio[0] == pytest.approx(wider, rel=0.003)


def test_the_table_follows_the_solution():
    layer = Layer(0.388, 0.0153, 0.3)
    exact = solve(layer, [0.03, 0.4, 1.1, 2.3, 7.0])
    wider, steeper = relative(layer, exact.width)
    np.testing.assert_allclose(wider, exact.radius / exact.width, rtol=1e-4)
    np.testing.assert_allclose(steeper, exact.concentration, rtol=1e-4)


def test_a_chain_touches_by_its_own_law():
    bead = Body(SOFT, 0.44e-3, 2.43e-3, coating=50e-6, core=STEEL)
    hertz = coated(bodies=bead, striker=STEEL, wall=STEEL)
    layered = effect("coating-thickness").apply(Setup(hertz), layer_thickness_um=50.0).chain
    depth = np.array([[5e-6]])
    plain, steeper = touched(hertz, 10, depth)
    assert plain == pytest.approx(math.sqrt(2.43e-3 / 2 * 5e-6))
    assert steeper == 1.5
    radius, concentration = touched(layered, 10, depth)
    assert 1.33 < (radius / plain).item() < 1.35  # chi 1.56
    assert 1.6 < concentration.item() < 2.0
    # What contacts of a wall touch has the wall's own sink in it, and a thick layer is Hertz again.
    at_wall, _ = touched(layered, 21, depth)
    assert at_wall < math.sqrt(2.0) * radius * 1.05
    thick = replace(layered.actions[0], parameters={"thickness": np.array([1.0])})
    assert touched(replace(layered, actions=(thick,)), 10, depth)[0] == pytest.approx(plain, rel=1e-3)
