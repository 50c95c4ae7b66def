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
    check_file(path)
    with reading(path, cure), open(path, encoding="utf-8", newline="") as stream:
        return list(csv.reader(stream, strict=True))


def read_csv(
    path: str | PathLike, cure: str = "give the path of a table", columns: Iterable[str] = ()
) -> list[dict[str, str]]:
    """Rows below the first line, by column, every cell as text.

    Raises:
        InputError: for a file that cannot be read, that lacks one of `columns`, or whose lines have more or
            fewer cells than the first; it names `cure`.
    """
    names, *rows = read_lines(path, cure) or [[]]
    with reading(path, cure):
        missing = [c for c in columns if c not in names]
        if missing:
            raise ValueError(f"no column {missing[0]}")
        rows = [cells for cells in rows if cells]
        for line, cells in enumerate(rows, 2):
            if len(cells) != len(names):
                raise ValueError(f"line {line} has another number of cells than the header")
    return [dict(zip(names, cells, strict=True)) for cells in rows]
