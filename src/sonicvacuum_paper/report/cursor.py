"""What the cursor tells over Figures 3–6: where each panel is in the drawing, and what its lines are called.

The figure is drawn again from its CSV, which takes a part of a second, and asked for its axes; the values
themselves stay in the SVG, see `sonicvacuum.report.interactive`.
"""

import re

from matplotlib.axes import Axes

from sonicvacuum.report.interactive import Line, Panel, scales
from sonicvacuum_paper import figures
from sonicvacuum_paper.figures import looks, traces

# Units of an SVG to the inch.
_DOTS = 72.0


def of_figure(name: str, path) -> str:
    """Value of `data-scales` of a figure, from the CSV that it is drawn from.

    Raises:
        InputError: where the file does not hold the numbers of that figure.
    """
    drawn = figures.draw(name, path)
    table = figures.read(name, path)
    width, height = (_DOTS * size for size in drawn.get_size_inches())
    panels = []
    for axes, letter in zip(drawn.axes, dict.fromkeys(table.panel), strict=True):
        part = table[table.panel == letter]
        stacked = name in ("fig3", "fig5")
        bases = traces.base_lines(part) if stacked else {}
        units = ("N", "m/s") if name == "fig4" else ("µs", "N")
        for frame in (*axes.child_axes, axes):  # an inset lies on its panel
            lines = tuple(_lines(name, frame, bases))
            box = _box(frame, width, height)
            panels.append(Panel(box, _scale(frame, "x"), _scale(frame, "y"), *units, lines))
    return scales(panels)


def _box(axes: Axes, width, height):
    """Left, top, right, bottom of the frame; matplotlib counts upwards, an SVG downwards."""
    frame = axes.get_position()
    return frame.x0 * width, (1.0 - frame.y1) * height, frame.x1 * width, (1.0 - frame.y0) * height


def _scale(axes: Axes, which):
    low, high = getattr(axes, f"get_{which}lim")()
    return float(low), float(high), getattr(axes, f"get_{which}scale")() == "log"


def _lines(name, axes, bases):
    for drawn in axes.get_lines():
        gid = drawn.get_gid() or ""
        series, _, rest = gid.partition("-")
        if series not in ("simulated", "reflected", "eq6", "eq7"):
            continue
        if name == "fig4":
            yield Line(f"{name}-{gid}", _speed_line(series, rest))
            continue
        sensor, _, model = rest.partition("-")
        told = looks.look(re.sub(r"-[ab](-inset)?$", "", model)).name
        told = told if name == "fig6" else f"{traces.label_of(sensor)}, {told}"
        told += ", reflected" if series == "reflected" else ""
        yield Line(f"{name}-{gid}", told, round(float(bases.get(sensor, 0.0)), 6))


def _speed_line(series, rest):
    """What a line of Fig. 4 is called: an equation, or a model and how its chain hangs."""
    if series != "simulated":
        return f"Eq. ({series[-1]}), {looks.look(rest).name}"
    model, _, orientation = rest.rpartition("-")
    return looks.look(model).name + (", no weight" if orientation == "horizontal" else "")
