"""Axes of a drawing: scales with their ticks, and a frame with curves, bands and dots at data values.

Lengths in mm, sizes of letters in points, as in `style`.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.figures.drawing import (
    INK,
    LEADING,
    POINT,
    Box,
    Curve,
    Dots,
    Drawing,
    Stroke,
    Text,
    rectangle,
    stretches,
    width_of,
)

LABEL, TICK_LABEL = 8.0, 7.5  # sizes of letters
TICK, PAD = 3.5 * POINT, 3.5 * POINT  # length of a tick, room before its label
# A curve of more points than this is drawn by the least and the largest of each stretch.
COLUMNS = 1200
_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0, 20.0, 25.0, 50.0, 100.0)
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Scale:
    """Values from `low` to `high` along an axis, logarithmic or not; about one alone, where both are that."""

    low: float
    high: float
    log: bool = False

    def __post_init__(self):
        if self.low == self.high:
            low, high = _about(self.low, self.log)
            object.__setattr__(self, "low", low)
            object.__setattr__(self, "high", high)

    @classmethod
    def over(cls, values, room: float = 0.05, log: bool = False) -> "Scale":
        """All values, with a share of their range beyond either end."""
        known = np.asarray(values, dtype=float)
        known = known[np.isfinite(known) & ((known > 0.0) | (not log))]
        low, high = (float(known.min()), float(known.max())) if len(known) else (1.0, 10.0)
        if low == high:
            return cls(low, high, log)
        if log:
            more = (high / low) ** room
            return cls(low / more, high * more, True)
        more = room * (high - low)
        return cls(low - more, high + more)

    def at(self, values) -> np.ndarray:
        """Where values (any shape) lie, 0 at the low end and 1 at the high one; of the same shape."""
        low, high = (math.log(self.low), math.log(self.high)) if self.log else (self.low, self.high)
        with np.errstate(divide="ignore", invalid="ignore"):
            values = np.log(values) if self.log else np.asarray(values, dtype=float)
        return (values - low) / (high - low)

    def ticks(self, most: float) -> list[tuple[float, str]]:
        """Round values and how they are written, no more than `most` (but two where the axis has them)."""
        found = self._decades(most) if self.log else []
        return found if len(found) > 1 else self._even(max(2, int(most)))

    def _even(self, most):
        power = 10.0 ** math.floor(math.log10(abs(self.high - self.low) / most))
        steps = (s * power for s in _STEPS)
        step, values = next((s, v) for s in steps if len(v := self._multiples(s)) <= most)
        size = max((abs(v) for v in values), default=1.0)
        power = math.floor(math.log10(size) + 1e-9) if size else 0
        if -4 < power < 5:
            power = 0
        step, unit = step / 10.0**power, "·10" + str(power).translate(_RAISED) if power else ""
        digits = next(d for d in range(20) if abs(round(step, d) - step) < 1e-6 * step)
        return [(v, _signed(f"{v / 10.0**power:.{digits}f}") + (unit if v else "")) for v in values]

    def _multiples(self, step):
        low, high = sorted((self.low, self.high))
        return [step * k for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]

    def _decades(self, most):
        first, last = math.ceil(math.log10(self.low) - 1e-9), math.floor(math.log10(self.high) + 1e-9)
        every = max(1, math.ceil((last - first + 1) / most))
        return [(10.0**k, _power(k)) for k in range(first, last + 1, every)]


def _about(value, log):
    """Ends of an axis on which one value alone stands."""
    if log:
        return value / 2.0, value * 2.0
    more = 0.05 * abs(value) or 1.0
    return value - more, value + more


def _signed(text):
    return text.replace("-", "−") if float(text) else text.replace("-", "")


def _power(k):
    return {0: "1", 1: "10", -1: "0.1", 2: "100"}.get(k, "10" + str(k).translate(_RAISED))


@dataclass(frozen=True)
class Frame:
    """A panel of a drawing at `box`, with its two scales."""

    drawing: Drawing
    box: Box
    x: Scale
    y: Scale

    def place(self, x, y) -> np.ndarray:
        """(n, 2) places of data values."""
        left, bottom, wide, high = self.box
        return np.column_stack(
            np.broadcast_arrays(left + wide * self.x.at(x), bottom + high * self.y.at(y))
        ).astype(float)

    def curve(self, x, y, stroke: Stroke) -> None:
        """A line through data values, cut off at the frame."""
        x, y = thinned(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        self.drawing.add(Curve(self.place(x, y), stroke, clip=self.box))

    def dots(self, x, y, size: float, fill: str, edge: Stroke | None = None) -> None:
        """Discs of a diameter in points at data values; those with an edge may stand on the frame."""
        x, y = thinned(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        self.drawing.add(Dots(self.place(x, y), size * POINT, fill, edge, None if edge else self.box))

    def cross(self, x: float, y: float, size: float, stroke: Stroke) -> None:
        """A cross of so many points at a data value."""
        ((left, bottom),) = self.place([x], [y]) - 0.5 * size * POINT
        corners = left + np.array([0.0, 1.0]) * size * POINT, bottom + np.array([0.0, 1.0]) * size * POINT
        for heights in (corners[1], corners[1][::-1]):
            self.drawing.add(Curve(np.column_stack([corners[0], heights]), stroke))

    def fill(self, x, low, high, color: str, opacity: float = 1.0) -> None:
        """The area between two lines over x, interrupted where one is not a number."""
        x, low, high = (np.asarray(a, dtype=float) for a in np.broadcast_arrays(x, low, high))
        for part in stretches(np.isfinite(low) & np.isfinite(high)):
            there, back = self.place(x[part], high[part]), self.place(x[part], low[part])[::-1]
            self.drawing.add(Curve(np.concatenate([there, back]), fill=color, opacity=opacity, clip=self.box))

    def band(self, low: float, high: float, color: str, upright: bool = False) -> None:
        """Values between two, over the whole frame: of y, or of x where the band stands upright."""
        left, bottom, wide, tall = self.box
        if upright:
            (begin, end) = left + wide * np.clip(self.x.at([low, high]), 0.0, 1.0)
            corners = rectangle(begin, bottom, end - begin, tall)
        else:
            (begin, end) = bottom + tall * np.clip(self.y.at([low, high]), 0.0, 1.0)
            corners = rectangle(left, begin, wide, end - begin)
        self.drawing.add(Curve(corners, fill=color))

    def level(self, y: float, stroke: Stroke) -> None:
        """A line across the frame."""
        left, bottom, wide, high = self.box
        at = bottom + high * float(self.y.at(y))
        self.drawing.add(Curve(np.array([(left, at), (left + wide, at)]), stroke, clip=self.box))

    def note(self, x: float, y: float, text: str, **look) -> None:
        """Words at a share of the frame's width and height."""
        left, bottom, wide, high = self.box
        self.drawing.add(Text(left + x * wide, bottom + y * high, text, **look))

    def bottom(self, label: str = "", ticks=None, numbers: bool = True, size=TICK_LABEL, color=INK) -> None:
        """The axis below with ticks (value, text), its own where none are given, and its label."""
        left, bottom, wide, _ = self.box
        ticks = self._across() if ticks is None else ticks
        at = left + wide * self.x.at([value for value, _ in ticks])
        self.drawing.add(Curve(np.array([(left, bottom), (left + wide, bottom)]), Stroke()))
        for x, (_, text) in zip(at, ticks, strict=True):
            self.drawing.add(Curve(np.array([(x, bottom), (x, bottom - TICK)]), Stroke()))
            if numbers:
                self.drawing.add(Text(x, bottom - TICK - PAD, text, size, anchor="centre", level="top"))
        lines = max((text.count("\n") + 1 for _, text in ticks), default=0) if numbers else 0
        below = TICK + PAD + (LEADING * lines * size + 3.0) * POINT
        if label:
            at = (left + 0.5 * wide, bottom - below)
            self.drawing.add(Text(*at, label, LABEL, color, anchor="centre", level="top"))

    def _across(self):
        """Ticks of the axis below, as many as have room for their texts."""
        wide = self.box[2]
        for most in range(max(2, min(9, int(wide / 6.0))), 1, -1):
            ticks = self.x.ticks(most)
            room = wide * np.diff(np.sort(self.x.at([v for v, _ in ticks])))
            need = max((width_of(t, TICK_LABEL) for _, t in ticks), default=0.0) + 1.5
            if not len(room) or room.min() >= need:
                break
        return ticks

    def left(self, label: str = "", ticks=None, size: float = TICK_LABEL, label_size: float = LABEL) -> None:
        """The axis on the left with ticks (value, text), its own where none are given, and its label."""
        left, bottom, _, high = self.box
        ticks = self.y.ticks(max(3, min(7, high / 4.5))) if ticks is None else ticks
        at = bottom + high * self.y.at([value for value, _ in ticks])
        self.drawing.add(Curve(np.array([(left, bottom), (left, bottom + high)]), Stroke()))
        for y, (_, text) in zip(at, ticks, strict=True):
            self.drawing.add(Curve(np.array([(left, y), (left - TICK, y)]), Stroke()))
            self.drawing.add(Text(left - TICK - PAD, y, text, size, anchor="right", level="middle"))
        if label:
            wide = max((width_of(text, size) for _, text in ticks), default=0.0)
            x = left - TICK - PAD - wide - 4.0 * POINT
            middle = bottom + 0.5 * high
            self.drawing.add(Text(x, middle, label, label_size, anchor="centre", turned=90.0, level="bottom"))


def thinned(x: np.ndarray, y: np.ndarray, columns: int = COLUMNS) -> tuple[np.ndarray, np.ndarray]:
    """A curve by the least and the largest value of each of so many stretches, where it has many more points.

    On paper it looks the same, and a trace of a million samples stays a small drawing.
    """
    if len(x) <= 2 * columns:
        return x, y
    stretches = np.array_split(np.arange(len(x)), columns)
    kept = np.unique([s[k] for s in stretches for k in (y[s].argmin(), y[s].argmax())])
    return x[kept], y[kept]


def legend(drawing: Drawing, right: float, y: float, entries, size: float = 7.0) -> None:
    """A row of (stroke or dots, words) that ends at `right`, its middle at the height y in mm.

    A sample is a `Stroke`, or `Dots` whose places do not matter.
    """
    line = 16.0 * POINT
    x = right
    for sample, words in reversed(entries):
        x -= width_of(words, size)
        drawing.add(Text(x, y, words, size, level="middle"))
        x -= line + 4.0 * POINT
        if isinstance(sample, Stroke):
            drawing.add(Curve(np.array([(x, y), (x + line, y)]), sample))
        else:
            drawing.add(replace(sample, points=np.array([(x + 0.5 * line, y)]), clip=None))
        x -= 10.0 * POINT
