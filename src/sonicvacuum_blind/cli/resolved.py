"""`sonicvacuum blind resolved`: how often one more run decides a case left ambiguous."""

import click

from sonicvacuum.cli.helped import PRESENT, verb
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind.cli.options import counted_into, held_against, keep


@verb(
    "sonicvacuum blind resolved --truth truth --verdicts found --proposed further joint \\",
    "    --random drawn joint-drawn --out resolved.csv --summary summary.csv",
)
@held_against
@click.option(
    "--proposed",
    required=True,
    nargs=2,
    type=PRESENT,
    metavar="RECORDS JOINT",
    help="Folders of the proposed runs' records and of the verdicts on them together with the first ones.",
)
@click.option(
    "--random", required=True, nargs=2, type=PRESENT, metavar="RECORDS JOINT", help="The same of random runs."
)
@counted_into
def resolved(truth, verdicts, proposed, random, out, summary, page):
    """Count the ambiguous cases that one more run decides: the proposed one, and a random one."""
    from sonicvacuum_blind import resolved as counting

    check_apart([out, summary], [truth, verdicts, *proposed, *random])
    rows = [
        row
        for choice, folders in (("proposed", proposed), ("random", random))
        for row in counting.resolved(truth, verdicts, choice, *folders)
    ]
    keep(rows, counting.Followed, counting.summary(rows), out, summary, page)
