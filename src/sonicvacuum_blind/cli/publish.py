"""`sonicvacuum blind publish`: what of a study is kept in git."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import FOLDER, PRESENT, verb
from sonicvacuum.outputs import check_apart


@verb("sonicvacuum blind publish results/blind/full --page docs/study.md --keep figures/blind")
@click.argument("folder", type=PRESENT)
@click.option("--page", required=True, type=existing(), help="Page (Markdown) whose tables are renewed.")
@click.option("--keep", required=True, type=FOLDER, help="Where the tables are kept.")
def publish(folder, page, keep):
    """Keep the tables of the blind study in FOLDER in git, and on their page."""
    from sonicvacuum_blind import report

    kept = [Path(keep) / f"{name}.csv" for name in (*report.KEPT, *report.ALSO_KEPT)]
    check_apart([page, *kept], [folder])
    report.publish(folder, page, keep)
