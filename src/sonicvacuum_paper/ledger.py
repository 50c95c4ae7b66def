"""The ledger: every claim of the paper, what each model of the ladder gives for it, and the verdict.

The column `layer` decides: the coating as the layer that the paper prints, with the handbook's modulus, to
which nothing was fitted. What every other model gives stands beside it, with the statements that exclude it
and by how much. What no model without losses can show is outside the model; printed numbers that contradict
one another are inconsistent in the paper, not a disagreement of the simulation.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from sonicvacuum.files import InputError
from sonicvacuum_paper import wording
from sonicvacuum_paper.claims import Claim, read_table
from sonicvacuum_paper.columns import Metrics
from sonicvacuum_paper.ladder import ARITHMETIC, COLUMNS, DECIDING, LOSS, SIMULATION
from sonicvacuum_paper.rows import Row, write_lines
from sonicvacuum_paper.verdict import (
    DISAGREES,
    INCONSISTENT,
    NOT_TESTABLE,
    OUTSIDE,
    REPRODUCED,
    UNTESTED,
    Judged,
    Target,
    judge,
)

__all__ = ["Claim", "LedgerRow", "build", "disagreements", "read_table", "write"]


@dataclass(frozen=True)
class LedgerRow:
    """One line of `results/ledger.csv`; NaN where there is no number.

    `agrees`, `fitted` and `excluded` name the models by column, the last with the difference in standard
    errors where there is one; `ideal` is no model of its own. `probability` gives beside each model how
    probable its agreement is once what the paper leaves open is drawn (`uncertainty.agreement`).
    """

    claim: str
    section: str
    kind: str
    quantity: str
    unit: str
    measured: str
    sigma: str
    handbook: float
    layer: float
    layer_membrane: float
    matched: float
    layer_loss: float
    matched_loss: float
    named: float
    ideal: float
    numerical_error: float
    difference_sigma: float
    verdict: str
    agrees: str
    fitted: str
    excluded: str
    probability: str
    reason: str


def build(
    metrics: Metrics,
    claims: list[Claim],
    path="claims.csv",
    probable: Mapping[str, Mapping[str, float]] | None = None,
) -> list[LedgerRow]:
    """The ledger, one row per claim in their order.

    Args:
        metrics: all metrics, with the columns of the configuration.
        claims: what to test.
        path: where they come from, for messages.
        probable: claim → model → probability of agreement; none where nothing was drawn.
    """
    probable = probable or {}
    rows = [_row(metrics, claim, f"{path}: {claim.claim}") for claim in claims]
    return [replace(r, probability=_probabilities(probable.get(r.claim, {}))) for r in rows]


def _probabilities(of_models):
    return "; ".join(f"{model} {share:.2g}" for model, share in of_models.items())


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
    write_lines(ledger, LedgerRow, path, numerical_error=2, difference_sigma=4)


def _row(metrics, claim, where):
    target = Target.parse(claim.test, claim.value, claim.sigma, where)
    rows = {} if claim.test in UNTESTED else found_in_columns(metrics, claim.metric, where)
    values = {c: rows[c].value if c in rows else math.nan for c in COLUMNS}
    # A model does not decide on what it was fitted to.
    deciding = (c for c in DECIDING if c not in claim.fitted.split())
    column = next((c for c in deciding if c in rows and rows[c].known), None)
    error, outcome = math.nan, Judged(NOT_TESTABLE)
    if column:
        error = rows[column].numerical_error
        outcome = judge(target, values[column], error)
    return LedgerRow(
        claim=claim.claim,
        section=claim.section,
        kind=claim.kind,
        quantity=claim.quantity,
        unit=claim.unit,
        measured=claim.value,
        sigma=claim.sigma,
        **values,
        numerical_error=error,
        difference_sigma=outcome.difference_sigma,
        verdict=_verdict(metrics, claim, column, outcome.verdict),
        **_models(metrics, claim, target, rows),
        probability="",
        reason=_reason(metrics, claim, target, rows, column),
    )


def _verdict(metrics, claim, column, judged):
    if claim.test == "misprint" or (claim.kind == ARITHMETIC and judged == DISAGREES):
        return INCONSISTENT
    outside = claim.needs == LOSS and column and not has_losses(metrics, DECIDING[0])
    return OUTSIDE if outside and judged != NOT_TESTABLE else judged


def has_losses(metrics: Metrics, column: str) -> bool:
    """Whether the model of a column takes energy, as its card of fig3a says."""
    count = metrics.find("fig3a", column, "loss_effects")
    return count is not None and count.value > 0.0


def _models(metrics, claim, target, rows):
    """Which models agree, agree after a fit, and are excluded; nobody for what needs no simulation."""
    told = {"agrees": [], "fitted": [], "excluded": []}
    for column, row in rows.items() if claim.kind == SIMULATION else ():
        if column not in COLUMNS or not row.known:
            continue
        if claim.needs == LOSS and not has_losses(metrics, column):
            continue
        outcome = judge(target, row.value, row.numerical_error)
        if outcome.verdict == REPRODUCED:
            told["fitted" if column in claim.fitted.split() else "agrees"].append(column)
        elif outcome.verdict == DISAGREES:
            told["excluded"].append(f"{column} {wording.by(outcome)}".strip())
    return {part: "; ".join(names) for part, names in told.items()}


def _reason(metrics, claim, target, rows, column):
    if claim.test in UNTESTED:
        return claim.note or "No metric tests this statement."
    if column is None and any(rows[c].known for c in DECIDING if c in rows):
        return "Not testable: every model that gives it was fitted to it."
    if column is None:
        return wording.absence(metrics, claim.metric, [rows[c] for c in DECIDING if c in rows])
    return wording.comparison(metrics, claim, target, {c: rows[c] for c in COLUMNS if c in rows}, column)
