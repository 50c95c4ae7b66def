"""`sonicvacuum paper timings`: how long each rule took."""

import click

from sonicvacuum.cli.helped import PRESENT, WRITTEN, verb


@verb("sonicvacuum paper timings results/benchmarks --out timings.csv")
@click.argument("folder", type=PRESENT)
@click.option("--out", required=True, type=WRITTEN, help="Summary (CSV) to write.")
def timings(folder, out):
    """Summarise the benchmark files of the workflow in FOLDER."""
    from sonicvacuum_paper.report.timings import write

    write(folder, out)
