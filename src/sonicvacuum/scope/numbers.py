"""Lines of samples to columns of numbers, and what stands between the samples.

A row that holds a number in some of its columns is a sample, of which words are lost cells. A row that holds
none is no sample: what follows it is a further table, whose header it may be.
"""

import io
import re
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from sonicvacuum.files import InputError
from sonicvacuum.scope.dialect import Dialect, is_like_number, stands_for

# A time of day, maybe behind a date and before a time zone or half of the day; without hours only where a
# fraction tells minutes and seconds from hours and minutes.
_CLOCK = re.compile(
    r"(?:\d[\d./-]+\d[T ]+)?(?:(?P<h>\d{1,2}):(?=\d+:))?(?P<m>\d{1,2}):(?P<s>\d{2}(?:[.,]\d+)?)"
    r"\s?(?P<half>[AaPp]\.?[Mm]\.?)?(?:Z|[-+]\d{2}:?\d{2})?"
)
# Numbers as Python reads them: the default from pandas 3.1 on, an option before.
_EXACT = {} if tuple(map(int, pd.__version__.split(".")[:2])) >= (3, 1) else {"float_precision": "round_trip"}
# Share of rows that are no samples, or of a column's cells that are no numbers, from which a text is not
# taken for a table.
MOST_FOREIGN = 0.3
# Cells to a row at most.
_WIDEST = 10_000
_SHOWN = 40


@dataclass(frozen=True, eq=False)
class Samples:
    """What was read.

    Attributes:
        columns: place of the column → (S,) numbers; NaN lost, ±inf over range.
        breaks: row of the first sample behind other lines → these lines, without blank ones.
        notes: what was left out, in whole sentences.
        clocks: places of columns of times of day, which are seconds.
    """

    columns: dict[int, np.ndarray]
    breaks: dict[int, list[str]]
    notes: tuple[str, ...]
    clocks: frozenset[int] = frozenset()


class _Lines:
    """Which line of the file a row of samples stands in; looked up only where something is to be said."""

    def __init__(self, body, rows, above):
        self.body, self.rows, self.above = body, rows, above

    @cached_property
    def texts(self):
        lines = enumerate(self.body.split("\n"), self.above + 1)
        found = [(k, line) for k, line in lines if line.strip(" \r")]
        # Quotation marks may join lines; their numbers are then not known.
        return found if len(found) == self.rows else []

    def where(self, row):
        return f"line {self.texts[row][0]}" if self.texts else f"row {row + 1} of the samples"

    def text(self, row):
        return self.texts[row][1].strip() if self.texts else ""

    def between(self, begin, end):
        return [line for _, line in self.texts[begin:end]]


def read(body: str, dialect: Dialect, places: list[int], path, width: int, above: int) -> Samples:
    """The columns at some places of the lines of `body`, above which so many lines stand in the file.

    Raises:
        InputError: for rows with more cells than there are columns, or where most rows are no samples.
    """
    if places[-1] >= _WIDEST:
        raise InputError(
            f"{path}: the table has more than {_WIDEST} columns; export the traces one "
            "below the other, in a column for each channel"
        )
    frame = _frame(body, dialect, width, path)
    lines = _Lines(body, len(frame), above)
    columns, strange, words = {}, np.zeros((len(places), len(frame)), dtype=bool), {}
    for j, k in enumerate(places):
        columns[k], strange[j], words[k] = _column(frame[k], dialect)
    number = ~np.isnan(np.array([columns[k] for k in places])).all(axis=0)
    clocks = {k: times for k in range(places[0]) if (times := clock(frame[k])) is not None}
    columns |= clocks
    left = frame[[k for k in range(places[0]) if k not in columns]].notna().any(axis=1).to_numpy()
    # A word in place of the first number, as of the time, begins a row of another kind.
    no_sample = strange.any(axis=0) & ~number | strange[0]
    foreign = _whole_headers(no_sample, strange.any(axis=0) | left | ~number)
    _refuse_wide(frame, width, foreign, number, lines, path)
    _refuse_foreign(foreign, strange, words, places, lines, path)
    notes = list(_lost(strange & ~foreign, words, places, lines))
    for j, k in enumerate(places):
        columns[k] = _grouped(columns[k], strange[j] & ~foreign, words[k], dialect, k, lines, path)
        _refuse_marks(columns[k], ~foreign, dialect, k, lines, path)
    kept, breaks, said = _cut(columns, foreign, lines)
    return Samples(kept, breaks, (*notes, *said), frozenset(clocks))


def _frame(body, dialect, width, path):
    """The cells, as many in a row as the widest has: pandas leaves cells out without a word otherwise."""
    wide = np.flatnonzero(_cells(body, dialect) > width)
    if len(wide):
        lines = body.split("\n")
        width = max(width, *(len(dialect.cells(lines[k])) for k in wide if len(lines[k]) < 20 * _WIDEST), 0)
    try:
        return pd.read_csv(
            io.StringIO(body),
            sep=r"\s+" if dialect.delimiter is None else dialect.delimiter,
            decimal=dialect.decimal,
            header=None,
            names=list(range(min(width, _WIDEST))),
            index_col=False,
            skipinitialspace=True,
            engine="c",
            low_memory=False,
            **_EXACT,
        )
    except (pd.errors.ParserError, ValueError) as error:
        # What is read is in memory: nothing but an interruption can fail there, and pandas hides it.
        if "Calling read(nbytes) on source failed" in str(error):
            raise KeyboardInterrupt from None
        if "EOF inside string" not in str(error):
            raise InputError(
                f"{path}: rows differ in their columns; export the traces as a table of numbers"
            ) from None
    raise InputError(f"{path}: a quotation mark is opened and never closed; export the traces again")


def _cells(body, dialect):
    """Cells of each line; marks within quotes count too."""
    data = np.frombuffer(body.encode("utf-8", "replace") + b"\n", dtype=np.uint8)
    ends = np.flatnonzero(data == ord("\n"))
    if dialect.delimiter is None:
        blank = data <= ord(" ")
        begins = np.flatnonzero(~blank & np.concatenate(([True], blank[:-1])))
        return np.diff(np.searchsorted(begins, ends), prepend=0)
    return np.diff(np.searchsorted(np.flatnonzero(data == ord(dialect.delimiter)), ends), prepend=0) + 1


def _refuse_wide(frame, width, foreign, number, lines, path):
    if len(frame.columns) <= width:
        return
    # Words behind the samples are remarks.
    beyond = frame[list(range(width, len(frame.columns)))].apply(pd.to_numeric, errors="coerce")
    wide = beyond.notna().any(axis=1).to_numpy()
    rows = np.flatnonzero(wide & ~foreign & number)
    if len(rows):
        cells = int(frame.iloc[rows[0]].notna().to_numpy().nonzero()[0].max()) + 1
        raise InputError(
            f"{path}: {lines.where(rows[0])} has {cells} cells, more than there are columns above it: "
            f"{_short(lines.text(rows[0]))!r}; export the traces as one table, or give each table a file"
        )


def _refuse_foreign(foreign, strange, words, places, lines, path):
    lost = (strange & ~foreign).mean(axis=1) > MOST_FOREIGN
    if foreign.mean() <= MOST_FOREIGN and not lost.any():
        return
    j = int(lost.argmax()) if lost.any() else int(strange[:, foreign].sum(axis=1).argmax())
    rows = np.flatnonzero(strange[j])
    row = int(rows[0]) if len(rows) else int(foreign.argmax())
    cell = words[places[j]].get(row, lines.text(row))
    raise InputError(
        f"{path}: most rows are no samples, the first in {lines.where(row)}: {_short(cell)!r} in column "
        f"{places[j] + 1} is no number; export the traces as a table of plain numbers"
    )


def _lost(strange, words, places, lines):
    """One sentence for cells that are no numbers and stand for none that is known."""
    # Numbers with marks are looked at on their own.
    found = [
        (row, k)
        for j, k in enumerate(places)
        for row in np.flatnonzero(strange[j])
        if not is_like_number(words[k][row])
    ]
    if found:
        row, k = min(found)
        yield (
            f"{len(found)} cells that are no numbers count as lost, the first in {lines.where(row)}, column "
            f"{k + 1}: {_short(words[k][row])!r}."
        )


def _column(series, dialect):
    """A column as floats, where it holds words that stand for no sample, and these."""
    none = np.zeros(len(series), dtype=bool)
    if series.dtype.kind in "iuf":
        return series.to_numpy(dtype=float), none, {}
    if series.dtype.kind == "b":
        return np.full(len(series), np.nan), ~none, dict(enumerate(series.astype(str)))
    texts = series.astype("string").str.strip().fillna("")
    plain = texts.str.replace(",", ".", n=1, regex=False) if dialect.decimal == "," else texts
    values = pd.to_numeric(plain, errors="coerce").to_numpy(dtype=float, na_value=np.nan)
    cells, words, thousands = texts.to_numpy(dtype=object), {}, False
    if dialect.decimal == ",":
        # A point beside decimal commas is none of decimals.
        pointed = texts.str.contains(".", regex=False).to_numpy(dtype=bool)
        values[pointed] = np.nan
        thousands = all(dialect.is_one_group(c) or dialect.is_sample(c) for c in cells[pointed])
    for k in np.flatnonzero(~np.isfinite(values)):
        stands = stands_for(cells[k]) if cells[k] else np.nan
        whole = dialect.ungrouped(cells[k])
        if stands is not None:
            values[k] = stands
        elif whole != cells[k]:
            values[k] = float(whole.replace(",", "."))
        elif thousands and dialect.is_one_group(cells[k]):
            values[k] = float(cells[k].replace(".", ""))
        elif not dialect.is_number(cells[k]):
            words[int(k)] = cells[k]
    strange = none.copy()
    strange[list(words)] = True
    return values, strange, words


def _grouped(values, strange, words, dialect, place, lines, path):
    """The column with cells such as 8,012 as thousands, where the others leave them nothing else to be."""
    rows = [k for k in np.flatnonzero(strange) if is_like_number(words[k])]
    if not rows:
        return values
    others = values[np.isfinite(values)]
    whole = bool((others == np.round(others)).all())
    small = bool((np.abs(others) < 1000.0).all())
    if all(dialect.is_one_group(words[k]) for k in rows) and (not whole or small):
        values = values.copy()
        for k in rows:
            values[k] = float(words[k].replace(",", "").replace(".", ""))
        return values
    row = next((k for k in rows if not dialect.is_one_group(words[k])), rows[0])
    raise _marks(words[row], f"elsewhere they follow a {dialect.decimal!r}", place, row, lines, path)


def _refuse_marks(values, held, dialect, place, lines, path):
    """Refuse whole numbers below a thousand beside such as 8.012 (8,012), which may be thousands as well."""
    found = values[held & np.isfinite(values)]
    broken = found != np.round(found)
    if not broken.any() or (np.abs(found) >= 1000.0).any() or (np.abs(found[broken]) < 1.0).any():
        return
    if broken.all() or (np.abs(found[broken] * 1e3 % 1.0 - 0.5) < 0.5 - 1e-6).any():
        return
    rows = np.flatnonzero(held & np.isfinite(values))
    cells = [dialect.cells(lines.text(row)) for row in rows]
    texts = np.array([row[place] if place < len(row) else "" for row in cells])
    mark = dialect.decimal
    grouped = [bool(re.fullmatch(rf"[-+]?[1-9]\d{{0,2}}\{mark}\d{{3}}", t)) for t in texts if mark in t]
    if all(grouped) and len(grouped) < len(texts):
        cell, why = str(texts[broken][0]), "other cells of the column are whole"
        raise _marks(cell, why, place, int(rows[broken][0]), lines, path)


def _marks(cell, why, place, row, lines, path):
    return InputError(
        f"{path}: {lines.where(row)}, column {place + 1}: {cell!r} may be a number with thousands apart or "
        f"one with decimals ({why}); export without marks of thousands"
    )


def _whole_headers(foreign, odd):
    """Rows of further headers: foreign ones, and odd ones in one stretch with them."""
    odd = foreign | odd
    edges = np.flatnonzero(np.diff(np.concatenate(([0], odd.astype(int), [0]))))
    result = foreign.copy()
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        result[begin:end] = foreign[begin:end].any()
    return result


def clock(series) -> np.ndarray | None:
    """Times of day (or dates with them) as seconds from the first; None for a column of anything else."""
    first = None if series.dtype.kind in "iufb" else _CLOCK.fullmatch(str(series.iloc[0]).strip())
    if first is None or (first["h"] is None and not re.search("[.,]", first["s"])):
        return None
    parts = series.astype("string").str.strip().str.extract(_CLOCK)
    hours, minutes, seconds = (
        pd.to_numeric(parts[c].str.replace(",", ".", n=1, regex=False), errors="coerce") for c in "hms"
    )
    if first["h"] is None:
        hours = 0.0 * minutes
    if first["half"]:
        hours = hours % 12.0 + 12.0 * parts["half"].str.lower().str.startswith("p").astype("Float64")
    times = (3600.0 * hours + 60.0 * minutes + seconds).to_numpy(dtype=float, na_value=np.nan)
    days = np.cumsum(np.concatenate(([0.0], np.diff(times) < -43_200.0)))
    return np.round(times - times[0] + 86_400.0 * days, 9)


def _cut(columns, foreign, lines):
    """The rows of samples alone: without foreign ones, and without empty ones at the ends of a shot."""
    stack = np.array(list(columns.values()))
    empty = np.isnan(stack).all(axis=0) | foreign
    keep = np.zeros(len(empty), dtype=bool)
    breaks, kept, last, notes = {}, 0, 0, []
    edges = np.flatnonzero(np.diff(np.concatenate(([1], foreign.astype(int), [1]))))
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        held = np.flatnonzero(~empty[begin:end])
        if len(held) < 2:
            continue
        keep[begin + held[0] : begin + held[-1] + 1] = True
        if kept:
            breaks[kept] = lines.between(last, begin)
            notes.append(
                f"{_said(foreign, last, lines)} holds no samples: what follows is a table of its own."
            )
        kept += int(held[-1] - held[0] + 1)
        last = begin + int(held[-1]) + 1
    if foreign[last:].any():
        rest = int(foreign[last:].sum())
        notes.append(f"{_said(foreign, last, lines)} and what follows are no samples: {rest} lines left out.")
    return {k: v[keep] for k, v in columns.items()}, breaks, tuple(notes)


def _said(foreign, begin, lines):
    row = begin + int(foreign[begin:].argmax())
    return f"{lines.where(row).capitalize()} ({_short(lines.text(row))})"


def _short(text):
    return text if len(text) <= _SHOWN else text[: _SHOWN - 1] + "…"
