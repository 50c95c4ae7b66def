"""`sonicvacuum paper rivals`: which models of the coating are left, and what would tell them apart."""

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.outputs import check_apart

_FILE = existing()


@verb(
    "sonicvacuum paper rivals --map map.csv --picture map.svg --experiments runs.csv \\",
    "    --relaxation solids.csv --losses laws.csv --explained fits.csv \\",
    "    --record workflow/resources/measured/daraio-nesterenko-2006-coated",
)
@click.option("--config", "path", default="config.yaml", show_default=True, type=_FILE)
@click.option("--map", "contours", required=True, type=WRITTEN, help="Map (CSV) to write.")
@click.option("--picture", required=True, type=WRITTEN, help="Its picture (SVG) to write.")
@click.option("--experiments", required=True, type=WRITTEN, help="Series (CSV) to write.")
@click.option("--relaxation", required=True, type=WRITTEN, help="Solids (CSV) to write.")
@click.option("--losses", required=True, type=WRITTEN, help="Laws of loss (CSV) to write.")
@click.option("--record", required=True, type=click.Path(exists=True), help="Record of the coated chain.")
@click.option("--explained", required=True, type=WRITTEN, help="Fits to it (CSV) to write.")
def rivals(path, record, picture, contours, **out):
    """Compare the layer with a loss, Hertz at 15 GPa with a loss, laws of loss, and a relaxing solid."""
    from sonicvacuum import config as configuration
    from sonicvacuum import records

    out |= {"map": contours}
    check_apart([*out.values(), picture], [path, record])
    cases, measured = configuration.read(path), records.read(record)
    # Long to load: what is wrong is said before.
    import pandas

    from sonicvacuum.figures import style
    from sonicvacuum_paper.uncertainty import picture as drawing
    from sonicvacuum_paper.uncertainty.rivals import write_rivals

    write_rivals(cases, measured, out)
    style.save(drawing.draw(pandas.read_csv(contours)), picture)
