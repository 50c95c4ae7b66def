"""Names, units and roles of the columns: which is time, which counts samples, which hold a channel."""

import re
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.scope.dialect import Dialect
from sonicvacuum.scope.table import Table
from sonicvacuum.scope.units import Unit, unit_of

_TIME = re.compile(
    r"(time|zeit|temps|tiempo|tempo|tid|tijd|czas|timestamp|elapsed.*|x[-_ ]?axis|x[-_ ]?values?|x|t|in|"
    r"seconds?|sec|time[ _].*|.*[ _]time|时间|時間)", re.IGNORECASE
)  # fmt: skip
_COUNTER = re.compile(
    r"(sequence|samples?|sample[ _-]?(no|nr|number)\.?|nr|no|index|idx|#|points?|n|i)\.?", re.I
)
_COUNTS = re.compile(r"(sequence|samples?|index|points?|#|no\.?)", re.IGNORECASE)
# Rows above samples that only say where these begin.
_MARKER = re.compile(
    r"\W*((waveform|measured|raw) )?(data|values|daten|messwerte)\W*|\*+end.*", re.IGNORECASE
)
# Words that name a kind of quantity, not a channel.
_GENERIC = re.compile(r"(volts?|voltage|value|ampl(itude)?|data|y|level|signal|spannung)", re.IGNORECASE)
_UNIT_AT_END = (
    re.compile(r"(.*?)\s*\(([^()]*(?:\([^()]*\))?[^()]*)\)\s*$"),
    re.compile(r"(.*?)\s*\[([^\[\]]*)\]\s*$"),
    re.compile(r"(.*?)\s*<([^<>]*)>\s*$"),
    re.compile(r"(.*?)\s*\bin\s+(\S+)\s*$"),
    re.compile(r"(.*?)\s*/\s*(\S+)\s*$"),
    re.compile(r"(CH\d+)(V|mV|A)\s*$"),
    re.compile(r"(.*\w)[_,]\s*(\S+)\s*$"),
)
# Steps of a column of times may differ from the usual by the rounding of what is printed.
_UNEVEN = 1.5


@dataclass(frozen=True)
class Column:
    """One column of samples.

    Attributes:
        place: its place in the rows.
        role: `time`, `counter` or `value`.
        name: "" where the header is silent.
        unit: as written in the header of the column, None where there is none.
    """

    place: int
    role: str
    name: str
    unit: Unit | None


def columns(table: Table) -> tuple[list[Column], list[list[str]]]:
    """The columns with samples and the header rows that are no names or units of columns."""
    names, units, used = _labels(table)
    found = []
    for k in table.places:
        name, unit = split_unit(_at(names, k))
        below = _at(units, k) if units else ""
        found.append((k, name, unit_of(below) or unit or _word(name), below))
    rows = [row for j, row in enumerate(table.header) if j not in used]
    if names and units:
        rows += _extra(names, units, table)
    rows += [[c] for row in (names, units) if row for c in row if re.match(r"\w[\w ]*\s*=", c)]
    return _roles(found, table), rows


def split_unit(label: str) -> tuple[str, Unit | None]:
    """A column's label as name and unit: `CH1 (V)`, `Time [ms]`, `C1 in V`, `F/N`."""
    label = label.strip().lstrip("#%").strip().strip('"')
    for form in _UNIT_AT_END:
        found = form.match(label)
        unit = unit_of(found.group(2)) if found else None
        if unit:
            return found.group(1).strip(), unit
    return label, None


def _word(name):
    """The unit that a name such as `Second` or `Volt` is; single letters are names of channels."""
    return unit_of(name) if len(name) > 2 else None


def _labels(table):
    """Row of names, row of units (None where there is none), and their places in the header."""
    last = len(table.header) - 1
    bottom = _row(table, last)
    if bottom is None:
        return [], None, set()
    if not _are_units(bottom, table):
        return bottom, None, {last}
    above = _row(table, last - 1)
    if above is None or _are_units(above, table):
        return bottom, None, {last}
    return above, bottom, {last, last - 1}


def _row(table, k):
    """Header row k cut so that it has a word above most columns of samples; None where it has not."""
    if k < 0:
        return None
    if all(_MARKER.fullmatch(c) for c in table.header[k] if c):
        return None
    for cells in _cuts(table, k):
        held = [_at(cells, p) for p in table.places]
        words = [c for c in held if c and not table.dialect.is_number(c)]
        numbers = [c for c in held[1:] if table.dialect.is_number(c) and not c.isdigit()]
        values = [c for c in words if re.search(r"[:=]\s*[-+.\d]", c)]
        if len(words) >= max(1, len(held) // 2) and not numbers and not values and _wide(cells, table):
            return cells
    return None


def _wide(cells, table):
    """A key with its value is no row of names, unless there are just as many columns."""
    words = [c for c in cells if c]
    return not (len(words) == 1 and (len(table.places) > 1 or re.search(r"[:=]", words[0])))


def _cuts(table, k):
    """The row as the samples are cut, or where it is cut by other marks than these, by those."""
    cells, raw = table.header[k], table.raw[k].strip().lstrip("#%").strip()
    width = table.places[-1] + 1
    blanks = table.dialect.delimiter is None
    yield cells if (len(cells) == width if blanks else len(cells) >= width) else []
    for mark in ("\t", ";", ","):
        other = Dialect(mark, table.dialect.decimal).cells(raw)
        if len(other) == width:
            yield other
    joined = re.findall(r"[^\s(\[]+(?:\s*[(\[][^)\]]*[)\]])?", raw)
    for parts in (re.split(r"\s{2,}", raw), joined, raw.split()):
        if len(parts) == width:
            yield parts
    if len(table.places) == 1 and cells and len(cells) == 1:
        yield ["" for _ in range(table.places[0])] + cells


def _at(row, k):
    return row[k] if row and k < len(row) else ""


def _are_units(row, table):
    held = [_at(row, k) for k in table.places]
    plain = [bool(unit_of(c) or _COUNTS.fullmatch(c)) for c in held if re.search(r"\w", c)]
    return bool(plain) and all(plain)


def _extra(names, units, table):
    """Keys in the row of names with their value in the row of units, as Rigol's Start and Increment."""
    return [
        [name, units[k]]
        for k, name in enumerate(names)
        if k not in table.columns and k < len(units) and table.dialect.is_number(units[k])
    ]


def _roles(found, table):
    """Columns with their roles, from names and units first, from the numbers where there are none."""
    result = []
    for k, name, unit, below in found:
        role = "value"
        if _COUNTS.fullmatch(below or "") or (_COUNTER.fullmatch(name) and counts(table.columns[k])):
            role = "counter"
        elif _is_time(name, unit, k == found[0][0]):
            role = "time"
        result.append(Column(k, role, name, unit))
    if len(result) > 1 and all(c.role == "value" for c in result):
        return _by_numbers(result, table)
    first = result[0]
    if first.role == "value" and not first.name and counts(table.columns[first.place]):
        result[0] = replace(first, role="counter")
    return result


def _by_numbers(found, table):
    """Without names: an evenly rising first column is time, and so is each with the same steps further on."""
    first = table.columns[found[0].place]
    if not even(first):
        return found
    steps = np.diff(first)
    same = {
        c.place
        for c in found[:-1]
        if np.allclose(np.diff(table.columns[c.place]), steps, rtol=1e-3, atol=0.0, equal_nan=False)
    }
    return [replace(c, role="time") if c.place in same | {found[0].place} else c for c in found]


def _is_time(name, unit, first):
    if unit is not None and unit.base == "s":
        return first or bool(_TIME.fullmatch(name))
    return unit is None and bool(_TIME.fullmatch(name)) and (first or not re.fullmatch("t|in", name, re.I))


def counts(values: np.ndarray) -> bool:
    """Whether numbers count samples: whole, from 0 or 1, by one each."""
    return len(values) > 1 and values[0] in (0.0, 1.0) and bool(np.all(np.diff(values) == 1.0))


def even(values: np.ndarray) -> bool:
    """Whether numbers rise (but for rounding) evenly, over each stretch between falls."""
    if len(values) < 3 or not np.isfinite(values).all():
        return False
    steps = np.diff(values)
    usual = float(np.median(steps[steps > 0.0])) if (steps > 0.0).any() else 0.0
    if usual <= 0.0 or (steps < 0.0).mean() > 0.1:
        return False
    rising = steps[steps >= 0.0]
    return bool(abs(rising.mean() / usual - 1.0) < 0.5 and (rising > _UNEVEN * 2.0 * usual).mean() < 0.01)


def channel_names(found: list[Column], given: list[str]) -> list[str]:
    """Names of the channels: those of the columns, where these say nothing the header's, else CH1, CH2 …"""
    own = [c.name for c in found if c.role == "value"]
    telling = [n for n in own if n and not _GENERIC.fullmatch(n)]
    if len(set(telling)) == len(own):
        return own
    given = given[-len(own) :] if len(given) == len(own) + 1 else given
    if len(given) == len(own) and len(set(given)) == len(given):
        return given
    if len(own) > 1 and all(own) and len(set(own)) == len(own):
        return own
    return unique([n if n in telling else f"CH{k + 1}" for k, n in enumerate(own)])


def unique(names: list[str]) -> list[str]:
    """Names with a number behind those that stand there more than once."""
    return [n if names.count(n) == 1 else f"{n} {names[: k + 1].count(n)}" for k, n in enumerate(names)]
