"""`sonicvacuum paper report`: the page."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.cards import read_card
from sonicvacuum.files import replacing
from sonicvacuum.outputs import check_apart

_FILE = existing()
_FOLDER = click.Path(exists=True, file_okay=False)


@click.command()
@click.option("--ledger", required=True, type=_FILE)
@click.option("--assumptions", required=True, type=_FILE)
@click.option("--metrics", required=True, type=_FILE)
@click.option("--claims", required=True, type=_FILE)
@click.option("--figure", "figures", multiple=True, type=_FILE, help="SVG of a figure; repeat.")
@click.option("--card", "cards", multiple=True, type=_FILE, help="Resolved card; repeat.")
@click.option("--lock", "locks", multiple=True, type=_FILE, help="Lock file of the environment; repeat.")
@click.option(
    "--discovery",
    "discoveries",
    multiple=True,
    type=_FOLDER,
    help="Folder that discover wrote; repeat.",
)
@click.option("--blind-small", type=_FILE, help="Summary of the small blind study.")
@click.option("--blind-full", type=_FOLDER, help="Folder of the full one's tables.")
@click.option("--picture", "pictures", multiple=True, type=_FILE, help="SVG of the full study; repeat.")
@click.option("--out", required=True, type=click.Path(dir_okay=False), help="Page (HTML) to write.")
def report(
    ledger,
    assumptions,
    metrics,
    claims,
    figures,
    cards,
    locks,
    discoveries,
    blind_small,
    blind_full,
    pictures,
    out,
):
    """Write the self-contained page with figures, ledger, audit, discoveries and provenance."""
    from sonicvacuum_blind import kept
    from sonicvacuum_paper.figures import caption
    from sonicvacuum_paper.report.page import build

    read_here = (ledger, assumptions, metrics, claims, *figures, *cards, *locks, *discoveries, *pictures)
    check_apart([out], [*read_here, blind_small, blind_full])
    captioned = [(figure, caption(Path(figure).stem)) for figure in figures]
    read = [read_card(card) for card in cards]
    tables = (ledger, assumptions, metrics, claims)
    seen = [(picture, kept.caption(Path(picture).stem)) for picture in pictures]
    text = build(*tables, captioned, read, locks, discoveries, blind_small, blind_full, seen)
    with replacing(out) as stream:
        stream.write(text)
