"""`sonicvacuum blind score` and `tables`: how well `discover` did on hidden effects."""

from dataclasses import replace
from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import FOLDER, PRESENT, WRITTEN, verb
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind.cli.options import held_against, say

DETAILS = "confusion, accuracy, reliability, seconds, parameters, coverage, pit (CSV)"


@verb("sonicvacuum blind score --truth truth --verdicts found --out scores.csv --summary summary.csv")
@held_against
@click.option("--out", required=True, type=WRITTEN, help="Score of each case (CSV) to write.")
@click.option("--summary", required=True, type=WRITTEN, help="Table (CSV) to write.")
@click.option(
    "--ideal", multiple=True, type=existing(), help="Table of sonicvacuum blind ideal; repeat for batches."
)
@click.option("--tables", type=FOLDER, help=f"Folder for the tables in detail: {DETAILS}.")
def score(truth, verdicts, out, summary, ideal, tables):
    """Compare verdicts with the truth: one row for each case, and a table with 95 % intervals."""
    from sonicvacuum_blind import score as scoring
    from sonicvacuum_blind.study import added

    check_apart([out, summary, *_paths(tables).values()], [truth, verdicts, *ideal])
    # All is read before anything is written.
    scored, intervals = scoring.score(truth, verdicts, ideal, added), scoring.intervals(truth, verdicts)
    scoring.write_table(scored, scoring.Row, out)
    # The tables are of what is written, digit by digit, so that they can be made of it again.
    rows = scoring.read_table(scoring.Row, out)
    _tabulate(rows, intervals, summary, tables)


@verb("sonicvacuum blind tables scored --out tables")
@click.argument("folders", type=PRESENT, nargs=-1, required=True)
@click.option("--out", required=True, type=FOLDER, help="Folder for the tables.")
@click.option("--page", type=existing(), help="Page (Markdown) whose table is written anew.")
def tables(folders, out, page):
    """Make the tables of a study again, of score.csv and parameters.csv in its folder; of the FOLDERS of
    several studies, tables of all their records together.
    """
    from sonicvacuum_blind import score as scoring
    from sonicvacuum_blind import table_page
    from sonicvacuum_blind.stated import Parameter

    check_apart([Path(out) / "summary.csv", *_paths(out).values()], folders)
    if page:
        table_page.around(page)

    def read(kind, name):
        first, *others = [scoring.read_table(kind, Path(folder) / name) for folder in folders]
        # Studies number their records alike.
        return first + [replace(row, id=f"{k}/{row.id}") for k, one in enumerate(others) for row in one]

    rows, intervals = read(scoring.Row, "score.csv"), read(Parameter, "parameters.csv")
    lines = _tabulate(rows, intervals, Path(out) / "summary.csv", out)
    if page:
        table_page.write(lines, page)


def _paths(folder):
    """Name of each table in detail → its file."""
    from sonicvacuum_blind import breakdown

    names = (*breakdown.TABLES, *breakdown.INTERVALS) if folder else ()
    return {name: Path(folder) / f"{name}.csv" for name in names}


def _tabulate(rows, intervals, summary, folder):
    """Write and say what the rows and the stated intervals come to; the lines of the summary."""
    from sonicvacuum_blind import breakdown
    from sonicvacuum_blind import score as scoring
    from sonicvacuum_blind.stated import Parameter
    from sonicvacuum_blind.summary import summary as summarise

    paths = _paths(folder)
    if folder:
        scoring.write_table(intervals, Parameter, paths["parameters"])
        intervals = scoring.read_table(Parameter, paths["parameters"])
    lines = summarise(rows, intervals)
    scoring.write_table(lines, scoring.SummaryLine, summary)
    for tables, given in ((breakdown.TABLES, rows), (breakdown.INTERVALS, intervals)):
        for name, (kind, table) in tables.items():
            if folder:
                scoring.write_table(table(given), kind, paths[name])
    say(lines)
    return lines
