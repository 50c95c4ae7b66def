"""What motion without loss keeps: energy, momentum, the way back, rest."""

import numpy as np
import pytest
from engine_cases import DURATION, coated

from sonicvacuum.physics import sampling
from sonicvacuum.physics.composition import U, V
from sonicvacuum.physics.methods import BLANES_MOAN, VERLET
from sonicvacuum.physics.run import _Batch, simulate

CHAINS = {
    "horizontal": coated(),
    "vertical": coated(gravity=9.81),
    "loaded": coated(static_force=5.0, gravity=9.81, striker_mass=1.23e-3),
    "with a gap": coated().with_defect("gap", 8, 2e-6),
}


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize("symplectic", [True, False])
def test_energy_and_momentum(name, symplectic):
    h = simulate(CHAINS[name], [21], DURATION, 1e-6, audit=True, symplectic=symplectic)
    assert len(h.energy) > 300
    # Openings and closings of contacts cost some 1e-7 each time, at the default step.
    assert np.ptp(h.energy) < 2e-6 * h.energy[0, 0]
    # Forces act in pairs: only rounding is left.
    assert np.ptp(h.momentum) < 1e-13 * h.momentum[0, 0]


def test_momentum_at_the_wall_is_the_impulse_of_the_recorded_force():
    chain = coated(beads=3)
    h = simulate(chain, [3], 0.4e-3, 1e-7, audit=True)
    impulse = np.trapezoid(h.of(3)[:, 0], h.time)
    # All beads end up moving away from the wall, with the striker's momentum and what the wall gave.
    assert impulse > 0.47e-3 * 0.44
    assert h.momentum[0, 0] == pytest.approx(0.47e-3 * 0.44, rel=1e-14)  # nothing received yet: rounding


def _batch(chain, step, samples=2, **changes):
    settings = {
        "bodies": chain.beads + 1,
        "contacts": (0,),
        "watched": (),
        "interval": step * 120,
        "refine": 1.0,
        "audit": False,
        "alone": True,
    }
    return _Batch(chain, chain.laws(), samples=samples, step=step, **(settings | changes))


@pytest.mark.parametrize("scheme", [VERLET, BLANES_MOAN])
@pytest.mark.parametrize("name", ["horizontal", "loaded"])
def test_splitting_retraces_its_way(scheme, name):
    chain = CHAINS[name]
    batch = _batch(chain, 1e-6)
    batch.run(scheme, 1)
    assert np.abs(batch.table[..., U, :]).max() > 1e-6
    batch.table[..., V, :] *= -1.0
    batch.clock[:, sampling.DUE] = batch.interval - batch.clock[:, sampling.TOLERANCE]
    batch.cursor[:] = 1
    batch.run(scheme, 1)
    back = np.zeros(22)
    back[0] = -0.44
    # Rounding of 120 steps; displacements are some 1e-5 m.
    np.testing.assert_allclose(batch.table[0, :22, V, 0], back, atol=1e-11)
    np.testing.assert_allclose(batch.table[0, :22, U, 0], 0.0, atol=1e-16)


@pytest.mark.parametrize("lanes", [1, 8])
def test_what_the_wave_has_not_reached_is_at_rest_to_the_bit(lanes):
    chain = coated(np.full(lanes, 15e9), gravity=9.81, static_force=3.0)
    step = 1e-6
    batch = _batch(chain, step, interval=step)
    batch.run(VERLET, 1)
    # One step of Verlet's reaches one body further, though four are stepped.
    assert (batch.table[:, 0, U] != 0.0).all()
    assert not batch.table[:, 2:, [U, V]].any()
