"""Names and words that others chose stand on a page as text, whatever they hold."""

import dataclasses
import json
import re
from html.parser import HTMLParser
from xml.etree import ElementTree

from made_verdicts import verdict, write
from read_pages import Page, told

from sonicvacuum.discover.verdict import write_json
from sonicvacuum.effects import CATALOGUE, Catalogue, Effect, Source
from sonicvacuum.figures import discovery
from sonicvacuum.report import plots
from sonicvacuum.report.record import write_page


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
