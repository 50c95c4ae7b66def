"""Pages in a real browser: Debian's Chromium without a screen, driven by Playwright; run by `make browser`.

Pages are those of `results/`, or of the folder that the variable RESULTS names; screenshots and printed pages
are left in `browser/` beside them, to be looked at.
"""

import os
import shutil
from pathlib import Path

import pytest
from playwright.sync_api import Page, sync_playwright

WIDTHS = (1300, 900, 390)


@pytest.fixture(scope="session")
def results(pytestconfig) -> Path:
    """Folder of the pages."""
    folder = Path(os.environ.get("RESULTS", pytestconfig.rootpath / "results")).resolve()
    assert (folder / "report.html").exists(), f"{folder}: no report.html; run make first"
    return folder


@pytest.fixture(scope="session")
def pictures(results) -> Path:
    """Folder of screenshots."""
    folder = results / "browser"
    folder.mkdir(exist_ok=True)
    return folder


@pytest.fixture(scope="session")
def chromium():
    """The browser, once for all tests."""
    path = shutil.which("chromium") or shutil.which("chromium-browser")
    assert path, "no Chromium: apt-get install chromium"
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture
def open_page(chromium, results):
    """Function (path below the results, width, scheme) → page; a word on its console fails the test."""
    said, contexts = [], []

    def opened(path: str, width: int = 1300, scheme: str = "light") -> Page:
        context = chromium.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda m: said.append(m.text) if m.type in ("error", "warning") else None)
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("request", lambda r: None if r.url.startswith(("file:", "data:")) else said.append(r.url))
        name, _, anchor = path.partition("#")
        page.goto((results / name).as_uri() + (f"#{anchor}" if anchor else ""))
        return page

    yield opened
    for context in contexts:
        context.close()
    assert said == []


def height(page: Page) -> int:
    """Height of the whole page in px."""
    return page.evaluate("document.documentElement.scrollHeight")


def sideways(page: Page) -> int:
    """By how many px the page is wider than its window."""
    return page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")


def unfold(page: Page) -> None:
    """Open every fold."""
    page.evaluate("document.querySelectorAll('details').forEach((part) => { part.open = true; })")


def pages_of(pdf: bytes) -> int:
    """Number of pages of a PDF."""
    return pdf.count(b"/Type /Page\n") + pdf.count(b"/Type /Page ") + pdf.count(b"/Type /Page/")
