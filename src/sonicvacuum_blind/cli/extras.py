"""`sonicvacuum blind extras` and `extras-score`: records with smooth systematic errors or with three and four
effects, and what was made of them.
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


@verb("sonicvacuum blind extras --records extras/records --truth extras/truth --first 40")
@made_into
@click.option(
    "--first", type=click.IntRange(min=1), help="So many of the list, whose order is drawn; all if not given."
)
@click.option("--seed", type=click.IntRange(min=0), help="Another list, all of it drawn anew.")
def extras(batch, first, seed, records_folder, truth_folder):
    """Make records with smooth systematic errors, and with three and four effects."""
    from sonicvacuum_blind import extra_cases
    from sonicvacuum_blind.study import batch as part

    every = extra_cases.cases() if seed is None else extra_cases.cases(seed)
    make(part(every[:first], *batch_of(batch)), extra_cases.write, records_folder, truth_folder)


@verb(
    "sonicvacuum blind extras-score --truth extras/truth --verdicts extras/verdicts"
    " --out extras/records.csv --summary extras/summary.csv",
    name="extras-score",
)
@held_against
@partly
@counted_into
def extras_score(truth, verdicts, partly, out, summary, page):
    """Count which effects are named beside systematic errors, and which of several."""
    from sonicvacuum_blind import extra_score

    check_apart([out, summary], [truth, verdicts])
    rows = extra_score.score(truth, verdicts, partly)
    keep(rows, extra_score.ExtraRow, extra_score.summary(rows), out, summary, page)
