"""The shots within one table or several that follow each other, and the header of each.

A table whose header names other channels than the one before holds these of the same shots; one that names
the same channels, or none, holds the next shots.
"""

import re
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum.scope import keys as header_keys
from sonicvacuum.scope import roles
from sonicvacuum.scope.keys import Keys
from sonicvacuum.scope.labels import TIME, split_unit
from sonicvacuum.scope.roles import Column
from sonicvacuum.scope.table import Table

# Said where lines between samples do not end a shot.
ON = "A table whose times go on where those before it end belongs to the same shot."
# Steps between samples above this multiple of the usual one part shots, which have at least so many samples.
GAP, FEWEST = 100.0, 8
# A line that names the channel of the table below it, and nothing else.
_CHANNEL = re.compile(
    r"\W*((?:channel|chan|ch|kanal|voie|canal|trace|math|ref)[ _-]?\w{1,2})\W*", re.IGNORECASE
)


@dataclass(frozen=True, eq=False)
class Shot:
    """One shot's columns with what the header says of them.

    Attributes:
        number: of the shot, from 1; several: whether there are others.
        columns: place → samples.
        found, keys: roles of the columns and keys of the header.
        notes: how the shot was found, in whole sentences.
    """

    number: int
    several: bool
    columns: dict[int, np.ndarray]
    found: list[Column]
    keys: Keys
    notes: tuple[str, ...]


def shots(table: Table, companion: list[str], path) -> list[Shot]:
    """The shots in a text, in order; InputError where a further header does not fit its columns."""
    found, keys = _header(table, [line.split(",") for line in companion])
    result, seen, begin = [], set(), 0
    parts = table.parts()
    for k, (part, title) in enumerate(zip(parts, _titles(parts, found), strict=True)):
        own, said = (found, keys) if k == 0 else _further(part, found, keys, path)
        if title:
            own = [c if c.role != "value" else replace(c, name="") for c in own]
            said = replace(said, values=said.values | {"name": [title]}, rows=said.rows | {"name": []})
        names = set(_names(own, said))
        if not names or names & seen:
            seen, begin = set(), max((s[0] for s in result), default=0)
        seen |= names
        pieces, notes = _pieces(part, own, said)
        if k and _goes_on(result[-1], pieces[0], own):
            number, columns, *rest, before = result.pop()
            pieces[0] = {p: np.concatenate([columns[p], v]) for p, v in pieces[0].items()}
            result.append((number, pieces.pop(0), *rest, (*before, *notes, ON)))
            begin = number
        result += [(begin + j + 1, columns, own, said, notes) for j, columns in enumerate(pieces)]
    several = max(number for number, *_ in result) > 1
    return [Shot(number, several, *rest) for number, *rest in result]


def _titles(parts, found):
    """The channel that a line of its own names above each of several tables of one channel; "" where these
    lines are lacking, or all alike.
    """
    named = [_title(part) for part in parts] if sum(c.role == "value" for c in found) == 1 else []
    return named if all(named) and len(set(named)) > 1 else [""] * len(parts)


def _title(part):
    rows = ([c for c in row if c.strip()] for row in reversed(part.header))
    alone = (_CHANNEL.fullmatch(row[0]) for row in rows if len(row) == 1)
    return next((m.group(1) for m in alone if m), "")


def _goes_on(last, columns, found):
    """Whether times go on behind other lines, one step further on, in columns of the same roles and units."""
    _, before, own, *_ = last
    clock = next((c for c in found if c.role == "time"), None)
    alike = [(c.place, c.role, c.unit) for c in found] == [(c.place, c.role, c.unit) for c in own]
    if clock is None or not alike:
        return False
    first, times = before[clock.place], columns[clock.place]
    step = float(np.median(np.diff(first)))
    return bool(step > 0.0 and 0.5 * step < times[0] - first[-1] < 1.5 * step)


def _names(found, keys):
    """What tells the channels of one header from those of another, () where it names none."""
    names = roles.channel_names(found, keys.texts("name"))
    return names if any(c.name for c in found if c.role == "value") or keys.texts("name") else ()


def _header(table, more=()):
    found, rows = roles.columns(table)
    channels = sum(c.role == "value" for c in found)
    width = table.places[-1] + 1
    return found, header_keys.read([*table.beside, *rows, *more], table.dialect, channels, width)


def _further(part, found, keys, path):
    """Roles and keys of a table behind another, whose header counts where its own is silent."""
    own, said = _header(part)
    said = said.beside(keys)
    # Rows of names have as many cells as there are columns, and name the time where the first table does.
    full = any(sum(map(bool, row)) == len(found) or _names_all(row, part) for row in part.header)
    timed = not (found[0].name and found[0].role == "time") or own[0].unit or TIME.fullmatch(own[0].name)
    if not full and any(_names_time(row) for row in part.header):
        raise _other(part, path)
    if not full or not timed:
        return found, said
    if [c.role for c in own] != [c.role for c in found]:
        raise _other(part, path)
    return own, said


def _names_all(row, part):
    """Whether a row names a time and every column, maybe with more names behind, as of remarks."""
    return _names_time(row) and all(k < len(row) and row[k] for k in part.places)


def _names_time(row):
    """Whether a row names a time and something beside it."""
    filled = [c for c in row if c]
    return (
        len(filled) > 1
        and bool(TIME.fullmatch(split_unit(row[0])[0]))
        and not any(c[0].isdigit() for c in filled)
    )


def _other(part, path):
    return InputError(
        f"{path}: a further table begins with {part.raw[-1].strip()[:60]!r}, whose columns are not those of "
        "the first; give each table a file of its own"
    )


def _pieces(part: Table, found, keys):
    """The columns of each shot of one table, cut where its time starts again or leaps, and remarks."""
    rows = len(next(iter(part.columns.values())))
    clock = next((c for c in found if c.role in ("time", "counter")), None)
    cuts, notes = np.zeros(0, dtype=int), []
    if clock is not None:
        times = part.columns[clock.place]
        steps = np.diff(times)
        again, leaps = _restarts(times, steps), _leaps(steps)
        cuts = np.union1d(again, leaps)
        if len(leaps):
            notes.append(
                f"Time leaps by {np.nanmax(steps):.4g}, more than {GAP:g} times the usual step: cut into "
                "shots there."
            )
    else:
        # A vague word, as `Points`, may count anything.
        count = None if "count" in keys.vague else keys.number("count", "")
        if count and count >= FEWEST and rows > count and rows % count == 0 and count == int(count):
            cuts = np.arange(int(count), rows, int(count))
            notes.append(f"Cut into shots of {count:g} samples, as the header announces.")
    edges = [0, *cuts.tolist(), rows]
    if len(edges) > 2 and np.median(np.diff(edges)) < FEWEST:
        edges, notes = [0, rows], []
    pieces = [(a, b) for a, b in pairwise(edges) if b - a > 1 or len(edges) == 2]
    left = rows - sum(b - a for a, b in pieces)
    if left:
        notes.append(f"{left} rows that stand alone in time are no shot: left out.")
    return [{p: v[a:b] for p, v in part.columns.items()} for a, b in pieces], tuple(notes)


def _restarts(times, steps):
    """Rows in which time starts again; none where it only falls a little, as in rows of wrong order."""
    again = np.flatnonzero(steps < 0.0) + 1
    spans = [np.nanmax(times[a:b]) - np.nanmin(times[a:b]) for a, b in pairwise([0, *again.tolist()])]
    return again if (-steps[again - 1] >= 0.5 * np.array(spans)).all() else again[:0]


def _leaps(steps):
    """Rows before which time leaps, where it rises evenly else."""
    rising = steps[steps > 0.0]
    if len(rising) < FEWEST:
        return np.zeros(0, dtype=int)
    leaps = np.flatnonzero(steps > GAP * np.median(rising)) + 1
    return leaps if len(leaps) < len(steps) / FEWEST else leaps[:0]
