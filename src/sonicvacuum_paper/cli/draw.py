"""`sonicvacuum paper draw`, `digitised`: a figure's numbers, then the figure; points of others against it."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.cards import read_card
from sonicvacuum.cli.helped import FOLDER, PRESENT, verb
from sonicvacuum.outputs import check_apart


@verb("sonicvacuum paper draw fig3 --cards results/cards --histories results/histories --out figures")
@click.argument("figure")
@click.option("--cards", required=True, type=PRESENT, help="Folder of resolved cards.")
@click.option("--histories", required=True, type=PRESENT, help="Folder of their simulations.")
@click.option("--points", multiple=True, type=existing(), help="Points read off the paper (YAML); repeat.")
@click.option("--out", required=True, type=FOLDER, help="Folder for CSV, SVG and PNG.")
def draw(figure, cards, histories, points, out):
    """Draw FIGURE (fig3, fig4, fig5 or fig6) of simulated cards."""
    from sonicvacuum import simulation
    from sonicvacuum_paper import digitised, figures

    check_apart([Path(out) / f"{figure}.{kind}" for kind in ("csv", "svg", "png")], [cards, histories])
    # A variant that the configuration does not have leaves its panel without that line.
    names = [name for name in figures.cards_of(figure) if (Path(cards) / f"{name}.json").exists()]
    simulations = {
        name: simulation.load(read_card(Path(cards) / f"{name}.json"), Path(histories) / f"{name}.npz")
        for name in names
    }
    figures.make(figure, simulations, out, [digitised.read(path) for path in points])


@verb("sonicvacuum paper digitised fig4-points.yaml --figure figures/fig4.csv")
@click.argument("points", type=existing())
@click.option("--figure", required=True, type=existing(), help="Numbers of its figure (CSV).")
def digitised(points, figure):
    """Check POINTS that were read off the paper, and hold them against each model of a figure."""
    from sonicvacuum.files import InputError
    from sonicvacuum_paper import digitised as module
    from sonicvacuum_paper import figures

    read = module.read(points)
    if Path(figure).stem != read.figure:
        raise InputError(
            f"{points}: figure: is {read.figure!r}; give --figure {read.figure}.csv, not {figure}"
        )
    click.echo(module.told(read, figures.read(read.figure, figure)))
