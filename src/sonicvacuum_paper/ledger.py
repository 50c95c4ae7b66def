"""The ledger: every claim of the paper, what the simulation gives for it under each modulus, and the verdict.

The column `matched` decides, the model that the paper itself settles on (15 GPa) to describe its chain;
what the manufacturer's modulus gives stands beside it, and the reason says where the two would be judged
differently. Claims about the handbook modulus itself are tested by metrics that name it and are alike in
all columns. `named` decides only what no other column can tell.
"""

import csv
import math
from dataclasses import dataclass, fields

from sonicvacuum.files import InputError, replacing
from sonicvacuum_paper import wording
from sonicvacuum_paper.columns import Metrics
from sonicvacuum_paper.rows import Row, cells_of, number
from sonicvacuum_paper.verdict import DISAGREES, NOT_TESTABLE, Judged, Target, judge

COLUMNS = ("handbook", "matched", "named")
DECIDING = ("matched", "named", "handbook")


@dataclass(frozen=True)
class Claim:
    """One line of `claims.csv`; see `claims.md`."""

    claim: str
    section: str
    statement: str
    quantity: str
    unit: str
    value: str
    sigma: str
    sigma_source: str
    test: str
    metric: str
    note: str


@dataclass(frozen=True)
class LedgerRow:
    """One line of `results/ledger.csv`; NaN where there is no number."""

    claim: str
    section: str
    quantity: str
    unit: str
    measured: str
    sigma: str
    handbook: float
    matched: float
    named: float
    numerical_error: float
    difference_sigma: float
    verdict: str
    reason: str


def read_table(path, kind: type) -> list:
    """The lines of a table of claims or assumptions; InputError names file, line and cure."""
    rows = [kind(*cells) for cells in cells_of(path, tuple(f.name for f in fields(kind)))]
    names = [getattr(r, fields(kind)[0].name) for r in rows]
    for name in names:
        if names.count(name) > 1:
            raise InputError(
                f"{path}: {name} stands here {names.count(name)} times; rename or remove all but one"
            )
    return rows


def build(metrics: Metrics, claims: list[Claim], path="claims.csv") -> list[LedgerRow]:
    """The ledger, one row per claim in their order.

    Args:
        metrics: all metrics, with the columns of the configuration.
        claims: what to test.
        path: where they come from, for messages.
    """
    return [_row(metrics, claim, f"{path}: {claim.claim}") for claim in claims]


def found_in_columns(metrics: Metrics, metric: str, where: str) -> dict[str, Row]:
    """Column → the row of `case/quantity/sensor` there; columns without are left out."""
    parts = metric.split("/")
    if len(parts) != 3:
        raise InputError(
            f"{where}: metric is {metric!r}; write case/quantity/sensor, the sensor may be empty"
        )
    case, quantity, sensor = parts
    found = {c: metrics.find(case, c, quantity, sensor) for c in metrics.columns}
    return {c: row for c, row in found.items() if row is not None}


def disagreements(ledger: list[LedgerRow]) -> list[LedgerRow]:
    """Rows that disagree, the largest difference in standard errors first, those without one last."""
    rows = [r for r in ledger if r.verdict == DISAGREES]
    return sorted(rows, key=lambda r: -abs(r.difference_sigma) if math.isfinite(r.difference_sigma) else 0.0)


def write(ledger: list[LedgerRow], path) -> None:
    """Write the ledger with exactly the columns of `LedgerRow`."""
    names = [f.name for f in fields(LedgerRow)]
    digits = {"numerical_error": 2, "difference_sigma": 4}
    with replacing(path) as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(names)
        for row in ledger:
            cells = ((n, getattr(row, n)) for n in names)
            table.writerow([number(c, digits.get(n, 8)) if isinstance(c, float) else c for n, c in cells])


def _row(metrics, claim, where):
    target = Target.parse(claim.test, claim.value, claim.sigma, where)
    rows = {} if claim.test == "not-testable" else found_in_columns(metrics, claim.metric, where)
    values = {c: rows[c].value if c in rows else math.nan for c in COLUMNS}
    column = next((c for c in DECIDING if c in rows and rows[c].known), None)
    error, outcome = math.nan, Judged(NOT_TESTABLE)
    if column:
        error = rows[column].numerical_error
        outcome = judge(target, values[column], error)
    return LedgerRow(
        claim=claim.claim,
        section=claim.section,
        quantity=claim.quantity,
        unit=claim.unit,
        measured=claim.value,
        sigma=claim.sigma,
        **values,
        numerical_error=error,
        difference_sigma=outcome.difference_sigma,
        verdict=outcome.verdict,
        reason=_reason(metrics, claim, target, rows, column),
    )


def _reason(metrics, claim, target, rows, column):
    if claim.test == "not-testable":
        return claim.note or "No metric tests this statement."
    if column is None:
        return wording.absence(metrics, claim.metric, [rows[c] for c in DECIDING if c in rows])
    return wording.comparison(metrics, claim, target, {c: rows[c] for c in COLUMNS if c in rows}, column)
