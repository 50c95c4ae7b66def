"""`sonicvacuum blind foretold`: how well models found foretell fresh runs."""

import click

from sonicvacuum.cli.helped import PRESENT, WRITTEN, verb
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind.cli.options import held_against, say


@verb(
    "sonicvacuum blind foretold --truth truth --verdicts found --compared compared \\",
    "    --out rows.csv --summary fresh.csv",
)
@held_against
@click.option(
    "--compared", required=True, type=PRESENT, help="Folder of what compare --json wrote: <id>/compared.json."
)
@click.option("--out", required=True, type=WRITTEN, help="Row of each run (CSV) to write.")
@click.option("--summary", required=True, type=WRITTEN, help="Table (CSV) to write.")
def foretold(truth, verdicts, compared, out, summary):
    """Hold models against fresh runs that discover never had."""
    from sonicvacuum_blind import foretold as fresh
    from sonicvacuum_blind.score import Line, write_table

    check_apart([out, summary], [truth, verdicts, compared])
    rows = fresh.foretold(truth, verdicts, compared)
    lines = fresh.summary(rows)
    write_table(rows, fresh.Foretold, out)
    write_table(lines, Line, summary)
    say(lines)
