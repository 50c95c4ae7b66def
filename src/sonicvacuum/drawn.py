"""Pictures and page of a verdict's folder, of what stands in it; the search itself knows neither."""

from pathlib import Path

from sonicvacuum.effects import Catalogue


def illustrate(folder: Path, known: Catalogue, png: bool = False) -> None:
    """Draw the pictures and write the page of one folder; the catalogue `known` holds its effects.

    Raises:
        InputError: where the folder does not hold what discover writes.
    """
    from sonicvacuum.figures.discovery import draw
    from sonicvacuum.report.record import write_page

    draw(folder, known, png)
    write_page(folder, known)


def page_files() -> tuple[str, ...]:
    """Names of the files that a page adds to the folder of discover."""
    from sonicvacuum.report.record import PAGE

    return PAGE
