"""A recorder whose steps outweigh the noise, eight bits over a range far above the pulse, misleads nobody."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest
from made_records import SIGMA, made

from sonicvacuum.discover import session
from sonicvacuum.discover.faults.changes import delayed
from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.model.masks import repeated
from sonicvacuum.discover.model.noise import noise, stepped
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.model.window import fitted
from sonicvacuum.records import Signals

# Step of the recorder over the noise.
STEP = 8.0


def coarse(effects=(), step=STEP, stated=True, seed=5):
    """A made record as such a recorder has it; the noise that is stated, if any, does not count the steps."""
    record, _ = made(effects, seed=seed)
    lsb = {g.id: step * g.sigma for g in record.gauges}
    signals = {
        run: Signals(s.time_us, {g: lsb[g] * np.round(v / lsb[g]) for g, v in s.readings.items()})
        for run, s in record.signals.items()
    }
    if not stated:
        sensors = [msgspec.structs.replace(s, sigma_N=msgspec.UNSET) for s in record.block.sensors]
        record = replace(record, block=msgspec.structs.replace(record.block, sensors=sensors))
    return replace(record, signals=signals)


def lsb(values, step=STEP * SIGMA):
    """In steps of the recorder."""
    return step * np.round(values / step)


def begun(record, first):
    """The same as if the recorder had started later, with no rest before the pulse."""
    late = {
        run: Signals(s.time_us[first:], {g: v[first:] for g, v in s.readings.items()})
        for run, s in record.signals.items()
    }
    return replace(record, signals=late)


def test_of_readings_on_one_step_one_counts():
    trace = np.array([0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 4, 7, 7, 9, 12, 12, 12, 12, 12, 10, 8, 6, 5], dtype=float)
    counted = np.flatnonzero(~repeated(trace))
    # Of the first nine, one of which noise lifts, and of the five at the top, the middle one; slopes whole.
    np.testing.assert_array_equal(counted, [5, 9, 10, 11, 12, 13, 16, 19, 20, 21, 22])


def test_a_slope_of_many_steps_is_left_whole():
    assert not repeated(np.arange(50.0)).any()


@pytest.mark.parametrize("stated", [True, False])
def test_noise_holds_the_steps(stated):
    record = coarse(stated=stated)
    sigma, _ = noise([record])
    # At rest nothing is seen where noise is an eighth of a step: what is not stated is the rounding alone.
    exact = SIGMA * np.hypot(1.0 if stated else 0.0, STEP / np.sqrt(12.0))
    assert sigma[0] == pytest.approx(exact, rel=1e-3)  # the model's own error is added
    trace = record.signals["v1"].readings["g4"]
    assert stepped(trace, sigma[0])
    assert not stepped(made()[0].signals["v1"].readings["g4"], SIGMA)


@pytest.mark.parametrize("step", [3.0, 5.0, STEP])
def test_a_reading_of_the_next_step_is_no_spike(step):
    assert examine(coarse(step=step, stated=False))[1] == []


@pytest.mark.parametrize("stated", [True, False])
@pytest.mark.parametrize("change", [lambda r: delayed(r, "g7", 7.3), lambda r: begun(r, 120), lambda r: r])
def test_what_is_done_to_traces_hides_no_steps(stated, change):
    plain = fitted(coarse(stated=stated))[0]
    assert plain.steps == pytest.approx({"g4": STEP * SIGMA, "g7": STEP * SIGMA, "wall": 2.0 * STEP * SIGMA})
    sigma, _ = noise([change(plain)])
    np.testing.assert_array_less(0.99 * STEP / np.sqrt(12.0) * np.array([SIGMA, SIGMA, 2.0 * SIGMA]), sigma)
    counted = experiment(change(plain)).runs[1].present
    assert counted[1, :40].sum() <= 3  # at rest; a shift leaves an edge beside


def test_fine_steps_are_no_property_of_a_record():
    record, _ = made()
    assert fitted(record)[0] is record


def test_a_drift_within_a_step_is_neither_told_nor_noise():
    slope = np.linspace(0.0, 60.0 * SIGMA, 700)
    record = coarse()
    tilted = {
        run: Signals(s.time_us, s.readings | {"g7": lsb(s.readings["g7"] + slope)})
        for run, s in record.signals.items()
    }
    assert examine(replace(record, signals=tilted))[1] == []


def test_only_what_rests_is_left_out():
    run = experiment(coarse()).runs[1]
    assert run.present is not None
    peak = int(run.readings[0].argmax())
    assert run.present[0][peak - 12 : peak - 4].mean() > 0.7  # the front of the pulse
    assert run.present[0][:40].sum() <= 2  # at rest


@pytest.mark.parametrize(
    ("effects", "named"), [((), []), ((("viscous-drag", {"rate_per_s": 900.0}),), ["viscous-drag"])]
)
def test_verdicts_hold(effects, named):
    found = session.discover(coarse(effects), threads=1, limits=False).verdict
    assert found.named == named
    assert found.faults == []
