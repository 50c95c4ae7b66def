"""One metric of one case, and the tables that hold them.

`results/metrics.csv` has one line per metric. A metric that does not exist, because its pulse is absent or
merged, keeps its line with an empty value; the reason stands in `results/absent.csv`.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from itertools import pairwise

from sonicvacuum.files import InputError
from sonicvacuum.tables import read_lines, write_csv

COLUMNS = ("case", "quantity", "sensor", "value", "unit", "numerical_error")
REASONED = (*COLUMNS, "reason")
ABSENT = ("case", "quantity", "sensor", "reason")


@dataclass(frozen=True)
class Row:
    """One metric.

    Attributes:
        case: card (`fig3a.matched`), one run of a sweep (`fig4a.matched@0.44`, speed in m/s) or a pseudo-case
            (`paper`, `theory.matched`, ...).
        quantity: its name in `claims.md`.
        sensor: gauge, pair of gauges, or empty.
        value: NaN where the quantity does not exist.
        unit: `1` for ratios; `us` and `um` stand for micro.
        numerical_error: change when the time step is halved; NaN where that has no meaning.
        reason: why there is no value.
    """

    case: str
    quantity: str
    sensor: str
    value: float
    unit: str
    numerical_error: float = 0.0
    reason: str = ""

    @property
    def key(self) -> tuple[str, str, str]:
        """What identifies the metric."""
        return self.case, self.quantity, self.sensor

    @property
    def known(self) -> bool:
        """Whether there is a value."""
        return math.isfinite(self.value)


def absent(case: str, quantity: str, sensor: str, unit: str, reason: str) -> Row:
    """The line of a quantity that does not exist."""
    return Row(case, quantity, sensor, math.nan, unit, math.nan, reason)


def write_rows(rows: Iterable[Row], path, reasons: bool = True) -> None:
    """Write rows, sorted by key: `COLUMNS`, and the reason as a seventh column unless it has its own table.

    Raises:
        ValueError: when two rows have one key.
    """
    columns = REASONED if reasons else COLUMNS
    cells = (
        [*r.key, number(r.value), r.unit, number(r.numerical_error, 3), r.reason][: len(columns)]
        for r in _sorted(rows)
    )
    write_csv(path, columns, cells)


def write_absent(rows: Iterable[Row], path) -> None:
    """Write the reasons of the rows that have no value."""
    write_csv(path, ABSENT, ([*r.key, r.reason] for r in _sorted(rows) if not r.known))


def write_lines(lines: Iterable, kind: type, path, digits: int = 8, **other_digits: int) -> None:
    """Write dataclasses of one kind, its fields as columns.

    Args:
        lines: the rows.
        kind: their class.
        path: of the file.
        digits: of numbers that are no integers.
        **other_digits: those of single columns.
    """
    names = [f.name for f in fields(kind)]

    def cell(name, value):
        return number(value, other_digits.get(name, digits)) if isinstance(value, float) else value

    write_csv(path, names, ([cell(name, getattr(line, name)) for name in names] for line in lines))


def read_rows(path, absent_path=None) -> list[Row]:
    """The rows of a table with or without reasons; those of `absent_path` are added where it is given.

    Raises:
        InputError: naming file, line and what is wrong.
    """
    lines = read_lines(path)
    if not lines or tuple(lines[0]) not in (COLUMNS, REASONED):
        raise InputError(
            f"{path}: the first line must read {','.join(COLUMNS)}; run sonicvacuum paper observe again"
        )
    rows = [_row(cells, len(lines[0]), path, number) for number, cells in enumerate(lines[1:], 2)]
    if absent_path is None:
        return rows
    reasons = {tuple(r[:3]): r[3] for r in cells_of(absent_path, ABSENT)}
    return [replace(r, reason=reasons.get(r.key, r.reason)) for r in rows]


def cells_of(path, columns: tuple[str, ...]) -> list[list[str]]:
    """Cells of a CSV file below its first line, which must name `columns`; InputError otherwise."""
    lines = read_lines(path)
    if not lines or tuple(lines[0]) != columns:
        raise InputError(f"{path}: the first line must read {','.join(columns)}")
    for place, cells in enumerate(lines[1:], 2):
        if len(cells) != len(columns):
            raise InputError(
                f"{path}, line {place}: {len(cells)} cells, expected {len(columns)}; quote what holds commas"
            )
    return lines[1:]


def number(value: float, digits: int = 12) -> str:
    """A number as text, empty for NaN; one spelling for one number."""
    return "" if math.isnan(value) else f"{value + 0.0:.{digits}g}"


def _sorted(rows):
    ordered = sorted(rows, key=lambda r: r.key)
    for one, other in pairwise(ordered):
        if one.key == other.key:
            raise ValueError(f"two rows for {'/'.join(one.key)}")
    return ordered


def _row(cells, count, path, place):
    if len(cells) != count:
        raise InputError(f"{path}, line {place}: {len(cells)} cells, expected {count}")
    case, quantity, sensor, value, unit, error, *reason = cells
    try:
        value, error = (float(c) if c else math.nan for c in (value, error))
    except ValueError:
        raise InputError(f"{path}, line {place}: {value!r} or {error!r} is not a number") from None
    if math.isinf(value) or math.isinf(error) or error < 0.0:
        raise InputError(
            f"{path}, line {place}: {value:g} with a numerical error of {error:g} is no result; "
            "leave a cell empty where there is no number"
        )
    return Row(case, quantity, sensor, value, unit, error, *reason)
