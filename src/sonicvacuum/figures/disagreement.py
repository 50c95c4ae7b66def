"""Where the nominal model and the data disagree: by run, gauge and feature, or by measured quantity."""

from itertools import pairwise

import numpy as np

from sonicvacuum.figures.colours import BAND, BLUE, GREY, ORANGE
from sonicvacuum.figures.drawing import (
    DOUBLE,
    INK,
    SINGLE,
    Curve,
    Dots,
    Drawing,
    Stroke,
    Text,
    rectangle,
    width_of,
)
from sonicvacuum.figures.frame import Frame, Scale, legend

# Scores beyond this are drawn in the full colour.
LIMIT = 10.0
# ColorBrewer's PuOr (Brewer, Hatchard & Harrower, Cartogr. Geogr. Inf. Sci. 30, 5, 2003), orange to violet.
_SHADES = "7f3b08b35806e08214fdb863fee0b6f7f7f7d8daebb2abd28073ac5427882d004b"
_COLOURS = np.frombuffer(bytes.fromhex(_SHADES), dtype=np.uint8).reshape(-1, 3).astype(float)
_WIDE, _HIGH = 9.0, 6.0  # of a cell, mm


def shade_of(score: float) -> str:
    """Colour of a score: orange below zero, violet above."""
    place = (np.clip(score / LIMIT, -1.0, 1.0) + 1.0) * 0.5 * (len(_COLOURS) - 1)
    parts = (np.interp(place, range(len(_COLOURS)), channel) for channel in _COLOURS.T)
    return "#" + "".join(f"{round(float(part)):02x}" for part in parts)


def where(cells: list[dict[str, str]]) -> Drawing | None:
    """Map of scores: features down, runs and gauges across; None without traces."""
    cells = [c for c in cells if c["sensor"]]
    if not cells:
        return None
    places = list(dict.fromkeys((c["run"], c["sensor"]) for c in cells))
    features = list(dict.fromkeys(c["feature"] for c in cells))
    wide = min(DOUBLE - 46.0, _WIDE * len(places))
    room = 6.0 + max(width_of(f"{r} {s}", 7.5) for r, s in places)
    high = max(_HIGH * len(features), 30.0)  # the least that the label of the colours needs
    box = (22.0, room, wide, high)
    page = Drawing(wide + 46.0, room + high + 3.0)
    frame = Frame(page, box, Scale(-0.5, len(places) - 0.5), Scale(len(features) - 0.5, -0.5))
    for c in cells:
        at = (places.index((c["run"], c["sensor"])), features.index(c["feature"]))
        _cell(page, frame, at, float(c["z_before"]), len(places) <= 16)
    frame.left(ticks=[])
    frame.bottom(ticks=[])
    for name, (x, y) in zip(features, frame.place(-0.5, np.arange(len(features))), strict=True):
        page.add(Text(x - 1.5, y, name, 7.5, anchor="right", level="middle"))
    for (run, sensor), (x, y) in zip(
        places, frame.place(np.arange(len(places)), len(features) - 0.5), strict=True
    ):
        page.add(Text(x + 1.0, y - 2.0, f"{run} {sensor}", 7.5, anchor="right", level="middle", turned=60.0))
    _key(page, (wide + 26.0, room, 3.0, high))
    return page


def _cell(page, frame, at, score, numbered):
    """One score, white where there is none; told where it is large and cells are not too many."""
    if np.isnan(score):
        return
    ((left, top), (right, bottom)) = frame.place([at[0] - 0.5, at[0] + 0.5], [at[1] - 0.5, at[1] + 0.5])
    # Neighbours overlap by a hair, so that no seam shows between them.
    page.add(Curve(rectangle(left, bottom, right - left + 0.08, top - bottom + 0.08), fill=shade_of(score)))
    if abs(score) >= 3.0 and numbered:
        ink = "#ffffff" if abs(score) > 7.0 else INK
        middle = (0.5 * (left + right), 0.5 * (top + bottom))
        told = f"{score:.0f}".replace("-", "−")
        page.add(Text(*middle, told, 6.0, ink, anchor="centre", level="middle"))


def _key(page, box):
    """The colours of the scores, pointed at the ends, beyond which nothing changes."""
    left, bottom, wide, high = box
    tip, right = 2.0, left + wide
    frame = Frame(page, (left, bottom + tip, wide, high - 2.0 * tip), Scale(0.0, 1.0), Scale(-LIMIT, LIMIT))
    edges = np.linspace(-LIMIT, LIMIT, 81)
    for low, high_ in pairwise(edges):
        frame.band(low, high_ + (0.05 if high_ < LIMIT else 0.0), shade_of(0.5 * (low + high_)))
    for score, foot, point in ((-LIMIT, bottom + tip, bottom), (LIMIT, bottom + high - tip, bottom + high)):
        corners = np.array([(left, foot), (left + 0.5 * wide, point), (right, foot)])
        page.add(Curve(corners, fill=shade_of(score)))
    for value, text in frame.y.ticks(max(2, min(9, high / 6.0))):
        ((_, y),) = frame.place(0.0, value)
        page.add(Curve(np.array([(right, y), (right + 1.0, y)]), Stroke()))
        page.add(Text(right + 2.0, y, text, 7.5, level="middle"))
    middle = bottom + 0.5 * high
    words = "score z of the residual"
    page.add(Text(right + 14.0, middle, words, anchor="centre", turned=90.0, level="middle"))


def scalars(cells: list[dict[str, str]], quantities: list[dict[str, str]] = ()) -> Drawing | None:
    """Score of each measured quantity before (open) and after (filled); None without any.

    `quantities` are the rows of quantities.csv, in the same order, which know the gauges: without them two
    amplitudes of one run look alike.
    """
    cells = [c for c in cells if not c["sensor"]]
    if not cells:
        return None
    labels = [f"{c['run']}, {c['feature'].replace('_', ' ')}" for c in cells]
    if len(quantities) == len(cells):
        labels = [f"{q['run']}, {q['quantity'].replace('-', '–')}" for q in quantities]
    left = min(56.0, 4.0 + max(width_of(label, 6.5) for label in labels))
    page = Drawing(SINGLE, 16.0 + 4.5 * len(cells))
    rank = np.arange(len(cells))
    before, after = ([float(c[key]) for c in cells] for key in ("z_before", "z_after"))
    across = Scale(min(-3.0, 1.1 * min(before + after)), max(3.0, 1.1 * max(before + after)))
    box = (left, 10.0, SINGLE - left - 4.0, 4.5 * len(cells))
    frame = Frame(page, box, across, Scale(len(cells) - 0.3, -0.7))
    frame.band(-2.0, 2.0, BAND, upright=True)
    for k, ends in enumerate(zip(before, after, strict=True)):
        frame.curve(ends, (k, k), Stroke(GREY, 0.6))
    looks = (("#ffffff", 4.0, Stroke(ORANGE, 1.0)), (BLUE, 2.5, Stroke(BLUE, 0.6)))
    for values, (fill, size, edge) in zip((before, after), looks, strict=True):
        frame.dots(values, rank, size, fill, edge)
    for label, (_, y) in zip(labels, frame.place(0.0, rank), strict=True):
        page.add(Text(left - 1.5, y, label, 6.5, anchor="right", level="middle"))
    frame.left(ticks=[])
    frame.bottom("score z of the residual")
    known = [Dots(np.empty((0, 2)), size * 0.35, fill, edge) for fill, size, edge in looks]
    words = ("nominal", "extended")
    legend(page, SINGLE - 4.0, page.height - 3.0, list(zip(known, words, strict=True)), 7.5)
    return page
