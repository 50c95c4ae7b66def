"""One run as a drawing: contact forces over place and time, below them the gauges' readings on the same axis.

The map is a grey picture with one row for each recorded contact, the root of the force over its largest as
darkness; the rows that a gauge reads are marked. The script of the page tells force and readings under the
cursor and lights up the reading of the gauge whose rows it is on.
"""

import base64
from io import BytesIO

import numpy as np
from markupsafe import Markup, escape
from PIL import Image

from sonicvacuum.figures.colours import GREY
from sonicvacuum.gauges import contacts_of
from sonicvacuum.report.interactive import Line, Panel, scales
from sonicvacuum.simulation import Simulation

# Sizes in the units of the drawing.
WIDTH, LEFT, RIGHT, TOP = 720.0, 70.0, 712.0, 6.0
_MAP, _TRACE, _GAP, _AXIS = 120.0, 46.0, 6.0, 30.0
# Pixels of the map along time; deviation of a thinned line, in units of the drawing.
_PIXELS, _DEVIATION = 321, 0.12
_COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#8C6D1F")


def drawing(simulation: Simulation, lane: int, name: str) -> dict[str, str]:
    """`svg`, `scales` of one run; ids begin with `name`."""
    time_us, force = 1e6 * simulation.time, simulation.force[:, :, lane]
    last = float(time_us[-1])
    gauges, readings = simulation.sensors, simulation.readings()
    bottom = TOP + _MAP
    parts = [_picture(force), *_marks(simulation, bottom)]
    space = Panel(
        (LEFT, TOP, RIGHT, bottom),
        (0.0, last, False),
        (0.0, 1.0, False),
        "µs",
        "N",
        map=_map(simulation, force),
    )
    panels = [space]
    for k, gauge in enumerate(gauges):
        top = bottom + _GAP + k * (_TRACE + _GAP)
        reading = readings[gauge.id][:, lane]
        low, high = min(0.0, float(reading.min())), max(1e-9, float(reading.max()))
        box = (LEFT, top, RIGHT, top + _TRACE)
        points = _points(time_us / last, (reading - low) / (high - low), box)
        color, own = _COLORS[k % len(_COLORS)], f"{name}-{gauge.id}"
        parts.append(_frame(box, f"{gauge.id}, {high:.3g} {gauge.unit}"))
        parts.append(f'<polyline id="{escape(own)}" class="trace" stroke="{color}" points="{points}"/>')
        line = Line(own, gauge.id, rows=_rows(simulation, gauge))
        panels.append(Panel(box, space.x, (low, high, False), "µs", gauge.unit, (line,)))
    end = bottom + len(gauges) * (_TRACE + _GAP)
    parts += _axis(last, end)
    told = f'role="img" aria-label="Space-time map and gauges of {escape(name)}"'
    head = f'<svg viewBox="0 0 {WIDTH:g} {end + _AXIS:g}" {told}>'
    return {"svg": Markup("\n".join([head, *parts, "</svg>"])), "scales": scales(panels)}


def _rows(simulation, gauge):
    """Rows of the map that a gauge reads."""
    felt = contacts_of(gauge, simulation.card.beads) or ((gauge.bead - 1, gauge.bead) if gauge.bead else ())
    return tuple(k for k, contact in enumerate(simulation.contacts) if contact in felt)


def _map(simulation, force):
    beads = simulation.card.beads
    ends = ["striker", *range(1, beads + 1), "wall"]
    rows = [f"{ends[c]}–{ends[c + 1]}" for c in simulation.contacts]
    return {"most": round(float(max(force.max(), 0.0)), 6), "rows": rows}


def _picture(force):
    """The map as an image: black is the largest force, white none."""
    at = np.linspace(0, len(force) - 1, min(_PIXELS, len(force))).astype(int)
    # The largest within each pixel, so that no peak is lost between two.
    peaks = np.maximum.reduceat(force, at, axis=0).T
    grey = 255.0 * (1.0 - np.sqrt(np.clip(peaks / max(force.max(), 1e-12), 0.0, 1.0)))
    found = BytesIO()
    Image.fromarray(np.round(grey).astype(np.uint8), "L").save(found, "PNG", optimize=True)
    data = base64.b64encode(found.getvalue()).decode()
    return (
        f'<image class="map" x="{LEFT:g}" y="{TOP:g}" width="{RIGHT - LEFT:g}" height="{_MAP:g}" '
        f'preserveAspectRatio="none" href="data:image/png;base64,{data}"/>'
    )


def _marks(simulation, bottom):
    """Frame of the map, its first and last contact, and a bar beside the rows of each gauge."""
    high = _MAP / len(simulation.contacts)
    yield _frame((LEFT, TOP, RIGHT, bottom), "")
    names = _map(simulation, simulation.force[:, :, 0])["rows"]
    yield _text(LEFT - 6, TOP + 8, names[0], "end") + _text(LEFT - 6, bottom - 1, names[-1], "end")
    for k, gauge in enumerate(simulation.sensors):
        rows = _rows(simulation, gauge)
        if rows:
            top, color = TOP + min(rows) * high, _COLORS[k % len(_COLORS)]
            tall = (max(rows) - min(rows) + 1) * high
            yield f'<rect x="{LEFT - 4:g}" y="{top:.1f}" width="4" height="{tall:.1f}" fill="{color}"/>'


def _frame(box, label):
    left, top, right, bottom = box
    rect = (
        f'<rect x="{left:g}" y="{top:g}" width="{right - left:g}" height="{bottom - top:g}" class="frame"/>'
    )
    return rect + (_text(left + 4, top + 11, label) if label else "")


def _text(x, y, text, anchor="start"):
    return f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}">{escape(text)}</text>'


def _axis(last, end):
    """Ticks at round times and the name of the axis."""
    step = 10.0 ** np.floor(np.log10(last / 2.0))
    step *= next(m for m in (1.0, 2.0, 5.0, 10.0) if last / (m * step) <= 8.0)
    for k in range(int(last / step) + 1):
        x = LEFT + (RIGHT - LEFT) * k * step / last
        yield f'<path d="M{x:.1f} {end:g}v4" stroke="{GREY}"/>' + _text(
            round(x, 1), end + 15, f"{k * step:g}", "middle"
        )
    yield _text((LEFT + RIGHT) / 2, end + 27, "Time after impact (µs)", "middle")


def _points(x, y, box):
    """Points of a polyline, those left out that lie on the line between their neighbours."""
    left, top, right, bottom = box
    place = np.column_stack([left + (right - left) * x, bottom - (bottom - top) * y])
    kept = thinned(place, _DEVIATION)
    return " ".join(f"{a:.1f},{b:.2f}" for a, b in kept)


def thinned(points: np.ndarray, deviation: float) -> np.ndarray:
    """The points (n, 2) of a line whose x grows, less those that others tell to within `deviation` in y.

    Ramer, Computer Graphics and Image Processing 1, 244 (1972), with the distance taken upright.
    """
    keep = np.zeros(len(points), dtype=bool)
    keep[[0, -1]] = True
    waiting = [(0, len(points) - 1)]
    while waiting:
        a, b = waiting.pop()
        if b - a < 2:
            continue
        inner = points[a + 1 : b]
        chord = np.interp(inner[:, 0], points[[a, b], 0], points[[a, b], 1])
        far = np.abs(inner[:, 1] - chord)
        worst = int(np.argmax(far))
        if far[worst] > deviation:
            keep[a + 1 + worst] = True
            waiting += [(a, a + 1 + worst), (a + 1 + worst, b)]
    return points[keep]
