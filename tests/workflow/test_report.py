"""The page and the README say what the tables say, and the page needs nothing but itself."""

import json
import re
from html.parser import HTMLParser

import pandas as pd
import pytest

from sonicvacuum import config
from sonicvacuum.files import InputError
from sonicvacuum.report.inline import with_subscripts
from sonicvacuum_paper.report import answer, cursor, publish, tables, timings
from sonicvacuum_paper.report.page import CLAIMS, Sources, build
from sonicvacuum_paper.verdict import VERDICTS

_OLD = ("claim", "section", "quantity", "unit", "measured", "sigma", "layer", "matched", "difference_sigma")
_ROWS = [
    ("a-speed", "Fig. 1", "speed", "m/s", "100", "10", "90", "101.23456", "0.12", "reproduced", "close"),
    ("b-order", "Fig. 2", "order", "1", "1", "", "0", "0", "", "disagrees", "it <does> not hold"),
    ("c-mass", "Fig. 2", "mass", "g", "1", "0.1", "2", "2", "10", "disagrees", "2 against 1"),
    ("d-crack", "Fig. 7", "count", "1", "", "", "", "", "", "not testable", "needs a microscope"),
]
LEDGER = [
    {
        **dict.fromkeys(tables.LEDGER, ""),
        "kind": "simulation",
        **dict(zip((*_OLD, "verdict", "reason"), row, strict=True)),
    }
    for row in _ROWS
]
SVG = '<?xml version="1.0"?><svg><defs><clipPath id="c"/></defs><g clip-path="url(#c)"/></svg>'


PAGES = ("runs.html", "blind.html")


class Page(HTMLParser):
    """What a browser would fetch, the ids on the page, where links lead, the scales of drawings."""

    def __init__(self, text):
        super().__init__()
        self.fetched, self.ids, self.links, self.scales, self.folds = [], [], [], {}, 0
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.ids += [attributes["id"]] if "id" in attributes else []
        self.folds += tag == "details"
        if tag == "a":
            self.links.append(attributes["href"])
        if tag == "figure" and "data-scales" in attributes:
            self.scales[attributes["id"]] = json.loads(attributes["data-scales"])["panels"]
        if tag in ("script", "img", "link", "iframe") and (
            source := attributes.get("src", attributes.get("href"))
        ):
            self.fetched.append(source)


@pytest.fixture
def page(tmp_path, pytestconfig):
    """The page of small tables and two figures that use the same id."""
    ledger = pd.DataFrame(LEDGER, columns=tables.LEDGER)
    ledger.to_csv(tmp_path / "ledger.csv", index=False)
    claims = pd.DataFrame(
        [(row[0], row[1], f"Statement {row[0]}.", *[""] * 11) for row in _ROWS], columns=CLAIMS
    )
    claims.to_csv(tmp_path / "claims.csv", index=False)
    pd.DataFrame(columns=tables.ASSUMPTIONS).to_csv(tmp_path / "assumptions.csv", index=False)
    metrics = [("fig3a.matched", "speed", "g9-g5", "219.7", "m/s", "1e-6")]
    pd.DataFrame(metrics, columns=tables.METRICS).to_csv(tmp_path / "metrics.csv", index=False)
    for name in ("fig3", "fig4"):
        (tmp_path / f"{name}.svg").write_text(SVG)
    root = pytestconfig.rootpath
    card = config.card(config.read(root / "config.yaml"), "fig3a", "matched")
    paths = [tmp_path / f"{name}.csv" for name in ("ledger", "assumptions", "metrics", "claims")]
    drawn = [tmp_path / f"{name}.svg" for name in ("fig3", "fig4")]
    return build(
        Sources(*paths, figures=drawn, cards=[card], locks=[root / "requirements.lock"], linked=PAGES)
    )


def test_the_page_needs_nothing_but_itself(page):
    assert Page(page).fetched == []
    assert "url(http" not in page


def test_no_id_stands_twice(page):
    ids = Page(page).ids
    assert len(ids) == len(set(ids))
    assert {"fig3-c", "fig4-c"} <= set(ids)
    assert "url(#fig4-c)" in page


def test_every_drawing_is_told_to_a_screen_reader(page):
    body = page[: page.index("<script>")]
    assert len(re.findall(r'<svg role="img" aria-label="[^"]+"', body)) == body.count("<svg") == 2


def test_every_claim_stands_on_the_page(page):
    for row in _ROWS:
        assert row[0] in page
        assert f"Statement {row[0]}." in page
    assert "it &lt;does&gt; not hold" in page
    assert "101.2" in page
    assert "<i>F</i><sub>m</sub> − <i>F</i><sub>0</sub>" in with_subscripts("F_m − F_0")


def test_links_on_the_page_lead_to_its_parts_or_to_the_pages_beside_it(page):
    found = Page(page)
    inner = {link[1:] for link in found.links if link.startswith("#")}
    assert inner <= set(found.ids)
    assert {"runs.html", "blind.html", "runs.html#fig3a.matched"} <= set(found.links)
    assert found.folds == 5  # ledger, what is uncertain and its inputs, assumptions, cards


def test_the_model_that_decides_stands_in_the_row_and_the_others_below_the_statement(page):
    row = page[page.index('id="claim-a-speed"') :]
    row = row[: row.index("</tr>")]
    assert row.startswith('id="claim-a-speed"><td class="verdict reproduced">')
    assert '<td class="n" data-name="model">90</td>' in row
    assert "Hertz, 15 GPa: 101.2" in row


def test_the_committed_figures_tell_their_values(pytestconfig):
    """Every line that the script would read is in the drawing, and every panel has its frame."""
    folder = pytestconfig.rootpath / "figures"
    for name in ("fig3", "fig4", "fig5", "fig6"):
        panels = json.loads(cursor.of_figure(name, folder / f"{name}.csv"))["panels"]
        assert len(panels) == 2 + (name == "fig6")  # with its inset
        ids = Page((folder / f"{name}.svg").read_text()).ids
        assert len(ids) == len(set(ids))
        for panel in panels:
            left, top, right, bottom = panel["box"]
            assert 0 < left < right < 496.1 and 0 < top < bottom  # the page is 175 mm wide
            assert panel["lines"] and panel["x"][0] < panel["x"][1] and panel["y"][0] < panel["y"][1]
            assert {line["id"].removeprefix(f"{name}-") for line in panel["lines"]} <= set(ids)


def test_a_line_is_drawn_where_its_scale_says(pytestconfig):
    """The first peak of Fig. 3(a), from its table, lies on the path of its line in the SVG."""
    folder = pytestconfig.rootpath / "figures"
    table = pd.read_csv(folder / "fig3.csv")
    peak = table[(table.series == "peak") & (table.sensor == "g9") & (table.model == "layer")].iloc[0]
    panel = json.loads(cursor.of_figure("fig3", folder / "fig3.csv"))["panels"][0]
    base = next(line["base"] for line in panel["lines"] if line["id"] == "fig3-simulated-g9-layer")
    left, top, right, bottom = panel["box"]
    x = left + (peak.time_us - panel["x"][0]) / (panel["x"][1] - panel["x"][0]) * (right - left)
    y = bottom - (peak.force_N + base - panel["y"][0]) / (panel["y"][1] - panel["y"][0]) * (bottom - top)
    svg = (folder / "fig3.svg").read_text()
    path = re.search(r'id="simulated-g9-layer">\s*<path d="([^"]*)"', svg)[1]
    points = [tuple(map(float, pair)) for pair in re.findall(r"([\d.]+) ([\d.]+)", path)]
    # Units of the drawing, 1/72 inch: the table is a sample of the trace, the peak is between two of them.
    assert min(abs(px - x) + abs(py - y) for px, py in points) < 1.5


def test_the_same_tables_give_the_same_page(page, request):
    again = request.getfixturevalue("page")
    assert again == page


def test_disagreements_are_ranked_with_the_unmeasured_last():
    ledger = pd.DataFrame(LEDGER, columns=tables.LEDGER)
    assert list(tables.disagreements(ledger)["claim"]) == ["c-mass", "b-order"]
    assert tables.counts(ledger) == dict(zip(VERDICTS, (1, 2, 0, 0, 1), strict=True))


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("219.7123", "219.7"),
        ("0.000012345", "1.234e-5"),
        ("0", "0"),
        ("", ""),
        ("nan", ""),
        ("2..3", "2..3"),
        ("1500000", "1.5e6"),
    ],
)
def test_numbers_are_shown_with_four_digits(text, shown):
    assert tables.number(text) == shown


def test_a_table_with_other_columns_is_refused(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("a,b\n1,2\n")
    with pytest.raises(InputError, match=r"t\.csv: columns are a,b; expected case"):
        tables.read(path, tables.METRICS)


def test_publishing_replaces_the_summary_and_nothing_else(tmp_path):
    ledger, readme, reference = (tmp_path / name for name in ("l.csv", "R.md", "ref.csv"))
    pd.DataFrame(LEDGER, columns=tables.LEDGER).to_csv(ledger, index=False)
    begin, end = publish.BEGIN.format("results"), publish.END.format("results")
    readme.write_text(f"before\n{begin}\nstale\n{end}\nafter\n")
    publish.publish(ledger, readme, reference)
    text = readme.read_text()
    assert text.startswith("before\n") and text.endswith("\nafter\n") and "stale" not in text
    assert "Of 4 statements 4 need a simulation: the printed layer, with nothing fitted, reproduces 1" in text
    assert reference.read_bytes() == ledger.read_bytes()
    publish.publish(ledger, readme, reference)
    assert readme.read_text() == text


def test_a_readme_without_markers_is_refused():
    with pytest.raises(InputError, match="markers are missing"):
        publish.with_part("nothing here", "results", "text")


def test_the_readme_in_git_shows_the_ledger_in_git(pytestconfig):
    root = pytestconfig.rootpath
    ledger = tables.read(root / "workflow/resources/reference/ledger.csv", tables.LEDGER)
    readme = (root / "README.md").read_text()
    assert publish.with_part(readme, "results", publish.summary(ledger)) == readme


def test_words_of_a_ledger_stay_in_their_cell(pytestconfig):
    ledger = tables.read_ledger(pytestconfig.rootpath / "workflow/resources/reference/ledger.csv")
    for column in ("claim", "reason"):
        ledger[column] = "a | b\n<script>x</script> <!-- end of results -->"
    text = publish.summary(ledger)
    assert "<script" not in text and "<!--" not in text
    assert " | b" not in text


def test_the_answer_says_what_the_ledger_in_git_says(pytestconfig):
    ledger = tables.read_ledger(pytestconfig.rootpath / "workflow/resources/reference/ledger.csv")
    like = [("compare.layer", f"hertz_modulus_{case}", "9.1") for case in ("fig3a", "small_amplitude")]
    metrics = pd.DataFrame(like, columns=["case", "quantity", "value"])
    laws = {"speaks": 4, "of": 4, "ratios": ["1.5", "1.4"], "whole": 4}
    first, _, against, loss, _ = answer.sentences(ledger, metrics, laws)
    assert first.startswith("If the film is bonded, linear and 50 µm thick, the 15 GPa come mostly from its ")
    assert "contradicts three printed numbers: its pulse is too fast (+3.7 σ), too short (74.6 µs" in against
    assert against.endswith(
        "; too strong as well (4.82 N against about 3), if Fig. 7 tells the largest force of all tests."
    )
    assert loss.endswith("All four laws of loss agree on both speeds: ratio 1.5 on the layer, 1.4 on Hertz.")
    short = ledger.assign(excluded=ledger["excluded"].where(ledger["claim"] != "fig3a-width", ""))
    *_, against, loss, _ = answer.sentences(short, metrics, laws | {"speaks": 3, "whole": 2})
    assert "contradicts two printed numbers" in against and "narrow" not in against
    assert "3 of 4 laws of loss agree" in loss
    assert loss.endswith("the pulse of Fig. 6(b) stays whole on the layer with 2 of them.")
    none = answer.sentences(ledger.assign(excluded="matched_loss"), metrics)[2]
    assert none.startswith("The layer without losses contradicts none")


def test_the_headlines_are_claims(pytestconfig):
    claims = tables.read(pytestconfig.rootpath / "workflow/resources/claims.csv", CLAIMS)
    assert set(tables.FIRST) <= set(claims["claim"])


def test_links_in_the_readme_and_the_pages_lead_somewhere(pytestconfig):
    root = pytestconfig.rootpath
    for page in (root / "README.md", *(root / "docs").glob("*.md")):
        for target in re.findall(r"\]\(([^)#]+)\)", page.read_text()):
            path = page.parent / target
            assert target.startswith("https://") or path.exists(), f"{page.name}: {target}"


def test_the_benchmark_has_a_page_of_its_own(tmp_path, pytestconfig):
    page, table = tmp_path / "benchmark.md", tmp_path / "bench.md"
    page.write_text((pytestconfig.rootpath / "docs/benchmark.md").read_text())
    table.write_text("| code | P1 |\n")
    publish.publish_benchmark(table, page)
    begin = publish.BEGIN.format("benchmark")
    assert f"{begin}\n| code | P1 |\n{publish.END.format('benchmark')}" in page.read_text()


def test_timings_summarise_the_benchmark_files(tmp_path):
    (tmp_path / "draw").mkdir()
    for name, seconds in (("a", 1.0), ("b", 3.0)):
        (tmp_path / "draw" / f"{name}.tsv").write_text(f"s\tmax_rss\n{seconds}\t{10 * seconds}\n")
    (tmp_path / "page.tsv").write_text("s\tmax_rss\n0.5\t-\n")
    table = timings.gather(tmp_path).set_index("rule")
    assert table.loc["draw", ["jobs", "median_s", "longest_s", "peak_memory_MB"]].tolist() == [
        2,
        2.0,
        3.0,
        30.0,
    ]
    assert table.loc["page", "jobs"] == 1
