"""The audit: does what the paper, or a model made from it, takes for granted hold in the runs?"""

import math
from dataclasses import dataclass

from sonicvacuum_paper.columns import Metrics
from sonicvacuum_paper.ladder import title
from sonicvacuum_paper.ledger import found_in_columns
from sonicvacuum_paper.rows import write_lines
from sonicvacuum_paper.verdict import DISAGREES, NOT_TESTABLE, Target, judge

HOLDS, FAILS = "holds", "fails"
# Columns of the ledger that are audited: Hertz with both moduli, the printed layer without and with its loss.
AUDITED = ("handbook", "matched", "layer", "layer_loss")


@dataclass(frozen=True)
class Assumption:
    """One line of `assumptions.csv`; see `claims.md`."""

    assumption: str
    section: str
    statement: str
    quantity: str
    unit: str
    limit: str
    test: str
    metric: str
    note: str


@dataclass(frozen=True)
class AssumptionRow:
    """One line of `results/assumptions.csv`; NaN where there is no number."""

    assumption: str
    section: str
    statement: str
    quantity: str
    unit: str
    limit: str
    handbook: float
    matched: float
    layer: float
    layer_loss: float
    verdict: str
    reason: str


def build(metrics: Metrics, assumptions: list[Assumption], path="assumptions.csv") -> list[AssumptionRow]:
    """The audit, one row per assumption in their order."""
    return [_row(metrics, a, f"{path}: {a.assumption}") for a in assumptions]


def write(rows: list[AssumptionRow], path) -> None:
    """Write the audit with exactly the columns of `AssumptionRow`."""
    write_lines(rows, AssumptionRow, path)


def _row(metrics, a, where):
    target = Target.parse(a.test, a.limit, "", where)
    rows = {} if a.test == "not-testable" else found_in_columns(metrics, a.metric, where)
    values = {c: rows[c].value if c in rows else math.nan for c in AUDITED}
    verdicts = {
        c: _word(judge(target, values[c], rows[c].numerical_error).verdict)
        for c in values
        if c in rows and rows[c].known
    }
    return AssumptionRow(
        assumption=a.assumption,
        section=a.section,
        statement=a.statement,
        quantity=a.quantity,
        unit=a.unit,
        limit=a.limit,
        **values,
        verdict=_verdict(verdicts),
        reason=_reason(a, rows, values, verdicts),
    )


def _word(verdict):
    return FAILS if verdict == DISAGREES else HOLDS


def _verdict(verdicts):
    if not verdicts:
        return NOT_TESTABLE
    good = [c for c, v in verdicts.items() if v == HOLDS]
    if len(good) == len(verdicts):
        return HOLDS
    return f"{HOLDS} for {'; '.join(map(title, good))} only" if good else FAILS


def _reason(a, rows, values, verdicts):
    if not verdicts:
        row = next(iter(rows.values()), None)
        return (row.reason + "." if row else a.note) or "No metric tests this statement."
    unit = "" if a.unit in ("", "1") else f" {a.unit}"
    bound = {"at_most": "at most ", "at_least": "at least "}.get(a.test, "") + a.limit.replace("..", " to ")
    if len({rows[c].key for c in verdicts}) == 1:
        shown = f"{values[next(iter(verdicts))]:.4g}"
    else:
        shown = "; ".join(f"{title(c)}: {values[c]:.4g}" for c in verdicts)
    return f"{shown} against {bound}{unit}."
