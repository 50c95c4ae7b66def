"""`sonicvacuum paper report`: the page."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.cards import read_card
from sonicvacuum.cli.helped import PRESENT, WRITTEN, verb
from sonicvacuum.files import replacing
from sonicvacuum.outputs import check_apart
from sonicvacuum_paper.cli.simulated import loaded

_FILE = existing()


@verb(
    "sonicvacuum paper report --ledger ledger.csv --assumptions audit.csv --metrics metrics.csv \\",
    "    --claims workflow/resources/claims.csv --figure figures/fig3.svg --out report.html",
)
@click.option("--ledger", required=True, type=_FILE)
@click.option("--assumptions", required=True, type=_FILE)
@click.option("--metrics", required=True, type=_FILE)
@click.option("--claims", required=True, type=_FILE)
@click.option(
    "--figure", "figures", multiple=True, type=_FILE, help="SVG of a figure, its CSV beside it; repeat."
)
@click.option("--card", "cards", multiple=True, type=_FILE, help="Resolved card; repeat.")
@click.option("--lock", "locks", multiple=True, type=_FILE, help="Lock file of the environment; repeat.")
@click.option(
    "--discovery", "discoveries", multiple=True, type=PRESENT, help="Folder that discover wrote; repeat."
)
@click.option("--blind-full", type=PRESENT, help="Folder of the full blind study's tables.")
@click.option("--histories", type=PRESENT, help="Simulated cards; those of your own cases are shown.")
@click.option("--animation", "animations", multiple=True, type=_FILE, help="SVG that moves; repeat.")
@click.option("--linked", multiple=True, help="Name of a page beside this one; repeat.")
@click.option("--map", "contours", type=_FILE, help="Map from `paper rivals`.")
@click.option("--map-picture", type=_FILE, help="Its picture (SVG).")
@click.option("--experiments", type=_FILE, help="Series from `paper rivals`.")
@click.option("--relaxation", type=_FILE, help="Solids from `paper rivals`.")
@click.option("--losses", type=_FILE, help="Laws of loss from `paper rivals`.")
@click.option("--explained", type=_FILE, help="Fits to the paper's record from `paper rivals`.")
@click.option("--sure", type=WRITTEN, help="Page (HTML) on what the paper leaves open to write, and link.")
@click.option("--out", required=True, type=WRITTEN, help="Page (HTML) to write.")
def report(cards, histories, sure, out, **given):
    """Write the self-contained page with figures, ledger, audit, discoveries and provenance."""
    from sonicvacuum_paper.shown import own as added

    named = [value for key, value in given.items() if key != "linked"]
    listed = [path for value in named for path in (value if isinstance(value, tuple) else (value,))]
    check_apart([out, sure], [*listed, *cards, histories])
    own = [path for path in cards if added(Path(path).stem)] if histories else []
    read = [read_card(card) for card in cards]
    from sonicvacuum_paper.report import page  # long to load: what is wrong with a card is said before

    given["linked"] += (Path(sure).name,) if sure else ()
    sources = page.Sources(cards=read, own=loaded(own, histories), **given)
    if sure:
        with replacing(sure) as stream:
            stream.write(page.sure(sources))
    text = page.build(sources)
    with replacing(out) as stream:
        stream.write(text)
