"""Speeds of waves of amplitudes that a gauge reads: its gain makes them other forces."""

import numpy as np
import pytest
from made_records import block

from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse

GAUGE, GAIN = "g4", 0.05


def told(amplitudes, static_force=0.0) -> Forward:
    """Predictor of a table of speeds over amplitudes, of one other number too."""
    content = block((0.3,))
    content["chain"]["static_force_N"] = static_force
    table = [
        {
            "quantity": "speed_at_amplitude",
            "amplitude_N": float(a),
            "sensor": GAUGE,
            "value": 500.0,
            "sigma": 5.0,
        }
        for a in amplitudes
    ]
    (run,) = content["runs"]
    del run["signals"]
    peak = {"quantity": "amplitude", "sensor": GAUGE, "value": 10.0, "sigma": 0.1, "unit": "N"}
    run["observables"] = [peak, *({**one, "unit": "m/s"} for one in table)]
    for sensor in content["sensors"]:
        del sensor["sigma_N"]
        sensor["gain_rel_sigma"] = GAIN
    return Forward(experiment(Record(parse(content), {}, "wave-speeds")))


def at_gain(forward, errors) -> np.ndarray:
    """(1, q) nuisances in which the gauge's gain is off by so many standard errors."""
    nu = np.zeros((1, forward.layout.size))
    nu[0, forward.layout.gains[[g.id for g in forward.experiment.gauges].index(GAUGE)]] = errors
    return nu


def speeds(forward, errors=0.0) -> np.ndarray:
    """Whitened predictions of the table."""
    return forward.sampled(Hypothesis(), np.zeros((1, 0)), at_gain(forward, errors))[0][0, 1:]


def test_an_amplitude_that_a_gauge_of_a_larger_gain_reads_is_a_smaller_force():
    amplitudes, errors = np.array([1.0, 4.0, 20.0]), 3.0
    found = speeds(told(amplitudes), errors)
    # Curves through other strikes: a few parts in 1e4.
    assert found == pytest.approx(speeds(told(amplitudes / np.exp(errors * GAIN))), rel=5e-4)
    assert found[0] < 0.99 * speeds(told(amplitudes))[0]


@pytest.mark.parametrize("static_force", [0.0, 20.0])
@pytest.mark.parametrize("amplitudes", [[0.5, 2.0, 6.0, 20.0, 60.0], [2.0, 20.0]])
def test_slopes_to_a_gain_are_those_of_the_curve(static_force, amplitudes):
    """Under a static force weak waves are sound: what force they are does not matter."""
    forward = told(amplitudes, static_force)
    column = forward.columns(Hypothesis(), np.zeros((1, 0)), at_gain(forward, 0.0))[0][0]
    place = 1 + np.flatnonzero(forward.local(0) == np.flatnonzero(at_gain(forward, 1.0)[0])[0])[0]
    difference = 0.5 * (speeds(forward, 1.0) - speeds(forward, -1.0))
    # A curve that bends once, and one of two amplitudes that does not, beside the sixth of a Hertz chain.
    near = 0.03 if len(amplitudes) > 2 else 0.06
    assert column[place, 1:] / speeds(forward) == pytest.approx(difference / speeds(forward), abs=near * GAIN)
    if static_force:
        assert abs(difference[0]) < 0.3 * GAIN / 6.0 * speeds(forward)[0]


@pytest.mark.parametrize("amplitudes", [[5.0], [5.0, 5.2]])
def test_amplitudes_that_show_no_slope_have_that_of_a_hertz_chain(amplitudes):
    forward = told(amplitudes)
    column = forward.columns(Hypothesis(), np.zeros((1, 0)), at_gain(forward, 0.0))[0][0]
    place = 1 + np.flatnonzero(forward.local(0) == np.flatnonzero(at_gain(forward, 1.0)[0])[0])[0]
    assert column[place, 1:] == pytest.approx(
        -GAIN / 6.0 * speeds(forward), rel=1e-3
    )  # of chains side by side
