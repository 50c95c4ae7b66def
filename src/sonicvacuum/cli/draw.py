"""`sonicvacuum draw`, `captions`: a figure's numbers, the figure made of them, the text below it."""

from pathlib import Path

import click

from sonicvacuum.cli.card import read_card

_FOLDER = click.Path(exists=True, file_okay=False)


@click.command()
@click.argument("figure")
@click.option("--cards", required=True, type=_FOLDER, help="Folder of resolved cards.")
@click.option("--histories", required=True, type=_FOLDER, help="Folder of their simulations.")
@click.option("--out", required=True, type=click.Path(file_okay=False), help="Folder for CSV, SVG and PNG.")
def draw(figure, cards, histories, out):
    """Draw FIGURE (fig3, fig4, fig5 or fig6) of simulated cards."""
    from sonicvacuum import figures, study

    studies = {
        name: study.load(read_card(Path(cards) / f"{name}.json"), Path(histories) / f"{name}.npz")
        for name in figures.cards_of(figure)
    }
    figures.make(figure, studies, out)


@click.command()
@click.option("--out", required=True, type=click.Path(file_okay=False), help="Folder for figN.rst.")
def captions(out):
    """Write the caption of every figure to a file of its own."""
    from sonicvacuum import figures
    from sonicvacuum.files import replacing

    for name in figures.names():
        with replacing(Path(out) / f"{name}.rst") as stream:
            stream.write(figures.caption(name) + "\n")
