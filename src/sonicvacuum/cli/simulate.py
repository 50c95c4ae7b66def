"""`sonicvacuum simulate`: one card, integrated at the chosen step and at half of it."""

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.card import read_card


@click.command()
@click.argument("card", type=existing())
@click.option("--out", required=True, type=click.Path(dir_okay=False), help="History (.npz) to write.")
def simulate(card, out):
    """Integrate the chains of a CARD and keep the contact forces."""
    from sonicvacuum import study

    study.save(study.run(read_card(card)), out)
