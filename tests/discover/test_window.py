"""Long and finely sampled traces cost what ordinary ones cost, and say the same."""

import numpy as np
import pytest
from made_records import block

from sonicvacuum.discover.model.window import ENOUGH, fitted
from sonicvacuum.files import InputError
from sonicvacuum.records import Record, Signals, extent
from sonicvacuum.records.reader import parse
from sonicvacuum.records.review import content, lines
from sonicvacuum.report.checked import looked_through
from sonicvacuum.scope import thin

# us: when the pulse passes each gauge, its width, and of the echo.
ARRIVALS, WIDTH, ECHO = {"g4": 60.0, "g7": 90.0, "wall": 120.0}, 12.0, 180.0


def recorded(interval, first, last, noise=0.02, sigma=True):
    """A record of one run whose gauges see a pulse and its echo on white noise."""
    content = block([0.5])
    if not sigma:
        for sensor in content["sensors"]:
            del sensor["sigma_N"]
    time = np.arange(first, last, interval)
    rng = np.random.default_rng(np.random.SeedSequence(4))

    def trace(at):
        pulse = np.exp(-(((time - at) / WIDTH) ** 2)) + 0.4 * np.exp(-(((time - at - ECHO) / WIDTH) ** 2))
        return 5.0 * pulse + noise * rng.standard_normal(len(time))

    return Record(parse(content), {"v0": Signals(time, {g: trace(at) for g, at in ARRIVALS.items()})})


def test_an_ordinary_record_is_left_as_it_is():
    record = recorded(1.0, -100.0, 600.0)
    same, notes = fitted(record)
    assert same is record
    assert notes == ()


def test_a_million_samples_become_some_hundred_that_hold_pulse_and_echo():
    record = recorded(0.02, -5000.0, 15000.0)
    less, notes = fitted(record)
    (before,), (after,) = record.signals.values(), less.signals.values()
    assert before.samples == 1_000_000
    assert after.samples < ENOUGH
    assert after.time_us[0] < 0.0
    assert after.time_us[-1] > ARRIVALS["wall"] + ECHO + 2.0 * WIDTH
    assert "cut to what the passage needs" in notes[0]
    assert "thinned by" in notes[1]


def test_a_search_is_refused_for_what_it_takes_and_not_for_what_was_recorded(monkeypatch):
    record = recorded(0.02, -5000.0, 15000.0)
    monkeypatch.setattr(extent, "AT_ONCE", 1000)
    with pytest.raises(InputError, match="GiB of memory"):
        extent.check_extent(record)
    extent.check_extent(fitted(record)[0])


def test_what_is_left_is_the_pulse_and_the_stated_noise():
    record = recorded(0.02, -5000.0, 15000.0)
    less, _ = fitted(record)
    (after,) = less.signals.values()
    clean = 5.0 * np.exp(-(((after.time_us - ARRIVALS["g4"]) / WIDTH) ** 2))
    clean += 2.0 * np.exp(-(((after.time_us - ARRIVALS["g4"] - ECHO) / WIDTH) ** 2))
    stated = less.gauges[0].sigma
    factor = round(float(np.diff(after.time_us)[0]) / 0.02)
    assert stated == pytest.approx(0.02 * thin.noise_left(factor))
    left = after.readings["g4"] - clean
    # A standard deviation of N samples is known to 1/√(2N), three of which are allowed.
    assert left.std() == pytest.approx(stated, rel=3.0 / np.sqrt(2.0 * len(left)))


def test_noise_that_nobody_stated_stays_to_be_estimated():
    less, _ = fitted(recorded(0.02, -1000.0, 3000.0, sigma=False))
    assert less.gauges[0].sigma == 0.0


def test_traces_without_a_pulse_are_kept_whole():
    record = recorded(0.5, 0.0, 2000.0)
    rng = np.random.default_rng(np.random.SeedSequence(5))
    quiet = {g: 0.02 * rng.standard_normal(len(v)) for g, v in record.signals["v0"].readings.items()}
    flat = Record(record.block, {"v0": Signals(record.signals["v0"].time_us, quiet)})
    less, notes = fitted(flat)
    assert less.signals["v0"].samples == flat.signals["v0"].samples
    assert notes == ()


def test_the_check_tells_beforehand_what_is_cut_and_thinned():
    long = looked_through(recorded(0.02, -5000.0, 15000.0))
    assert [note.split()[2] for note in long.treatment] == ["cut", "by"]
    assert all(f"  for the search: {note}" in lines(long) for note in long.treatment)
    assert content(long)["treatment"] == list(long.treatment)
    # A million samples cost as many as are left of them: three gauges of no more than that.
    short = looked_through(recorded(1.0, -100.0, 600.0))
    assert short.treatment == ()
    assert long.discover_s < short.discover_s * ENOUGH / 700.0
