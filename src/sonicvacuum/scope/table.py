"""A text split into the rows above the samples and the columns of samples.

Which columns hold samples is seen at the end of the text; the first row of samples is the first from which
these columns hold numbers line after line. What stands beside samples (names and values in columns A to C of
some recorders) is kept as further header rows.
"""

import io
import re
from collections import Counter
from dataclasses import dataclass

import numpy as np
import pandas as pd

from sonicvacuum.files import InputError
from sonicvacuum.scope.dialect import LOST, OVER, UNDER, Dialect, sniff

# Lines in a row that must look like samples where the table begins; header lines looked through at most.
BEGINNING = 4
LONGEST_HEADER = 100_000
# Rows beside which a header may stand.
BESIDE = 200
# A time of day, maybe behind a date.
_CLOCK = re.compile(r"(?:\d[\d./-]+\d[T ]+)?(?P<h>\d{1,2}):(?P<m>\d{2}):(?P<s>\d{2}(?:[.,]\d+)?)Z?")
# Numbers as Python reads them: the default from pandas 3.1 on, an option before.
_EXACT = {} if tuple(map(int, pd.__version__.split(".")[:2])) >= (3, 1) else {"float_precision": "round_trip"}
# Share of rows that are no samples from which a text is not taken for a table.
MOST_FOREIGN = 0.3


@dataclass(frozen=True, eq=False)
class Table:
    """Header rows and samples of one text.

    Attributes:
        dialect: of the samples.
        header: rows of cells above the samples, blank ones left out.
        raw: the same rows as they stand.
        beside: rows of cells that stand to the left of samples.
        columns: place of the column → (S,) numbers; NaN lost, ±inf over range.
        breaks: rows at which a further header interrupts the samples (shots in a row).
    """

    dialect: Dialect
    header: list[list[str]]
    raw: list[str]
    beside: list[list[str]]
    columns: dict[int, np.ndarray]
    breaks: tuple[int, ...]

    @property
    def places(self) -> list[int]:
        """Places of the columns with samples, in order."""
        return sorted(self.columns)


def split(text: str, path) -> Table:
    """Header and columns of a text.

    Raises:
        InputError: where no columns of numbers are found, or a row has more cells than the table columns.
    """
    dialect = sniff(text, path)
    places = _places(text, dialect, path)
    above, offset = _above(text, dialect, places, path)
    start = _rows(text[offset : offset + 200 * BESIDE].split("\n")[:BESIDE], dialect)
    header = [(raw, cells) for raw, cells in ((a, _header_cells(a, dialect)) for a in above) if any(cells)]
    places = _with_sparse(places, start, header[-1][1] if header else [], dialect)
    beside = [row[: places[0]] for row in start if any(row[: places[0]])]
    width = max(_width(start, places, text, dialect), len(header[-1][1]) if header else 0)
    columns, breaks = _numbers(text[offset:], dialect, places, path, width)
    return Table(dialect, [c for _, c in header], [r for r, _ in header], beside, columns, breaks)


def _header_cells(line, dialect):
    """Cells of a header row, which may be cut by another mark where the samples stand in one column."""
    cells = dialect.cells(line)
    if len(cells) > 1:
        return cells
    mark = next((m for m in "\t;," if m in line), None)
    return Dialect(mark, dialect.decimal).cells(line) if mark else cells


def _rows(lines, dialect):
    return [dialect.cells(line) for line in lines if line.strip()]


def _numeric(row, dialect):
    return tuple(k for k, cell in enumerate(row) if dialect.is_sample(cell))


def _places(text, dialect, path):
    """Columns that hold samples in most of the last rows."""
    rows = _rows(text[-20_000:].split("\n")[-60:], dialect)
    if dialect.delimiter is None and sum(len(_numeric(r, dialect)) < len(r) for r in rows[-16:]) > 8:
        raise InputError(f"{path}: words stand between the numbers; export the traces as a table of numbers")
    seen = [p for p in (_numeric(r, dialect) for r in rows[-16:]) if p]
    return list(Counter(seen).most_common(1)[0][0])


def _above(text, dialect, places, path):
    """Lines above the first row of samples, and where in the text that row begins."""
    above, offset, run, begin = [], 0, 0, 0
    while offset < len(text) and len(above) < LONGEST_HEADER:
        end = text.find("\n", offset)
        end = len(text) if end < 0 else end
        line = text[offset:end]
        cells = dialect.cells(line)
        if _fits(cells, places, dialect):
            begin = begin if run else offset
            run += 1
        elif line.strip():
            run = 0
        above.append(line)
        offset = end + 1
        if run >= BEGINNING:
            break
    if not run:
        raise InputError(f"{path}: no row of samples found; export the traces as a table")
    return text[:begin].split("\n")[:-1], begin


def _fits(cells, places, dialect):
    """Whether a row has a sample or nothing in each column of samples, and at least one number.

    A text before the first such column is a header's key only where that column is the first of all.
    """
    held = [cells[k] for k in places if k < len(cells)]
    return (
        len(held) >= 1
        and all(not c or dialect.is_sample(c) for c in held)
        and any(dialect.is_number(c) for c in held)
        and len(held) >= min(len(places), 2)
    )


def _with_sparse(places, rows, names, dialect):
    """Also columns that have a name and seldom a number, as of a slower channel."""
    found = set(places)
    for k, name in enumerate(names):
        held = [r[k] for r in rows if k < len(r) and r[k]]
        if name and k > places[0] and len(held) >= 2 and all(map(dialect.is_number, held)):
            found.add(k)
    return sorted(found)


def _width(start, places, text, dialect):
    tail = _rows(text[-5_000:].split("\n")[-20:], dialect)
    return max(max(map(len, (*start, *tail)), default=0), places[-1] + 1) + 1


def _numbers(body, dialect, places, path, width):
    """Columns of numbers of the rows of samples, and the rows at which text interrupts them."""
    try:
        frame = pd.read_csv(
            io.StringIO(body),
            sep=r"\s+" if dialect.delimiter is None else dialect.delimiter,
            decimal=dialect.decimal,
            header=None,
            names=list(range(width)),
            index_col=False,
            skipinitialspace=True,
            engine="c",
            low_memory=False,
            **_EXACT,
        )
    except (pd.errors.ParserError, ValueError) as error:
        raise InputError(f"{path}: rows differ in their columns: {str(error).strip()}") from None
    columns, foreign = {}, np.zeros(len(frame), dtype=bool)
    for k in places:
        columns[k], strange = _column(frame[k], dialect)
        foreign |= strange
    for k in range(places[0]):
        times = clock(frame[k])
        columns |= {k: times} if times is not None else {}
    left = frame[[k for k in range(places[0]) if k not in columns]].notna().any(axis=1).to_numpy()
    foreign = _whole_headers(foreign, left | np.isnan([columns[k] for k in places]).all(axis=0))
    if foreign.mean() > MOST_FOREIGN:
        raise InputError(f"{path}: most rows are no samples; export the traces as a table of numbers")
    return _cut(columns, foreign)


def _column(series, dialect):
    """A column as floats, and where it holds words that are no samples."""
    if series.dtype.kind in "iuf":
        return series.to_numpy(dtype=float), np.zeros(len(series), dtype=bool)
    if series.dtype.kind == "b":
        return series.to_numpy(dtype=float), np.ones(len(series), dtype=bool)
    texts = series.astype("string").str.strip().fillna("")
    plain = texts.str.replace(",", ".", n=1, regex=False) if dialect.decimal == "," else texts
    values = pd.to_numeric(plain, errors="coerce").to_numpy(dtype=float, na_value=np.nan)
    words = texts.str.lower().to_numpy(dtype=object)
    strange = np.zeros(len(values), dtype=bool)
    for k in np.flatnonzero(~np.isfinite(values)):
        word = words[k]
        values[k] = np.inf if word in OVER else -np.inf if word in UNDER else np.nan
        strange[k] = bool(word) and word not in LOST and word not in OVER and word not in UNDER
    return values, strange


def _whole_headers(foreign, beside):
    """Rows of further headers: foreign ones, and those with words beside numbers in one stretch with them."""
    odd = foreign | beside
    edges = np.flatnonzero(np.diff(np.concatenate(([0], odd.astype(int), [0]))))
    result = foreign.copy()
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        result[begin:end] = foreign[begin:end].any()
    return result


def clock(series) -> np.ndarray | None:
    """Times of day (or dates with them) as seconds from the first; None for a column of anything else."""
    if series.dtype.kind in "iufb" or not _CLOCK.fullmatch(str(series.iloc[0]).strip()):
        return None
    parts = series.astype("string").str.strip().str.extract(_CLOCK)
    hours, minutes, seconds = (
        pd.to_numeric(parts[c].str.replace(",", ".", n=1, regex=False), errors="coerce") for c in "hms"
    )
    times = (3600.0 * hours + 60.0 * minutes + seconds).to_numpy(dtype=float, na_value=np.nan)
    days = np.cumsum(np.concatenate(([0.0], np.diff(times) < -43_200.0)))
    return np.round(times - times[0] + 86_400.0 * days, 9)


def _cut(columns, foreign):
    """The rows of samples alone: without foreign ones, and without empty ones at the ends of a shot."""
    stack = np.array(list(columns.values()))
    empty = np.isnan(stack).all(axis=0) | foreign
    keep = np.zeros(len(empty), dtype=bool)
    breaks, kept = [], 0
    edges = np.flatnonzero(np.diff(np.concatenate(([1], foreign.astype(int), [1]))))
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        held = np.flatnonzero(~empty[begin:end])
        if len(held) < 2:
            continue
        keep[begin + held[0] : begin + held[-1] + 1] = True
        if kept:
            breaks.append(kept)
        kept += int(held[-1] - held[0] + 1)
    return {k: v[keep] for k, v in columns.items()}, tuple(breaks)
