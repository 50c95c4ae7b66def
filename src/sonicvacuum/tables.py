"""Tables as CSV files: written whole or not at all, with the line ends and encoding of all other files."""

import csv
from collections.abc import Iterable, Sequence
from os import PathLike
from typing import Any

from sonicvacuum.files import check_file, reading, replacing


def write_csv(path: str | PathLike, columns: Sequence[str], rows: Iterable[Iterable[Any]]) -> None:
    """A first line that names the columns, then one line for each row."""
    with replacing(path) as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(columns)
        table.writerows(rows)


def read_lines(path: str | PathLike, cure: str = "give the path of a table") -> list[list[str]]:
    """All lines as cells of text, first of all the one that names the columns.

    Raises:
        InputError: for a file that cannot be read, or is no CSV; it names `cure`.
    """
    return [cells for _, cells in _numbered(path, cure)]


def read_csv(
    path: str | PathLike, cure: str = "give the path of a table", columns: Iterable[str] = ()
) -> list[dict[str, str]]:
    """Rows below the first line, by column, every cell as text; empty lines are none.

    Raises:
        InputError: for a file that cannot be read, that lacks one of `columns`, or whose lines have more or
            fewer cells than the first; it names `cure`.
    """
    return [row for _, row in read_numbered(path, cure, columns)]


def read_numbered(
    path: str | PathLike, cure: str = "give the path of a table", columns: Iterable[str] = ()
) -> list[tuple[int, dict[str, str]]]:
    """The same, each row with the number of its line in the file, as an editor counts it."""
    (_, names), *rows = _numbered(path, cure) or [(1, [])]
    with reading(path, cure):
        missing = [c for c in columns if c not in names]
        if missing:
            raise ValueError(f"no column {missing[0]}")
        rows = [(line, cells) for line, cells in rows if cells]
        for line, cells in rows:
            if len(cells) != len(names):
                raise ValueError(f"line {line} has another number of cells than the header")
    return [(line, dict(zip(names, cells, strict=True))) for line, cells in rows]


def _numbered(path, cure):
    """All rows of cells, each with the line where it begins: a quoted cell may go over several lines."""
    check_file(path)
    found, line = [], 1
    with reading(path, cure), open(path, encoding="utf-8", newline="") as stream:
        table = csv.reader(stream, strict=True)
        for cells in table:
            found.append((line, cells))
            line = table.line_num + 1
    return found
