"""Cards with fewer than two embedded gauges, or with some where virtual ones would sit, have metrics too."""

import numpy as np
import pytest

from sonicvacuum import simulation
from sonicvacuum.card import Card, CardSensor, CardStriker
from sonicvacuum.laboratory.specimen import Bead, Material
from sonicvacuum_paper.metrics import card_rows
from sonicvacuum_paper.one_run import OneRun

STEEL = Material(name="steel", modulus_Pa=193e9, poisson=0.3)
WALL = CardSensor(id="end", kind="wall")


def made(*sensors, speeds=(0.4, 0.8), effects=None):
    """A simulated chain of ten beads: g9 sits in bead 2, g5 in bead 6."""
    card = Card(
        case="c",
        variant="nominal",
        title="Ten steel beads",
        beads=10,
        bead=Bead(diameter_m=5e-3, mass_kg=0.5e-3, surface=STEEL),
        wall=STEEL,
        striker=CardStriker(mass_kg=0.5e-3, surface=STEEL, speeds_m_s=speeds),
        gravity_m_s2=0.0,
        static_force_N=0.0,
        sensors=sensors,
        duration_s=150e-6,
        interval_s=0.5e-6,
        effects=effects or {},
    )
    return simulation.simulate(card)


def gauge(name, bead):
    return CardSensor(id=name, kind="embedded", bead=bead)


@pytest.mark.parametrize(
    ("sensors", "names"),
    [
        ([WALL], ["g9", "g5", "end"]),
        ([gauge("own", 4)], ["g9", "own", "g5", "wall"]),
        ([gauge("own", 2), WALL], ["own", "g5", "end"]),
        ([gauge("g9", 8), WALL], ["g9_virtual", "g5", "g9", "end"]),
        ([gauge("a", 4), gauge("b", 4), WALL], ["g9", "a", "b", "g5", "end"]),
        ([gauge("wall", 4), gauge("b", 6)], ["wall", "b", "wall_virtual"]),
    ],
)
def test_a_sweep_with_few_gauges_has_the_virtual_ones(sensors, names):
    done = made(*sensors)
    assert [g.id for g in OneRun(done).gauges] == names
    rows = card_rows(done)
    amplitudes = [r for r in rows if r.quantity == "amplitude" and r.case.endswith("@0.4")]
    assert {r.sensor for r in amplitudes} == set(names)
    assert all(np.isfinite(r.value) for r in amplitudes)


def test_metrics_see_the_gauges_with_the_effects_that_signals_show():
    effects = {"sensor-gain": {"gain_ratio": 1.5, "sensor": 0}}
    done = made(gauge("a", 4), gauge("b", 7), WALL, speeds=(0.4,), effects=effects)
    rows = {r.sensor: r.value for r in card_rows(done) if r.quantity == "amplitude"}
    # The peak is interpolated between samples, a small part of it above the largest sample.
    assert rows["a"] == pytest.approx(done.readings()["a"].max(), rel=0.01)
