"""The pages of the reproduction in a browser: what they do, how tall they are, how they print."""

import re

import pytest
from conftest import WIDTHS, height, pages_of, sideways, unfold

PAGES = ("report.html", "sure.html", "runs.html", "blind.html")
# px at a width of 1300, every fold open.
TALLEST = 9000


@pytest.mark.parametrize("name", PAGES)
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", WIDTHS)
def test_no_page_scrolls_sideways_nor_complains(open_page, pictures, name, width, scheme):
    page = open_page(name, width, scheme)
    assert sideways(page) == 0
    page.screenshot(path=pictures / f"{name.removesuffix('.html')}-{width}-{scheme}.png", full_page=True)
    unfold(page)
    assert sideways(page) == 0


def test_the_report_is_short_with_every_fold_open(open_page, pictures):
    page = open_page("report.html")
    unfold(page)
    page.screenshot(path=pictures / "report-1300-unfolded.png", full_page=True)
    assert height(page) <= TALLEST


@pytest.mark.parametrize("name", ["fig3", "fig4", "fig5", "fig6"])
def test_the_cursor_tells_the_values_of_a_line(open_page, name):
    """The middle of a line's own drawing is asked for, and its name and units are told."""
    page = open_page("report.html", 900)
    page.locator(f"#{name}").scroll_into_view_if_needed()
    told = page.locator(f"#{name} output")
    box = page.locator(f"#{name} svg").bounding_box()
    seen = set()
    for part in range(5, 100, 3):
        page.mouse.move(box["x"] + part / 100 * box["width"], box["y"] + 0.6 * box["height"])
        if told.is_visible():
            seen.add(told.inner_text())
    unit = "N, [0-9.]+ m/s$" if name == "fig4" else "µs, -?[0-9.e-]+ N$"
    assert len(seen) >= 5
    assert all(re.search(unit, text) for text in seen), seen


def test_a_value_under_the_cursor_is_the_one_of_the_table(open_page, results):
    """Fig. 3(a): the peak of the layer at g9, from the table beside the drawing."""
    import csv

    table = results.parent / "figures/fig3.csv"
    with open(table, encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    peak = next(r for r in rows if (r["series"], r["sensor"], r["model"]) == ("peak", "g9", "layer"))
    page = open_page("report.html")
    time, force = float(peak["time_us"]), float(peak["force_N"])
    place = page.evaluate(
        """([time]) => {
          const figure = document.getElementById("fig3"), svg = figure.querySelector("svg");
          const panel = JSON.parse(figure.dataset.scales).panels[0];
          const line = panel.lines.find((one) => one.id === "fig3-simulated-g9-layer");
          const [left, top, right, bottom] = panel.box;
          const x = left + ((time - panel.x[0]) / (panel.x[1] - panel.x[0])) * (right - left);
          svg.scrollIntoView();
          return { x, base: line.base, panel };
        }""",
        [time],
    )
    _, top, _, bottom = place["panel"]["box"]
    low, high, _ = place["panel"]["y"]
    y = bottom - (force + place["base"] - low) / (high - low) * (bottom - top)
    at = page.evaluate(
        """([x, y]) => { const svg = document.querySelector("#fig3 svg");
          const p = new DOMPoint(x, y).matrixTransform(svg.getScreenCTM()); return [p.x, p.y]; }""",
        [place["x"], y],
    )
    page.mouse.move(*at)
    told = page.locator("#fig3 output").inner_text()
    shown_time, shown_force = (float(v) for v in re.search(r"([\d.]+) µs, ([\d.]+) N", told).groups())
    assert told.startswith("9th bead, layer, 2.76 GPa:")
    assert shown_time == pytest.approx(time, abs=1.0)  # the cursor stands on whole pixels, 0.3 us each
    assert shown_force == pytest.approx(force, rel=0.02)  # the same in height, and the table's step of 2 us


def test_the_ledger_opens_filters_and_finds(open_page):
    page = open_page("report.html", 900)
    rows = page.locator("#claims tbody tr")
    assert not rows.first.is_visible()
    page.locator("#ledger summary").click()
    assert rows.first.is_visible()
    everything = rows.count()
    page.locator("#ledger button", has_text="disagrees").click()
    shown = page.locator("#claims tbody tr:not([hidden])")
    assert 0 < shown.count() < everything
    assert set(shown.locator("td.verdict").all_inner_texts()) == {"disagrees"}
    page.locator("#ledger button").first.click()
    page.locator("#ledger input").fill("speed fig3a")
    assert 0 < shown.count() < everything
    assert "shown" in page.locator("#ledger [aria-live]").inner_text()


@pytest.mark.parametrize("width", [900, 1300])
def test_every_column_of_the_ledger_is_in_sight(open_page, pictures, width):
    page = open_page("report.html#ledger", width)
    box = page.locator("#ledger .box").bounding_box()
    heads = page.locator("#claims th")
    assert page.locator("#ledger details").evaluate("(e) => e.open")
    for k in range(heads.count()):
        own = heads.nth(k).bounding_box()
        assert own["width"] >= 40
        assert box["x"] - 1 <= own["x"] and own["x"] + own["width"] <= box["x"] + box["width"] + 1
    page.screenshot(path=pictures / f"ledger-{width}.png")


def test_a_run_is_unfolded_by_its_link_and_its_map_tells_forces_and_gauges(open_page, pictures):
    page = open_page("report.html")
    unfold(page)
    page.locator("#made a", has_text="fig3a.layer").first.click()
    page.wait_for_url(re.compile(r"runs\.html#"))
    figure = page.locator("figure.run:visible").first
    image = figure.locator("image").bounding_box()
    for _ in range(2):  # the first move makes the script read the picture
        page.mouse.move(image["x"] + 0.3 * image["width"], image["y"] + 0.5 * image["height"])
        page.wait_for_timeout(100)
        page.mouse.move(image["x"] + 0.3 * image["width"] + 1, image["y"] + 0.62 * image["height"])
        page.wait_for_timeout(100)
    told = figure.locator("output").inner_text()
    assert re.search(r"µs · 1\d–1\d: [\d.]+ N · g9: -?[\d.]+ N · g5: -?[\d.]+ N · wall: -?[\d.]+ N", told), (
        told
    )
    assert figure.locator(".trace.picked").count() == 1
    page.screenshot(path=pictures / "run.png")


def test_the_waves_move_until_they_are_stopped(open_page):
    page = open_page("report.html")
    first = page.locator("#moving-solitary")
    time = "(e) => e.querySelector('svg').getCurrentTime()"
    before = first.evaluate(time)
    page.wait_for_timeout(300)
    assert first.evaluate(time) > before
    first.locator("button").click()
    stopped = first.evaluate(time)
    page.wait_for_timeout(300)
    assert first.evaluate(time) == stopped
    assert first.locator("button").inner_text() == "play"


@pytest.mark.parametrize(("name", "most"), [("report.html", 30), ("blind.html", 12)])
def test_pages_print_with_their_folds_open(open_page, pictures, name, most):
    page = open_page(name)
    pdf = page.pdf(path=pictures / f"{name.removesuffix('.html')}.pdf", format="A4", print_background=True)
    assert 1 <= pages_of(pdf) <= most
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    if name == "report.html":
        assert page.locator("#claims td.verdict").first.is_visible()
        assert not page.locator("#ledger .controls").is_visible()


def test_of_all_runs_those_are_printed_that_are_unfolded_and_with_their_numbers(open_page, pictures):
    page = open_page("runs.html#fig3b.nominal")
    page.emulate_media(media="print")
    rows = page.locator("#cards > tbody > tr")
    assert [row.is_visible() for row in rows.all()].count(True) == 1
    assert page.locator("[id='fig3b.nominal'] figure.run td").first.is_visible()
    assert page.get_by_text("On paper stand the cases that are unfolded").is_visible()
    assert pages_of(page.pdf(path=pictures / "runs.pdf", format="A4")) == 1
    page.emulate_media(media="screen")
    assert rows.first.is_visible()
