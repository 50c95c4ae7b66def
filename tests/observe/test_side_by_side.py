"""Pulses found side by side are those found one by one, to the bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sonicvacuum.forward.columns import Columns
from sonicvacuum.forward.striker import Strikers
from sonicvacuum.forward.together import runs_of
from sonicvacuum.gauges import Gauge
from sonicvacuum.observe.contacts import contact_duration, restitution
from sonicvacuum.observe.quantities import measure_run
from sonicvacuum.observe.run import Geometry, Run

TIME = np.arange(400) * 1e-6
GAUGES = (Gauge("g", "embedded", 8), Gauge("h", "embedded", 15), Gauge("wall", "wall", None))
GEOMETRY = Geometry(20, 5e-3, GAUGES)
ASKED = [
    *(("amplitude", {"sensor": s}) for s in ("g", "h", "wall")),
    *(("duration", {"sensor": s, "level": level}) for s in ("g", "wall") for level in (0.01, 0.5, 1.5)),
    ("speed", {"from": "g", "to": "h"}),
    ("decay", {"from": "g", "to": "wall"}),
    ("onset", {"sensor": "h", "level": 0.1}),
    ("width_half", {"from": "g", "to": "h", "sensor": "g"}),
    ("pulse_count", {"sensor": "g"}),
    ("arrival", {"sensor": "nowhere"}),
]


def told(quantity, run, options):
    """Value and reason, or the error."""
    try:
        found = measure_run(quantity, run, **options)
    except ValueError as error:
        return str(error)
    return found.value, found.reason


def compare(signals, geometry=GEOMETRY):
    """Runs side by side and alone, and whole columns, which may leave a run aside."""
    runs = runs_of(signals, TIME, geometry)
    columns = Columns(runs)
    for lane, run in enumerate(runs):
        alone = Run(run.readings, TIME, geometry)
        for quantity, options in ASKED:
            # As text, so that NaN equals NaN.
            found = told(quantity, alone, options)
            assert repr(told(quantity, run, options)) == repr(found)
            value = columns.of(quantity, options)[lane]
            assert np.isnan(value) or (value, "") == found
    return columns


def pulse(middle, width, height):
    return height / np.cosh(np.clip((TIME - middle) / width, -50.0, 50.0)) ** 4


@pytest.mark.parametrize("gap", [1.6e-5, 1.8e-5, 2.2e-5])
def test_two_humps_as_high_as_each_other_are_found_side_by_side(gap):
    signals = np.array([[pulse(1.2e-4, 1.5e-5, 1.0) + pulse(1.2e-4 + gap, 1.5e-5, 1.001)] * 3])
    compare(signals)
    (run,) = runs_of(signals, TIME, GEOMETRY)
    assert run.first("g").time < 1.2e-4 + 0.5 * gap


def test_what_is_usual_is_found_side_by_side():
    rows = [
        [pulse(1e-4 + k * 1e-6, 2e-5, 1.0 + k), pulse(1.6e-4, 2e-5, 2.0), pulse(2.2e-4, 1.5e-5, 3.0)]
        for k in range(9)
    ]
    columns = compare(np.array(rows))
    runs = runs_of(np.array(rows), TIME, GEOMETRY)
    for sensor in ("g", "h", "wall"):
        assert None not in runs[0].together.pulses(sensor)
        for rising in (True, False):
            assert np.isfinite(runs[0].together.crossings(sensor, 0.5, rising)).all()
    for quantity, options in ASKED:
        usual = (
            "nowhere" not in options.values() and quantity != "pulse_count" and 1.5 not in options.values()
        )
        assert np.isfinite(columns.of(quantity, options)).all() == usual


def test_without_a_wall_gauge_only_the_last_bead_is_overlapped():
    rows = np.array([[pulse(1e-4 + k * 1e-6, 2e-5, 1.0), pulse(1.6e-4, 2e-5, 2.0)] for k in range(5)])
    for bead, clear in ((15, True), (20, False)):
        columns = compare(rows, Geometry(20, 5e-3, (GAUGES[0], Gauge("h", "embedded", bead))))
        assert np.isfinite(columns.of("amplitude", {"sensor": "h"})).all() == clear


@settings(max_examples=40, deadline=None)
@given(
    places=st.lists(st.integers(0, 399), min_size=3, max_size=3),
    heights=st.lists(st.floats(-1.0, 5.0), min_size=3, max_size=3),
    width=st.integers(1, 120),
    seed=st.integers(0, 2**32 - 1),
    ripple=st.sampled_from([0.0, 0.0, 1e-12, 0.02, 0.5]),
)
def test_signals_of_any_kind_are_measured_alike(places, heights, width, seed, ripple):
    """Cut off at either end, empty, upside down, with echoes and ripples that break rise and fall."""
    generator = np.random.default_rng(seed)
    rows = [
        [pulse(TIME[p] + lane * 3e-6, width * 1e-6, h) for p, h in zip(places, heights, strict=True)]
        for lane in range(3)
    ]
    echo = pulse(TIME[places[0]] + 1.2e-4, width * 1e-6, 0.7 * abs(heights[1]))
    compare(
        np.array(rows) + np.array([echo, 0 * echo, -echo]) + ripple * generator.standard_normal((3, 3, 400))
    )


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_what_is_not_finite_is_said_as_ever(value):
    signals = np.array([[pulse(1e-4, 2e-5, 1.0)] * 3] * 2)
    signals[1, 0, 7] = value
    compare(signals)


def _contacts():
    """Forces of strikers: usual ones, several, cut off at either end, none, no numbers."""
    usual = [pulse((20 + 37 * k) * 1e-6, 1e-5 * (1 + k), 10.0 + k) for k in range(4)]
    again = usual[0] + np.roll(usual[0], 150) - 1.0
    steep = np.where((TIME > 5e-5) & (TIME < 9e-5), 1.0 + 1e-3 * np.sin(TIME * 1e5), 0.0)
    at_once, never_open = np.maximum(1e-4 - TIME, 0.0), TIME * 1e4
    one_sample = np.where(np.arange(400) == 50, 3.0, -1.0)
    first_sample = np.where(np.arange(400) == 0, 3.0, 0.0)
    broken = np.where(np.arange(400) == 70, np.nan, at_once)
    rows = [*(u - 1e-3 * u.max() for u in usual), again, steep, at_once, one_sample, first_sample]
    return np.array([*rows, never_open, 0.0 * TIME, broken, np.where(np.isnan(broken), np.inf, at_once)])


class _Chain:
    """What is asked of a chain."""

    striker_mass, speed, gravity = np.linspace(1e-4, 2e-4, 13), np.linspace(0.1, 2.0, 13), np.full(13, 9.81)


class _History:
    """What is asked of a history."""

    time = TIME

    def of(self, contact):
        return _contacts().T


def test_contacts_of_strikers_are_those_found_one_by_one():
    strikers = Strikers(_History(), _Chain())
    for found, alone in (
        (strikers.contact_duration, lambda lane, force: contact_duration(TIME, force)),
        (
            strikers.restitution,
            lambda lane, force: restitution(
                TIME, force, _Chain.striker_mass[lane], _Chain.speed[lane], _Chain.gravity[lane]
            ),
        ),
    ):
        for lane, force in enumerate(_contacts()):
            assert np.isnan(found[lane]) or found[lane] == alone(lane, force).value
        assert np.count_nonzero(np.isfinite(found)) == 9
