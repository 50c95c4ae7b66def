"""`sonicvacuum paper runs`: every run over place and time."""

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import PRESENT, WRITTEN, verb
from sonicvacuum.files import replacing
from sonicvacuum_paper.cli.simulated import loaded


@verb("sonicvacuum paper runs card.json --histories histories --metrics metrics.csv --out runs.html")
@click.argument("cards", nargs=-1, required=True, type=existing())
@click.option("--histories", required=True, type=PRESENT, help="Folder of their simulations.")
@click.option("--metrics", required=True, type=existing())
@click.option("--out", required=True, type=WRITTEN, help="Page (HTML) to write.")
def runs(cards, histories, metrics, out):
    """Write the page of every run of CARDS: space-time maps linked to the gauges, and numbers."""
    from sonicvacuum_paper.report import runs as page

    text = page.build(loaded(cards, histories), metrics)
    with replacing(out) as stream:
        stream.write(text)
