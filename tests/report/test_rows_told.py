"""What the tables of a page say in plain words: quantities with unit and error, slips, places, laws."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from made_chains import record
from made_verdicts import model, verdict, write
from msgspec.structs import replace

from sonicvacuum.discover.draws import PLACES, Draws
from sonicvacuum.discover.verdict import Known, Value
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.records import read
from sonicvacuum.report import bench, inline, rows, words
from sonicvacuum.report.record import write_page


def test_what_stays_within_its_stated_error_is_no_slip():
    calm = replace(model(verdict()), speed_ratio={"slow": 1.02}, trigger_us={"slow": 2.0}, gain={"g1": 0.96})
    assert bench.strained(verdict(), calm, record()) == []
    far = replace(calm, trigger_us={"slow": -9.0}, gain={"g1": 0.9}, modulus_ratio=1.2)
    told = bench.strained(verdict(), far, record())
    assert [re.search(r"(time zero|modulus|calibration)", line)[0] for line in told] == [
        "modulus", "time zero", "calibration"
    ]  # fmt: skip
    off = {
        "clock": Known(value=3e-3, sigma=1e-4, prior=1e-3),
        "delay g1": Known(value=1.0, sigma=0.1, prior=1.0),
    }
    assert len(bench.strained(verdict(nuisances=off), calm, record())) == 1


def test_what_all_runs_share_is_called_by_its_name_and_unit():
    off = {
        "modulus brass": Known(value=0.868, sigma=0.02, prior=0.05),
        "delay g1": Known(value=4.0, sigma=0.1, prior=1.0),
        "bead-mass": Known(value=1.1, sigma=0.01, prior=0.02),
        "clock": Known(value=-0.02, sigma=1e-3, prior=5e-3),
        "shared gauge-places": Known(value=2.6, sigma=0.5, prior=1.0),
    }
    told = " ".join(
        bench.strained(verdict(named=[], nuisances=off), replace(model(verdict()), speed_ratio={}), record())
    )
    for part in (
        # Brass has no error in the record.
        "the modulus of brass: the data ask for 0.868 ± 0.017 times the value used, 2.8 times the standard "
        "error of 5 % that is taken, none being stated.",
        "the delay of gauge g1: the data ask for 4 µs, 4.0 of",
        "the mass of the beads: the data ask for 1.100 ± 0.011 times",
        "the recorder's clock: the data ask for one that is off by -2 %, 4.0 of",
        "common to several quantities, gauge-places: the data ask for a shift, 2.6 of",
    ):
        assert part in told


def test_an_error_wider_than_the_stated_one_is_no_measurement():
    """Of a misfit that is left errors are widened: `1.21 ± 0.32` would not be far from 1."""
    off = {"modulus brass": Known(value=1.21, sigma=0.26, prior=0.05)}
    told = bench.strained(verdict(named=["unknown"], nuisances=off), model(verdict()), record())
    assert any("of brass: the data ask for 1.21 times the value used" in line for line in told)


def test_what_the_data_measure_is_told_with_its_error():
    known = {
        "gain g1": Known(value=0.0943, sigma=0.084, prior=None),
        "modulus foam": Known(value=1.47, sigma=0.018, prior=0.5),
        "modulus steel": Known(value=1.01, sigma=0.02, prior=0.03),
        "clock": Known(value=-0.02, sigma=1e-5, prior=5e-3),
    }
    assert bench.measured(verdict(nuisances=known)) == (
        "The data measure what the record leaves open, as factors of what it says: calibration of g1 "
        "0.0943 ± 0.0079 and modulus of foam 1.470 ± 0.026 (stated to 50 %)."
    )
    # The record says nothing of foam: whatever error it has is taken.
    assert "(taken as known to 50 %)" in bench.measured(verdict(nuisances=known), [record()])
    assert bench.measured(verdict()) == ""


def test_numbers_of_a_page_have_no_powers_of_ten_where_people_write_none():
    one = replace(model(verdict()), trigger_us={"slow": 332.1}, gain={"g1": 12.3, "g2": 1.02})
    said = bench.nuisances(one, verdict())
    assert "gauge gains by up to 1100 % and time zeros by up to 330 µs" in said
    # Nobody has calibrated g1: there is no gain that could have moved.
    open_ = {"gain g1": Known(value=12.3, sigma=0.1, prior=None)}
    assert "gauge gains by up to 2 %" in bench.nuisances(one, verdict(nuisances=open_))


def test_a_gauge_at_fault_is_called_by_its_name():
    found = verdict(parameters={"sensor-gain": {
        "gain_ratio": Value(value=0.68, sigma=0.01), "sensor": Value(value=1.0, sigma=0.0)}})  # fmt: skip
    (one,) = rows.effects(found, CATALOGUE, {}, ["g1", "wall"])
    place = one["parameters"][1]
    assert (place["name"], place["value"], place["interval"]) == ("sits at gauge", "wall", "")
    odds = Draws("sensor-gain", "sensor", PLACES, np.array([1.0, 0.0]), np.array([0.7, 0.3]))
    (one,) = rows.effects(found, CATALOGUE, {("sensor-gain", "sensor"): odds}, ["g1", "wall"])
    assert one["parameters"][1]["interval"] == "wall\N{NO-BREAK SPACE}(0.70), g1\N{NO-BREAK SPACE}(0.30)"


def test_a_place_is_told_with_the_others_that_it_may_be():
    found = verdict(parameters={"contact-gap": {
        "gap_um": Value(value=0.04, sigma=0.01), "contact": Value(value=4.0, sigma=0.6)}})  # fmt: skip
    share = np.array([0.4, 0.06, 0.45, 0.09])
    odds = Draws("contact-gap", "contact", PLACES, np.array([4.0, 2.0, 3.0, 5.0]), share)
    (one,) = rows.effects(found, CATALOGUE, {("contact-gap", "contact"): odds})
    place = one["parameters"][1]
    assert (place["name"], place["value"]) == ("sits at contact (between that bead and the next)", "4")
    # What is told first, then by what they have, as many as have 90 % together.
    assert place["interval"].split(", ") == [
        f"{k}\N{NO-BREAK SPACE}({p})" for k, p in ((4, "0.40"), (3, "0.45"), (5, "0.09"))
    ]
    # How intervals were found is said of parameters; a place has none.
    assert words.drawn({("contact-gap", "contact"): odds}) == ""


@pytest.mark.parametrize(
    ("value", "sigma", "shown"),
    [
        (18222.0, 913.0, "18220 ± 910"),
        (0.0271, 0.00142, "0.0271 ± 0.0014"),
        (0.5, 0.0996, "0.50 ± 0.10"),
        (2.5e7, 3e5, "2.500e7 ± 0.030e7"),
        (8.0376e-5, 2.51e-6, "8.04e-5 ± 0.25e-5"),  # of volts a newton: 8.038e-5 ± 2.5e-6
        (3e-9, 4e-8, "0.3e-8 ± 4.0e-8"),
        (1.98, 0.0, "1.98 (error not determined)"),
    ],
)
def test_a_value_ends_where_its_error_does(value, sigma, shown):
    assert rows.with_error(value, sigma) == shown


def test_columns_that_say_the_same_stand_once(tmp_path):
    made = write(tmp_path / "made", "scalars")
    assert "Extended, fitted to it" in write_page(made).read_text(encoding="utf-8")
    table = (made / "quantities.csv").read_text().replace("0.91,0.92", "0.99,0.98").replace("0.84", "0.99")
    (made / "quantities.csv").write_text(table)
    page = write_page(made).read_text(encoding="utf-8")
    assert "Extended, fitted to it" not in page
    assert "The same, fitted to all others" in page


def test_formulas_are_set():
    assert inline.formula("F = K delta^{3/2} v, A < 1") == "F = K δ<sup>3/2</sup> v, A &lt; 1"
    assert inline.formula("F = K delta^1.5 v^-0.5.") == "F = K δ<sup>1.5</sup> v<sup>−0.5</sup>."
    assert inline.formula("m_j -> r m_j, 1 - c, 5 us") == "m<sub>j</sub> → r m<sub>j</sub>, 1 − c, 5 µs"
    assert inline.typeset("10^-3: 3 ± 1 us (-4.1 σ), fig3a-width, 1e-6") == (
        "10⁻³: 3 ± 1 µs (−4.1 σ), fig3a-width, 10⁻⁶"
    )
    assert inline.typeset("+-1 mm, 0.07 uN at 7.8 g/cm3, 10^3 us") == "±1 mm, 0.07 µN at 7.8 g/cm³, 10³ µs"
    assert inline.typeset("(1 - nu)/(1 - 2 nu), a - b") == "(1 − ν)/(1 − 2 ν), a - b"
    assert inline.formula("u^{alpha-6/5}") == "u<sup>α−6/5</sup>"
    assert inline.formula("m u'^2/tau") == "m u&#39;<sup>2</sup>/τ"


def test_what_the_record_says_acts_is_part_of_the_nominal_model():
    effects = {"coating-thickness": {"layer_thickness_um": 50.3}, "kuwabara-kono": {"time_us": 6.1}}
    held, one = SimpleNamespace(effects=effects), SimpleNamespace(named=["kuwabara-kono"])
    told = rows.present(one, held, CATALOGUE)
    assert told == "bonded coating on its core (thickness of the layer on its core = 50 µm)"
    assert rows.present(SimpleNamespace(named=list(effects)), held, CATALOGUE) == ""


def test_quantities_are_told_with_unit_and_level():
    def told(label, unit, bound=""):
        row = {"run": "a", "quantity": label, "unit": unit, "bound": bound, "measured": "130", "sigma": "14"}
        (one,) = rows.quantities([row | dict.fromkeys(("nominal", "extended", "held_out"), "1")])
        return one["quantity"], one["measured"]

    assert told("duration g9 at 0.02", "us") == ("duration g9, above 0.02 of the peak", "130 ± 14 µs")
    assert told("pulse count wall at 0.15", "1")[0] == "pulse count wall, above 0.15 of the first peak"
    assert told("speed at amplitude g9 0.25 N", "m/s") == ("speed where g9 reads 0.25 N", "130 ± 14 m/s")
    assert told("width g9-g5 g9 at 0.02", "1")[0] == (
        "width at g9, by the speed g9–g5, above 0.02 of the peak"
    )
    assert (told("speed g9-g5", "m/s")[0], told("decay g9-g5", "1")[0]) == ("speed g9–g5", "decay g9–g5")
    assert told("amplitude g9", "N", "at_most") == ("amplitude g9", "at most 130 ± 14 N")


def test_an_error_that_quantities_share_stands_beside_their_own(pytestconfig):
    paper = read(pytestconfig.rootpath / "workflow/resources/measured/daraio-nesterenko-2006-coated")
    empty = dict.fromkeys(("nominal", "extended", "held_out"), "1") | {"run": "light-striker", "bound": ""}
    table = [
        empty | {"quantity": "speed g9-g5", "unit": "m/s", "measured": "197", "sigma": "2"},
        empty | {"quantity": "speed at amplitude g9 0.25 N", "unit": "m/s", "measured": "130", "sigma": "5"},
        empty | {"quantity": "duration g9 at 0.02", "unit": "us", "measured": "130", "sigma": "14"},
    ]
    told = rows.quantities(table, [paper])
    assert [r["measured"] for r in told] == ["197 ± 2 m/s ± 4.1 %", "130 ± 5 m/s ± 4.1 %", "130 ± 14 µs"]
    assert [r["common"] for r in told] == [["gauge-places"], ["gauge-places"], []]
    # A verdict that was written before its record was kept knows of its own errors only.
    assert rows.quantities(table)[0]["measured"] == "197 ± 2 m/s"


def test_the_place_of_an_effect_is_told_by_the_name_of_its_gauge():
    told = rows.placed("sensor-gain gain_ratio 5; sensor-gain sensor 1", ["g9", "wall"], CATALOGUE)
    assert told == "sensor-gain gain_ratio 5; sensor-gain gauge wall"
    assert rows.placed("contact-gap gap_um 5; contact-gap contact 1", ["g9"], CATALOGUE).endswith("contact 1")
    assert rows.placed("sensor-gain sensor 1", (), CATALOGUE) == "sensor-gain sensor 1"


def test_data_that_test_nothing_leave_every_effect_open():
    blank = verdict(named=[], upper_limits={}, not_testable=["gravity"])
    assert blank.sees_nothing
    assert "these data test none" in words.alternatives(blank)
