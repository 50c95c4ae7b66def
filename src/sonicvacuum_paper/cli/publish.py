"""`sonicvacuum paper publish`: what of the results is kept in git."""

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.files import InputError, replacing
from sonicvacuum.outputs import check_apart

_FILE = existing()


@verb(
    "sonicvacuum paper publish --ledger results/ledger.csv --claims workflow/resources/claims.csv \\",
    "    --readme README.md --guide figures/README.md --reference ledger.csv",
)
@click.option("--ledger", required=True, type=_FILE)
@click.option("--claims", required=True, type=_FILE, help="Table of the paper's claims.")
@click.option("--readme", required=True, type=_FILE, help="README whose result table is renewed.")
@click.option("--guide", required=True, type=WRITTEN, help="Guide to the figures (Markdown).")
@click.option("--reference", required=True, type=WRITTEN, help="Where the ledger is kept in git.")
@click.option("--benchmark", type=_FILE, help="Table of the benchmark (Markdown), where one was made.")
@click.option("--speeds", type=_FILE, help="Page (Markdown) whose benchmark is renewed.")
@click.option("--study", type=_FILE, help="Scores of the small blind study.")
@click.option("--naming", type=WRITTEN, help="Where its naming is kept in git.")
def publish(ledger, claims, readme, guide, reference, benchmark, speeds, study, naming):
    """Keep the ledger as the reference of later checks; renew the README's table and the figures' guide."""
    from sonicvacuum_paper.report import guide as figure_guide
    from sonicvacuum_paper.report import publish as keep

    if (study is None) != (naming is None):
        raise InputError("publish: --study and --naming go together: give both, or neither")
    if benchmark and not speeds:
        raise InputError("publish: --benchmark needs --speeds, the page to renew: give both")
    # The pages are renewed in their place: that they are read is no fault.
    check_apart([guide, reference, naming, readme, speeds], [ledger, claims, benchmark, study])
    keep.publish(ledger, readme, reference)
    if benchmark:
        keep.publish_benchmark(benchmark, speeds)
    if study:
        keep.publish_study(study, naming)
    with replacing(guide) as stream:
        stream.write(figure_guide.text(claims))
