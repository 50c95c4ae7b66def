"""A text split into the rows above the samples and the columns of samples.

Which columns hold samples is seen at the end of the text; the first row of samples is the first from which
these columns hold numbers line after line. What stands beside samples (names and values in columns A to C of
some recorders) is kept as further header rows.
"""

import re
from collections import Counter
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum.scope import commas, numbers
from sonicvacuum.scope.dialect import Dialect, last_lines, sniff
from sonicvacuum.scope.keys import is_key, keyed

# Lines in a row that must look like samples where the table begins; header lines looked through at most.
BEGINNING = 4
LONGEST_HEADER = 100_000
# Lines behind the samples from which on they are left out of what is looked at there.
FOOTER = 10
# A key and one number with a decimal comma.
_VALUE = re.compile(r"[^,:=]*[:=]\s*[-+]?\d*,\d[^,]*$")
# Rows beside which a header may stand.
BESIDE = 200


@dataclass(frozen=True, eq=False)
class Table:
    """Header rows and samples of one text.

    Attributes:
        dialect: of the samples.
        header: rows of cells above the samples, blank ones left out.
        raw: the same rows as they stand.
        beside: rows of cells that stand to the left of samples.
        columns: place of the column → (S,) numbers; NaN lost, ±inf over range.
        breaks: row of the first sample behind lines between the samples → these lines.
        notes: what was left out, in whole sentences.
        clocks: places of columns of times of day, which are seconds.
        odd: place of a column that is none of samples → line and text of its first cell that is no number.
    """

    dialect: Dialect
    header: list[list[str]]
    raw: list[str]
    beside: list[list[str]]
    columns: dict[int, np.ndarray]
    breaks: dict[int, list[str]]
    notes: tuple[str, ...] = ()
    clocks: frozenset[int] = frozenset()
    odd: dict[int, tuple[int, str]] = field(default_factory=dict)

    @property
    def places(self) -> list[int]:
        """Places of the columns with samples, in order."""
        return sorted(self.columns)

    def parts(self) -> list["Table"]:
        """The tables that follow each other in the text, each with the rows above it."""
        edges = [0, *sorted(self.breaks), len(next(iter(self.columns.values())))]
        found = []
        for k, (a, b) in enumerate(pairwise(edges)):
            part = replace(self, columns={p: v[a:b] for p, v in self.columns.items()}, breaks={})
            if k:
                rows = [(line, _header_cells(line, self.dialect)) for line in self.breaks[a]]
                part = replace(part, header=[c for _, c in rows], raw=[r for r, _ in rows], beside=[])
            found.append(part)
        return found


def whole(text: str) -> tuple[str, list[str]]:
    """A text without blank ends and without a last line that was cut off, and remarks.

    Where no line end follows the last line, and it has fewer cells than those before, or its last number
    fewer digits of the exponent, that number may be wrong by factors.
    """
    content = text.rstrip(" ;,\t\n")
    if text.endswith("\n") or content.count("\n") < 2 * BEGINNING:
        return content, []
    *lines, last = [line.strip() for line in content.rsplit("\n", 2 * BEGINNING)[1:]]
    shapes = {_shape(line) for line in lines}
    (marks, digits), cut = shapes.pop(), _shape(last)
    if shapes or (cut[0] >= marks and cut[1] >= digits) or not re.match(r"[-+.\d\",;|]", last):
        return content, []
    return content.rsplit("\n", 1)[0], [f"The last line ends in the middle ({last[:60]}): left out."]


def _shape(line):
    """Numbers in a line, and digits of the exponent that it ends with."""
    exponent = re.search(r"[eE][-+]?(\d*)\W*$", line)
    return len(re.findall(r"[-+.]?\d[.\d]*(?:[eE][-+]?\d*)?", line)), len(
        exponent.group(1)
    ) if exponent else 0


def split(text: str, path) -> Table:
    """Header and columns of a text.

    Raises:
        InputError: where no columns of numbers are found, or a row has more cells than the table columns.
    """
    samples = _without_footer(text)
    dialect = commas.settled(sniff(samples, path), samples, last_lines(samples), path)
    places = _places(samples, dialect, path)
    above, offset = _above(text, dialect, places, path)
    first = text[offset : offset + 200 * BESIDE].split("\n")[:BESIDE]
    start = _rows(first, dialect)
    header = [(raw, cells) for raw, cells in ((a, _header_cells(a, dialect)) for a in above) if any(cells)]
    places = _with_sparse(places, start, header[-1][1] if header else [], dialect)
    beside = [row[: places[0]] for row in start if any(row[: places[0]])]
    width = max(_width(start, places, samples, dialect), len(header[-1][1]) if header else 0)
    _refuse_commas(header, start, dialect, path)
    lines = text.count("\n", 0, offset)
    found = numbers.read(text[offset:], dialect, places, path, width, lines)
    odd = _odd(first, lines, found.columns, dialect)
    rows, raw = [c for _, c in header], [r for r, _ in header]
    return Table(dialect, rows, raw, beside, found.columns, found.breaks, found.notes, found.clocks, odd)


def _odd(lines, above, columns, dialect):
    """The first cells that are no numbers in the columns beside those of samples."""
    found = {}
    for number, line in enumerate(lines, above + 1):
        for k, cell in enumerate(dialect.cells(line)):
            if cell and k not in columns and not dialect.is_sample(cell):
                found.setdefault(k, (number, cell))
    return found


def _refuse_commas(header, rows, dialect, path):
    """Names for half the columns, and no decimal point in any: commas are decimal marks too."""
    if dialect != Dialect(",", ".") or not header:
        return
    names = [c for c in header[-1][1] if c]
    cells = [[c for c in row if c] for row in rows]
    wide = [len(row) for row in cells if len(row) > len(names)]
    named = len(names) > 1 and not any(map(dialect.is_number, names))
    if named and len(wide) > 0.5 * len(cells) and not any("." in c for row in cells for c in row):
        raise commas.both(path)


def _without_footer(text):
    """The text up to the last line that does not begin with a letter, where many such lines end it."""
    lines = text[-100_000:].split("\n")
    foot = next((k for k, x in enumerate(reversed(lines)) if x.strip() and not x.strip()[0].isalpha()), 0)
    return text[: len(text) - sum(len(x) + 1 for x in lines[-foot:])] if foot >= FOOTER else text


def _header_cells(line, dialect):
    """Cells of a header row, which may be cut by another mark where the samples stand in one column."""
    cells = dialect.cells(line)
    if dialect.decimal == "," and _VALUE.match(line) and len(cells) == 1:
        return cells
    mark = next((m for m in "\t;," if m in line), None)
    if dialect.delimiter is None and len(cells) > 1:
        if mark and is_key(line.split(mark)[0]):
            return Dialect(mark, dialect.decimal).cells(line)
        # Blanks also stand within keys and between a number and its unit.
        before = re.match(r"\W*([A-Za-z][^:=]*)[:=]", line)
        return [line.strip()] if before and is_key(before.group(1)) else keyed(line) or cells
    if len(cells) > 1:
        return cells
    return Dialect(mark, dialect.decimal).cells(line) if mark else keyed(line) or cells


def _rows(lines, dialect):
    return [dialect.cells(line) for line in lines if line.strip()]


def _numeric(row, dialect):
    return tuple(k for k, cell in enumerate(row) if dialect.is_sample(cell))


def _places(text, dialect, path):
    """Columns that hold samples in most of the last rows."""
    rows = _rows(text[-20_000:].split("\n")[-60:], dialect)
    if dialect.delimiter is None and sum(len(_numeric(r, dialect)) < len(r) for r in rows[-16:]) > 8:
        odd = next(" ".join(r) for r in rows[-16:] if len(_numeric(r, dialect)) < len(r))
        raise InputError(
            f"{path}: words stand between the numbers, as in {odd[:60]!r}; export the traces as a table of "
            "plain numbers"
        )
    seen = [p for p in (_numeric(r, dialect) for r in rows[-16:]) if p]
    if not seen:
        last = " ".join(rows[-1])[:60] if rows else ""
        raise InputError(
            f"{path}: the last lines hold no columns of numbers, as {last!r}; export the traces as a table"
        )
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
        elif any(cells):
            run = 0
        above.append(line)
        offset = end + 1
        if run >= BEGINNING:
            break
    if not run:
        raise InputError(f"{path}: no row of samples found; export the traces as a table")
    _refuse_broken(text[:begin].split("\n")[:-1], places, dialect, path)
    return text[:begin].split("\n")[:-1], begin


def _refuse_broken(above, places, dialect, path):
    """Refuse rows of samples above the first stretch of them: odd cells stand in many of them."""
    rows = [dialect.cells(line) for line in above]
    fit = [_fits(c, places, dialect) and not any(c[: places[0]]) for c in rows]
    first = fit.index(True) if any(fit) else len(rows)
    odd = next((k for k in range(first, len(rows)) if not fit[k] and any(rows[k])), None)
    if sum(fit) > 2 * BEGINNING and odd is not None:
        raise InputError(
            f"{path}: line {odd + 1} ({above[odd].strip()[:60]!r}) is no row of numbers, and others like it "
            "stand between the samples; export the traces as a table of plain numbers"
        )


def _fits(cells, places, dialect):
    """Whether a row has a sample or nothing in each column of samples, and at least one number.

    A text before the first such column is a header's key only where that column is the first of all.
    """
    held = [cells[k] for k in places if k < len(cells)]
    return (
        len(held) >= 1
        and not (places[0] == 1 and is_key(cells[0]))
        and all(not c or dialect.is_sample(c) or dialect.is_one_group(c) for c in held)
        and any(dialect.is_number(c) for c in held)
        and len(held) >= min(len(places), 2)
    )


def _with_sparse(places, rows, names, dialect):
    """Also columns that have a name and seldom a number, as of a slower channel, or as of its times, which
    may stand before all others, in a row of names for every column.
    """
    found = set(places)
    named = len(names) > places[-1] and all(names[: places[-1] + 1])
    for k, name in enumerate(names):
        held = [r[k] for r in rows if k < len(r) and r[k]]
        fewest = 2 if k > places[0] else BEGINNING
        if name and (named or k > places[0]) and len(held) >= fewest and all(map(dialect.is_number, held)):
            found.add(k)
    return sorted(found)


def _width(start, places, samples, dialect):
    """Cells that most rows have."""
    tail = _rows(samples[-5_000:].split("\n")[-20:], dialect)
    usual = Counter(map(len, (*start, *tail))).most_common(1)
    return max(usual[0][0] if usual else 0, places[-1] + 1)
