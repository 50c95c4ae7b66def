"""The pulse that the wall sends back, in simulated chains against a hard wall and softer ones."""

from dataclasses import replace

import numpy as np
import pytest

from sonicvacuum.gauges import Gauge, needed, reading
from sonicvacuum.observe.quantities import measure
from sonicvacuum.observe.run import Geometry
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.run import simulate

BEADS, DIAMETER = 20, 4.76e-3
STEEL = Elastic("steel", 193e9, 0.3)
BEAD = Body(STEEL, 0.45e-3, 2.38e-3)
CHAIN = Chain(
    beads=BEADS, bodies=BEAD, striker=STEEL, wall=Elastic("hard", 1e15, 0.3),
    striker_radius=DIAMETER / 2, striker_mass=0.45e-3, speed=0.4,
)  # fmt: skip
GAUGES = (
    Gauge("force", "embedded", 10),
    Gauge("speed", "velocity", 10),
    Gauge("acceleration", "acceleration", 10),
    Gauge("wall", "wall"),
)
GEOMETRY = Geometry(BEADS, DIAMETER, GAUGES)


def seen(modulus, quantity, sensor):
    """A quantity of the chain before a wall of this modulus."""
    chain = replace(CHAIN, wall=Elastic("wall", modulus, 0.3))
    contacts, bodies = needed(GAUGES, BEADS)
    history = simulate(chain, contacts, 8e-4, 0.5e-6, bodies=bodies)
    readings = {g.id: reading(g, history, BEADS)[:, 0] for g in GAUGES}
    return measure(quantity, readings, history.time, GEOMETRY, sensor=sensor)


@pytest.mark.parametrize("sensor", ["force", "speed", "acceleration"])
def test_a_hard_wall_sends_the_pulse_back_and_a_soft_one_part_of_it(sensor):
    # A rigid wall is a mirror: two equal solitary waves that meet part again as they were but for a small
    # loss (Manciu, Sen & Hurd, PRE 63, 016614, 2001). A soft one bears the pulse for longer and sends it back
    # late, broken into several.
    walls = (1e15, 5e9, 0.2e9)
    ratios = [seen(m, "echo_ratio", sensor).value for m in walls]
    assert ratios[0] == pytest.approx(
        1.0, abs=0.01
    )  # the striker's mass makes the pulse solitary to about that
    assert ratios[0] - 0.03 > ratios[1] > ratios[2]
    delays = [seen(m, "echo_delay", sensor).value for m in walls]
    assert delays[0] + 30e-6 < delays[1] < delays[2] - 30e-6


def test_the_echo_of_a_hard_wall_takes_the_way_there_and_back():
    # From bead 10 to the wall are 10.5 diameters; the rigid wall is a mirror of the chain, in which the pulse
    # meets its image: the way is longer or shorter by less than a diameter.
    speed = measure(
        "speed", *_pair(), Geometry(BEADS, DIAMETER, (Gauge("a", "embedded", 6), Gauge("b", "embedded", 12))),
        from_="a", to="b",
    )  # fmt: skip
    delay = seen(1e15, "echo_delay", "force")
    assert delay.value * speed.value / DIAMETER == pytest.approx(21.0, abs=1.0)


def _pair():
    gauges = (Gauge("a", "embedded", 6), Gauge("b", "embedded", 12))
    history = simulate(CHAIN, needed(gauges, BEADS)[0], 3e-4, 0.5e-6)
    return {g.id: reading(g, history, BEADS)[:, 0] for g in gauges}, history.time


def test_the_wall_gauge_has_no_echo_and_a_short_record_neither():
    assert seen(1e15, "echo_ratio", "wall").reason.startswith("overlapped")
    contacts, bodies = needed(GAUGES, BEADS)
    history = simulate(CHAIN, contacts, 2.2e-4, 0.5e-6, bodies=bodies)
    readings = {g.id: reading(g, history, BEADS)[:, 0] for g in GAUGES}
    short = measure("echo_delay", readings, history.time, GEOMETRY, sensor="force")
    assert np.isnan(short.value)
    assert short.reason
