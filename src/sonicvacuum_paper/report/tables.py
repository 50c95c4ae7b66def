"""The columns of the pipeline's tables, what the report counts in the ledger, and how a column is called."""

import re
from dataclasses import fields

import pandas as pd

from sonicvacuum.report.tables import number, read
from sonicvacuum_paper.assumptions import AssumptionRow
from sonicvacuum_paper.ledger import LedgerRow
from sonicvacuum_paper.rows import COLUMNS
from sonicvacuum_paper.verdict import DISAGREES, NOT_TESTABLE, REPRODUCED

__all__ = ["number", "read"]

LEDGER = [field.name for field in fields(LedgerRow)]
ASSUMPTIONS = [field.name for field in fields(AssumptionRow)]
METRICS = list(COLUMNS)
VERDICTS = (REPRODUCED, DISAGREES, NOT_TESTABLE)


def shown(reason: str) -> str:
    """The reason of a row of the ledger with its third column called as people read it."""
    return re.sub(r"\bnamed: ", "as discovered: ", reason)


def counts(ledger: pd.DataFrame) -> dict[str, int]:
    """Verdict → number of claims."""
    return {verdict: int((ledger["verdict"] == verdict).sum()) for verdict in VERDICTS}


def disagreements(ledger: pd.DataFrame) -> pd.DataFrame:
    """Rows that disagree, the largest difference in standard errors first, those without one last."""
    rows = ledger[ledger["verdict"] == "disagrees"].copy()
    size = pd.to_numeric(rows["difference_sigma"], errors="coerce").abs().fillna(-1.0)
    return rows.loc[size.sort_values(ascending=False, kind="stable").index]
