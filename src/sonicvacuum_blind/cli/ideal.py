"""`sonicvacuum blind ideal`: what an ideal rule could make of each case, known before any verdict."""

import click

from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum_blind.cli.options import batch_of, making, of_cases


@verb("sonicvacuum blind ideal --study small --batch 0/4 --out ideal.csv")
@of_cases
@click.option("--out", required=True, type=WRITTEN, help="Table (CSV) to write.")
def ideal(study, path, batch, out):
    """Work out how often a rule that knows all signatures names each hidden effect rightly.

    Beside it, where the hidden effect shows and how far it moves the record's own errors. Needs neither
    records nor verdicts: a case is the same whenever it is asked for.
    """
    from sonicvacuum_blind import ideal as rule
    from sonicvacuum_blind.score import write_table
    from sonicvacuum_blind.study import chosen

    lines = []
    for spec in chosen(study, path, *batch_of(batch)):
        with making(path):
            lines.append(rule.line(spec))
    write_table(lines, rule.IdealLine, out)
