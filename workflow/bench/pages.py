"""How long and heavy pages are: each opened in Chromium at three widths, unfolded, and printed on A4.

`python workflow/bench/pages.py OUT NAME=FILE …` writes one row for each page; needs what `make browser`
installs, and a Chromium on the path. Heights are in px, of the whole page.
"""

import argparse
import csv
import shutil
from pathlib import Path

WIDTHS = (1300, 900, 400)
COLUMNS = ("page", "kB", "at 1300", "all unfolded", "at 900", "at 400", "A4 pages")
HEIGHT = "document.documentElement.scrollHeight"
SIDEWAYS = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
UNFOLD = "document.querySelectorAll('details').forEach((part) => { part.open = true; })"


def measured(browser, name: str, path: Path) -> list:
    """Row of one page; RuntimeError where it scrolls sideways or says a word on the console."""
    said, heights = [], []
    for width in WIDTHS:
        page = browser.new_page(viewport={"width": width, "height": 900})
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.goto(path.resolve().as_uri())
        page.wait_for_timeout(300)
        heights.append(page.evaluate(HEIGHT))
        if width == WIDTHS[0]:
            pdf = page.pdf(format="A4")
            page.evaluate(UNFOLD)
            heights.append(page.evaluate(HEIGHT))
        if page.evaluate(SIDEWAYS):
            said.append(f"scrolls sideways at {width} px")
        page.close()
    if said:
        raise RuntimeError(f"{path}: {said}")
    sheets = sum(pdf.count(b"/Type /Page" + end) for end in (b"\n", b" ", b"/"))
    return [name, round(path.stat().st_size / 1000), *heights, sheets]


def main(out: str, pages: list[str]) -> None:
    """Measure all pages and write the table."""
    from playwright.sync_api import sync_playwright  # not of the locked environment: --help does without

    with sync_playwright() as driver, open(out, "w", encoding="utf-8", newline="") as stream:
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(COLUMNS)
        table.writerows(measured(browser, *_named(page)) for page in pages)
        browser.close()


def _named(page):
    name, _, path = page.partition("=")
    return name, Path(path)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", metavar="OUT", help="table (CSV) to write")
    parser.add_argument("pages", metavar="NAME=FILE", nargs="+", help="name of a page, and its file")
    given = parser.parse_args()
    main(given.out, given.pages)
