"""`sonicvacuum blind foretold`: how well models found foretell fresh runs."""

import click

from sonicvacuum.cli.helped import PRESENT, verb
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind.cli.options import counted_into, held_against, keep


@verb(
    "sonicvacuum blind foretold --truth truth --verdicts found --compared compared \\",
    "    --out rows.csv --summary fresh.csv",
)
@held_against
@click.option(
    "--compared", required=True, type=PRESENT, help="Folder of what compare --json wrote: <id>/compared.json."
)
@counted_into
def foretold(truth, verdicts, compared, out, summary, page):
    """Hold models against fresh runs that discover never had."""
    from sonicvacuum_blind import foretold as fresh

    check_apart([out, summary], [truth, verdicts, compared])
    rows = fresh.foretold(truth, verdicts, compared)
    keep(rows, fresh.Foretold, fresh.summary(rows), out, summary, page)
