"""One gauge that reads otherwise in one run, as where a range was set for a shot: `unknown`, after minutes,
before.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from made_records import DAMPING, SIGMA, made
from made_slips import altered, unstated

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes, gains
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.faults.judged import Model
from sonicvacuum.discover.faults.searching import _sized_anew
from sonicvacuum.discover.faults.slips import Slip
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.report.bench import slip

SPEEDS = (0.3, 0.5, 0.9)


@pytest.fixture(scope="module")
def sound():
    """Three speeds."""
    return made(seed=12, speeds=SPEEDS)[0]


def asked(record):
    """What is asked of a record: (run, gauge, value), None where its trace is left out."""
    found = gains.gains_of_one(record, predicted(experiment(record)))
    return [(s.run, s.sensor, None if s.continuous else s.value(0.0)) for s in found]


def told(record):
    """Slips that are sure, what is named, and the slips in words."""
    v = session.discover(record).verdict
    sure = [f for f in v.faults if f.probability > 0.9]
    return [(f.fault, f.run, f.sensor, f.value) for f in sure], v.named, [slip(f) for f in sure]


def test_nothing_is_asked_of_traces_of_the_same_gain(sound):
    assert asked(sound) == []
    # A gauge of another gain in all runs is an effect's, and so are all gauges of a run.
    everywhere = sound
    for run in sound.signals:
        everywhere = changes.trace_scaled(everywhere, run, "g7", 10.0)
    assert asked(everywhere) == []
    whole = sound
    for gauge in ("g4", "g7", "wall"):
        whole = changes.trace_scaled(whole, "v1", gauge, 0.5)
    assert asked(whole) == []
    # Nearer to none than to a step of two.
    assert asked(changes.trace_scaled(sound, "v1", "g7", 1.3)) == []


def test_it_is_told_where_noise_is_not_stated(sound):
    """It ended in a division by 0."""
    off = unstated(changes.trace_scaled(sound, "v0", "wall", 2.0))
    assert [at[:2] for at in asked(off)] == [("v0", "wall")] * 2
    ((fault, *where, value),), named, _ = told(off)
    assert (fault, where, named) == ("gain-common", ["v0", "wall"], [])
    assert value == pytest.approx(2.0, rel=0.01)  # its noise hardly tells the step from the height


@pytest.mark.parametrize(
    ("run", "gauge", "ratio"), [("v2", "g7", 0.1), ("v0", "wall", 2.0), ("v1", "g4", 5.0)]
)
def test_the_step_of_a_range_is_told(sound, run, gauge, ratio):
    off = changes.trace_scaled(sound, run, gauge, ratio)
    (plain, height) = asked(off)
    assert plain == (run, gauge, pytest.approx(ratio))
    assert height == (run, gauge, pytest.approx(ratio, rel=0.2))
    ((fault, *where, value),), named, (said,) = told(off)
    assert (fault, where, named) == ("gain-common", [run, gauge], [])
    assert value == pytest.approx(ratio)
    assert said == f"gauge {gauge} reads {value:.4g} times the force in run {run}"


@pytest.mark.long
def test_any_factor_is_told_beside_the_effect():
    damped = made([("kuwabara-kono", {"time_us": DAMPING})], seed=12, speeds=SPEEDS)[0]
    found, named, _ = told(changes.trace_scaled(damped, "v1", "g7", 3.3))
    assert named == ["kuwabara-kono"]
    assert found == [("gain-common", "v1", "g7", pytest.approx(3.3, rel=0.03))]


def test_a_trace_that_is_too_noisy_to_be_put_right_is_left_out(sound):
    rng = np.random.default_rng(3)
    low = altered(sound, "g7", lambda v: 0.1 * v + SIGMA * rng.normal(size=len(v)), "v2")
    assert asked(low) == [("v2", "g7", None)]
    ((fault, *where, value),), named, _ = told(low)
    assert (fault, where, named) == ("gain-common", ["v2", "g7"], [])
    assert value == pytest.approx(0.1, rel=0.1)


def test_a_factor_that_heights_told_is_asked_for_once_more(sound):
    wrong = changes.trace_scaled(sound, "v1", "g7", 1.05)
    forward = Forward(experiment(wrong))
    model = Model(Bench(wrong), forward, nominal(forward))
    given = {"run": "v1", "sensor": "g7", "corrected": True}
    (again,) = gains.rough_gains([Finding("gauge-gain", value=3.1, **given)], model)
    # The gauge's own gain has followed a third of it.
    assert again.value(0.0) == pytest.approx(1.035, abs=0.015)
    # A step of a range is exact.
    assert gains.rough_gains([Finding("gauge-gain", value=0.2, **given)], model) == []
    gone = changes.trace_scaled(sound, "v1", "g7", 0.0)
    assert "g7" not in gone.signals["v1"].readings
    left = Model(Bench(gone), forward, model.fit)
    assert gains.rough_gains([Finding("gauge-gain", value=3.1, **given)], left) == []


def test_noise_that_becomes_less_is_no_gain(sound):
    along, alone = (changes.trace_scaled(sound, "v2", "g7", r) for r in (10.0, 1.0))
    plain = gains.gains_of_one(along, predicted(experiment(along)))[0]
    assert plain.occam == 0.0
    samples = sound.signals["v2"].samples
    one = gains._by(alone, "v2", "g7", np.log(10.0))
    assert one.occam == pytest.approx(-0.5 * samples, rel=0.05)


def test_noise_tells_nothing_of_a_factor_beside_a_step(sound):
    doubled = changes.trace_scaled(sound, "v2", "g7", 2.0)
    samples = sound.signals["v2"].samples
    more, less = (gains._price(doubled, "v2", "g7", np.log(2.0) + sign * 0.2) for sign in (1.0, -1.0))
    # Over 2.44 the noise of so many samples has a third less of χ² than over 2, over 1.64 half more.
    square = gains._noise(doubled, "v2", "g7", np.log(2.0)) ** 2
    assert more - less == pytest.approx(-0.5 * samples * square * (np.exp(0.4) - np.exp(-0.4)), rel=0.01)


@pytest.mark.parametrize(
    ("fault", "told", "more", "put"), [("gauge-gain", 3.2, 1.03, 3.296), ("time-zero", 31.0, 3.5, 34.5)]
)
def test_what_is_asked_for_once_more_is_told_with_what_was_said(fault, told, more, put):
    """A factor times the other, whether steps or heights tell it; a time added."""
    said = Finding(fault, value=told, run="v1", corrected=True)
    again = SimpleNamespace(slip=Slip(fault, None, "v1", value=lambda size: more), size=0.0)
    assert _sized_anew(said, again).value == pytest.approx(put)
    other = SimpleNamespace(slip=Slip(fault, None, "v2", value=lambda size: more), size=0.0)
    assert _sized_anew(said, other) is said
