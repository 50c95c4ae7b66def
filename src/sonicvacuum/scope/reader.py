"""One file to its channels: text → dialect → table → roles of the columns → time base and units."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum.scope import roles, text
from sonicvacuum.scope.binary import ENVELOPE, is_binary, read_binary
from sonicvacuum.scope.dialect import is_like_number
from sonicvacuum.scope.labels import TIME, split_unit
from sonicvacuum.scope.layouts import Layout, recognise
from sonicvacuum.scope.matlab import is_matlab, read_matlab
from sonicvacuum.scope.recording import Channel, Recording
from sonicvacuum.scope.shots import Shot, shots
from sonicvacuum.scope.table import split, whole
from sonicvacuum.scope.timebase import TimeBase, from_column, from_header
from sonicvacuum.scope.units import quantity, unit_of

_HEAD = 20_000
# A channel's mark in the name of a file that holds one channel.
_MARK = re.compile(r"(?:^|[-_. ])((?:CH|C|F|M|R|REF|MATH)\d)(?=$|[-_. ]|Trace)", re.IGNORECASE)
# Recorders write numbers of this size for a sample beyond the range (Agilent and others: 9.91e37).
OVERFLOW = 9.0e36
# Letters that hardly stand in a label of times of Latin-1: other alphabets, in encodings of their own.
_FOREIGN = re.compile(r"[^\x00-\x7f\xb5]")
# More columns of fewer samples than this are rows of a table that lies on its side.
MOST_BESIDE = 16


def read(path) -> Recording:
    """The channels of a recorder's file.

    Raises:
        InputError: for a file that cannot be read, with the reason.
    """
    path = Path(path)
    if path.is_dir():
        raise InputError(f"{path}: is a folder; give the files in it, as in {path}/*.csv")
    if not path.is_file():
        raise InputError(f"{path}: no such file; give files as the recorder wrote them")
    if is_matlab(path):
        return read_matlab(path)
    if is_binary(path):
        return read_binary(path)
    content, encoding = text.read(path)
    layout = recognise(content[:_HEAD], path)
    content, cut = whole(content)
    table = split(content, path)
    channels, said = [], [] if encoding.startswith("utf-8") else [f"Text is {encoding}."]
    for shot in shots(table, layout.companion(path) if layout.companion else [], path):
        said += [n for n in shot.notes if n not in said]
        found = [_legible(c) for c in shot.found] if encoding == "latin-1" else shot.found
        channels += _channels(replace(shot, found=found), layout, path, _why(table))
    if not channels:
        odd = next((_told(table, k) for k in sorted(table.odd)), "")
        if odd:
            raise InputError(f"{path}: has times but no channel beside them: {odd}; export plain numbers")
        raise InputError(f"{path}: has times but no channel beside them; export the traces too")
    if len(channels) > MOST_BESIDE > max(c.samples for c in channels):
        raise InputError(
            f"{path}: holds {len(channels)} columns of {max(c.samples for c in channels)} numbers, as where "
            "each trace is a row; export each trace as a column"
        )
    return Recording(path, layout.name, tuple(channels), (*said, *cut, *table.notes))


def _legible(column):
    """Times without a unit that is read, whose label is of another encoding: what it says is not known."""
    odd = column.role == "time" and column.unit is None and not column.said and _FOREIGN.search(column.name)
    return replace(column, said=column.name) if odd else column


def _why(table):
    """Why a table has no times, where it has no column of them."""
    names = next((row for row in reversed(table.header) if len(row) > table.places[0]), [])
    for k in sorted(table.odd):
        if k < len(names) and TIME.fullmatch(split_unit(names[k])[0]):
            return f"the column of times is not read: {_told(table, k)}"
    first = split_unit(names[table.places[0]])[0] if names else ""
    if first and roles.even(table.columns[table.places[0]]) and not TIME.fullmatch(first):
        return f"the first column, {first!r}, is no time, and the header gives no interval"
    return "the file has no times and no interval"


def _told(table, k):
    line, cell = table.odd[k]
    mark = f" (decimals elsewhere follow a {table.dialect.decimal!r})" if is_like_number(cell) else ""
    return f"line {line}, column {k + 1}: {cell[:40]!r} is no number{mark}"


def _channels(shot: Shot, layout: Layout, path, why):
    found, keys, columns = shot.found, shot.keys, shot.columns
    names = _names(found, keys, path)
    values = [c.place for c in found if c.role == "value"]
    # Times stand before their channels; where none do, the first further on counts for all.
    clocks = [c for c in found if c.role == "time"][:1] if values and found[0].place == values[0] else []
    place, beside = 0, False
    for column in found:
        if column.role == "value":
            values, kept = _held(columns[column.place])
            if len(values) < 2:
                place += 1
                continue
            base = _base(_clock(clocks, column, columns), column, columns, kept, keys, place, why)
            channel = _channel(names[place], column, values, base, keys, layout, place, shot.several)
            if shot.several:
                channel = replace(channel, segment=shot.number)
            yield channel
            place += 1
        elif not clocks or column.role == "time":
            clocks = [*clocks, column] if beside else [column]
        beside = column.role == "time"


def _clock(clocks, column, columns):
    """Of times side by side, as recorders with several rates write them, those that end first of all that
    last as long as the channel; the last where none does, or several are alike. None without any.
    """
    rows = roles.ends(columns[column.place])
    long = [c for c in reversed(clocks) if roles.ends(columns[c.place]) >= rows]
    return min(long, key=lambda c: roles.ends(columns[c.place]), default=clocks[-1] if clocks else None)


def _held(values):
    """Samples of a channel without empty cells at its ends or in a regular pattern, and their rows."""
    lost = np.isnan(values)
    if not lost.any():
        return values, slice(None)
    held = np.flatnonzero(~lost)
    if not len(held):
        return values[:0], slice(0)
    if lost.mean() > 0.4 and len(held) > 2 and np.ptp(np.diff(held)) == 0:
        return values[held], held
    rows = slice(int(held[0]), int(held[-1]) + 1)
    return values[rows], rows


def _base(clock, column, columns, kept, keys, place, why) -> TimeBase:
    if clock is None:
        return _shifted(from_header(keys, place, column.place, why), kept)
    times = columns[clock.place]
    if clock.role == "counter" or (
        clock.unit is None and roles.counts(times) and keys.values.get("interval")
    ):
        return _shifted(from_header(keys, place, column.place, why), kept)
    return from_column(times[kept], clock.unit, keys, place, column.place, clock.said)


def _shifted(base, kept):
    """The time base from the first sample that a channel has."""
    first = kept.start or 0 if isinstance(kept, slice) else int(kept[0])
    step = 1 if isinstance(kept, slice) else int(kept[1] - kept[0])
    if base.interval_s is None or (first == 0 and step == 1):
        return base
    return TimeBase(base.start_s + first * base.interval_s, step * base.interval_s, base.notes)


def _channel(name, column, values, base, keys, layout, place, several):
    notes = list(base.notes)
    if layout.readings:
        values, said = layout.readings(values, keys, place)
        notes += [said] if said else []
    unit, factor = _unit(column, keys, layout, place, notes)
    values = np.where(np.abs(values) > OVERFLOW, np.copysign(np.inf, values), values) * factor
    told = keys.text("factor", place, column.place)
    if (number := quantity(told)) and number[0] != 1.0:
        notes.append(f"The header's factor, {told}, counts as in the numbers already; if not, give --scale.")
    if keys.text("format", place, column.place).upper().startswith("ENV"):
        notes.append(ENVELOPE)
    count = keys.number("count", "", place, column.place)
    if count and not several and abs(count - len(values)) > 1:
        notes.append(f"The header announces {count:g} samples, the file holds {len(values)}.")
    if not np.isfinite(values).all():
        over, lost = int(np.isinf(values).sum()), int(np.isnan(values).sum())
        notes.append(f"{over} samples over range and {lost} lost, of {len(values)}.")
    return Channel(name, unit, values, base.start_s, base.interval_s, tuple(notes), 1, base.times_s)


def _unit(column, keys, layout, place, notes):
    """Base unit and factor of a channel: the column's label, else the header's word, else the layout's."""
    said = keys.text("unit", place, column.place)
    header = unit_of(said)
    if header and header.base == "s":  # of the times beside it
        said, header = "", None
    if column.said and not header:
        known = all(map(unit_of, column.said.split(", ")))
        told = f"That the unit is {column.said}" if known else f"The unit {column.said}"
        notes.append(f"{told} is not known; numbers are as written.")
        return column.said, 1.0
    if column.unit:
        if header and header != column.unit:
            notes.append(f"The header's unit is {said}, that of the column counts: {column.unit.base}.")
        return column.unit.base, column.unit.factor
    if header:
        return header.base, header.factor
    if said:
        notes.append(f"The unit {said} is not known; numbers are as written.")
        return said, 1.0
    notes.append(f"No unit given; {layout.unit} assumed." if layout.unit else "No unit given.")
    return layout.unit, 1.0


def _names(found, keys, path):
    names = roles.channel_names(found, keys.texts("name"))
    mark = _MARK.search(Path(path).stem)
    if names == ["CH1"] and len(keys.texts("name")) != 1 and mark:
        return [mark.group(1).upper()]
    return names
