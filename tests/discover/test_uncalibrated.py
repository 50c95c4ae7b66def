"""A rig as hospitals have them: one gauge in volts, nothing known of calibration, time zero and speed, a soft
wall. The gauge discharges, and that is found.
"""

from dataclasses import replace

import numpy as np
import pytest

from sonicvacuum.discover.forward import Forward
from sonicvacuum.discover.hypothesis import Hypothesis
from sonicvacuum.discover.problem import experiment
from sonicvacuum.discover.session import discover
from sonicvacuum.effects import effect
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.reader import parse

TAU, VOLTS, STIFFER, SHIFTS = 160.0, 3e-3, 1.3, (260.4, 231.7, 248.2)
SPEEDS = (0.22, 0.25, 0.24)
BALL = {"diameter_mm": 19.05, "mass_g": 28.21, "material": "ball"}


def rig(speeds, known: bool, modulus=0.45) -> dict:
    """Six balls on a foam under gravity, the third one a gauge with flat faces."""
    striker = {"shape": "sphere", **BALL, "speed_rel_sigma": 0.0 if known else 0.2}
    return {
        "format": 1,
        "title": "rig",
        "chain": {
            "beads": 6,
            "orientation": "vertical",
            "bead": BALL,
            "bodies": {3: {"mass_g": 29.85, "faces": "flat"}},
            "wall": {"material": "foam"},
        },
        "materials": {
            "ball": {"modulus_GPa": 200.0, "poisson": 0.29, "modulus_rel_sigma": 0.02},
            "foam": {"modulus_GPa": modulus, "poisson": 0.3, "modulus_rel_sigma": 0.5},
        },
        "sensors": [
            {"id": "g3", "kind": "embedded", "bead": 3, "gain_rel_sigma": 0.0 if known else "unknown"}
        ],
        "trigger_sigma_us": 0.0 if known else "unknown",
        "runs": [
            {"id": f"s{k}", "striker": {**striker, "speed_m_s": v}, "signals": f"s{k}.csv"}
            for k, v in enumerate(speeds)
        ],
    }


def measured(noise: float, seed: int = 1) -> Record:
    """Three shots with a hidden discharge, noise a share of the first peak, as the recorder gives them."""
    content = parse(rig(SPEEDS, True, 0.45 * STIFFER))
    time = np.arange(-100.0, 1900.0, 10.0)
    empty = {r.id: Signals(time, {"g3": np.zeros(len(time))}) for r in content.runs}
    truth = experiment(Record(content, empty, "truth"))
    forward = Forward(replace(truth, sigma=np.ones(1), correlation=np.zeros(1)))

    def droop(setup, _):
        return effect("sensor-droop").apply(setup, tau_us=np.full(setup.chain.lanes, TAU))

    nothing = np.zeros((1, forward.layout.size))
    found = forward.sampled(Hypothesis(), np.zeros((1, 0)), nothing, change=droop)
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    peak = max(float(value.max()) for value, _ in found)
    signals = {}
    for k, (run, (value, _)) in enumerate(zip(content.runs, found, strict=True)):
        noisy = value[0] + noise * peak * rng.normal(size=len(time))
        signals[run.id] = Signals(time + SHIFTS[k], {"g3": VOLTS * noisy})
    return Record(parse(rig([0.26] * len(SPEEDS), False)), signals, "rig")


@pytest.fixture(scope="module")
def found():
    """The verdict on a noisy record."""
    return discover(measured(0.03), threads=1)


def test_the_discharge_is_named_with_its_time(found):
    assert found.verdict.named == ["sensor-droop"]
    tau = found.verdict.parameters["sensor-droop"]["tau_us"]
    assert tau.value == pytest.approx(TAU, abs=3.0 * tau.sigma) and tau.sigma < 0.15 * TAU


def test_the_gap_closes_on_runs_left_out(found):
    assert found.verdict.gap.held_out.closed > 0.9


def test_wall_gain_time_zero_and_speeds_are_found(found):
    known = found.verdict.nuisances
    wall = known["modulus foam"]
    assert wall.value == pytest.approx(STIFFER, rel=3.0 * wall.sigma) and wall.sigma < 0.3
    gain = known["gain g3"]
    assert gain.value == pytest.approx(VOLTS, rel=3.0 * gain.sigma) and gain.prior is None
    final, forward = found.found.final, found.found.forward
    speeds = 0.26 * np.exp(final.nu[:3] * 0.2)
    np.testing.assert_allclose(speeds, SPEEDS, rtol=3.0 * gain.sigma)
    shifts = [
        r.shift + final.nu[3 + k] * forward.experiment.trigger_sigma
        for k, r in enumerate(forward.experiment.runs)
    ]
    np.testing.assert_allclose(1e6 * np.array(shifts), SHIFTS, atol=10.0)  # one sample
