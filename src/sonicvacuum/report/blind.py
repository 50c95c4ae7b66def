"""The blind test as the report shows it: the summaries that `sonicvacuum score` wrote."""

from dataclasses import fields
from pathlib import Path

from sonicvacuum.blind.score import Line
from sonicvacuum.report import tables

SUMMARY = [field.name for field in fields(Line)]


def shown(path) -> list[dict[str, str]]:
    """Rows of a summary that rest on at least one case, times left out; empty where there is no file.

    Times differ from run to run, and the page must not.

    Raises:
        InputError: when the table has other columns than `SUMMARY`.
    """
    if path is None or not Path(path).exists():
        return []
    table = tables.read(path, SUMMARY)
    rows = table[~table["count"].isin(["", "0"]) & ~table["measure"].str.startswith("seconds")]
    return [_row(row) for row in rows.to_dict("records")]


def _row(row):
    number = {key: tables.number(row[key], 3) for key in ("value", "low", "high", "ideal")}
    interval = f"{number['low']} to {number['high']}" if number["low"] else ""
    return {**row, **number, "interval": interval}
