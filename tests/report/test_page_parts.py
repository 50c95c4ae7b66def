"""What a page adds to a verdict: sketch and origin of the data, tables in plain words, traces to zoom."""

import csv
import datetime
import html
import json
import re
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from made_verdicts import model, verdict, write
from msgspec.structs import replace

from sonicvacuum.discover import given
from sonicvacuum.discover.draws import PLACES, Draws
from sonicvacuum.discover.law import Law, Near
from sonicvacuum.discover.verdict import Known, Value, write_json
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.figures import discovery
from sonicvacuum.files import InputError
from sonicvacuum.records import Record, read
from sonicvacuum.records.described import chain_of
from sonicvacuum.records.reader import parse
from sonicvacuum.report import bench, inline, next_run, plots, rows, words
from sonicvacuum.report.record import write_page
from sonicvacuum.report.sketch import MOST, sketch

STEEL = {"diameter_mm": 10, "mass_g": 4, "material": "bearing-steel"}
STRIKER = {"shape": "sphere", "speed_m_s": 0.5, "speed_rel_sigma": 0.01, **STEEL}


def record(beads=12, **changes) -> Record:
    """A chain of steel balls with a gauge in a bead and one at the wall."""
    content = {
        "format": 1,
        "title": "Steel balls <in> a row",
        "chain": {"beads": beads, "orientation": "horizontal", "bead": STEEL, "wall": {"material": "brass"}},
        "materials": {"bearing-steel": {"modulus_rel_sigma": 0.02}},
        "sensors": [
            {"id": "g1", "kind": "embedded", "bead": 5, "gain_rel_sigma": 0.02},
            {"id": "wall", "kind": "wall", "gain_rel_sigma": 0.02},
        ],
        "trigger_sigma_us": 1.0,
        "runs": [
            {"id": run, "striker": STRIKER, "observables": [
                {"quantity": "amplitude", "sensor": "g1", "value": 30.0, "sigma": 1.0, "unit": "N"}]}
            for run in ("slow", "fast")
        ],
        **changes,
    }  # fmt: skip
    return Record(parse(content), name="made", digest="ab" * 32)


@pytest.fixture
def folder(tmp_path):
    made = write(tmp_path / "made", "single")
    source = {"date": datetime.date(2026, 5, 1), "licence": "CC0"}
    write_json(given.inputs((record(source=source),), ("g1: 3 spikes left out",)), made / given.FILE)
    return made


def test_a_page_opens_with_verdict_bench_chain_and_origin(folder):
    slow = {"slow": 1.04, "fast": 1.001}
    write_json(replace(model(verdict()), speed_ratio=slow), folder / "model.json")
    page = write_page(folder).read_text(encoding="utf-8")
    order = [
        "Steel balls &lt;in&gt; a row</h1>", "What is missing: Visco", "Check your set-up first", "<svg role",
        "12 beads of bearing-steel, 10 mm, 4 g, horizontal", "2026-05-01", "SHA-256 abab", "sonicvacuum 0.",
        "g1: 3 spikes left out.", "Where they disagree", "What it is", "How sure", "What else it could be",
        "How the gap shrinks", "What the others could still be", "What experiment would settle it",
    ]  # fmt: skip
    places = [page.index(part) for part in order]
    assert places == sorted(places)
    asked = "speed in run slow: the data ask for 1.04 times what is stated, 3.9 of the stated standard errors"
    assert asked in html.unescape(page)
    assert "speed in run fast" not in page


def test_words_of_statisticians_stay_folded(folder):
    page = write_page(folder).read_text(encoding="utf-8")
    open_part = re.sub(r"<(details|script|style|svg).*?</\1>", "", page, flags=re.DOTALL)
    for jargon in ("χ", "Bayes", "posterior", "nuisance", "residual", "p-value", "likelihood"):
        assert jargon not in open_part


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
        bench.strained(verdict(nuisances=off), replace(model(verdict()), speed_ratio={}), record())
    )
    for part in (
        # Brass has no error in the record.
        "the modulus of brass: the data ask for 0.868 ± 0.017 times what is stated, 2.8 times the standard "
        "error of 5 % that is taken, none being stated.",
        "the delay of gauge g1: the data ask for 4 µs, 4 of",
        "the mass of the beads: the data ask for 1.1 ± 0.011 times",
        "the recorder's clock: the data ask for one that is off by -2 %, 4 of",
        "common to several quantities, gauge-places: the data ask for a shift, 2.6 of",
    ):
        assert part in told


def test_what_the_data_measure_is_told_with_its_error():
    known = {
        "gain g1": Known(value=0.0943, sigma=0.084, prior=None),
        "modulus foam": Known(value=1.47, sigma=0.018, prior=0.5),
        "modulus steel": Known(value=1.01, sigma=0.02, prior=0.03),
        "clock": Known(value=-0.02, sigma=1e-5, prior=5e-3),
    }
    assert bench.measured(verdict(nuisances=known)) == (
        "The data measure what the record leaves open, as factors of what it says: calibration of g1 "
        "0.0943 ± 0.0079 and modulus of foam 1.47 ± 0.026 (stated to 50 %)."
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
    assert (place["name"], place["value"]) == ("sits at contact", "4")
    # What is told first, then by what they have, as many as have 90 % together.
    assert place["interval"].split(", ") == [
        f"{k}\N{NO-BREAK SPACE}({p})" for k, p in ((4, "0.40"), (3, "0.45"), (5, "0.09"))
    ]
    # How intervals were found is said of parameters; a place has none.
    assert words.drawn({("contact-gap", "contact"): odds}) == ""


def test_one_ball_falls_on_its_wall_and_is_not_made_of_it():
    ball = {"beads": 0, "orientation": "vertical", "bead": STEEL, "wall": {"material": "brass"}}
    run = {"id": "drop", "striker": STRIKER, "observables": [
        {"quantity": "restitution", "value": 0.9, "sigma": 0.01, "unit": "1"}]}  # fmt: skip
    of = record(chain=ball, sensors=[], runs=[run])
    assert chain_of(of) == "one ball of bearing-steel, 10 mm, 4 g, on a wall of brass, vertical"
    struck, wall = re.search(r'<text x="([\d.]+)" y="18.0">striker.*?<text x="([\d.]+)"', sketch(of)).groups()
    # Letters are 6.2 wide: `wall: brass` begins behind `striker`, not at the other end of the drawing.
    assert 7 * 6.2 <= float(wall) - 11 * 6.2 - float(struck) < 80.0


@pytest.mark.parametrize(
    ("value", "sigma", "shown"),
    [
        (18222.0, 913.0, "18220 ± 910"),
        (0.0271, 0.00142, "0.0271 ± 0.0014"),
        (0.5, 0.0996, "0.50 ± 0.10"),
        (2.5e7, 3e5, "2.5e7 ± 300000"),
        (1.98, 0.0, "1.98 (error not determined)"),
    ],
)
def test_a_value_ends_where_its_error_does(value, sigma, shown):
    assert rows.with_error(value, sigma) == shown


def test_runs_are_counted_without_the_line_of_all(folder):
    page = write_page(folder).read_text(encoding="utf-8")
    assert "Run by run (1)" in page  # the made table holds the run `slow` and a line `all`


def test_columns_that_say_the_same_stand_once(tmp_path):
    made = write(tmp_path / "made", "scalars")
    assert "Extended, fitted to it" in write_page(made).read_text(encoding="utf-8")
    table = (made / "quantities.csv").read_text().replace("0.91,0.92", "0.99,0.98").replace("0.84", "0.99")
    (made / "quantities.csv").write_text(table)
    page = write_page(made).read_text(encoding="utf-8")
    assert "Extended, fitted to it" not in page
    assert "The same, fitted to all others" in page


def test_nothing_is_proposed_where_nothing_is_open(folder):
    sure = {"none": 0.0, "unknown": 0.001, "kuwabara-kono": 0.999}
    write_json(verdict(probabilities=sure), folder / "verdict.json")
    assert "What experiment" not in write_page(folder).read_text(encoding="utf-8")
    assert next_run.settled(verdict(probabilities=sure))
    assert not next_run.settled(verdict(probabilities=sure, confusable=[["kuwabara-kono", "tsuji"]]))
    assert not next_run.settled(verdict())


def test_a_sketch_has_a_disc_for_each_bead_and_a_name_for_each_gauge():
    drawn = sketch(record())
    assert drawn.count('class="bead') == 12
    assert drawn.count('class="bead held"') == 1
    assert "g1, bead 5" in drawn
    long = sketch(record(beads=MOST + 200))
    assert long.count('class="bead') < MOST
    assert "g1, bead 5" in long


def test_a_sketch_keeps_names_apart_and_inside():
    sensors = [{"id": f"gauge{k}", "kind": "embedded", "bead": k} for k in (1, 2, 3, 11, 12)]
    text = sketch(record(sensors=sensors, runs=[
        {"id": "a", "striker": STRIKER, "observables": [
            {"quantity": "amplitude", "sensor": "gauge1", "value": 30.0, "sigma": 1.0, "unit": "N"}]}
    ]))  # fmt: skip
    found = re.findall(r'class="gauge" x="([\d.]+)" y="([\d.]+)">([^<]+)<', text)
    boxes = [(float(y), float(x), float(x) + 6.2 * len(name)) for x, y, name in found]
    assert len(boxes) == 5
    assert all(left >= 0.0 and right <= 360.5 for _, left, right in boxes)
    for row in {y for y, _, _ in boxes}:
        ends = sorted((left, right) for y, left, right in boxes if y == row)
        assert all(a[1] < b[0] for a, b in pairwise(ends))


def test_traces_hold_what_the_table_holds(folder):
    found = plots.plots(folder / "traces.csv")
    assert [(t["run"], t["sensor"]) for t in found] == [
        (r, s) for r in ("slow", "fast") for s in ("g1", "wall")
    ]
    with open(folder / "traces.csv", newline="") as stream:
        table = [r for r in csv.DictReader(stream) if r["run"] == "fast" and r["sensor"] == "wall"]
    last = found[-1]
    assert last["start"] + last["step"] * 10 == pytest.approx(float(table[10]["time_us"]))
    for name in ("measured", "nominal", "extended"):
        shown = [v * last["value"] for v in last[name]]
        # Half a step of the readings, a 9999th of the largest.
        assert shown == pytest.approx([float(r[f"{name}_N"]) for r in table], abs=0.51 * last["value"])
    assert last["sigma"] * last["value"] == pytest.approx(0.02, rel=1e-5)


def test_lost_samples_keep_their_times(tmp_path):
    lines = [f"a,g,{t},1,2,2,0.1" for t in (0, 1, 2, 7, 8, 9)]
    (tmp_path / "traces.csv").write_text("\n".join(["run,sensor,time_us,m,n,e,s", *lines]) + "\n")
    (only,) = plots.plots(tmp_path / "traces.csv")
    assert only["times"] == [0, 1, 2, 7, 8, 9]
    assert "extended" not in only


def test_a_page_stays_below_two_megabytes_whatever_the_record(folder):
    head = (folder / "traces.csv").read_text().splitlines()[0]
    with open(folder / "traces.csv", "w") as stream:
        stream.write(head + "\n")
        for run in range(30):
            for gauge in range(6):
                for k in range(1000):
                    stream.write(f"r{run},g{gauge},{0.5 * k},{(k * 37 % 101) / 7},{k % 13},{k % 17},0.1\n")
    page = write_page(folder)
    assert page.stat().st_size < 2e6
    assert len(plots.plots(folder / "traces.csv")) == 180


def test_the_grid_tells_every_comparison():
    cells = [
        {"run": "a", "sensor": "g", "feature": "delay", "z_before": "-12.4"},
        {"run": "a", "sensor": "h", "feature": "tail", "z_before": "1.5"},
    ]
    table = rows.grid(cells)
    assert table["features"] == ["delay", "tail"]
    first, second = table["lines"]
    assert first["cells"][0]["said"] == "run a, gauge g: an earlier pulse by 12.4 standard errors"
    assert (first["cells"][0]["shown"], first["cells"][1]) == ("−12", None)
    assert second["cells"][1]["shown"] == ""
    assert rows.grid([{"run": "a", "sensor": "", "feature": "speed", "z_before": "3"}]) is None


def test_a_law_without_a_name_is_told_and_drawn(folder):
    grid = [0.0, 1.0, 2.0], [-0.1, 0.0, 0.1]
    force = [[0.5 * d**1.5 * (1.0 + v) for v in grid[1]] for d in grid[0]]
    found = Law(
        depth_um=grid[0], speed_m_s=grid[1], force_N=force, band_N=force, visited=[[True] * 3] * 3,
        nearest=[Near(effect="tsuji", distance=0.25)],
        formula="2 N s/m delta^{1/4} v", log10_bayes=9.0, closed=0.8,
    )  # fmt: skip
    write_json(verdict(named=["unknown"], parameters={}, law=found), folder / "verdict.json")
    table = [",".join(("depth_um", "speed_m_s", "hertz_N", "force_N", "band_N", "visited"))]
    table += [f"{d},{v},{d},{d + v},0.1,1" for d in grid[0] for v in grid[1]]
    (folder / "law.csv").write_text("\n".join(table) + "\n")
    discovery.draw(folder)
    page = write_page(folder).read_text(encoding="utf-8")
    assert "a contact law without a name: 2 N s/m δ<sup>1/4</sup> v." in page
    assert "damping with constant restitution (0.25)" in page
    assert "closes 80 % of what was left" in page
    assert "force between two beads besides the nominal one" in page
    (folder / "law.csv").unlink()
    discovery.draw(folder)
    assert not (folder / "law.svg").exists()


def test_formulas_are_set():
    assert inline.formula("F = K delta^{3/2} v, A < 1") == "F = K δ<sup>3/2</sup> v, A &lt; 1"
    assert inline.formula("F = K delta^1.5 v^-0.5.") == "F = K δ<sup>1.5</sup> v<sup>−0.5</sup>."
    assert inline.formula("m_j -> r m_j, 1 - c, 5 us") == "m<sub>j</sub> → r m<sub>j</sub>, 1 − c, 5 µs"
    assert inline.typeset("10^-3: 3 ± 1 us (-4.1 σ), fig3a-width, 1e-6") == (
        "10⁻³: 3 ± 1 µs (−4.1 σ), fig3a-width, 1e-6"
    )
    assert inline.typeset("+-1 mm, 0.07 uN at 7.8 g/cm3, 10^3 us") == "±1 mm, 0.07 µN at 7.8 g/cm³, 10³ µs"
    assert inline.formula("m u'^2/tau") == "m u&#39;<sup>2</sup>/τ"


def test_a_folder_of_older_days_has_a_page_without_origin(tmp_path):
    page = write_page(write(tmp_path / "made", "single")).read_text(encoding="utf-8")
    assert "<h1>made</h1>" in page
    assert 'class="sketch"' not in page


def test_beads_that_differ_come_back_by_their_numbers(tmp_path):
    """JSON has texts for keys, a record has numbers of beads: a sensor of another mass ended every page."""
    chain = {"beads": 12, "orientation": "vertical", "bead": STEEL, "wall": {"material": "brass"}}
    one = record(chain=chain | {"bodies": {5: {"mass_g": 4.5, "faces": "flat"}}})
    made = write(tmp_path / "made", "single")
    write_json(given.inputs((one,)), made / given.FILE)
    _, (read,) = given.read(made)
    assert read.block == one.block
    assert "bead 5 bearing-steel, 10 mm, 4.5 g, flat faces" in write_page(made).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "text", ["{", '{"format": 1}', json.dumps({"version": "1", "records": [{"name": 3}]})]
)
def test_a_damaged_origin_is_refused(folder, text):
    (folder / given.FILE).write_text(text)
    with pytest.raises(InputError, match=r"given\.json: not what sonicvacuum discover writes"):
        write_page(folder)


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


def test_data_that_test_nothing_have_a_page_without_probabilities(folder):
    blank = verdict(named=[], parameters={}, upper_limits={}, not_testable=["gravity"])
    write_json(blank, folder / "verdict.json")
    page = write_page(folder).read_text(encoding="utf-8")
    sure = page[page.index("How sure") : page.index("What else it could be")]
    assert "can test no effect of the catalogue, so no probabilities are given" in sure
    assert "bars" not in sure
