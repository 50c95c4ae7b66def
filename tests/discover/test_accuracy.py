"""Steps are as long as noise leaves unseen; where a chain errs by more than expected, they are cut."""

from dataclasses import replace

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover.model import accuracy
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.reader import parse

PRELOAD = {
    "format": 1,
    "title": "long",
    "chain": {
        "beads": 20,
        "orientation": "horizontal",
        "bead": {"diameter_mm": 9.525, "mass_g": 3.62, "material": "stainless-steel"},
        "wall": {"material": "stainless-steel"},
        "static_force_N": 40.0,
    },
    "sensors": [
        {"id": f"g{b}", "kind": "embedded", "bead": b, "sigma_N": 1.3, "gain_rel_sigma": 0.02}
        for b in (5, 12)
    ],
    "trigger_sigma_us": 0.5,
    "runs": [
        {
            "id": "strong",
            "striker": {
                "shape": "sphere",
                "material": "stainless-steel",
                "diameter_mm": 9.525,
                "mass_g": 3.62,
                "speed_m_s": 0.9,
                "speed_rel_sigma": 0.01,
            },
            "signals": "strong.csv",
        }
    ],
}


def _after_many_reflections(duration):
    """The predictor of a preloaded chain whose contacts open and close; its noise is of no account."""
    content, time = parse(PRELOAD), np.arange(0.0, duration, 1.0)

    def predictor(values):
        signals = Signals(time, dict(zip(("g5", "g12"), values, strict=True)))
        return Forward(experiment(Record(content, {"strong": signals}, "long")))

    silent = predictor(np.zeros((2, len(time))))
    (value,) = silent.sampled(Hypothesis(), np.zeros((1, 0)), np.zeros((1, silent.layout.size)))
    return predictor(1.3 * value[0].reshape(2, -1))


def _error(forward):
    """Distance of the nominal prediction from one of an eighth of the step, in standard errors."""
    fine = Forward(forward.experiment)
    fine._refine = 8.0 * forward._refine
    nu = np.zeros((1, forward.layout.size))
    seen = [f.sampled(Hypothesis(), np.zeros((1, 0)), nu) for f in (forward, fine)]
    one, other = (np.concatenate(runs, axis=1) for runs in seen)
    return float(np.linalg.norm(one - other))


def test_long_records_under_preload_are_simulated_with_shorter_steps():
    forward = _after_many_reflections(2500.0)
    expected = Forward(forward.experiment)
    expected._refine = accuracy.refinement(forward.norm)
    assert forward._refine >= 2.0 * expected._refine
    assert _error(expected) > 3.0 * accuracy.TOLERATED
    assert _error(forward) < accuracy.TOLERATED  # the last doubling is not measured again


@pytest.mark.parametrize(
    "predictor", [lambda: Forward(experiment(made()[0])), lambda: _after_many_reflections(400.0)]
)
def test_others_keep_the_steps_that_noise_asks_for(predictor):
    forward = predictor()
    assert forward._refine == accuracy.refinement(forward.norm)
    assert _error(forward) < accuracy.TOLERATED


def test_other_data_of_the_same_chains_are_not_held_against_shorter_steps_again():
    forward = _after_many_reflections(2500.0)
    other = forward.of(forward.experiment)
    assert other._refine == forward._refine
    assert other.simulations == 0 < forward.simulations


def test_steps_are_not_cut_where_what_is_left_hides_what_they_err_by():
    forward = _after_many_reflections(2500.0)
    other = Forward(replace(forward.experiment, approximate=True))
    assert other._refine == accuracy.refinement(forward.norm) < forward._refine
    assert _error(other) ** 2 < 0.05 * accuracy.HIDES * forward.experiment.size(
        0
    )  # a small part of what is left
