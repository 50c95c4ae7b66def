"""`sonicvacuum blind publish`: what of a study is kept in git."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind.cli.options import present


@click.command()
@click.argument("folder", type=present)
@click.option("--readme", required=True, type=existing(), help="README whose part on the study is renewed.")
@click.option("--keep", required=True, type=click.Path(file_okay=False), help="Where the tables are kept.")
def publish(folder, readme, keep):
    """Keep the tables of the blind study in FOLDER in git, and in the README."""
    from sonicvacuum_blind import report

    check_apart(
        [readme, *(Path(keep) / f"{name}.csv" for name in (*report.KEPT, *report.ALSO_KEPT))], [folder]
    )
    report.publish(folder, readme, keep)
