"""The page of a verdict in a real browser: `make browser` runs this, no other suite does.

Needs a Chromium (`apt-get install chromium`), found on the path or named by the variable CHROMIUM.
"""

import os
import re
import shutil
from itertools import combinations

import pytest
from made_chains import STEEL, STRIKER, record
from made_verdicts import KINDS, WITHOUT_TRACES, write
from playwright.sync_api import sync_playwright

from sonicvacuum.discover import given
from sonicvacuum.discover.verdict import write_json
from sonicvacuum.figures import discovery
from sonicvacuum.report.record import write_page

WIDTHS = (1300, 900, 390)
SCHEMES = ("light", "dark")
NAMES = ("chromium", "chromium-browser", "google-chrome")
# A page of two runs and two gauges; a long record folds, so that it adds little.
MOST_SHEETS = 5
# CSS px between the margins of an A4 sheet.
SHEET = 703
BALL = {"beads": 0, "orientation": "vertical", "bead": STEEL, "wall": {"material": "stainless-steel"}}
DROPS = [
    {"id": run, "striker": STRIKER, "observables": [
        {"quantity": "restitution", "value": 0.9, "sigma": 0.01, "unit": "1"}]}
    for run in ("slow", "fast")
]  # fmt: skip


@pytest.fixture(scope="session")
def browser():
    found = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)
    if not found:
        pytest.fail("no browser is here: apt-get install chromium, or name one: make browser CHROMIUM=…")
    with sync_playwright() as playwright:
        one = playwright.chromium.launch(executable_path=found, args=["--no-sandbox"])
        yield one
        one.close()


@pytest.fixture(scope="session")
def address(tmp_path_factory):
    """A page with everything on it."""
    folder = write(tmp_path_factory.mktemp("found") / "made", "class")
    write_json(given.inputs((record(),)), folder / given.FILE)
    discovery.draw(folder)
    return write_page(folder).as_uri()


@pytest.fixture
def opened(browser, address):
    """Opens the page at a width; afterwards nothing may have gone wrong, nor come from elsewhere."""
    wrong, fetched, pages = [], [], []

    def at(width, scheme="light", **options):
        page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme, **options)
        page.on("console", lambda m: wrong.append(m.text) if m.type in ("error", "warning") else None)
        page.on("pageerror", lambda e: wrong.append(str(e)))
        page.on("request", lambda r: fetched.append(r.url))
        page.goto(address)
        if options.get("java_script_enabled", True):
            page.wait_for_selector(".uplot canvas")
        pages.append(page)
        return page

    yield at
    for page in pages:
        page.close()
    assert wrong == []
    assert {url for url in fetched if not url.startswith("data:")} == {address}


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_is_wider_than_the_window(opened, width, scheme):
    page = opened(width, scheme)
    page.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    dark = page.evaluate("getComputedStyle(document.body).backgroundColor") != "rgb(255, 255, 255)"
    assert dark == (scheme == "dark")


def test_long_numbers_do_not_run_into_the_name_of_the_axis(browser, tmp_path):
    """Volts of a gauge, −0.0005 and the like, stood on "reading (as recorded)"."""
    places = []
    for scale in (1.0, 1e-3):
        folder = write(tmp_path / f"{scale}", "single")
        lines = (folder / "traces.csv").read_text().splitlines()
        rows = [line.split(",") for line in lines[1:]]
        scaled = [[*r[:3], *(repr(scale * (float(v) - 0.5)) for v in r[3:6]), r[6]] for r in rows]
        (folder / "traces.csv").write_text("\n".join([lines[0], *map(",".join, scaled)]) + "\n")
        page = browser.new_page(viewport={"width": 1300, "height": 900})
        page.goto(write_page(folder).as_uri())
        page.wait_for_selector(".uplot canvas")
        places.append(page.evaluate("parseFloat(document.querySelector('.signal .u-over').style.left)"))
        page.close()
    assert places[1] >= places[0] + 10.0  # "−0.0005" for "−0.5"; 12 px of type are some 7 px wide


def told(page, name):
    """Number under the cursor, of the upper picture."""
    row = page.locator(".signal .u-series", has_text=name).locator(".u-value")
    text = row.inner_text().replace("–", "nan")
    return float(text)


def plot(page):
    """Where the upper picture stands in the window."""
    over = page.locator(".signal .u-over")
    over.scroll_into_view_if_needed()
    return over.bounding_box()


def hover(page, share):
    """Move the cursor to a share of the width and wait until the legend has followed."""
    box = plot(page)
    page.mouse.move(box["x"] + share * box["width"] - 3.0, box["y"] + 0.4 * box["height"])
    page.mouse.move(box["x"] + share * box["width"], box["y"] + 0.5 * box["height"])
    page.wait_for_function("document.querySelector('.signal .u-value').textContent !== '–'")
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def test_values_stand_under_the_cursor(opened):
    page = opened(1300)
    hover(page, 0.5)
    # The pulse of the made record: 1 N at 200 us, measured 0.01 and extended 0.005 above nominal.
    assert told(page, "time") == pytest.approx(200.0, abs=3.0)
    assert told(page, "nominal") == pytest.approx(1.0, abs=0.01)
    assert told(page, "measured") - told(page, "nominal") == pytest.approx(0.01, abs=2e-3)


def test_a_drag_zooms_and_a_double_click_comes_back(opened):
    page = opened(1300)
    box = plot(page)
    middle = box["y"] + 0.5 * box["height"]
    page.mouse.move(box["x"] + 0.4 * box["width"], middle)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.6 * box["width"], middle, steps=5)
    page.mouse.up()
    hover(page, 0.02)
    assert told(page, "time") == pytest.approx(163.0, abs=6.0)
    page.mouse.dblclick(box["x"] + 0.5 * box["width"], middle)
    hover(page, 0.02)
    assert told(page, "time") == pytest.approx(8.0, abs=6.0)


def test_every_run_and_gauge_can_be_chosen(opened):
    page = opened(900)
    runs = page.locator("select[name=run] option").all_inner_texts()
    assert runs == ["slow", "fast"]
    seen = set()
    for _ in range(4):
        page.click("button[name=later]")
        seen.add((page.input_value("select[name=run]"), page.input_value("select[name=sensor]")))
    assert seen == {(r, s) for r in runs for s in ("g1", "wall")}
    page.select_option("select[name=run]", "slow")
    assert page.locator(".signal .uplot").count() == 1


def test_it_prints_on_few_sheets(opened):
    page = opened(1300)
    sheets = len(re.findall(rb"/Type\s*/Page\b(?!s)", page.pdf(format="A4")))
    assert 1 <= sheets <= MOST_SHEETS


def test_without_scripts_it_can_still_be_read(opened):
    page = opened(900, java_script_enabled=False)
    assert "traces.svg" in page.inner_text("body")
    assert "What is missing is one of" in page.inner_text("body")


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_verdict_fits_a_phone_and_a_sheet(browser, tmp_path, kind):
    """Named, unknown, a set, numbers only, one ball: nothing is wider than its window, on paper neither."""
    folder = write(tmp_path / "made", kind)
    of = record(beads=0, sensors=[], chain=BALL, runs=DROPS) if kind in WITHOUT_TRACES else record()
    write_json(given.inputs((of,)), folder / given.FILE)
    discovery.draw(folder)
    address = write_page(folder).as_uri()
    for width, options in ((390, {"color_scheme": "dark"}), (SHEET, {})):
        page = browser.new_page(viewport={"width": width, "height": 900}, **options)
        page.goto(address)
        if width == SHEET:
            page.emulate_media(media="print")
        page.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        shown = page.locator("svg.sketch text").evaluate_all(
            "(all) => all.map((e) => e.getBoundingClientRect()).map((r) => [r.left, r.right, r.y, r.bottom])"
        )
        assert not [(a, b) for a, b in combinations(shown, 2) if meet(a, b)]
        page.close()


def meet(one, other) -> bool:
    """Whether two boxes (left, right, top, bottom) in px cover each other by more than a pixel."""
    beside = min(one[1], other[1]) - max(one[0], other[0])
    above = min(one[3], other[3]) - max(one[2], other[2])
    return beside > 1.0 and above > 1.0
