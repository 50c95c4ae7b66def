"""Beads that part and meet again follow a preload in narrow minima, which slopes at none of it miss."""

import numpy as np
import pytest
from made_records import block, made

from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import directions, screen, singles

PRELOAD, FORCE = "static-preload", 0.5


def steel():
    """Ten steel balls in gauges of 2 N noise, watched until the wave has come back from the wall."""
    ball = {"material": "bearing-steel", "diameter_mm": 9.5, "mass_g": 3.506}
    content = block((0.2, 0.6))
    content["chain"] |= {"bead": ball, "wall": {"material": "titanium"}}
    content["materials"] = {"bearing-steel": {"modulus_rel_sigma": 0.02}}
    content["trigger_sigma_us"] = 0.0
    for sensor in content["sensors"]:
        sensor["sigma_N"] = 2.0
    for run in content["runs"]:
        speed = run["striker"]["speed_m_s"]
        run["striker"] = {"shape": "sphere", **ball, "speed_m_s": speed, "speed_rel_sigma": 0.02}
    return content


def test_a_preload_is_found_past_the_minima_that_lie_nearer():
    forward = Forward(experiment(made([(PRELOAD, {"force_N": FORCE})], given=steel())[0]))
    null = wide.nominal(forward)
    known = directions.catalogue(singles.setup_of(forward), ())
    best, *others = singles.fit_all(forward, null, screen.screen(forward, null, known))
    size = sum(forward.experiment.size(run) for run in range(2))
    assert best.effect == PRELOAD
    force = best.fit.hypothesis.coordinates[0].value(best.fit.u)[0]
    assert force == pytest.approx(FORCE, rel=0.1)  # 2 % is its error; the next minimum is at half of it
    assert best.fit.objective < size + 3.0 * np.sqrt(2.0 * size)  # three σ of χ²
    assert best.gain > others[0].gain + 100.0  # of all other effects, on which χ² of 5 would be evidence
