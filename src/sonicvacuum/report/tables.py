"""The pipeline's tables as the report shows them: read, checked for their columns, numbers made legible."""

import math

import pandas as pd

from sonicvacuum.files import InputError

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


def read(path, columns) -> pd.DataFrame:
    """A table with exactly these columns, text kept as text and missing cells empty.

    Raises:
        InputError: when the file has other columns or cannot be parsed.
    """
    try:
        table = pd.read_csv(path, dtype=str, keep_default_na=False)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as a table ({error})") from None
    if list(table.columns) != list(columns):
        raise InputError(f"{path}: columns are {','.join(table.columns)}; expected {','.join(columns)}")
    return table


def number(text: str, digits: int = 4) -> str:
    """A number of a table with so many significant digits; other text as it is, nothing for nothing."""
    try:
        value = float(text)
    except ValueError:
        return text
    if math.isnan(value):
        return ""
    if value == 0.0:
        return "0"
    exponent = math.floor(math.log10(abs(value)))
    if -3 <= exponent < 6:
        shown = f"{value:.{max(0, digits - 1 - exponent)}f}"
        return shown.rstrip("0").rstrip(".") if "." in shown else shown
    mantissa, power = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa.rstrip('0').rstrip('.')}e{int(power)}"


def counts(ledger: pd.DataFrame) -> dict[str, int]:
    """Verdict → number of claims."""
    return {verdict: int((ledger["verdict"] == verdict).sum()) for verdict in VERDICTS}


def disagreements(ledger: pd.DataFrame) -> pd.DataFrame:
    """Rows that disagree, the largest difference in standard errors first, those without one last."""
    rows = ledger[ledger["verdict"] == "disagrees"].copy()
    size = pd.to_numeric(rows["difference_sigma"], errors="coerce").abs().fillna(-1.0)
    return rows.loc[size.sort_values(ascending=False, kind="stable").index]
