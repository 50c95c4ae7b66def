"""`sonicvacuum paper uncertainty`: what the paper leaves open, drawn together and simulated."""

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.outputs import check_apart

_FILE = existing()


@verb("sonicvacuum paper uncertainty --claims workflow/resources/claims.csv --draws 50 --out probable.csv")
@click.option("--claims", required=True, type=_FILE, help="Table of the paper's claims.")
@click.option("--config", "path", default="config.yaml", show_default=True, type=_FILE)
@click.option("--draws", type=click.IntRange(min=2), help="Number of draws; default as in the report.")
@click.option("--named", multiple=True, type=_FILE, help="Card with the model that discover names; repeat.")
@click.option("--out", required=True, type=WRITTEN, help="Probabilities (CSV) to write.")
def uncertainty(claims, path, draws, named, out):
    """Find how probable each statement of the paper is under each model."""
    from sonicvacuum.cli.cards import read_card
    from sonicvacuum_paper import columns

    check_apart([out], [claims, path, *named])
    cases, cards = columns.read(path), [read_card(card) for card in named]
    # Long to load: what is wrong is said before.
    from sonicvacuum_paper.uncertainty.inputs import DRAWS
    from sonicvacuum_paper.uncertainty.stage import write_uncertainty

    write_uncertainty(claims, cases, out, draws or DRAWS, cards)
