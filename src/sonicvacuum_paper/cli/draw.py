"""`sonicvacuum paper draw`: a figure's numbers, then the figure made of them."""

from pathlib import Path

import click

from sonicvacuum.cli.cards import read_card
from sonicvacuum.outputs import check_apart

_FOLDER = click.Path(exists=True, file_okay=False)


@click.command()
@click.argument("figure")
@click.option("--cards", required=True, type=_FOLDER, help="Folder of resolved cards.")
@click.option("--histories", required=True, type=_FOLDER, help="Folder of their simulations.")
@click.option("--out", required=True, type=click.Path(file_okay=False), help="Folder for CSV, SVG and PNG.")
def draw(figure, cards, histories, out):
    """Draw FIGURE (fig3, fig4, fig5 or fig6) of simulated cards."""
    from sonicvacuum import simulation
    from sonicvacuum_paper import figures

    check_apart([Path(out) / f"{figure}.{kind}" for kind in ("csv", "svg", "png")], [cards, histories])
    # A variant that the configuration does not have leaves its panel without that line.
    names = [name for name in figures.cards_of(figure) if (Path(cards) / f"{name}.json").exists()]
    simulations = {
        name: simulation.load(read_card(Path(cards) / f"{name}.json"), Path(histories) / f"{name}.npz")
        for name in names
    }
    figures.make(figure, simulations, out)
