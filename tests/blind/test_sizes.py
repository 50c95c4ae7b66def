"""A table of restitution of a ball of 16 kg: what the catalogue's ranges do not reach is found."""

import math
from dataclasses import replace

import numpy as np
import pytest

from sonicvacuum.discover.session import discover
from sonicvacuum_blind.design import Design, Scalar
from sonicvacuum_blind.plan import Plan, Solid
from sonicvacuum_blind.record import as_record

SIGMA, GAMMA, ALPHA = 0.005, 900.0, 1.75
# By `sonicvacuum_blind.gauges.bounce` of the ball below with that damping, at these speeds.
TRUE = {0.3: 0.96909026, 0.8: 0.94848301, 2.0: 0.91812587, 5.0: 0.87243697}


def table(radius=0.15):
    """Restitution over speed, damped by a power of velocity nine times beyond the catalogue's range."""
    bead, wall = Solid("nylon", 2e9, 0.4), Solid("stainless-steel", 193e9, 0.3)
    mass = 1150.0 * 4.0 / 3.0 * math.pi * radius**3
    plan = Plan(0, bead, bead, wall, radius, radius, mass, mass, 1.0)
    runs = tuple(replace(plan, speed=v) for v in TRUE)
    scalars = tuple(Scalar(k, "restitution", {}, SIGMA) for k in range(len(runs)))
    design = Design("ball", runs, None, 1e-6, 0, scalars=scalars, trigger_sigma=0.0, gain_sigma=0.0)
    noise = np.random.default_rng(np.random.SeedSequence(3)).standard_normal(len(TRUE))
    return as_record(design, np.zeros((len(runs), 0, 0)), np.array([*TRUE.values()]) + SIGMA * noise, "table")


def test_a_strength_beyond_the_catalogues_range_is_followed():
    verdict = discover(table(), threads=1).verdict
    assert verdict.named == ["velocity-power"]
    found = verdict.parameters["velocity-power"]
    for name, true in (("gamma", GAMMA), ("alpha", ALPHA)):
        assert found[name].value == pytest.approx(true, abs=4.0 * found[name].sigma)
    assert not any("bound" in reason for reason in verdict.reasons)
