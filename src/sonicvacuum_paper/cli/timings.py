"""`sonicvacuum paper timings`: how long each rule took."""

import click


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False))
@click.option("--out", required=True, type=click.Path(dir_okay=False), help="Summary (CSV) to write.")
def timings(folder, out):
    """Summarise the benchmark files of the workflow in FOLDER."""
    from sonicvacuum_paper.report.timings import write

    write(folder, out)
