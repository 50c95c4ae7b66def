"""`sonicvacuum page`: what `discover` wrote into a folder, drawn and told on a page."""

from pathlib import Path

import click

from sonicvacuum.cli.helped import PRESENT, verb
from sonicvacuum.cli.own_effects import catalogue, own_effects


@verb(
    "sonicvacuum page found",
    "sonicvacuum page --png found",
    short_help="Draw the pictures and the page of a verdict anew.",
)
@click.argument("folders", nargs=-1, required=True, type=PRESENT)
@click.option("--png", is_flag=True, help="Each picture as PNG too, for slides and word processors.")
@own_effects
def page(folders, png, own):
    """Draw the pictures of what discover wrote into FOLDERS, and write its page, index.html."""
    from sonicvacuum import drawn
    from sonicvacuum.files import InputError, reading
    from sonicvacuum.records.guard import check_out
    from sonicvacuum.report.record import section

    known = catalogue(own)
    for folder in map(Path, folders):
        if not (folder / "verdict.json").is_file():
            raise InputError(f"{folder}: has no verdict.json; give a folder that sonicvacuum discover wrote")
        check_out(folder)
        # What is not a discovery's folder is refused before anything is drawn.
        section(folder, known)
        with reading(folder, "run sonicvacuum discover again"):
            drawn.illustrate(folder, known, png)


def slips_of(verdict, records=()) -> str:
    """What a verdict says to check at the bench first, in one line; empty where there is nothing."""
    from sonicvacuum.report.bench import slip
    from sonicvacuum.report.phrases import share

    return "; ".join(f"{slip(f, records)} (probability {share(f.probability)})" for f in verdict.faults)


def likely(probability: float) -> str:
    """A probability as a page has it; words of pages are no part of a search and stand behind this module."""
    from sonicvacuum.report.phrases import share

    return share(probability)
