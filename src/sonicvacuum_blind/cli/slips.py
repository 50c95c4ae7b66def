"""`sonicvacuum blind slips` and `slips-score`: records with slips of the laboratory, and what was made of
them.
"""

import click

from sonicvacuum.cli.helped import verb
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind.cli.made import make
from sonicvacuum_blind.cli.options import (
    batch_of,
    counted_into,
    held_against,
    keep,
    made_into,
    partly,
)


@verb("sonicvacuum blind slips --records slips/records --truth slips/truth --batch 0/8")
@made_into
@click.option("--smooth", is_flag=True, help="Those of a list of their own, beside smooth systematic errors.")
@click.option(
    "--alone", is_flag=True, help="Those of one run alone: late, or struck far from what is stated."
)
def slips(batch, records_folder, truth_folder, smooth, alone):
    """Make records with slips of the laboratory, with and without a hidden effect."""
    from sonicvacuum_blind import slip_cases
    from sonicvacuum_blind.study import batch as part

    if smooth and alone:
        raise click.UsageError("--smooth and --alone are lists of their own: give one of them")
    chosen = part(slip_cases.alone() if alone else slip_cases.cases(smooth), *batch_of(batch))
    make(list(filter(slip_cases.possible, chosen)), slip_cases.write, records_folder, truth_folder)


@verb(
    "sonicvacuum blind slips-score --truth slips/truth --verdicts slips/verdicts"
    " --out slips/records.csv --summary slips/summary.csv",
    name="slips-score",
)
@held_against
@partly
@counted_into
def slips_score(truth, verdicts, partly, out, summary, page):
    """Count which slips are named, and which effects, rightly and wrongly."""
    from sonicvacuum_blind import slip_score

    check_apart([out, summary], [truth, verdicts])
    rows = slip_score.score(truth, verdicts, partly)
    keep(rows, slip_score.SlipRow, slip_score.summary(rows), out, summary, page)
