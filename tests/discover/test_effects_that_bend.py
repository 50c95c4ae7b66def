"""Beads that part and meet again follow a preload in narrow minima, which slopes at none of it miss."""

import numpy as np
import pytest
from made_records import block, made

from sonicvacuum.discover.fit import refit, wide
from sonicvacuum.discover.model import accuracy
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import directions, screen, singles
from sonicvacuum.effects import CATALOGUE

PRELOAD = "static-preload"


def steel(noise=2.0):
    """Ten steel balls and three gauges, watched until the wave has come back from the wall."""
    ball = {"material": "bearing-steel", "diameter_mm": 9.5, "mass_g": 3.506}
    content = block((0.2, 0.6))
    content["chain"] |= {"bead": ball, "wall": {"material": "titanium"}}
    content["materials"] = {"bearing-steel": {"modulus_rel_sigma": 0.02}}
    content["trigger_sigma_us"] = 0.0
    for sensor in content["sensors"]:
        sensor["sigma_N"] = noise
    for run in content["runs"]:
        speed = run["striker"]["speed_m_s"]
        run["striker"] = {"shape": "sphere", **ball, "speed_m_s": speed, "speed_rel_sigma": 0.02}
    return content


@pytest.mark.parametrize(("force", "seed"), [(0.5, 0), (0.2, 0), (0.5, 3)])
def test_a_preload_is_found_past_the_minima_that_lie_nearer(force, seed):
    """Others lie at 0.23 N beside 0.5 N, and at 0.12 N beside 0.2 N, where χ² is higher by 19."""
    forward = Forward(experiment(made([(PRELOAD, {"force_N": force})], seed=seed, given=steel())[0]))
    null = wide.nominal(forward)
    known = directions.catalogue(singles.setup_of(forward), ())
    best, *others = singles.fit_all(forward, null, screen.screen(forward, null, known))
    size = sum(forward.experiment.size(run) for run in range(2))
    assert best.effect == PRELOAD
    assert best.fit.objective < size + 3.0 * np.sqrt(2.0 * size)  # three σ of χ²
    assert best.gain > others[0].gain + 10.0  # of all other effects, on which χ² of 5 would be evidence
    fine = refit.finely(forward, best.fit)
    found = fine.hypothesis.coordinates[0].value(fine.u)[0]
    assert found == pytest.approx(force, rel=0.1)  # a step of the search's minima; the others are 0.4 off
    # χ² has several minima a few per cent apart, in any of which rounding may leave a fit, and whose widths
    # are no errors: how far the truth is off is told by what it leaves with all else fitted.
    held = Hypothesis((Component(CATALOGUE.effect(PRELOAD), (), {"force_N": force}),))
    truth = refit.fit(forward.finely(), held, np.zeros((1, 0)), fine.nu)
    assert -0.5 < truth.objective - fine.objective < 3.5**2  # no lower minimum there; 3.5 σ


@pytest.mark.parametrize("force", [0.5, 0.2])
def test_no_preload_is_known_better_than_all_forces_together(force):
    """Without gravity, masses as they are, a chain whose speeds, forces and preload are larger by one factor
    and whose stiffnesses are smaller by its root shows the same after gains that much smaller: however quiet
    the gauges are, the logarithm of a preload has the error that priors of speeds (2 %), gains (2 %) and
    moduli (2 % and 5 %) leave to that factor. Slopes over the usual steps give half of it.
    """
    limit = (2 / 0.02**2 + 3 / 0.02**2 + 0.25 / 0.02**2 + 0.25 / 0.05**2) ** -0.5
    forward = Forward(experiment(made([(PRELOAD, {"force_N": force})], given=steel(0.2))[0]))
    setup, effect = singles.setup_of(forward), CATALOGUE.effect(PRELOAD)
    law = Hypothesis((Component(effect, variants(effect, setup)[0]),))
    start = np.zeros((1, forward.layout.size))
    rough = refit.fit(forward, law, [[law.coordinates[0].inverse(force)]], start)
    fine = refit.finely(forward, rough)
    assert fine.sigma[0] == pytest.approx(limit, rel=0.02)  # 1 % is what the noise of 0.2 N adds
    assert rough.sigma[0] < 0.8 * limit
    assert fine.objective < rough.objective + 0.1  # a tenth of a standard error


def test_errors_are_taken_as_they_are_where_data_do_not_bend():
    short = Forward(experiment(made()[0]))
    assert not accuracy.bent(short.experiment)
    null = wide.nominal(short)
    assert refit.finely(short, null) is null
