"""How a text file separates columns and writes numbers, found from its last lines, which are samples."""

import csv
import math
import re
from collections import Counter
from dataclasses import dataclass

from sonicvacuum.files import InputError

_POINT = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_COMMA = re.compile(r"[-+]?(\d+(,\d+)?|,\d+)([eE][-+]?\d+)?")
# Digits in groups of three that nothing else can be: by blanks or apostrophes, by the mark that is not the
# decimal one before a decimal mark, or by it more than once.
_GROUPED = {
    decimal: re.compile(
        rf"[-+]?\d{{1,3}}(([ \u00a0\u202f'’])\d{{3}}(\2\d{{3}})*({re.escape(decimal)}\d*)?"
        rf"|({re.escape(mark)}\d{{3}})+{re.escape(decimal)}\d*|({re.escape(mark)}\d{{3}}){{2,}})"
    )
    for decimal, mark in ((".", ","), (",", "."))
}
# One group only, which may as well be decimals.
_ONE_GROUP = {
    d: re.compile(rf"[-+]?[1-9]\d{{0,2}}{re.escape(m)}\d{{3}}") for d, m in ((".", ","), (",", "."))
}
# Digits and marks as in a number, whether it is one or not.
_LIKE = re.compile(r"[-+]?[\d.,'’ \u00a0\u202f]*\d[\d.,'’ \u00a0\u202f]*([eE][-+]?\d+)?")
# What stands for a sample that the recorder could not give; so does any row of marks such as **** or --.--.
LOST = {"nan", "-nan", "na", "n/a", "n.a.", "null", "none", "1.#ind", "-1.#ind", "1.#qnan", "lost", "invalid",
        "err", "error", "no data", "missing", "burnout"}  # fmt: skip
_MARKS = re.compile(r"[-+*?.><_/\s]*[-+*?><_/]|#n/a|#[\w/]+[!?]|-?1\.#(ind|qnan|snan)\d*", re.IGNORECASE)
OVER = {"∞", "+∞", "inf", "+inf", "infinity", "overrange", "over range", "over", "ol", "o.l", "o.l.", "ovl",
        "ovfl", "overflow", "overload", "clipped", "+over", "+ol", ">range", "âˆž", "+overrange", "ofl",
        "ovr", "sat", "saturated", "out of range", "oor"}  # fmt: skip
UNDER = {"-∞", "-inf", "-infinity", "underrange", "under range", "under", "-over", "-ol", "-ovl",
         "-overrange", "-overflow", "-overload", "<range", "-âˆž", "-ofl", "-ovr", "-sat"}  # fmt: skip
_INFINITE = re.compile(r"[-+]?1\.#inf\d*", re.IGNORECASE)
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
        plain = _COMMA if self.decimal == "," else _POINT
        return bool(plain.fullmatch(cell) or _GROUPED[self.decimal].fullmatch(cell))

    def is_sample(self, cell: str) -> bool:
        """Whether a cell can be a sample: a number, or a word for a lost or overranging one."""
        return self.is_number(cell) or stands_for(cell) is not None

    def ungrouped(self, cell: str) -> str:
        """A number with digits in groups as Python reads it; what only may be one stays as it is."""
        if not _GROUPED[self.decimal].fullmatch(cell):
            return cell
        return re.sub(r"[^-+\d.,]", "", cell).replace("," if self.decimal == "." else ".", "")

    def is_one_group(self, cell: str) -> bool:
        """Whether a cell is a number of thousands only if its mark is none of decimals, as in 8,012."""
        return bool(_ONE_GROUP[self.decimal].fullmatch(cell))


def stands_for(cell: str) -> float | None:
    """What a word in place of a sample means: lost (NaN), beyond the range (±inf), or None for any other."""
    word = cell.lower()
    if word in OVER or word in UNDER or _INFINITE.fullmatch(word):
        return -math.inf if word in UNDER or word.startswith("-1") else math.inf
    return math.nan if word in LOST or _MARKS.fullmatch(word) else None


def is_like_number(cell: str) -> bool:
    """Whether a cell holds nothing but digits and the marks within numbers."""
    return bool(_LIKE.fullmatch(cell))


def last_lines(text: str) -> list[str]:
    """The lines that a dialect is found from."""
    return [line for line in text[-200 * LOOKED_AT :].split("\n")[-LOOKED_AT - 1 :] if line.strip()]


def sniff(text: str, path) -> Dialect:
    """The dialect in which the last lines of a text hold most numbers; InputError where none does."""
    lines = last_lines(text)
    best, dialect = 0.0, None
    for delimiter in _CANDIDATES:
        for decimal in ".,":
            candidate = Dialect(delimiter, decimal)
            found = _score(candidate, lines[-max(3, len(lines) // 4) :])
            if found > best + 1e-9:
                best, dialect = found, candidate
    if dialect is None:
        last = f", as {lines[-1].strip()[:60]!r}" if lines else ""
        raise InputError(
            f"{path}: the last lines hold no columns of numbers{last}; export the traces as a table"
        )
    return dialect


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
