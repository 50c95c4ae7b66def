"""The page of a record says what its verdict says, whatever the outcome, and needs nothing but itself."""

import dataclasses
import json
import re
import shutil
from html.parser import HTMLParser
from xml.etree import ElementTree

import numpy as np
import pytest
from made_verdicts import KINDS, WITHOUT_TRACES, verdict, write

from sonicvacuum.discover import draws
from sonicvacuum.discover.judge.strained import ONLY_WITH
from sonicvacuum.discover.verdict import write_json
from sonicvacuum.effects import CATALOGUE, Catalogue, Effect, Source
from sonicvacuum.figures import disagreement, discovery, posterior, raster
from sonicvacuum.figures.drawing import POINT, Curve, Text
from sonicvacuum.files import InputError
from sonicvacuum.physics import compiled
from sonicvacuum.report import misfit, plots, record, words
from sonicvacuum.report.record import write_page
from sonicvacuum.tables import read_csv


class Page(HTMLParser):
    """Words, ids and what a browser would fetch."""

    def __init__(self, text):
        super().__init__()
        self.words, self.fetched, self.ids = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.ids += [given["id"]] if "id" in given else []
        source = given.get("src") or (given.get("href") if tag == "link" else None)
        if source and not source.startswith("data:"):
            self.fetched.append(source)

    def handle_data(self, data):
        self.words.append(data)


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Kind of outcome → its folder with pictures and page."""
    root = tmp_path_factory.mktemp("discover")
    made = {kind: write(root / kind, kind) for kind in KINDS}
    for folder in made.values():
        discovery.draw(folder)
        record.write_page(folder)
    return made


def told(folder):
    return " ".join(" ".join(Page((folder / "index.html").read_text()).words).split())


def test_what_the_nominal_model_strains_stands_where_it_disagrees_nowhere():
    said = f"{ONLY_WITH} the gain of gauge wall 1.93 times the stated one, 35 of its stated errors away"
    v = verdict(named=["kuwabara-kono"], where=[])
    cells = [{"sensor": "g1", "feature": "amplitude", "q_before": "0.9"}]
    plain = misfit.where(v, cells)
    v.reasons.append(said)
    assert "spread over them" in plain
    strained = misfit.where(v, cells)
    assert strained.endswith("The" + said[3:] + ": that is what speaks against it.")
    assert "spread over them" not in strained


SENTENCES = {
    "none": (
        "Nothing is named: the nominal model explains these data",
        "That none of the effects that these data could show is missing is probable (0.91)",
        "Nowhere: of 8 comparisons",
        "The nearest single effects: damping with constant restitution (0.08)",
        "No proposal: no rivals are left",
    ),
    "single": (
        "What is missing: Viscoelastic Hertz contact (kuwabara-kono)",
        "very probable (0.97)",
        "In 1 of 8 comparisons (run, gauge and feature of the trace)",
        "run fast, gauge g1: the data show a lower peak than predicted, by 12 standard errors",
        "1.980 ± 0.060 µs",
        "1.8813 to 2.0787",
        "falls from 80.7 to 1.05 (99.9 % of the gap closed)",
        "No rival comes near",
        "with the striker at 1.25 m/s would most likely leave one explanation alone: viscoelastic Hertz "
        "contact and damping with constant restitution, its nearest rival there, would differ by about 5 "
        "standard errors",
        "Beside what was named these data cannot test: gravity along the chain",
    ),
    "class": (
        "one of viscoelastic Hertz contact or damping with constant restitution, which these data cannot",
        "together practically certain (0.99)",
        "These data cannot tell viscoelastic Hertz contact from damping with constant restitution.",
    ),
    "pair": (
        "Two effects are missing: Mass defect (mass-defect)",
        "sits at bead",
        "These data cannot tell viscoelastic Hertz contact from damping with constant restitution.",
        "mass-defect + kuwabara-kono",
    ),
    "unknown": (
        "Something is missing, and it is unknown",
        "practically certain (above 0.99)",
        "The nearest model that was found, which is not named, leaves 1.02",
    ),
    "scalars": (
        "In 1 of 2 comparisons (run and measured quantity)",
        "run fast: the measured restitution is lower than predicted",
        "restitution at most 0.85 ± 0.01 0.99 0.84 –",
        "Only the last column is a prediction",
        "There is one run only",
        "this record has none",
    ),
    "ball": ("(hunt-crossley)", "practically certain (above 0.99)", "0.0270 ± 0.0014"),
}


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_can_be_read_aloud(folders, kind):
    text = told(folders[kind])
    for sentence in SENTENCES[kind]:
        assert sentence in text
    assert "nan" not in text.lower().replace("nanosecond", "")
    assert "None" not in text


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_needs_nothing_but_itself_and_no_id_stands_twice(folders, kind):
    page = Page((folders[kind] / "index.html").read_text())
    assert page.fetched == []
    assert len(page.ids) == len(set(page.ids))


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


def test_times_do_not_enter_the_page(folders):
    assert "12.345" not in told(folders["single"])


def test_a_new_verdict_removes_the_pictures_of_the_old_one(tmp_path):
    folder = write(tmp_path / "made", "ball")
    (folder / "traces.svg").write_text("stale")
    discovery.draw(folder)
    assert not (folder / "traces.svg").exists()


def test_the_same_verdict_gives_the_same_bytes(folders, tmp_path):
    again = write(tmp_path / "again", "pair")
    discovery.draw(again)
    record.write_page(again)
    for path in again.iterdir():
        assert path.read_bytes() == (folders["pair"] / path.name).read_bytes(), path.name


def test_a_folder_of_something_else_is_refused_with_the_file(tmp_path):
    with pytest.raises(InputError, match=r"verdict\.json: No such file"):
        record.write_page(tmp_path)
    folder = write(tmp_path / "made", "none")
    (folder / "verdict.json").write_text('{"named": 3}')
    with pytest.raises(InputError, match=r"verdict\.json: not what sonicvacuum discover writes"):
        record.write_page(folder)


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


def test_sets_that_come_near_are_told_where_no_single_effect_does():
    odds = {"unknown": 0.7, "mass-defect + tsuji": 0.2, "gravity + unknown": 0.1}
    told = words.alternatives(verdict(named=["unknown"], probabilities=odds, parameters={}))
    assert told == (
        "No single effect comes near. "
        "The nearest sets: mass defect and damping with constant restitution (0.20)."
    )


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
    assert f"{found[0]:.4f} to {found[1]:.4f}" in text  # a digit more than 1.980 ± 0.060
    assert ("Pareto k" in text) == (how == draws.SAMPLED)
    assert ("the valley that they leave" in text) == (how == draws.VALLEY)


def test_all_significant_comparisons_are_counted_and_not_only_those_kept():
    """The verdict keeps 40 at most; the page counts what where.csv holds."""
    cell = {"sensor": "g1", "feature": "amplitude", "z_before": "-9"}
    cells = [{**cell, "run": f"r{k}", "q_before": "1e-9" if k < 45 else "0.5"} for k in range(60)]
    told = misfit.where(verdict(where=KINDS["single"].where * 40), cells)
    assert "In 45 of 60 comparisons" in told
    assert "amplitude (45)" in told


def test_every_picture_is_described(folders):
    text = (folders["single"] / "index.html").read_text()
    assert len(re.findall(r'<svg role="img" aria-label=', text)) == len(re.findall("<svg", text))


def test_what_leaves_the_range_of_the_physics_stands_on_the_page(tmp_path):
    folder = write(tmp_path / "made", "single")
    told = "contact 3 is pressed by 200 um, 0.17 of its <effective> radius"
    write_json(verdict(warnings=[told]), folder / "verdict.json")
    page = write_page(folder).read_text(encoding="utf-8")
    assert "Beware: contact 3 is pressed by 200 µm, 0.17 of its &lt;effective&gt; radius." in page


def test_a_name_of_any_kind_leaves_ids_whole(tmp_path):
    folder = write(tmp_path / "made", "single")
    (folder / "parameters.svg").write_text('<svg width="100pt"><g id="a"/><use href="#a"/></svg>')
    write_json(verdict(record='"><script>x</script> µ'), folder / "verdict.json")
    page = write_page(folder).read_text(encoding="utf-8")
    assert "<script>x" not in page
    (id,) = re.findall(r'<g id="([^"]*-parameters[^"]*)"', page)
    assert re.fullmatch(r"[A-Za-z0-9_.-]+", id)
    assert f'href="#{id}"' in page


def test_data_for_a_script_hold_nothing_that_ends_or_hides_it():
    hostile = "</script><!--<script>"
    text = str(plots.script([{"title": hostile}]))
    data = text.split(">", 1)[1].split("</script>", 1)[0]
    assert "<" not in data
    assert json.loads(data) == [{"title": hostile}]


class Tags(HTMLParser):
    """Names of tags in order, and of attributes that would run something."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.handlers = [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.handlers += [name for name, _ in attributes if name.startswith("on")]


def test_words_of_an_effect_of_ones_own_are_text(folders, tmp_path):
    hostile = "\"'><img src=x onerror=alert(1)>&amp; <!--<script> ${x} a_{<b>} $\\\\frac{$"
    words = {f.name: hostile for f in dataclasses.fields(Effect) if f.type in ("str", str) and f.name != "id"}
    own = tuple(
        dataclasses.replace(e, **words, source=Source(hostile, "0" * 64)) if e.id == "kuwabara-kono" else e
        for e in CATALOGUE
    )
    known = Catalogue(own, CATALOGUE.besides)
    folder = write(tmp_path / "made", "class")
    discovery.draw(folder, known)
    found, usual = (
        Tags(path.read_text(encoding="utf-8"))
        for path in (write_page(folder, known), folders["class"] / "index.html")
    )
    assert set(found.tags) <= {*usual.tags, "sub", "i"}  # formulas have subscripts
    assert found.handlers == []
    assert "onerror=alert(1)" in told(folder)
    for picture in folder.glob("*.svg"):
        ElementTree.parse(picture)


def test_hostile_names_of_runs_gauges_and_the_rest_are_text(folders, tmp_path):
    """Names from a record, put where each kind of name stands, add no tag and no attribute to the page."""
    hostile = "\"'><img src=x onerror=alert(1)>&amp;"
    folder = write(tmp_path / "made", "single")
    for path in folder.iterdir():
        text = path.read_text()
        for name in ("fast", "g1", "made", "kuwabara-kono leaves nothing significant"):
            quoted = hostile.replace('"', '""') if path.suffix == ".csv" else hostile.replace('"', '\\"')
            text = re.sub(rf"(?<![\w-])\"?{name}\"?(?![\w-])", lambda _, q=quoted: f'"{q}"', text)
        path.write_text(text)
    discovery.draw(folder)
    page = write_page(folder).read_text(encoding="utf-8")
    found, usual = (Tags(text) for text in (page, (folders["single"] / "index.html").read_text()))
    assert set(found.tags) == set(usual.tags)
    assert found.tags.count("img") == usual.tags.count("img")
    assert found.handlers == []
    assert "onerror=alert(1)" in " ".join(Page(page).words)
    ids = Page(page).ids
    assert len(ids) == len(set(ids)) and all(re.fullmatch(r"[A-Za-z0-9_.-]+", id) for id in ids)


def test_a_page_of_kept_templates_is_the_same(tmp_path, monkeypatch):
    folder = write(tmp_path / "found", "single")
    monkeypatch.setattr(compiled, "cache_folder", lambda: None)
    plain = write_page(folder).read_bytes()
    monkeypatch.setattr(compiled, "cache_folder", lambda: tmp_path)
    pages = [write_page(folder).read_bytes()]
    kept = sorted(tmp_path.glob("page-*.bin"))
    pages.append(write_page(folder).read_bytes())
    for one in kept:
        one.write_bytes(b"damaged")
    pages.append(write_page(folder).read_bytes())
    assert kept
    assert pages == 3 * [plain]
