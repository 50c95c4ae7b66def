"""The full motion and the terms made of it, against the record that was hidden and against Newton's law."""

import json
from dataclasses import replace

import numpy as np
import pytest

from sonicvacuum import records
from sonicvacuum_blind.baselines import motion as motions
from sonicvacuum_blind.baselines import terms
from sonicvacuum_blind.gauges import read
from sonicvacuum_blind.hide import Spec, write

SEED = 11


@pytest.fixture(scope="module")
def hidden(tmp_path_factory):
    """(record, truth) of a chain with a viscoelastic contact, white noise."""
    folder = tmp_path_factory.mktemp("hidden")
    spec = Spec("x", "single", "one-speed", "white", ("linear-dashpot",), 20.0, SEED, 0)
    write(spec, folder / "records", folder / "truth")
    truth = json.loads((folder / "truth" / "x" / "truth.json").read_text())
    return records.read(folder / "records" / "x"), truth


def test_true_plan_gives_the_record_up_to_its_noise(hidden):
    record, truth = hidden
    run, errors = record.runs[0], truth["errors_sigma"]
    plan = motions.true_plan(record, run, truth)
    time = run.signals.time_us * 1e-6 - record.trigger_sigma_s * errors["triggers"][0]
    for gauge, clean, error in zip(record.gauges, read(plan, time), errors["gains"], strict=True):
        rest = run.signals.readings[gauge.id] - (1.0 + gauge.gain_rel_sigma * error) * clean
        # 480 samples of unit variance: standard error of their mean square 0.065; five of them.
        assert np.mean((rest / gauge.sigma) ** 2) == pytest.approx(1.0, abs=0.33)


def test_an_effect_beside_one_from_outside_is_in_the_motion_with_it(hidden):
    record, truth = hidden
    outside = {"id": "dimer", "parameters": {"contrast": 0.05}}
    both = truth | {"kind": "beside", "hidden": [*truth["hidden"], outside]}
    alone, beside = (motions.true_plan(record, record.runs[0], one) for one in (truth, both))
    assert dict(beside.mass_ratios)[2] == pytest.approx(1.05)
    assert replace(beside, mass_ratios=alone.mass_ratios) == alone


def test_terms_with_their_true_coefficients_are_the_acceleration(hidden):
    """m u'' = F_{i−1} − F_i + m g with the Hertz term of the true modulus and the dashpot's constant."""
    record, truth = hidden
    found = motions.motion(record, record.runs[0], truth, tolerance=1e-10)
    made = terms.bead_terms(found.compression, found.rate, found.velocity, found)
    names = list(terms.EFFECTS)
    true = motions.true_plan(record, record.runs[0], truth)
    coefficients = np.zeros(len(names))
    coefficients[names.index("hertz")] = true.modulus_ratio
    coefficients[names.index("dashpot")] = truth["hidden"][0]["parameters"]["damping_kg_s"]
    velocity, weight = found.velocity[:, 2 : record.beads], found.plan.gravity
    step = found.time[1] - found.time[0]
    gained = velocity[2:] - velocity[:-2]
    left = gained - simpson(made @ coefficients + weight, step)
    without = gained - simpson(made[:, :, 0] * true.modulus_ratio + weight, step)
    # Simpson's rule, some twenty samples a pulse; where a contact opens, damping would pull, and may not.
    assert np.std(left) < 2e-3 * np.std(gained)
    assert np.std(left) < 0.2 * np.std(without)


def simpson(values, step):
    """Integrals over two steps each, along the first axis."""
    return step / 3.0 * (values[:-2] + 4.0 * values[1:-1] + values[2:])


def test_every_term_stands_for_an_effect_of_the_catalogue():
    from sonicvacuum.effects import IDS

    assert set(terms.EXPRESSIBLE) <= set(IDS)
    assert len(terms.EXPRESSIBLE) == 13


def test_noise_level_is_that_of_the_gauges(hidden):
    record, _ = hidden
    # Designs draw 0.6 to 1.5 % of the peak; the largest of 480 noisy samples is a little above it.
    assert 0.004 < motions.noise_level(record) < 0.018
