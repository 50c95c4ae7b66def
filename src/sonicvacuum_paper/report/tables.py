"""The columns of the pipeline's tables, and what the report counts in the ledger."""

import pandas as pd

from sonicvacuum.report.tables import number, read

__all__ = ["number", "read"]

LEDGER = [
    "claim",
    "section",
    "quantity",
    "unit",
    "measured",
    "sigma",
    "handbook",
    "matched",
    "named",
    "numerical_error",
    "difference_sigma",
    "verdict",
    "reason",
]
ASSUMPTIONS = [
    "assumption",
    "section",
    "statement",
    "quantity",
    "unit",
    "limit",
    "handbook",
    "matched",
    "verdict",
    "reason",
]
METRICS = ["case", "quantity", "sensor", "value", "unit", "numerical_error"]
VERDICTS = ("reproduced", "disagrees", "not testable")


def counts(ledger: pd.DataFrame) -> dict[str, int]:
    """Verdict → number of claims."""
    return {verdict: int((ledger["verdict"] == verdict).sum()) for verdict in VERDICTS}


def disagreements(ledger: pd.DataFrame) -> pd.DataFrame:
    """Rows that disagree, the largest difference in standard errors first, those without one last."""
    rows = ledger[ledger["verdict"] == "disagrees"].copy()
    size = pd.to_numeric(rows["difference_sigma"], errors="coerce").abs().fillna(-1.0)
    return rows.loc[size.sort_values(ascending=False, kind="stable").index]
