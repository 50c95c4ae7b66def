"""`sonicvacuum paper metrics`: the numbers of all cards, with those of theory and comparison."""

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.outputs import check_apart


@verb("sonicvacuum paper metrics results/metrics/*.csv --out metrics.csv")
@click.argument("files", nargs=-1, required=True, type=existing())
@click.option("--config", "path", default="config.yaml", show_default=True, type=existing())
@click.option("--out", required=True, type=WRITTEN, help="All metrics (CSV) to write.")
def metrics(files, path, out):
    """Gather the metrics of all cards (FILES) and add those of theory, arithmetic, audit and comparison."""
    from sonicvacuum_paper import columns
    from sonicvacuum_paper.stages import write_metrics

    check_apart([out], [*files, path])
    write_metrics(files, columns.read(path), out)
