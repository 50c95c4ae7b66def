"""What a page draws beside the pictures of a verdict: the sketch, traces to zoom, the grid, a free law."""

import csv
import re
from itertools import pairwise

import pytest
from made_chains import STEEL, STRIKER, record
from made_verdicts import verdict

from sonicvacuum.discover import given
from sonicvacuum.discover.law import Law, Near
from sonicvacuum.discover.verdict import write_json
from sonicvacuum.figures import discovery
from sonicvacuum.records.described import chain_of
from sonicvacuum.report import origin, plots, rows
from sonicvacuum.report.record import write_page
from sonicvacuum.report.sketch import MOST, sketch


def test_one_ball_falls_on_its_wall_and_is_not_made_of_it():
    ball = {"beads": 0, "orientation": "vertical", "bead": STEEL, "wall": {"material": "brass"}}
    run = {"id": "drop", "striker": STRIKER, "observables": [
        {"quantity": "restitution", "value": 0.9, "sigma": 0.01, "unit": "1"}]}  # fmt: skip
    of = record(chain=ball, sensors=[], runs=[run])
    assert chain_of(of) == "one ball of bearing-steel, 10 mm, 4 g, on a wall of brass, vertical"
    struck, wall = re.search(r'<text x="([\d.]+)" y="18.0">ball<.*?<text x="([\d.]+)"', sketch(of)).groups()
    # Letters are 6.2 wide: `wall: brass` begins behind the wall, not at the other end of the drawing.
    assert 4 * 6.2 <= float(wall) - 11 * 6.2 - float(struck) < 80.0
    labels = [row["label"] for row in origin.rows(given.inputs((of,), ()), [of])]
    assert labels[:2] == ["Ball", "Impacts"]


def test_a_coated_bead_is_told_with_its_core():
    coated = {**STEEL, "material": "ptfe", "coating_um": 60, "core": "bearing-steel"}
    chain = {"beads": 18, "orientation": "vertical", "bead": coated, "wall": {"material": "brass"}}
    assert chain_of(record(chain=chain)) == (
        "18 beads of ptfe (60 µm on bearing-steel), 10 mm, 4 g, vertical"
    )


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


@pytest.mark.parametrize("beads", [(19, 20, 21, 30), (8, 10), (1, 2, 3, 11, 12)])
def test_no_line_to_a_gauge_crosses_the_name_of_another(beads):
    sensors = [{"id": f"gauge{k}", "kind": "embedded", "bead": k} for k in beads]
    text = sketch(record(beads=39, sensors=sensors, runs=[
        {"id": "a", "striker": STRIKER, "observables": [
            {"quantity": "amplitude", "sensor": sensors[0]["id"], "value": 30.0, "sigma": 1.0, "unit": "N"}]}
    ]))  # fmt: skip
    names = re.findall(r'class="gauge" x="([\d.]+)" y="([\d.]+)">([^<]+)<', text)
    lines = re.findall(r'class="lead" d="M([\d.]+) [\d.]+ V([\d.]+)"', text)
    assert len(names) == len(lines) == len(beads)
    for x, bottom in lines:
        for left, y, name in names:
            beside = not float(left) < float(x) < float(left) + 6.2 * len(name)
            assert beside or float(bottom) <= float(y) - 11.0


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
