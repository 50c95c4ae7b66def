"""`sonicvacuum blind baselines`: simpler rules on the cases of a blind study."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import PRESENT, WRITTEN, verb
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind.cli.options import held_against

_RULES = ("best-chi2", "bic", "nearest-shape", "forest", "state")


@verb("sonicvacuum blind baselines --records records --truth truth --verdicts found --out rules.csv")
@click.option("--records", required=True, type=PRESENT, help="Folder of the cases' records.")
@held_against
@click.option("--out", required=True, type=WRITTEN, help="Table (CSV) to write.")
@click.option("--ideal", multiple=True, type=existing(), help="Table of sonicvacuum blind ideal; repeat.")
@click.option("--training", type=PRESENT, help="Folder with records/, truth/ and verdicts/ to learn from.")
@click.option(
    "--rule",
    "wanted",
    multiple=True,
    type=click.Choice(_RULES),
    help="Only these; repeat. forest and state need the packages that make study installs.",
)
@click.option(
    "--state-cases",
    default=200,
    show_default=True,
    type=click.IntRange(1),
    help="So many cases, evenly spread, for the rule state, which integrates each chain again.",
)
def baselines(records, truth, verdicts, out, ideal, training, wanted, state_cases):
    """Name what is hidden by simpler rules on the same cases, and count how often they are right."""
    from sonicvacuum_blind.baselines.cases import read

    check_apart([out], [records, truth, verdicts, training, *ideal])
    cases = read(records, truth, verdicts, ideal)
    known = read(*(Path(training) / part for part in ("records", "truth", "verdicts"))) if training else []
    # Long to load: what is wrong with a case is said before.
    from sonicvacuum_blind.baselines import table
    from sonicvacuum_blind.score import write_table

    lines = table.compare(cases, known, wanted or table.RULES, state_cases)
    write_table(lines, table.RuleLine, out)
    for line in lines:
        text = f"{line.rule}, {line.measure}, {line.group}: {line.value:.3f}"
        click.echo(f"{text} [{line.low:.3f}, {line.high:.3f}] of {line.count}")
