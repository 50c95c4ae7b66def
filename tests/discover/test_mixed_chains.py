"""Chains of several kinds of beads: models, nominal and with an effect, are followed past the nearest of many
minima.
"""

import math

import numpy as np
import pytest
from made_records import block, made

from sonicvacuum.discover.fit.evidence import Candidate, log_bayes
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.fit.wide import noise, nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import elsewhere
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.effects import CATALOGUE


def dimer(beads=20):
    """Balls of two sizes and materials in turn, that part behind the wave, under noise of 0.2 % of it."""
    kinds = [(1.643, 0.002784, "polycarbonate"), (0.986, 0.001092, "ptfe")]
    pattern = [dict(zip(("diameter_mm", "mass_g", "material"), kind, strict=True)) for kind in kinds]
    content = block([4.0])
    content["chain"] = {"beads": beads, "orientation": "horizontal", "wall": {"material": "titanium"}}
    content["chain"]["pattern"] = pattern
    content["materials"] = {kind[2]: {"modulus_rel_sigma": 0.03} for kind in kinds}
    content["sensors"] = [
        {"id": f"g{b}", "kind": "embedded", "bead": b, "sigma_N": 0.002, "gain_rel_sigma": 0.01}
        for b in (10, 11, 15)
    ]
    striker = {"shape": "flat", "material": "alumina", "mass_g": 0.003618, "speed_rel_sigma": 0.02}
    content["runs"][0]["striker"] = {**striker, "speed_m_s": 4.0}
    return content


def test_a_chain_of_two_kinds_of_beads_is_followed_to_where_it_leaves_noise():
    """From the middle of the moduli's priors a fit ends at a χ² of 19,000 for 2,100 data."""
    forward = Forward(experiment(made(given=dimer())[0]))
    short = fit(forward, Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))
    assert short.objective > 5.0 * 2100
    # Three standard deviations of χ² from what noise leaves.
    assert nominal(forward).objective < 2100 + 3.0 * math.sqrt(2.0 * 2100)


def falling():
    """Glass and steel balls in turn under gravity, with gauges of 0.3 N noise."""
    content = block([0.4])
    pattern = [
        {"diameter_mm": 16, "mass_g": 5.362, "material": "glass"},
        {"diameter_mm": 10, "mass_g": 4.089, "material": "bearing-steel"},
    ]
    wall = {"material": "pmma"}
    content["chain"] = {"beads": 10, "orientation": "vertical", "wall": wall, "pattern": pattern}
    content["materials"] = {
        "glass": {"modulus_rel_sigma": 0.06},
        "bearing-steel": {"modulus_rel_sigma": 0.06},
    }
    for sensor in content["sensors"]:
        sensor["sigma_N"] = 0.3
    striker = {"shape": "sphere", "diameter_mm": 16, "mass_g": 5.36, "material": "glass"}
    content["runs"][0]["striker"] = {**striker, "speed_m_s": 0.4, "speed_rel_sigma": 0.02}
    return content


@pytest.mark.parametrize(("steps", "further"), [(3, True), (12, False)])
def test_an_effect_that_explains_nearly_all_is_followed_past_the_nearest_minima(steps, further):
    """A fit that ended at 2665 for 2,100 data, of 98,976 without the dashpot, goes on to noise and takes a
    rival along; one that leaves noise stays where it is.
    """
    hidden = [("linear-dashpot", {"damping_kg_s": 4.0})]
    forward = Forward(experiment(made(hidden, speeds=(0.4,), given=falling())[0]))
    null, setup = nominal(forward), setup_of(forward)
    start = np.zeros((1, forward.layout.size))

    def ended(name):
        effect = CATALOGUE.effect(name)
        law = Hypothesis((Component(effect, variants(effect, setup)[0]),))
        u = [[c.starts()[len(c.starts()) // 2] for c in law.coordinates]]
        one = fit(forward, law, np.array(u), start, None, 1, steps, finish=False)
        gain = null.objective - one.objective
        return Candidate(name, one, gain, log_bayes(one, gain, None))

    short = [ended("linear-dashpot"), ended("tsuji")]
    found = elsewhere.past_minima(forward, null, short)
    assert [c.effect for c in found] == ["linear-dashpot", "tsuji"]
    assert found[0].fit.objective < noise(forward)
    assert (short[0].fit.objective > noise(forward)) is further
    for before, after in zip(short, found, strict=True):
        assert (after.gain > before.gain + 100.0) is further  # χ² of 500 and of 1,100 in the first case
        assert after.gain == pytest.approx(null.objective - after.fit.objective)
