"""`sonicvacuum page`: what `discover` wrote into a folder, drawn and told on a page."""

from pathlib import Path

import click


@click.command()
@click.argument("folders", nargs=-1, required=True, type=click.Path(exists=True, file_okay=False))
def page(folders):
    """Draw the pictures of what discover wrote into FOLDERS, and write its page, index.html."""
    from sonicvacuum.records.guard import check_out
    from sonicvacuum.report.record import section

    for folder in map(Path, folders):
        check_out(folder)
        section(folder)  # what is not a discovery's folder is refused before anything is drawn
        illustrate(folder)


def illustrate(folder) -> None:
    """Draw the pictures and write the page of one folder."""
    from sonicvacuum.figures.discovery import draw
    from sonicvacuum.report.record import write_page

    draw(folder)
    write_page(folder)


def page_files() -> tuple[str, ...]:
    """Names of the files that a page adds to the folder of discover."""
    from sonicvacuum.report.record import PAGE

    return PAGE
