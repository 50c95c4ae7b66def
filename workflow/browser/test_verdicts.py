"""The pages of verdicts, and all pages on paper: three widths, light and dark, nothing cut off or covered."""

import pytest
from conftest import WIDTHS, pages_of, sideways, unfold

# CSS px between the margins of an A4 sheet.
SHEET = 688
# Sheets of a record of the paper: a table of seven quantities, and all limits.
MOST_SHEETS = 4
REPORTS = ("report.html", "sure.html", "runs.html", "blind.html")


@pytest.fixture(scope="session")
def verdicts(results) -> list[str]:
    """Pages of the records that the pipeline searched."""
    found = sorted(str(path.relative_to(results)) for path in results.glob("discover/*/index.html"))
    assert found, f"{results}/discover: no page of a verdict; run make first"
    return found


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", WIDTHS)
def test_no_verdict_scrolls_sideways_nor_complains(open_page, verdicts, pictures, width, scheme):
    for name in verdicts:
        page = open_page(name, width, scheme)
        page.screenshot(path=pictures / f"{name.split('/')[-2]}-{width}-{scheme}.png", full_page=True)
        unfold(page)
        assert sideways(page) == 0, name


def test_verdicts_print_on_few_sheets(open_page, verdicts, pictures):
    for name in verdicts:
        pdf = open_page(name).pdf(path=pictures / f"{name.split('/')[-2]}.pdf", format="A4")
        assert 1 <= pages_of(pdf) <= MOST_SHEETS, name


def overlaps(page) -> list[str]:
    """Heads of columns whose words run into the next head."""
    return page.evaluate(
        """() => [...document.querySelectorAll("thead tr")].flatMap((row) => {
          const boxes = [...row.cells].filter((c) => c.offsetWidth).map((cell) => {
            const range = document.createRange();
            range.selectNodeContents(cell);
            const { left, right } = range.getBoundingClientRect();
            return { left, right, text: cell.textContent };
          }).filter((b) => b.right > b.left);
          return boxes.slice(1).filter((b, k) => b.left < boxes[k].right - 1).map((b) => b.text);
        })"""
    )


def test_on_paper_nothing_leaves_the_sheet_or_covers_its_neighbour(open_page, verdicts):
    for name in (*REPORTS, *verdicts):
        page = open_page(name)
        page.emulate_media(media="print")
        page.set_viewport_size({"width": SHEET, "height": 970})
        page.evaluate("dispatchEvent(new Event('beforeprint'))")
        assert sideways(page) == 0, name
        assert overlaps(page) == [], name


def test_on_a_phone_drawings_keep_a_size_that_can_be_read(open_page):
    page = open_page("report.html", 390)
    for name in ("fig3", "fig4", "fig5", "fig6"):
        figure = page.locator(f"#{name}")
        assert figure.locator("svg").bounding_box()["width"] >= 600, name
        assert figure.evaluate("(e) => e.scrollWidth > e.clientWidth"), name
    # The caption stays in sight where the drawing is scrolled.
    page.locator("#fig3").evaluate("(e) => { e.scrollLeft = 200; }")
    assert page.locator("#fig3 figcaption").bounding_box()["x"] >= 0


def test_on_a_phone_a_fold_and_its_heading_stand_on_one_line(open_page):
    page = open_page("report.html", 390)
    for summary in page.locator("section > details > summary:has(h2)").all():
        lower = summary.evaluate(
            "(e) => e.querySelector('h2').getClientRects()[0].top - e.getBoundingClientRect().top"
        )
        assert lower < 10  # px; one line more would be 20 at least
