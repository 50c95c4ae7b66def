"""`sonicvacuum blind score`: how well `discover` did on hidden effects."""

from pathlib import Path

import click

from sonicvacuum.cli.helped import FOLDER, PRESENT, WRITTEN, verb
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind.cli.options import say


@verb("sonicvacuum blind score --truth truth --verdicts found --out scores.csv --summary summary.csv")
@click.option("--truth", required=True, type=PRESENT, help="Folder of truths.")
@click.option("--verdicts", required=True, type=PRESENT, help="Folder of verdicts.")
@click.option("--out", required=True, type=WRITTEN, help="Score of each case (CSV) to write.")
@click.option("--summary", required=True, type=WRITTEN, help="Table (CSV) to write.")
@click.option(
    "--tables",
    type=FOLDER,
    help="Folder for the tables in detail: confusion, accuracy, reliability, coverage, seconds (CSV).",
)
def score(truth, verdicts, out, summary, tables):
    """Compare verdicts with the truth: one row for each case, and a table with 95 % intervals."""
    from sonicvacuum_blind import breakdown
    from sonicvacuum_blind import score as scoring
    from sonicvacuum_blind.summary import summary as summarise

    details = {name: Path(tables) / f"{name}.csv" for name in breakdown.TABLES} if tables else {}
    check_apart([out, summary, *details.values()], [truth, verdicts])
    rows = scoring.score(truth, verdicts)
    lines = summarise(rows)
    scoring.write_table(rows, scoring.Row, out)
    scoring.write_table(lines, scoring.Line, summary)
    for name, path in details.items():
        kind, table = breakdown.TABLES[name]
        scoring.write_table(table(rows), kind, path)
    say(lines)
