"""`sonicvacuum blind extras` and `extras-score`: records with smooth systematic errors or with three and four
effects, and what was made of them.
"""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind import TRUTH
from sonicvacuum_blind.cli.hide import check_truth
from sonicvacuum_blind.cli.options import batch_of, held_against, made_into, say


@verb("sonicvacuum blind extras --records extras/records --truth extras/truth --first 40")
@made_into
@click.option(
    "--first", type=click.IntRange(min=1), help="So many of the list, whose order is drawn; all if not given."
)
def extras(batch, first, records_folder, truth_folder):
    """Make records with smooth systematic errors, and with three and four effects."""
    from sonicvacuum.records.guard import check_collection
    from sonicvacuum_blind import extra_cases
    from sonicvacuum_blind.study import batch as part

    chosen = part(extra_cases.cases()[:first], *batch_of(batch))
    check_truth(truth_folder, records_folder)
    check_collection(records_folder, [c.id for c in chosen], lambda name: Path(truth_folder) / name / TRUTH)
    for case in chosen:
        extra_cases.write(case, records_folder, truth_folder)
        click.echo(case.id)


@verb(
    "sonicvacuum blind extras-score --truth extras/truth --verdicts extras/verdicts"
    " --out extras/records.csv --summary extras/summary.csv",
    name="extras-score",
)
@held_against
@click.option("--partly", is_flag=True, help="Leave out cases that have no verdict yet.")
@click.option("--out", required=True, type=WRITTEN, help="Row of each record (CSV) to write.")
@click.option("--summary", required=True, type=WRITTEN, help="Table (CSV) to write.")
@click.option("--page", type=existing(), help="Page (Markdown) whose table is written anew.")
def extras_score(truth, verdicts, partly, out, summary, page):
    """Count which effects are named beside systematic errors, and which of several."""
    from sonicvacuum_blind import extra_page, extra_score
    from sonicvacuum_blind.score import Line, write_table

    check_apart([out, summary], [truth, verdicts])
    rows = extra_score.score(truth, verdicts, partly)
    lines = extra_score.summary(rows)
    write_table(rows, extra_score.ExtraRow, out)
    write_table(lines, Line, summary)
    if page:
        extra_page.write(lines, page)
    say(lines)
