"""`sonicvacuum blind publish`: what of a study is kept in git."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import FOLDER, PRESENT, verb
from sonicvacuum.outputs import check_apart


@verb(
    "sonicvacuum blind publish results/blind/full --page docs/study.md "
    "--keep workflow/resources/reference/blind_full"
)
@click.argument("folder", type=PRESENT)
@click.option("--page", required=True, type=existing(), help="Page (Markdown) whose tables are renewed.")
@click.option("--readme", type=existing(), help="README whose lines on the study are renewed.")
@click.option("--keep", required=True, type=FOLDER, help="Where the tables are kept.")
def publish(folder, page, readme, keep):
    """Keep the tables of the blind study in FOLDER in git, on their page and in the README."""
    from sonicvacuum_blind import published

    kept = [Path(keep) / f"{name}.csv" for name in (*published.KEPT, *published.ALSO_KEPT)]
    check_apart([page, readme, *kept], [folder])
    published.publish(folder, page, keep, readme)
