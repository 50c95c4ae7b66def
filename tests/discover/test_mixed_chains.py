"""Chains of several kinds of beads: their nominal model is followed past the nearest of many minima."""

import math

import numpy as np
from made_records import block, made

from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment


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
