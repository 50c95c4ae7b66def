"""`sonicvacuum paper ledger`, `audit`: the paper's claims and assumptions held against the metrics."""

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.outputs import check_apart

_FILE = existing()
_CONFIG = click.option("--config", "path", default="config.yaml", show_default=True, type=_FILE)


@verb("sonicvacuum paper ledger metrics.csv --claims workflow/resources/claims.csv --out ledger.csv")
@click.argument("metrics", type=_FILE)
@click.option("--claims", required=True, type=_FILE, help="Table of the paper's claims.")
@_CONFIG
@click.option("--uncertainty", "probable", type=_FILE, help="Probabilities from `paper uncertainty`.")
@click.option("--out", required=True, type=WRITTEN, help="Ledger (CSV) to write.")
def ledger(metrics, claims, path, probable, out):
    """Hold the claims against METRICS."""
    from sonicvacuum_paper import columns
    from sonicvacuum_paper.stages import write_ledger

    check_apart([out], [metrics, claims, path, *([probable] if probable else [])])
    write_ledger(metrics, claims, columns.read(path), out, probable)


@verb("sonicvacuum paper audit metrics.csv --assumptions assumptions.csv --out audit.csv")
@click.argument("metrics", type=_FILE)
@click.option("--assumptions", required=True, type=_FILE, help="Table of the assumptions.")
@_CONFIG
@click.option("--out", required=True, type=WRITTEN, help="Audit (CSV) to write.")
def audit(metrics, assumptions, path, out):
    """Hold the assumptions against METRICS."""
    from sonicvacuum_paper import columns
    from sonicvacuum_paper.stages import write_assumptions

    check_apart([out], [metrics, assumptions, path])
    write_assumptions(metrics, assumptions, columns.read(path), out)
