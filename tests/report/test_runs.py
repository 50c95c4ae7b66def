"""The page of all runs: each a map and its gauges, a user's own among them; and the pictures that move."""

import json
import re
from dataclasses import asdict
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
import yaml

import sonicvacuum as sv
from sonicvacuum import config
from sonicvacuum.card import CaseBlock, resolve
from sonicvacuum.files import convert
from sonicvacuum.simulation import simulate
from sonicvacuum_paper.figures import drawable, names
from sonicvacuum_paper.metrics import card_rows
from sonicvacuum_paper.report import animation, runs, space_time, tables
from sonicvacuum_paper.shown import own

BALL = {"diameter_mm": 5.0, "mass_g": 0.51, "material": "bearing-steel"}
BLOCK = {
    "title": "A chain of one's own",
    "chain": {"beads": 6, "orientation": "horizontal", "bead": BALL, "wall": {"material": "bearing-steel"}},
    "striker": {"shape": "sphere", **BALL, "speed_m_s": [0.3, 0.6]},
    "sensors": [
        {"id": "g3", "kind": "embedded", "bead": 3},
        {"id": "laser", "kind": "velocity", "bead": 4},
        {"id": "wall", "kind": "wall"},
    ],
    "duration_us": 150,
}


@pytest.fixture(scope="module")
def study():
    """Two runs of a small chain, with a gauge of each sort of reading."""
    return simulate(resolve("mine", "nominal", convert(BLOCK, CaseBlock, "case")))


@pytest.fixture
def page(study, tmp_path):
    """The page of it."""
    table = pd.DataFrame(map(asdict, card_rows(study)))[tables.METRICS]
    table.to_csv(tmp_path / "metrics.csv", index=False)
    return runs.build([study], tmp_path / "metrics.csv")


def figures(page):
    """Run → panels of its drawing."""
    found = re.findall(r'<figure id="([^"]+)" class="run" data-scales="([^"]+)"', page)
    return {name: json.loads(text.replace("&#34;", '"'))["panels"] for name, text in found}


def test_every_run_of_a_case_has_its_map_gauges_and_numbers(page, study):
    drawn = figures(page)
    assert list(drawn) == ["run-mine.nominal-at-0.3", "run-mine.nominal-at-0.6"]
    assert "<strong>your own</strong>" in page
    for lane, (name, (space, *gauges)) in enumerate(drawn.items()):
        assert space["map"]["most"] == pytest.approx(study.force[:, :, lane].max(), abs=1e-6)  # as written
        assert space["map"]["rows"] == ["striker–1", "1–2", "2–3", "3–4", "4–5", "5–6", "6–wall"]
        assert [panel["lines"][0]["rows"] for panel in gauges] == [[2, 3], [3, 4], [6]]
        assert [panel["yunit"] for panel in gauges] == ["N", "m/s", "N"]
        assert all(f'id="{panel["lines"][0]["id"]}"' in page for panel in gauges)
        assert name in page
    assert page.count("<td>g3</td>") == 2
    assert "speed g3-laser: 5" in page


def test_the_same_study_gives_the_same_page(page, study, tmp_path):
    assert runs.build([study], tmp_path / "metrics.csv") == page


def test_a_line_is_drawn_where_its_scale_says(study):
    """The peak of a reading, read back off the drawing, within what thinning and rounding may move."""
    made = space_time.drawing(study, 1, "x")
    panel = json.loads(made["scales"])["panels"][1]
    text = re.search(r'id="x-g3"[^>]*points="([^"]+)"', made["svg"])[1]
    points = np.array([pair.split(",") for pair in text.split()], dtype=float)
    _, top, _, bottom = panel["box"]
    low, high, _ = panel["y"]
    values = low + (bottom - points[:, 1]) / (bottom - top) * (high - low)
    reading = study.readings()["g3"][:, 1]
    assert values.max() == pytest.approx(reading.max(), rel=0.005)  # 0.12 of 46 units
    assert len(points) < len(reading) / 2


def test_thinning_moves_a_line_by_no_more_than_it_may():
    x = np.linspace(0.0, 10.0, 400)
    points = np.column_stack([x, np.sin(x) + 0.3 * np.sin(7.0 * x)])
    kept = space_time.thinned(points, 0.01)
    assert np.abs(np.interp(x, *kept.T) - points[:, 1]).max() <= 0.01
    assert len(kept) < 150
    assert len(space_time.thinned(np.column_stack([x, 2.0 * x]), 1e-9)) == 2


def test_metrics_of_other_columns_are_refused(study, tmp_path):
    pd.DataFrame(columns=[*tables.METRICS, "more"]).to_csv(tmp_path / "metrics.csv", index=False)
    with pytest.raises(sv.InputError, match="columns are"):
        runs.build([study], tmp_path / "metrics.csv")


def test_a_picture_moves_the_beads_and_nothing_else():
    for name, text in ((name, animation.animation(name)) for name in ("solitary", "train")):
        root = ElementTree.fromstring(text)
        moves = root.findall(".//{*}animate[@attributeName='cx']")
        assert len(moves) == animation.BEADS + 1
        paths = np.array([m.get("values").split(";") for m in moves], dtype=float)
        assert paths.shape[1] == animation.FRAMES
        assert np.all(np.diff(paths, axis=0) > 0.0), f"{name}: beads change places"
        assert len(text) < 40_000


def test_an_equal_ball_stops_and_a_heavy_one_follows():
    """One impact hands an equal ball's momentum on (v/v0 below 1/10); five beads' mass keeps two thirds."""
    _, equal = animation._motion(1.0)
    place, _ = animation._motion(5.0)
    assert np.all(equal[-10:, 0] < 0.1)
    assert place[-1, 0] > 0.9 * place[:, 1:].max()
    with pytest.raises(sv.InputError, match="use one of solitary, train"):
        animation.animation("soliton")


def test_a_configuration_of_own_cases_needs_no_ledger(tmp_path):
    path = tmp_path / "own.yaml"
    path.write_text(yaml.safe_dump({"cases": {"mine": BLOCK}}))
    found = config.read(path)
    assert found.ledger == {}
    assert [own(name) for name in config.card_names(found)] == [True]
    assert not own("fig3a.layer")
    assert not any(drawable(name, config.card_names(found)) for name in names())
