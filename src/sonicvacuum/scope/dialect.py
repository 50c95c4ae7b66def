"""How a text file separates columns and writes numbers, found from its last lines, which are samples."""

import csv
import re
from collections import Counter
from dataclasses import dataclass

from sonicvacuum.files import InputError

_POINT = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_COMMA = re.compile(r"[-+]?(\d+(,\d+)?|,\d+)([eE][-+]?\d+)?")
_INTEGER = re.compile(r"[-+]?\d+")
# What stands for a sample that the recorder could not give.
LOST = {"nan", "-nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "---", "***", "?", "1.#ind", "-1.#ind",
        "1.#qnan", "lost", "invalid", "#value!", "#wert!", "err", "error", "no data"}  # fmt: skip
OVER = {"∞", "+∞", "inf", "+inf", "infinity", "1.#inf", "overrange", "over range", "over", "ol", "o.l", "ovl",
        "ovfl", "overflow", "overload", "clipped", "+over", "+ol", ">range", "âˆž", "+overrange"}  # fmt: skip
UNDER = {"-∞", "-inf", "-infinity", "-1.#inf", "underrange", "under range", "under", "-over", "-ol", "-ovl",
         "-overrange", "-overflow", "-overload", "<range", "-âˆž"}  # fmt: skip
# Tried in this order: where two read equally well, the earlier is taken. None: any white space.
_CANDIDATES = ("\t", ";", ",", "|", None)
LOOKED_AT = 40


@dataclass(frozen=True)
class Dialect:
    """Separator of columns (None: white space) and the decimal mark."""

    delimiter: str | None
    decimal: str

    def cells(self, line: str) -> list[str]:
        """The cells of one line, without quotes and outer blanks."""
        if self.delimiter is None:
            parts = next(csv.reader([line.strip()], delimiter=" ", skipinitialspace=True), [])
            return [p for p in (x.strip() for x in parts) if p] if '"' in line else line.split()
        if '"' in line:
            return [
                c.strip() for c in next(csv.reader([line], delimiter=self.delimiter, skipinitialspace=True))
            ]
        return [c.strip() for c in line.split(self.delimiter)]

    def is_number(self, cell: str) -> bool:
        """Whether a cell is a number written with this decimal mark."""
        return bool((_COMMA if self.decimal == "," else _POINT).fullmatch(cell))

    def is_sample(self, cell: str) -> bool:
        """Whether a cell can be a sample: a number, or a word for a lost or overranging one."""
        return self.is_number(cell) or cell.lower() in LOST or cell.lower() in OVER or cell.lower() in UNDER


def sniff(text: str, path) -> Dialect:
    """The dialect in which the last lines of a text hold most numbers; InputError where none does."""
    lines = [line for line in text[-200 * LOOKED_AT :].split("\n")[-LOOKED_AT - 1 :] if line.strip()]
    best, dialect = 0.0, None
    for delimiter in _CANDIDATES:
        for decimal in ".,":
            candidate = Dialect(delimiter, decimal)
            found = _score(candidate, lines[-max(3, len(lines) // 4) :])
            if found > best + 1e-9:
                best, dialect = found, candidate
    if dialect is None:
        raise InputError(f"{path}: the last lines hold no columns of numbers; export the traces as a table")
    return _decided(dialect, lines, path)


def _score(dialect, lines):
    """Share of cells that are numbers times share of lines with the usual count of them."""
    counts, cells = [], 0
    for line in lines:
        row = [c for c in dialect.cells(line) if c]
        counts.append(sum(map(dialect.is_sample, row)))
        cells += len(row)
    usual = Counter(c for c in counts if c).most_common(1)
    if not usual:
        return 0.0
    even = counts.count(usual[0][0]) / len(counts)
    # Blanks also stand within names and beside other separators.
    return sum(counts) / cells * even * (0.95 if dialect.delimiter is None else 1.0)


def _decided(dialect, lines, path):
    """Commas alone may be decimal marks: whole numbers with leading zeros behind them give that away."""
    if dialect != Dialect(",", "."):
        return dialect
    rows = [[c for c in dialect.cells(line) if c] for line in lines]
    rows = [r for r in rows if r and all(map(_INTEGER.fullmatch, r))]
    if len(rows) < 0.6 * len(lines) or any(c[0] in "+-" for r in rows for c in r[1::2]):
        return dialect
    if not any(len(c) > 1 and c[0] == "0" for r in rows for c in r[1::2]):
        return dialect
    if max(map(len, rows)) <= 2:
        return Dialect(";", ",")
    raise InputError(
        f"{path}: commas serve both as decimal marks and between columns, which cannot be told apart; export "
        "with semicolons or tabs between the columns"
    )
