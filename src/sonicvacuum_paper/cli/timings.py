"""`sonicvacuum paper timings`: how long each rule took."""

import click

from sonicvacuum.cli.helped import examples


@click.command(
    epilog=examples(
        "sonicvacuum paper timings results/benchmarks --out timings.csv",
    )
)
@click.argument("folder", type=click.Path(exists=True, file_okay=False))
@click.option("--out", required=True, type=click.Path(dir_okay=False), help="Summary (CSV) to write.")
def timings(folder, out):
    """Summarise the benchmark files of the workflow in FOLDER."""
    from sonicvacuum_paper.report.timings import write

    write(folder, out)
