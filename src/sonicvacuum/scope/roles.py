"""Names, units and roles of the columns: which is time, which counts samples, which hold a channel."""

import re
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.scope.labels import (
    COUNTER,
    COUNTS,
    TICKS,
    TIME,
    alone,
    labels,
    split_unit,
    unknown_time_unit,
    unknown_unit,
)
from sonicvacuum.scope.table import Table
from sonicvacuum.scope.units import Unit, spelled, unit_of

# Words that name a kind of quantity, not a channel.
_GENERIC = re.compile(r"(volts?|voltage|value|ampl(itude)?|data|y|level|signal|spannung)", re.IGNORECASE)
# Quantities that traces are told over, besides time: steps of these are no steps of time.
_OTHER = re.compile(
    r"freq(uency|uenz)?\.?|position|pos|dist(ance)?|displ(acement)?|deflection|stroke|weg|angle|winkel|phase"
    r"|strain|dehnung|volt(s|age)?|spannung|current|strom|force|kraft|load|temp(erature|eratur)?",
    re.IGNORECASE,
)
# What is said of times in a line of words.
_REMARK = re.compile(r"\b(?:times?|zeit(?:en)?|t)\b(?:\s+\w+)?\s+in\s+(\S+)", re.IGNORECASE)
# Names of times that as often name a coordinate or an input.
_VAGUE = re.compile("t|x|in", re.IGNORECASE)
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
        said: what the header holds in place of a unit, where that is none that is known.
    """

    place: int
    role: str
    name: str
    unit: Unit | None
    said: str = ""


def columns(table: Table) -> tuple[list[Column], list[list[str]]]:
    """The columns with samples and the header rows that are no names or units of columns."""
    said, found = labels(table), []
    for k in table.places:
        name, unit = split_unit(said.name(k))
        below = said.unit(k)
        unit = unit_of(below) or unit or spelled(name) or alone(table, k)
        if unit is None and k == table.places[0] and TIME.fullmatch(name):
            unit = _remarked(table)
        odd = "" if unit else unknown_unit(said.name(k)) or _unread(below) or said.stray(k)
        found.append((Column(k, "value", name, unit, odd), below))
    others = [column.name for column, _ in found]
    return [_timed(c, said.name(c.place), table, others) for c in _roles(found, table)], said.rest


def _remarked(table):
    """The unit of time of which a line of words above the table speaks, `times in ms`; None without one."""
    found = [m.group(1).strip(".,;:)]") for line in table.raw for m in _REMARK.finditer(line)]
    units = {unit for unit in map(unit_of, found) if unit and unit.base == "s" and unit.factor <= 1.0}
    return units.pop() if len(units) == 1 else None


def _timed(column, label, table, names):
    """A column of times with what its label holds in place of a unit, or a counter where that is samples."""
    if column.role == "time" and column.place in table.clocks:
        return replace(column, unit=Unit("s"), said="")
    if column.role != "time" or column.unit is not None:
        return column
    said = unknown_time_unit(label)
    whole = re.compile(rf"(?<![^\W_]){re.escape(said)}(?![^\W_])", re.IGNORECASE)
    if not said or any(whole.search(name) for name in names if name != column.name):
        # Nothing, or the name of the channel that the times are of.
        return replace(column, said="")
    counting = TICKS.fullmatch(said) and (np.diff(table.columns[column.place]) == 1.0).all()
    return replace(column, role="counter" if counting else "time", said=said)


def _unread(text):
    """What stands in the row of units and is none that is known."""
    return text.strip("()[] ") if re.search(r"\w", text) and not COUNTS.fullmatch(text) else ""


def _roles(found, table):
    """Columns with their roles, from names and units first, from the numbers where there are none."""
    result, first = [], found[0][0]
    for column, below in found:
        role = "value"
        unnamed = not column.name and column.unit is None and column is first and len(found) > 1
        counting = COUNTER.fullmatch(column.name) or unnamed
        if COUNTS.fullmatch(below) or (counting and counts(table.columns[column.place])):
            role = "counter"
        elif _is_time(column.name, column.unit, column is first):
            role = "time"
        result.append(replace(column, role=role))
    if len(result) > 1 and all(c.role == "value" for c in result):
        result = _by_numbers(result, table)
    return _with_twins(result, table)


def _with_twins(found, table):
    """Also times further on that are called otherwise: columns before values that rise evenly.

    They are in a unit of time, or labelled as the first time but for a number or a letter: `t1,F1,t2,F2`; or
    they stand beside times of another number of rows, as those of a faster rate do.
    """
    result, first = list(found), next((c for c in found if c.role == "time"), None)
    for k, column in enumerate(found[:-1]):
        timed = column.unit is not None and column.unit.base == "s"
        named = first and (are_twins(first.name, column.name) or first.name == column.name != "")
        alike = named and column.unit == first.unit
        # What stands beside times or behind counts alone is no trace of them, but may be the first times.
        apart = k > 1 or (k == 1 and found[0].role == "counter" and first is None)
        before = found[k + 1].role == "value" and (first is None or result[k - 1].role == "value")
        faster = timed and k and result[k - 1].role == "time" and _ends_apart(column, found[k - 1], table)
        wanted = column.role == "value" and (((timed or alike) and apart and before) or faster)
        if wanted and _rises(table.columns[column.place]):
            result[k] = replace(column, role="time")
            first = first or result[k]
    return result


def _ends_apart(one, other, table):
    return ends(table.columns[one.place]) != ends(table.columns[other.place])


def _rises(values):
    """Whether numbers rise evenly to their end; times of a shorter trace end before the others."""
    return bool(ends(values)) and even(values[: ends(values)])


def ends(values: np.ndarray) -> int:
    """Rows up to the last number of a column, 0 where it has none."""
    held = np.flatnonzero(np.isfinite(values))
    return int(held[-1]) + 1 if len(held) else 0


def are_twins(one: str, other: str) -> bool:
    """Whether two labels differ by nothing but one number or single letter, as `t1`, `t2` or `x`, `x.1`."""
    parts = [re.findall(r"\d+|[^\W\d_]+", name.lower()) for name in (one, other)]
    if len(parts[1]) == len(parts[0]) + 1:
        parts[0].append("0")
    if len(parts[0]) != len(parts[1]):
        return False
    differ = [pair for pair in zip(*parts, strict=True) if pair[0] != pair[1]]
    return len(differ) == 1 and all(p.isdigit() or len(p) == 1 for p in differ[0])


def _by_numbers(found, table):
    """Without names: an evenly rising first column is time, and so is each with the same steps further on.

    A first column with another unit, or called another quantity, is none.
    """
    first = table.columns[found[0].place]
    called = re.split(r"\s*[(\[]", found[0].name)[0]
    other = found[0].unit is not None or _OTHER.fullmatch(called)
    if (other and not TIME.fullmatch(called)) or not even(first):
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
        return first or bool(TIME.fullmatch(name) or unit_of(name) == unit)
    return unit is None and bool(TIME.fullmatch(name)) and (first or not _VAGUE.fullmatch(name))


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
    if len(given) == len(own) + 1 and TIME.fullmatch(split_unit(given[0])[0]):
        given = given[1:]
    if len(given) == len(own) and len(set(given)) == len(given):
        return given
    if len(own) > 1 and all(own) and len(set(own)) == len(own):
        return own
    return unique([n if n in telling else f"CH{k + 1}" for k, n in enumerate(own)])


def unique(names: list[str]) -> list[str]:
    """Names with a number behind those that stand there more than once."""
    return [n if names.count(n) == 1 else f"{n} {names[: k + 1].count(n)}" for k, n in enumerate(names)]
