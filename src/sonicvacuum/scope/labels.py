"""The rows of a header that name the columns and their units, and what one label says."""

import re
from dataclasses import dataclass

from sonicvacuum.scope.dialect import Dialect
from sonicvacuum.scope.keys import MARKER, is_key, meaning
from sonicvacuum.scope.table import Table
from sonicvacuum.scope.units import Unit, quantity, unit_of

TIME = re.compile(
    r"(time|zeit|temps|tiempo|tempo|tid|tijd|czas|timestamp|elapsed.*|x[-_ ]?axis|x[-_ ]?values?|x|t|in|"
    r"seconds?|sec|time[ _].*|.*[ _]time|时间|時間)", re.IGNORECASE
)  # fmt: skip
COUNTER = re.compile(
    r"(sequence|(sample|scan)s?([ _-]?(no|nr|number|#))?\.?|nr|no|index|idx|#|points?|n|i)\.?", re.I
)
COUNTS = re.compile(r"(sequence|samples?|index|points?|#|no\.?)", re.IGNORECASE)
# The mark of a comment, before a word or a bracket: alone it may be a name or a unit.
_COMMENT = re.compile(r"^[#%]+\s*(?=[\w(\[<{\"])")
# Rows above the samples in which names and units are looked for.
LOOKED_AT = 6
# Symbols of units that are as likely the letter of a channel.
_LETTERS = re.compile("[ACFHJKTWgm]")
_UNIT_AT_END = (
    re.compile(r"(.*?)\s*\(([^()]*(?:\([^()]*\))?[^()]*)\)\s*$"),
    re.compile(r"(.*?)\s*\[([^\[\]]*)\]\s*$"),
    re.compile(r"(.*?)\s*<([^<>]*)>\s*$"),
    re.compile(r"(.*?)\s*\{([^{}]*)\}\s*$"),
    re.compile(r"(.*?)\s*\bin\s+(\S+)\s*$"),
    # Behind a lower dash a single letter is a name, but for those that time, volts and newtons mostly bear.
    re.compile(r"(.*\w)(?:,\s*|_(?=[sVN]$|\S\S))(\S+)\s*$"),
    re.compile(r"(a|acc\w*?)_(g)$", re.IGNORECASE),
    re.compile(r"(.*?)\s*/\s*(\S+)\s*$"),
    re.compile(r"(CH\d+)(V|mV|A)\s*$"),
)
# Marks that stand in front of a unit as well as of anything else; a blank and a point before those of times.
_BEHIND = re.compile(r"(.*?\S)(\s*[:|]\s*|\s+-\s+|\s+|\.)(\S+)\s*$")
_SYMBOL = re.compile("(?:[numkM]|\u00b5|\u03bc)(?:V|N|Pa|Hz)")
_NUMBERED = re.compile(r"[ _.-]?(\d+|(?<=[ _.-])[a-z])$", re.IGNORECASE)
# What else stands in brackets behind a time: of what kind it is, since when it counts, and whose it is.
_REMARK = re.compile(
    r"rel\.?|relativ(e|es)?|abs\.?|absolut(e)?|elapsed|local|utc.*|gmt.*|ce?s?t|(since|from|after|seit|ab)\b.*"
    r"|h+:m+.*|x|(x.?)?axis|trigger.*|start.*|.*\b(time|zeit)\b.*|[^\W\d_]+[ _.-]?\d+|(?-i:[A-Z])|[\W\d]*",
    re.IGNORECASE,
)
# Counts of samples or of the ticks of a clock.
TICKS = re.compile(r"(samples?|ticks?|pts|points?|counts?|cycles|scans?|index|idx|n)\.?", re.IGNORECASE)
# Kinds of numbers, which programs write below the names.
_KIND = re.compile(r"(double|float|single|real|u?int(eger)?|number|string|date ?time|bool)\d*", re.IGNORECASE)
_BRACKETS = re.compile(r".*[(\[<]([^()\[\]<>]+)[)\]>]\s*$")
# A unit in brackets before the words that tell a run or a channel, as in `Time (ms) Run #1`, `F [kN] - Ch1`;
# what stands there instead of words may be a factor.
_REMARKED = re.compile(r"(.*\w)\s*[(\[]([^()\[\]]+)[)\]]\s*([-:|,]?\s*(?!x\s*\d|e[-+]?\d)(?:[^\W\d]|#).*)$")
# Times as programs call them, with the unit as the last part of one word.
_TIME_IN_WORD = re.compile(r"(time(?:stamp)?|elapsed|zeit|t)(ms|msec|us|µs|usec|ns|nsec|sec)", re.IGNORECASE)


def split_unit(label: str) -> tuple[str, Unit | None]:
    """A column's label as name and unit: `CH1 (V)`, `Time [ms]`, `C1 in V`, `F/N`."""
    label = label.strip().lstrip("#%").strip().strip('"').rstrip(":").rstrip()
    for form in _UNIT_AT_END:
        found = form.match(label)
        unit = unit_of(found.group(2)) if found else None
        if unit:
            return found.group(1).strip(), unit
    name, unit = _behind(label)
    if unit:
        return name, unit
    # Times may be counted in so many seconds; with other units that may as well be a range.
    found = _BRACKETS.match(label)
    words = found.group(1).split() if found else []
    if (
        len(words) > 1
        and _is_time_word(label[: found.start(1) - 1])
        and _REMARK.fullmatch(" ".join(words[1:]))
    ):
        unit = unit_of(words[0])
        if unit and unit.base == "s":
            return label[: found.start(1) - 1].strip(), unit
    scaled = quantity(found.group(1)) if found else None
    if scaled and scaled[1] and scaled[1].base == "s" and scaled[0] > 0.0:
        return label[: found.start(1) - 1].strip(), Unit("s", scaled[0] * scaled[1].factor)
    return _within(label)


def _within(label):
    """Name and unit where a remark follows the unit, or where name and unit of a time are one word."""
    found = _REMARKED.match(label)
    unit = unit_of(found.group(2)) if found else None
    if unit:
        return f"{found.group(1)} {found.group(3)}", unit
    found = _TIME_IN_WORD.fullmatch(label)
    return (found.group(1), unit_of(found.group(2).lower())) if found else (label, None)


def _behind(label):
    """Name and unit parted by a mark that may part anything, as in `Time: us`, `CH1 - mV`, `Time us`."""
    found = _BEHIND.match(label)
    unit = unit_of(found.group(3)) if found else None
    if not unit:
        return label, None
    name, mark, text = found.groups()
    if unit.base == "s":
        sure = _is_time_word(name) and (text != "min" or bool(mark.strip(" .")))
    else:
        sure = (
            bool(_SYMBOL.fullmatch(text))
            if not mark.strip()
            else mark != "." and not _LETTERS.fullmatch(text)
        )
    return (name.strip(), unit) if sure else (label, None)


def _is_time_word(name):
    return bool(TIME.fullmatch(_NUMBERED.sub("", name.strip())))


def unknown_time_unit(label: str) -> str:
    """What stands where the unit of a time would and is none that is known, "" where nothing does."""
    label = label.strip().strip('"')
    within, found = _REMARKED.match(label), re.search(r"[(\[<{]([^()\[\]<>{}]+)[)\]>}]\s*$", label)
    if found or within:
        text = (found.group(1) if found else within.group(2)).strip()
        words = text.split()
        unit = next((u for u in map(unit_of, (words or [""])[:: max(1, len(words) - 1)]) if u), None)
        if len(words) > 1 and not (unit and unit.base == "s") and not words[0][0].isdigit():
            return ""
    else:
        # Behind other marks a name is as likely, as in `Time - Force`.
        found = re.match(r".*?\S(?:\s*[:|]\s*|\s+-\s+)(\S+)$", label)
        text = found.group(1) if found else ""
        if not re.fullmatch(r".{0,2}s|\w*se[ck]\w*\.?", text, re.IGNORECASE) and not TICKS.fullmatch(text):
            return ""
    return "" if "?" not in text and _REMARK.fullmatch(text) else text


def unknown_unit(label: str) -> str:
    """What stands in brackets where a unit would, "" where it is none by its form: one word, or a scaled one.

    `(bead 5)` is a remark; `(counts)`, `(% FS)` and `(1E-3 V)` are units that are not read here.
    """
    found = _BRACKETS.match(label.strip().strip('"'))
    words = found.group(1).split() if found else []
    scaled = len(words) > 1 and (unit_of(words[-1]) or words[0].startswith("%"))
    one = len(words) == 1 and re.search(r"[^\W\d_]|%", words[0])
    return found.group(1).strip() if scaled or one else ""


@dataclass(frozen=True)
class Labels:
    """What the header says of the columns.

    Attributes:
        names, units: row of names and row of units by place of the column, empty where there is none.
        rest: the other rows of the header, which may hold keys.
        width: cells in a row of samples.
    """

    names: list[str]
    units: list[str]
    rest: list[list[str]]
    width: int

    def name(self, k: int) -> str:
        """Label of the column at a place, "" where there is none."""
        return _at(self.names, k)

    def unit(self, k: int) -> str:
        """What the row of units holds at a place."""
        return _at(self.units, k)

    def stray(self, k: int) -> str:
        """A unit that another row of the header holds at a place, or units of a row of no known places."""
        rows = [row for row in self.rest if not is_key(row[0])]
        held = [row[k] for row in rows if len(row) == self.width]
        held += [", ".join(filter(None, row)) for row in rows if len(row) != self.width and _all_units(row)]
        return next((c for c in held if all(map(unit_of, c.split(", "))) and not _LETTERS.fullmatch(c)), "")


def _all_units(row):
    units = [unit_of(c) for c in row if c]
    return None not in units and any(u.base != "s" for u in units)


def labels(table: Table) -> Labels:
    """Names and units of the columns, from the last rows above the samples."""
    last = len(table.header) - 1
    found = {k: _row(table, k) for k in range(last, max(-1, last - LOOKED_AT), -1)}
    wide = {k: cells for k, cells in found.items() if cells is not None}
    at = next((k for k, cells in wide.items() if _are_units(cells, table)), None)
    at = _unit_of_time(wide, table) if at is None else at
    names = _names_at(wide, at, last, table)
    if names is None and at is not None and _only_letters(wide[at], table):
        names, at = at, None
    used = {k for k in (names, at) if k is not None}
    rows = [row for k, row in enumerate(table.header) if k not in used]
    if names is not None and at is not None:
        rows += _extra(wide[names], wide[at], table)
    taken = [wide[k] for k in used]
    rows += [[c] for row in taken for c in row if re.match(r"\w[\w ]*\s*=", c)]
    return Labels(wide.get(names, []), wide.get(at, []), rows, table.places[-1] + 1)


def alone(table: Table, place: int) -> Unit | None:
    """The unit of time above one column: in a label that stands by itself, or in a row that begins `Unit`."""
    for row in table.header[-LOOKED_AT:]:
        # The key stands above the first column, or before the table.
        before = len(row) == table.places[-1] + 2
        below = unit_of(_at(row, place + before)) if place + before and meaning(row[0]) == "unit" else None
        if below and below.base == "s":
            return below
        cell = _COMMENT.sub("", _at(row, place))
        name, unit = ("time", unit_of(cell)) if _says_time(cell) else split_unit(cell)
        single = sum(map(bool, row)) == 1 and TIME.fullmatch(name) and not is_key(name)
        if single and unit and unit.base == "s":
            return unit
    return None


def _says_time(cell):
    """Whether a cell is a unit of time and hardly anything else."""
    unit = unit_of(cell)
    return unit is not None and unit.base == "s" and cell.strip("()[]<> ").lower() != "min"


def _unit_of_time(wide, table):
    """The row of units of which that of time alone is known, beside a row that names a time without one."""
    for k, cells in wide.items():
        for place in table.places if any(map(_says_time, cells)) else ():
            near = [_at(wide.get(j), place) for j in (k - 1, k + 1)]
            if _says_time(_at(cells, place)) and any(TIME.fullmatch(n) and not unit_of(n) for n in near):
                return k
    return None


def _names_at(wide, units, last, table):
    """Which of the wide rows holds the names: beside that of units, else one that names a time or units."""
    others = {k: cells for k, cells in wide.items() if not _are_units(cells, table)}
    if units is not None:
        near = [k for k in (units - 1, units + 1) if k in others]
        return next((k for k in near if _begins_with_time(others[k], table)), near[0] if near else None)
    told = [k for k, c in others.items() if _tells(c, table)]
    return told[0] if told else last if last in others else None


def _tells(cells, table):
    """Whether labels differ and name a time in front, or units."""
    held = [_at(cells, p) for p in table.places]
    differ = len(set(held)) == len(held) > 1
    return differ and (_begins_with_time(cells, table) or any(split_unit(c)[1] for c in held))


def _begins_with_time(cells, table):
    name = split_unit(_at(cells, table.places[0]))[0]
    return bool(TIME.fullmatch(name) or COUNTER.fullmatch(name))


def _only_letters(cells, table):
    held = [c for c in (_at(cells, k) for k in table.places) if c]
    return all(_LETTERS.fullmatch(c) for c in held)


def _row(table, k):
    """Header row k cut so that it has a word above most columns of samples; None where it has not."""
    held = [c for c in table.header[k] if c]
    if all(map(MARKER.fullmatch, held)) or all(map(_KIND.fullmatch, held[1:] or held)):
        return None
    if _is_setting(table.header[k]) or not any(re.search(r"\w", c) for c in table.header[k]):
        return None
    return next((cells for cells in _cuts(table, k) if _are_names(cells, table)), None)


def _is_setting(cells):
    """Whether a row is a key and its values: words of one that has words, or what begins with digits."""
    rest = [c for c in cells[1:] if c]
    if rest and re.fullmatch(r"\w[\w ]*=", cells[0]) and not rest[0].endswith("="):
        return True
    worded = meaning(cells[0]) in ("name", "unit", "time unit")
    return bool(rest) and is_key(cells[0]) and (worded or any(re.match(r"[-+.]?\d", c) for c in rest))


def _are_names(cells, table):
    """Whether cells can be names or units: words above most columns, or numbers of channels beside times."""
    held = [_at(cells, p) for p in table.places]
    words = [c for c in held if c and not table.dialect.is_number(c)]
    numbers = [c for c in held if table.dialect.is_number(c)]
    # Values behind keys, dates and times of day, and marks alone name no column.
    if any(re.search(r"[:=]\s*[-+.\d]|^\d+([-/.:]\d+){2}|^[:=,;]", c) for c in words):
        return False
    if numbers:
        whole = all(c.isdigit() for c in numbers) and not table.dialect.is_number(held[0])
        # Beside a time the same number may stand twice, as for the least and the most of a channel.
        return whole and (_begins_with_time(cells, table) or len(set(numbers)) == len(held) - 1)
    return len(words) >= max(1, len(held) // 2) and _wide(cells, table)


def _wide(cells, table):
    """A key with its value is no row of names, unless there are just as many columns."""
    words = [c for c in cells if c]
    return not (len(words) == 1 and (len(table.places) > 1 or re.search(r"[:=]", words[0])))


def _cuts(table, k):
    """The row as the samples are cut, or where it is cut by other marks than these, by those."""
    first, *rest = table.header[k]
    cells, raw = [_COMMENT.sub("", first), *rest], table.raw[k].strip().lstrip("#%").strip()
    width = table.places[-1] + 1
    blanks = table.dialect.delimiter is None
    yield cells if (len(cells) == width if blanks else len(cells) >= width) else []
    for mark in ("\t", ";", ","):
        other = Dialect(mark, table.dialect.decimal).cells(raw)
        if len(other) == width and mark != table.dialect.decimal:
            yield other
    if not blanks and table.dialect.delimiter in raw:
        # Names of the first columns only; blanks stand within them.
        if 1 < len(cells) < width and k == len(table.header) - 1 and split_unit(cells[0])[1]:
            yield cells + [""] * (width - len(cells))
        return
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
    plain = [bool(unit_of(c) or COUNTS.fullmatch(c)) for c in held if re.search(r"\w", c)]
    # Beside a unit of time and another one, what is no unit is one that is not known.
    time = unit_of(held[0]) if len(held) > 2 else None
    partly = time is not None and time.base == "s" and sum(plain) > 1 and len(held[0]) > 1
    return bool(plain) and (all(plain) or partly)


def _extra(names, units, table):
    """Keys in the row of names with their value in the row of units, as Rigol's Start and Increment."""
    return [
        [name, units[k]]
        for k, name in enumerate(names)
        if k not in table.columns and k < len(units) and table.dialect.is_number(units[k])
    ]
