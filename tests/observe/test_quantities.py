"""The list of quantities on runs made of known pulses that travel to the wall and back at one speed."""

import inspect
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pulse_shapes import DIAMETER, SPEED, chain_run, gauges, pulse, pulse_duration

from sonicvacuum.gauges import Gauge
from sonicvacuum.observe.quantities import QUANTITIES, measure, measure_run
from sonicvacuum.observe.run import Geometry, Run
from sonicvacuum.observe.trace import Measured

# Pulses are sampled 39 times per half-height width: peaks are found to 3e-7 of it, crossings to 2e-6.
CLOSE = 1e-5
ON_RUN = [name for name, entry in QUANTITIES.items() if entry.over == "run"]
PAPER = gauges(13, 17)


NAMES = {"from": "b13", "to": "b17", "sensor": "b13"}


def requests(name):
    """What a request for the quantity names, between the two gauges of the paper."""
    return {need: NAMES[need] for need in QUANTITIES[name].needs}


@pytest.fixture(scope="module")
def paper_run():
    time, readings = chain_run(PAPER)
    return Run(readings, time, PAPER)


def test_speed_amplitude_and_arrival_are_those_of_the_pulse(paper_run):
    assert measure_run("speed", paper_run, from_="b13", to="b17").value == pytest.approx(SPEED, rel=CLOSE)
    assert measure_run("speed", paper_run, from_="b17", to="wall").value == pytest.approx(SPEED, rel=CLOSE)
    assert measure_run("speed", paper_run, from_="wall", to="b13").value == pytest.approx(SPEED, rel=CLOSE)
    assert measure_run("amplitude", paper_run, sensor="b13").value == pytest.approx(4.8, rel=CLOSE)
    arrival = 5e-4 - 8.5 * DIAMETER / SPEED
    assert measure_run("arrival", paper_run, sensor="b13").value == pytest.approx(arrival, abs=1e-9)
    assert measure_run("amplitude", paper_run, sensor="wall").value == pytest.approx(9.6, rel=CLOSE)


def test_durations_and_widths_are_those_of_the_pulse(paper_run):
    ask = {"from_": "b13", "to": "b17", "sensor": "b17"}
    for level in (0.01, 0.1, 0.5):
        lasting = measure_run("duration", paper_run, sensor="b17", level=level)
        assert lasting.value == pytest.approx(pulse_duration(level), rel=CLOSE)
        width = measure_run("width", paper_run, level=level, **ask)
        assert width.value == pytest.approx(pulse_duration(level) * SPEED / DIAMETER, rel=2 * CLOSE)
    half = measure_run("duration_half", paper_run, sensor="b17")
    assert half == measure_run("duration", paper_run, sensor="b17", level=0.5)
    assert measure_run("width_half", paper_run, **ask) == measure_run("width", paper_run, level=0.5, **ask)
    onset = measure_run("onset", paper_run, sensor="b17", level=0.1).value
    arrival = measure_run("arrival", paper_run, sensor="b17").value
    assert arrival - onset == pytest.approx(pulse_duration(0.1) / 2, rel=2 * CLOSE)  # a symmetric pulse
    assert measure_run("asymmetry", paper_run, sensor="b17").value == pytest.approx(0.0, abs=CLOSE)


def test_decay_is_the_later_amplitude_over_the_earlier():
    time, readings = chain_run(PAPER, decay=12.0)
    decay = measure("decay", readings, time, PAPER, from_="b13", to="b17")
    assert decay.value == pytest.approx(math.exp(-12.0 * 4 * DIAMETER), rel=CLOSE)


def test_reflection_is_not_counted_and_not_taken_for_the_main_pulse():
    # It is half as high again as the pulse itself, and the train's second pulse still comes before it.
    time, readings = chain_run(PAPER, train=((0.0, 4.8), (2.5e-4, 1.6)), reflected=1.5)
    assert readings["b13"].max() > 7.0
    run = Run(readings, time, PAPER)
    assert run.main("b13").force == pytest.approx(4.8, rel=CLOSE)
    assert measure_run("pulse_count", run, sensor="b13").value == 2.0
    assert measure_run("pulse_count", run, sensor="b13", threshold=0.5).value == 1.0
    assert measure_run("extra_pulse_fraction", run, sensor="b13").value == pytest.approx(1 / 3, rel=CLOSE)
    assert measure_run("valley_depth", run, sensor="b13").value > 0.99
    # Nearer to the wall the second pulse comes with the reflection of the first.
    assert measure_run("pulse_count", run, sensor="b17").value == 1.0
    assert measure_run("valley_depth", run, sensor="b17").value == 0.0


def test_reflection_time_from_the_wall_or_from_another_gauge(paper_run):
    exact = 5e-4 + 8.5 * DIAMETER / SPEED
    assert paper_run.reflection_time("b13").value == pytest.approx(exact, abs=1e-9)
    start = paper_run.main("b13").time
    assert paper_run.free_until("b13") == pytest.approx(start + 0.9 * (exact - start), abs=1e-9)
    # At the wall: back from the top of 21 beads.
    top = 5e-4 + 2 * 21 * DIAMETER / SPEED
    assert paper_run.reflection_time("wall").value == pytest.approx(top, abs=1e-8)
    embedded = Geometry(21, DIAMETER, PAPER.sensors[:2])
    without = Run(paper_run.readings, paper_run.time, embedded)
    assert without.reflection_time("b13").value == pytest.approx(exact, abs=1e-8)


def test_without_a_second_gauge_the_whole_record_counts():
    alone = gauges(13)
    time, readings = chain_run(alone)
    del readings["wall"]
    run = Run(readings, time, alone)
    assert run.reflection_time("b13").reason.startswith("unknown")
    assert run.free_until("b13") == math.inf
    assert measure_run("pulse_count", run, sensor="b13").value == 2.0


def test_gauge_that_the_reflection_overlaps_gives_no_speed():
    near = gauges(13, 19, 20, 21)
    time, readings = chain_run(near)
    run = Run(readings, time, near)
    for bead in (19, 20):
        assert measure_run("speed", run, from_="b13", to=f"b{bead}").known
    # In the last bead incident and reflected pulse make one hump whose peak is neither's.
    last = measure_run("speed", run, from_="b13", to="b21")
    assert math.isnan(last.value) and last.reason.startswith("b21: overlapped")
    assert measure_run("amplitude", run, sensor="b21").reason.startswith("overlapped")
    accepted = Run(readings, time, near, accept_overlap=True)
    assert measure_run("amplitude", accepted, sensor="b21").value == pytest.approx(
        readings["b21"].max(), rel=1e-3
    )
    # The same without the wall gauge to compare with.
    blind = Run({k: v for k, v in readings.items() if k != "wall"}, time, near)
    assert not blind.main("b21").found and blind.main("b20").found


def test_gauges_near_the_wall_see_a_merged_pulse_before_an_overlapped_one():
    near = gauges(13, 20)
    time, readings = chain_run(near)
    assert measure("amplitude", readings, time, near, sensor="b20").value == pytest.approx(4.8, rel=0.02)
    merged = measure("duration", readings, time, near, sensor="b20")
    assert math.isnan(merged.value) and merged.reason.startswith("merged")


def test_peaks_in_the_wrong_order_are_no_passage():
    time, readings = chain_run(PAPER)
    swapped = {"b13": readings["b17"], "b17": readings["b13"], "wall": readings["wall"]}
    back = measure("speed", swapped, time, PAPER, from_="b13", to="b17")
    assert math.isnan(back.value) and back.reason.startswith("no passage")
    without = Run(swapped, time, Geometry(21, DIAMETER, PAPER.sensors[:2]))
    assert without.reflection_time("b13").reason.startswith("unknown")


@pytest.mark.parametrize("name", ON_RUN)
def test_every_quantity_is_given_by_a_good_run(name, paper_run):
    measured = measure_run(name, paper_run, **requests(name))
    assert isinstance(measured, Measured)
    assert measured.known and math.isfinite(measured.value)


@pytest.mark.parametrize("name", ON_RUN)
@pytest.mark.parametrize(
    ("record", "reason"),
    [
        (lambda time, force: (time, 0.0 * force), "absent"),
        (lambda time, force: (time[:270], force[:270]), "truncated"),
    ],
)
def test_no_quantity_is_given_by_a_run_without_a_pulse(name, record, reason):
    time, readings = chain_run(PAPER)
    readings = {k: record(time, r)[1] for k, r in readings.items()}
    measured = measure(name, readings, record(time, time)[0], PAPER, **requests(name))
    assert math.isnan(measured.value)
    assert reason in measured.reason


@pytest.mark.parametrize("name", QUANTITIES)
def test_every_entry_of_the_list_is_complete(name):
    entry = QUANTITIES[name]
    assert entry.unit
    assert inspect.getdoc(entry.function)
    assert entry.over in ("run", "sweep", "contact", "striker")
    if entry.over == "run":
        arguments = inspect.signature(entry.function).parameters
        wanted = ["run", *("from_" if n == "from" else n for n in entry.needs)]
        assert list(arguments)[: len(wanted)] == wanted
        assert list(arguments)[len(wanted) :] == list(entry.options)


@pytest.mark.parametrize(
    ("name", "needs", "unit"),
    [
        # The table of quantities of the measured-data record.
        ("speed", ("from", "to"), "m/s"),
        ("amplitude", ("sensor",), "N"),
        ("duration", ("sensor",), "s"),
        ("width", ("from", "to", "sensor"), "diameters"),
        ("pulse_count", ("sensor",), "1"),
        ("decay", ("from", "to"), "1"),
        ("echo_delay", ("sensor",), "s"),
        ("echo_ratio", ("sensor",), "1"),
        ("speed_at_amplitude", ("amplitude", "sensor"), "m/s"),
        ("restitution", (), "1"),
        ("contact_duration", (), "s"),
    ],
)
def test_quantities_of_a_record_are_on_the_list(name, needs, unit):
    assert (QUANTITIES[name].needs, QUANTITIES[name].unit) == (needs, unit)


def test_many_runs_are_measured_column_by_column():
    runs = [chain_run(PAPER, train=((0.0, height),)) for height in (1.0, 2.0, 4.0)]
    time = runs[0][0]
    readings = {s.id: np.stack([r[s.id] for _, r in runs], axis=1) for s in PAPER.sensors}
    together = measure("amplitude", readings, time, PAPER, sensor="b13", noise=0.001)
    assert together == tuple(measure("amplitude", r, time, PAPER, sensor="b13", noise=0.001) for _, r in runs)
    assert [m.value for m in together] == pytest.approx(
        [1.0, 2.0, 4.0], rel=1e-3
    )  # the fit for noisy signals


def test_noise_may_be_given_gauge_by_gauge(paper_run):
    noise = {"b13": 2.0, "b17": 0.0}
    run = Run(paper_run.readings, paper_run.time, PAPER, noise)
    assert measure_run("amplitude", run, sensor="b13").reason.startswith("absent")
    assert measure_run("amplitude", run, sensor="b17") == measure_run("amplitude", paper_run, sensor="b17")


@pytest.mark.parametrize(
    ("name", "options", "says"),
    [
        ("velocity", {}, "'velocity' is not one of speed, amplitude"),
        ("speed", {"from": "b13"}, "needs 'to'"),
        ("speed", {"from": "b13", "to": "b13"}, "same place"),
        ("amplitude", {"sensor": "b14"}, "'b14' is not one of b13, b17, wall"),
        ("amplitude", {"sensor": "b13", "level": 0.1}, "takes no 'level', only sensor"),
        ("duration", {"sensor": "b13", "level": 2.0}, "level is 2.0"),
        ("restitution", {}, "found over a striker"),
    ],
)
def test_impossible_requests_are_refused(name, options, says, paper_run):
    with pytest.raises(ValueError, match=says):
        measure_run(name, paper_run, **options)


def test_malformed_readings_are_refused_with_the_gauge_named():
    time, readings = chain_run(PAPER)
    broken = readings["b17"].copy()
    broken[7] = math.nan
    for force, says in ((broken, "b17: force.7. is nan"), (broken[:-1], "b17: reading has shape")):
        with pytest.raises(ValueError, match=says):
            measure("speed", {**readings, "b17": force}, time, PAPER, from_="b13", to="b17")
    with pytest.raises(ValueError, match="b17 has no reading"):
        measure("amplitude", {"b13": readings["b13"]}, time, PAPER, sensor="b17")
    with pytest.raises(ValueError, match="all must be"):
        measure("amplitude", {**readings, "b17": np.zeros((len(time), 2))}, time, PAPER, sensor="b13")
    with pytest.raises(ValueError, match="equal steps"):
        measure("amplitude", readings, time**2, PAPER, sensor="b13")


@pytest.mark.parametrize(
    ("beads", "diameter", "sensors", "says"),
    [
        (21, 0.0, (), "diameter_m"),
        (12, DIAMETER, (Gauge("b13", "embedded", 13),), "the chain has 12"),
        (21, DIAMETER, (Gauge("g", "embedded", 13), Gauge("g", "wall", None)), "given 2 times"),
    ],
)
def test_impossible_geometry_is_refused(beads, diameter, sensors, says):
    with pytest.raises(ValueError, match=says):
        Geometry(beads, diameter, sensors)


@given(st.floats(-1e-3, 1e-3), st.floats(0.1, 10.0))
def test_trigger_shift_and_common_gain_leave_speed_and_shape_alone(shift, gain):
    time, readings = chain_run(PAPER, decay=5.0, train=((0.0, 4.8), (1.6e-4, 1.6)))
    before = Run(readings, time, PAPER)
    after = Run({k: gain * r for k, r in readings.items()}, time + shift, PAPER)
    for name in (
        "speed",
        "width",
        "decay",
        "pulse_count",
        "valley_depth",
        "asymmetry",
        "extra_pulse_fraction",
    ):
        ask = requests(name)
        # Rounding of times of order 1e-3 s over a travel of 1e-4 s, and of fits.
        exact = measure_run(name, before, **ask).value
        assert measure_run(name, after, **ask).value == pytest.approx(exact, rel=1e-9, abs=1e-9)


def test_main_pulse_may_be_lower_than_what_follows():
    # A long record in which later pulses are up to four times higher still begins with the main pulse.
    time = np.arange(0.0, 2e-3, 1e-6)
    force = pulse(time, 3e-4) + pulse(time, 1.5e-3, 3.9)
    run = Run({"b13": force}, time, gauges(13))
    assert measure_run("arrival", run, sensor="b13").value == pytest.approx(3e-4, abs=1e-9)
