"""Records of real laboratories: gauges of every kind, unknown errors, runs that lack a gauge."""

import math
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from record_cases import CONTENT, SCALARS, content, made, put

from sonicvacuum.files import InputError
from sonicvacuum.records import Record, Signals, read, signals, write
from sonicvacuum.records.checks import warnings
from sonicvacuum.records.commands import summary
from sonicvacuum.records.predict import predict
from sonicvacuum.records.reader import parse
from sonicvacuum.records.record import Tolerances
from sonicvacuum.records.review import review

LASER = {"id": "laser", "kind": "velocity", "bead": 5, "sigma_m_s": 0.002, "gain_rel_sigma": "unknown"}
BALL = {"id": "ball", "kind": "acceleration", "bead": 7, "sigma_m_s2": 40.0, "drift_sigma_m_s2": 2.0}
WALL = CONTENT["sensors"][2] | {"delay_sigma_us": 0.4, "baseline_sigma_N": 0.01}
MIXED = content(sensors=[LASER, BALL, WALL], runs__1__observables=[])
LABORATORY = {
    "trigger_sigma_us": "unknown",
    "clock_rel_sigma": 1e-5,
    "tolerances": {"bead_mass_rel": 0.0, "speed_common_rel": 0.01},
    "model_floor_rel": 0.01,
    "priors": {"coating-thickness": 10.0, "gravity": 0},
}
TIME = np.arange(-20.0, 180.0, 0.5)


def simulated(base=MIXED):
    """A record with the nominal readings of its gauges."""
    block = parse(base)
    ids = [s.id for s in block.sensors]
    empty = {r.id: Signals(TIME, {i: np.zeros(len(TIME)) for i in ids}) for r in block.runs}
    shown = predict(Record(block, empty))
    return Record(
        block, {r.id: Signals(TIME, dict(p.readings)) for r, p in zip(block.runs, shown, strict=True)}
    )


def test_gauges_of_every_kind_and_their_errors_in_si_units():
    laser, ball, wall = simulated().gauges
    assert (laser.kind, laser.bead, laser.sigma, laser.unit) == ("velocity", 5, 0.002, "m/s")
    assert not laser.calibrated
    assert laser.gain_rel_sigma == math.inf
    assert laser.log_gain_sigma == math.log(1e3)
    assert (ball.sigma, ball.drift_sigma, ball.unit) == (40.0, 2.0, "m/s2")
    assert (wall.sigma, wall.delay_sigma_s, wall.baseline_sigma) == (0.1, 0.4 / 1e6, 0.01)
    assert wall.log_gain_sigma == wall.gain_rel_sigma == 0.02


def test_what_a_laboratory_knows_is_on_the_record():
    record = Record(parse(content(**LABORATORY)))
    assert record.trigger_sigma_s == math.inf
    assert record.clock_rel_sigma == 1e-5
    assert record.tolerances == Tolerances(bead_mass_rel=0.0, speed_common_rel=0.01)
    assert record.model_floor_rel == 0.01
    assert record.priors == {"coating-thickness": 10.0, "gravity": 0.0}
    silent = Record(parse(content()))
    assert silent.tolerances == Tolerances()
    assert (silent.model_floor_rel, silent.priors, silent.clock_rel_sigma) == (None, {}, 0.0)


def test_an_unknown_time_zero_lies_within_a_tenth_of_the_trace():
    record = simulated(MIXED | {"trigger_sigma_us": "unknown"})
    assert record.trigger_width_s == pytest.approx(20e-6)


def test_a_mixed_record_reads_back_to_the_byte(tmp_path):
    record = simulated(MIXED | LABORATORY)
    write(record, tmp_path / "first")
    again = read(tmp_path / "first")
    assert again.block == record.block
    assert all(again.signals[r].equals(t) for r, t in record.signals.items())
    write(again, tmp_path / "second")
    for file in (tmp_path / "first").iterdir():
        assert (tmp_path / "second" / file.name).read_bytes() == file.read_bytes()


def test_what_is_not_said_is_not_written(tmp_path):
    write(made(), tmp_path)
    text = (tmp_path / "record.yaml").read_text()
    for key in ("kind: velocity", "tolerances", "priors", "clock", "delay", "baseline", "sigma_m_s"):
        assert key not in text


def test_check_and_summary_know_the_units():
    record = simulated()
    text = summary(record, review(record))
    assert "laser: peak 0." in text
    assert " m/s, " in text
    assert "ball: peak" in text
    assert "m/s2, " in text
    assert not [w for w in warnings(record) if "laser" in w and "sign" in w]


def test_a_run_may_lack_a_gauge_and_have_its_own_times(tmp_path):
    folder = put(tmp_path)
    lines = (folder / "slow.csv").read_text().splitlines()
    rows = [lines[0], *lines[1::2]]
    (folder / "slow.csv").write_text("\n".join(",".join(r.split(",")[:3]) for r in rows) + "\n")
    record = read(folder)
    assert list(record.signals["slow"].readings) == ["near", "far"]
    assert list(record.signals["fast"].readings) == ["near", "far", "wall"]
    assert record.signals["slow"].interval_s == pytest.approx(2.0 * record.signals["fast"].interval_s)
    assert "wall: not recorded in this run" in summary(record, review(record))
    write(record, tmp_path / "again")
    assert read(tmp_path / "again").signals["slow"].equals(record.signals["slow"])


names = st.lists(st.sampled_from(["near", "far", "wall", "laser"]), min_size=1, max_size=4, unique=True)
numbers = st.floats(-1e300, 1e300, allow_nan=False, allow_subnormal=True)


@given(
    present=names,
    start=st.floats(-1e3, 1e3),
    interval=st.floats(1e-3, 10.0),
    samples=st.integers(16, 40),
    data=st.data(),
)
@settings(max_examples=60)
def test_any_choice_of_columns_and_sampling_reads_back(present, start, interval, samples, data):
    time = start + interval * np.arange(samples)
    column = st.lists(numbers, min_size=samples, max_size=samples)
    trace = Signals(time, {n: np.array(data.draw(column)) for n in present})
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "x.csv"
        signals.write(trace, path)
        assert signals.read(path, ["laser", "wall", "far", "near"]).equals(trace)
        missing = next((n for n in present if n in ("near", "far")), None)
        if missing:
            with pytest.raises(InputError, match=f"{missing!r} is no sensor of this record"):
                signals.read(path, ["laser", "wall"])


@pytest.mark.parametrize(
    ("changes", "parts"),
    [
        ({"sensors__0__kind": "laser"}, ["sensors[0].kind", "'laser'", "embedded or wall or velocity"]),
        ({"sensors__0__sigma_m_s": 0.1}, ["sensors[0].sigma_m_s", "embedded reads N", "sigma_N"]),
        ({"sensors__0__baseline_sigma_m_s2": 0.1}, ["baseline_sigma_m_s2", "give baseline_sigma_N"]),
        ({"sensors__0": LASER | {"bead": 11}}, ["sensors[0].bead", "10 beads"]),
        ({"sensors__0": {"id": "near", "kind": "velocity"}}, ["sensors[0].bead", "velocity sensor needs"]),
        ({"sensors__0__gain_rel_sigma": "known"}, ["sensors[0].gain_rel_sigma", "'known'"]),
        ({"sensors__0__gain_rel_sigma": -0.1}, ["sensors[0].gain_rel_sigma"]),
        ({"sensors__0__delay_sigma_us": 1e6}, ["sensors[0].delay_sigma_us", "us"]),
        ({"trigger_sigma_us": "about 3"}, ["trigger_sigma_us", "'about 3'"]),
        ({"clock_rel_sigma": 50.0}, ["clock_rel_sigma", "ppm"]),
        ({"tolerances": {"bead_colour": 0.1}}, ["tolerances.bead_colour", "unknown key"]),
        ({"tolerances": {"bead_mass_rel": 2.0}}, ["tolerances.bead_mass_rel", "%"]),
        ({"model_floor_rel": 3.0}, ["model_floor_rel", "%"]),
        ({"priors": {"gravity": -1.0}}, ["priors"]),
    ],
)
def test_what_is_wrong_is_said(changes, parts):
    with pytest.raises(InputError) as error:
        parse(content(**changes))
    for part in parts:
        assert part in str(error.value)


@pytest.mark.parametrize(
    ("sensor", "entry", "parts"),
    [
        ("laser", {"quantity": "amplitude", "unit": "N"}, [".unit", "reads m/s"]),
        ("wall", {"quantity": "amplitude", "unit": "m/s"}, [".unit", "reads N"]),
        (
            "laser",
            {"quantity": "speed_at_amplitude", "amplitude_N": 2.0, "unit": "m/s"},
            ["reads m/s, not N"],
        ),
        ("laser", {"quantity": "echo_delay", "unit": "ms"}, ["given in us"]),
    ],
)
def test_units_of_observables_are_those_of_their_gauges(sensor, entry, parts):
    entry = {"sensor": sensor, "value": 400.0, "sigma": 1.0} | entry
    with pytest.raises(InputError) as error:
        parse(MIXED | {"runs": [MIXED["runs"][0] | {"observables": [entry]}]})
    for part in parts:
        assert part in str(error.value)


def test_a_decay_needs_two_gauges_of_one_unit():
    entry = SCALARS[5] | {"from": "laser", "to": "ball"}
    with pytest.raises(InputError, match="reads m/s2, while 'laser' reads m/s"):
        parse(MIXED | {"runs": [MIXED["runs"][0] | {"observables": [entry]}]})


def test_observables_of_motion_gauges_are_predicted():
    entries = [
        {"quantity": "amplitude", "sensor": "laser", "value": 0.2, "sigma": 0.01, "unit": "m/s"},
        {"quantity": "amplitude", "sensor": "ball", "value": 2e4, "sigma": 1e3, "unit": "m/s2"},
        {"quantity": "duration", "sensor": "laser", "level": 0.1, "value": 30.0, "sigma": 1.0, "unit": "us"},
        {"quantity": "speed", "from": "laser", "to": "wall", "value": 580.0, "sigma": 5.0, "unit": "m/s"},
        {"quantity": "echo_delay", "sensor": "laser", "value": 90.0, "sigma": 1.0, "unit": "us"},
        {"quantity": "echo_ratio", "sensor": "laser", "value": 0.9, "sigma": 0.1, "unit": "1"},
    ]
    runs = [MIXED["runs"][1] | {"signals": None, "observables": entries}]
    (shown,) = predict(
        Record(parse(MIXED | {"runs": [{k: v for k, v in r.items() if v is not None} for r in runs]}))
    )
    values = [o.value for o in shown.observables]
    assert all(o.known for o in shown.observables), shown.observables
    amplitude, _, _, speed, delay, ratio = values
    assert 0.05 < amplitude < 0.44  # slower than the striker
    # There and back from bead 5 to the wall, 5.5 diameters, within a diameter (see the tests of the echo).
    assert delay * speed / 4.76e-3 == pytest.approx(11.0, abs=1.5)
    assert 0.5 < ratio < 1.1
