"""The traces of one run: a CSV file, header `time_us,<sensor ids>`, readings at equidistant times.

Each sensor's column is in the unit of its kind: N, m/s, m/s². A run may lack a sensor and have its own times.

A file is read whole by a fast parser; only where that fails is it gone through again row by row, to name the
line and the column at fault.
"""

import io
import math
import re
import warnings
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sonicvacuum.files import InputError, read_text, replacing
from sonicvacuum.laboratory.checks import TIME
from sonicvacuum.observe.trace import Trace

FEWEST = 16
# Times may be off the equidistant ones by this fraction of the interval, or by the rounding of the digits
# printed while that is below the second fraction (a missing row puts times off by half an interval or more).
EVEN = 0.01
ROUNDED = 0.4
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", re.ASCII)


@dataclass(frozen=True, eq=False)
class Signals:
    """The traces of one run, as recorded.

    Attributes:
        time_us: (S,) recorded time in microseconds: true time plus the run's trigger shift.
        readings: sensor id → (S,) change from rest in the sensor's unit, forces positive in compression,
            motions towards the wall. A sensor that this run lacks is not among them.
    """

    time_us: np.ndarray
    readings: dict[str, np.ndarray]

    @property
    def samples(self) -> int:
        """Number of samples."""
        return len(self.time_us)

    @cached_property
    def _line(self):
        return grid(self.time_us)

    @property
    def start_s(self) -> float:
        """Recorded time of the first sample in s, free of the rounding of printed times."""
        return self._line[0] / 1e6

    @property
    def interval_s(self) -> float:
        """Time between samples in s."""
        return self._line[1] / 1e6

    @cached_property
    def time_s(self) -> np.ndarray:
        """(S,) recorded time in s, exactly equidistant."""
        return self.start_s + self.interval_s * np.arange(self.samples)

    def trace(self, sensor: str, noise: float = 0.0) -> Trace:
        """One gauge's signal, as the search for pulses takes it; `noise` in its unit."""
        return Trace(self.start_s, self.interval_s, self.readings[sensor], noise)

    def equals(self, other: "Signals") -> bool:
        """Whether both hold the same numbers, bit for bit."""
        return (
            list(self.readings) == list(other.readings)
            and np.array_equal(self.time_us, other.time_us)
            and all(np.array_equal(r, other.readings[s]) for s, r in self.readings.items())
        )


def grid(time: np.ndarray) -> tuple[float, float]:
    """Start and interval of the equidistant times nearest to (S,) times, by least squares; in their unit."""
    place = np.arange(len(time)) - 0.5 * (len(time) - 1)
    interval = float(place @ (time - time.mean()) / (place @ place))
    return float(time.mean()) + interval * float(place[0]), interval


def read(path, sensors: list[str]) -> Signals:
    """The signals of one run.

    Args:
        path: of the CSV file.
        sensors: ids of the record's gauges; the header names those of this run, at least one, in any order.

    Raises:
        InputError: naming the file, the line, the column and the cure.
    """
    text = read_text(path).removeprefix("\ufeff")
    if not text or text.isspace():
        raise InputError(f"{path}: the file is empty; write the header {_header(sensors)} and the samples")
    stream = io.StringIO(text, newline=None)
    columns = _columns(path, stream.readline().splitlines()[0], sensors)
    values = _values(path, stream, text, columns)
    _check_time(path, values[:, columns.index(TIME)], text, columns.index(TIME))
    parts = {c: np.ascontiguousarray(values[:, k]) for k, c in enumerate(columns)}
    return Signals(parts.pop(TIME), parts)


def write(signals: Signals, path) -> None:
    """Write a CSV file that `read` returns bit for bit."""
    columns = [signals.time_us, *signals.readings.values()]
    rows = zip(*(np.asarray(c, dtype=float).tolist() for c in columns), strict=True)
    with replacing(path) as stream:
        stream.write(",".join((TIME, *signals.readings)) + "\n")
        stream.writelines(",".join(map(_text, row)) + "\n" for row in rows)


def _text(number):
    """Shortest text that reads back as the same number, without a trailing .0."""
    text = repr(number)
    return text.removesuffix(".0") if number else text


def _columns(path, head, sensors):
    for mark, name in ((";", "semicolons"), ("\t", "tabs")):
        if mark in head:
            raise InputError(
                f"{path}, line 1: columns are separated by {name}; separate them by commas and "
                "write numbers with a decimal point"
            )
    columns = [c.strip().strip('"') for c in head.split(",")]
    if _NUMBER.fullmatch(columns[0]):
        raise InputError(f"{path}, line 1: the header is missing; write {_header(sensors)} above the samples")
    for c in columns:
        if columns.count(c) > 1:
            raise InputError(f"{path}, line 1: column {c!r} stands here twice; remove one")
    _check_names(path, columns, sensors)
    return columns


def _check_names(path, columns, sensors):
    if TIME not in columns:
        near = next((c for c in columns if c.lower().startswith("time") or c.lower() == "t"), None)
        found = f"; {near!r} is there: convert it to microseconds and call it {TIME}" if near else ""
        raise InputError(f"{path}, line 1: column {TIME} is missing{found}; expected {_header(sensors)}")
    for c in columns:
        if c != TIME and c not in sensors:
            raise InputError(
                f"{path}, line 1: column {c!r} is no sensor of this record; expected {_header(sensors)}"
            )
    if len(columns) == 1:
        raise InputError(f"{path}, line 1: no sensor has a column; expected {_header(sensors)}")


def _header(sensors):
    return ",".join((TIME, *sensors))


def _rows(text):
    """(number, line) of the lines below the header that hold something: for messages, as it takes long."""
    return [(number, line) for number, line in enumerate(text.splitlines()[1:], start=2) if line.strip()]


def _values(path, stream, text, columns):
    """(S, columns) numbers below the header of a text, which stand in the rest of a stream."""
    values = _parsed(stream)
    if values is None or values.shape[1] != len(columns) or not np.isfinite(values).all():
        rows = _rows(text)
        for number, line in rows:
            _check_row(path, number, line, columns)
        values = _parsed(io.StringIO("\n".join(line for _, line in rows)))
    if len(values) < FEWEST:
        raise InputError(
            f"{path}: has {len(values)} samples; at least {FEWEST} are needed: is the file complete?"
        )
    return values


def _parsed(stream):
    """Numbers of a stream, None where a row is none of numbers, or has more or fewer than the first."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*no data")  # said below, with the cure
        try:
            return np.loadtxt(stream, delimiter=",", ndmin=2, comments=None)
        except ValueError:
            return None


def _check_row(path, number, line, columns):
    cells = line.split(",")
    if len(cells) < len(columns):
        raise InputError(
            f"{path}, line {number}: has {len(cells)} of {len(columns)} columns, so the row is cut short; "
            "complete or remove it"
        )
    if len(cells) > len(columns):
        raise InputError(
            f"{path}, line {number}: has {len(cells)} cells, the header {len(columns)}; "
            "write numbers with a decimal point, not a comma, and no further columns"
        )
    for name, cell in zip(columns, cells, strict=True):
        if not (_NUMBER.fullmatch(cell.strip()) and math.isfinite(float(cell))):
            raise InputError(f"{path}, line {number}, column {name}: {_fault(cell)}")


def _fault(cell):
    cell = cell.strip()
    if not cell:
        return "the cell is empty; give a number, or remove the row if it is at an end of the record"
    if not re.fullmatch(r"[-+]?(nan|inf|infinity|[\d.]+e[-+]?\d+)", cell.lower()):
        return f"is {cell[:40]!r}, not a number; write a plain number without unit"
    return f"is {cell}; every sample must be a finite number: cut the record where the reading is lost"


def _check_time(path, time, text, column):
    steps = np.diff(time)
    usual = float(np.median(steps))
    if not np.all(steps > 0.0):
        k = int(np.argmin(steps > 0.0))
        line, _ = _rows(text)[k + 1]
        raise InputError(
            f"{path}, line {line}, column {TIME}: is {time[k + 1]:g} after {time[k]:g}; times "
            "must increase: sort the rows, remove repeated ones, and give times enough digits"
        )
    start, interval = grid(time)
    off = np.abs(time - (start + interval * np.arange(len(time))))
    if off.max() <= EVEN * interval:
        return
    rows = _rows(text)
    allowed = max(EVEN * interval, min(_rounding(rows, column), ROUNDED * interval))
    if off.max() > allowed:
        # The first odd step, where the reader should look.
        k = int(np.argmax(np.abs(steps - usual) > min(2.0 * allowed, np.abs(steps - usual).max() * 0.999)))
        raise InputError(
            f"{path}, line {rows[k + 1][0]}, column {TIME}: the step to {time[k + 1]:g} us is {steps[k]:g} "
            f"us, the usual one {usual:g} us; times must be equidistant within {allowed / interval:.0%} of "
            "the step: interpolate to equal steps, restore missing rows, or print more digits"
        )


def _rounding(rows, column):
    """A unit of the last digit printed, in us: half of it, and as much for the line; 0 with exponents."""
    cells = [line.split(",")[column].strip().lower() for _, line in rows]
    if any("e" in c for c in cells):
        return 0.0
    return 10.0 ** -max(len(c.partition(".")[2]) for c in cells)
