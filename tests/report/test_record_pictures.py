"""The pictures of a verdict: which there are, that nothing leaves them, that they are described."""

import re
import shutil

import numpy as np
import pytest
from made_verdicts import KINDS, WITHOUT_TRACES, write

from sonicvacuum.discover import draws
from sonicvacuum.figures import disagreement, discovery, posterior, raster
from sonicvacuum.figures.drawing import POINT, Curve, Text
from sonicvacuum.report.record import write_page
from sonicvacuum.tables import read_csv


@pytest.mark.parametrize("kind", KINDS)
def test_the_pictures_are_those_that_the_record_gives(folders, kind):
    drawn = {path.stem for path in folders[kind].glob("*.svg")}
    expected = {"candidates", "gap"}
    expected |= {"scalars"} if kind in WITHOUT_TRACES else {"where", "traces"}
    expected |= {"parameters"} if KINDS[kind].parameters else set()
    assert drawn == expected
    assert not list(folders[kind].glob("*.png"))


def test_pictures_for_slides_are_drawn_where_they_are_asked_for(folders, tmp_path):
    found = shutil.copytree(folders["ball"], tmp_path / "found")
    drawn = {path.stem for path in discovery.draw(found, png=True)}
    assert drawn == {path.stem for path in found.glob("*.png")}
    discovery.draw(found)
    assert not list(found.glob("*.png"))


def test_a_new_verdict_removes_the_pictures_of_the_old_one(tmp_path):
    folder = write(tmp_path / "made", "ball")
    (folder / "traces.svg").write_text("stale")
    discovery.draw(folder)
    assert not (folder / "traces.svg").exists()


def beyond_the_page(drawing):
    """Texts with ink that leave the page, set in the font that is named first."""
    figure = raster.figure_of(drawing)
    renderer, page = figure.canvas.get_renderer(), figure.bbox
    boxes = [(t.get_text(), t.get_window_extent(renderer)) for t in figure.texts if t.get_text().strip()]
    assert boxes
    return [n for n, b in boxes if b.x0 < page.x0 or b.x1 > page.x1 or b.y0 < page.y0 or b.y1 > page.y1]


@pytest.mark.parametrize("kind", ["pair", "ball"])
def test_no_text_of_the_pictures_leaves_the_page(folders, kind):
    tables = {name: read_csv(folders[kind] / f"{name}.csv") for name in ("where", "parameters", "gap")}
    drawings = [
        posterior.parameters(tables["parameters"]),
        disagreement.where(tables["where"]),
        disagreement.scalars(tables["where"]),
        discovery.gap(tables["gap"]),
        discovery.candidates(KINDS[kind].probabilities),
    ]
    for drawing in filter(None, drawings):
        assert beyond_the_page(drawing) == []


def test_what_a_trace_is_of_stands_where_nothing_is_drawn(folders):
    """A pulse may be anywhere in a frame: the words stand above it, and below what is above them."""
    page = discovery.traces(read_csv(folders["single"] / "traces.csv"), ["kuwabara-kono"])
    frames = {m.clip for m in page.marks if isinstance(m, Curve) and m.clip}
    names = [m for m in page.marks if isinstance(m, Text) and m.words in ("slow, g1", "fast, wall")]
    assert len(frames) == 8 and len(names) == 2
    for text in names:
        for left, bottom, wide, high in frames:
            beside = text.x < left or text.x > left + wide
            assert beside or text.y >= bottom + high or text.y + text.size * POINT < bottom


def test_the_posterior_is_drawn_where_the_verdict_has_it(folders):
    (row,) = read_csv(folders["single"] / "parameters.csv")
    assert (float(row["value"]), float(row["sigma"])) == (1.98, 0.06)
    x, y = posterior.density(row)
    assert x[y.argmax()] == pytest.approx(1.98)
    half = x[y >= 0.5]
    # Full width at half height of a Gaussian, on a grid of 8 sigma in 400 steps.
    assert half[-1] - half[0] == pytest.approx(2.3548 * 0.06, abs=2 * 8 * 0.06 / 400)
    marks = posterior.parameters([row]).marks
    (curve,) = [m.points for m in marks if isinstance(m, Curve) and len(m.points) == 401]
    top = (curve[curve[:, 1].argmax(), 0] - 8.0) / 70.0
    assert top == pytest.approx((1.98 - x[0]) / (x[-1] - x[0]), abs=1 / 400)  # a step of the grid


@pytest.mark.parametrize("how", [draws.SAMPLED, draws.VALLEY, draws.PROFILE])
def test_intervals_are_of_the_draws_and_not_of_the_gaussian(how, tmp_path):
    """Draws of a skewed distribution: exp(-x), whose 90 % interval is -ln 0.95 to -ln 0.05."""
    folder = write(tmp_path / "made", "single")
    value = np.linspace(0.0, 12.0, 2401)
    weight = np.exp(-value) / np.exp(-value).sum()
    draws.write(folder, [draws.Draws("kuwabara-kono", "time_us", how, value, weight)])
    discovery.draw(folder)
    (row,) = read_csv(folder / "parameters.csv")
    assert row["how"] == how
    found = [float(row["from_90"]), float(row["to_90"])]
    assert found == pytest.approx([-np.log(0.95), -np.log(0.05)], abs=0.006)  # a step of the draws
    text = write_page(folder).read_text(encoding="utf-8")
    assert f"{found[0]:.3f} to {found[1]:.3f}" in text  # to the digits of 1.980 ± 0.060
    assert ("Pareto k" in text) == (how == draws.SAMPLED)
    assert ("the valley that they leave" in text) == (how == draws.VALLEY)


def test_every_picture_is_described(folders):
    text = (folders["single"] / "index.html").read_text()
    assert len(re.findall(r'<svg role="img" aria-label=', text)) == len(re.findall("<svg", text))
