"""What a page does in a browser: one script for all pages, inlined, and the scales that it reads drawings by.

A drawing whose values are told under the cursor stands in `<figure data-scales='…'>`: its panels, each with
its frame in the units of the SVG, the data values at the frame's edges, and its lines by their ids there.
The script reads a line's points off the SVG itself, so that a page holds no number twice.
"""

import json
from dataclasses import asdict, dataclass, field
from importlib.resources import files

from markupsafe import Markup


@dataclass(frozen=True)
class Line:
    """One line of a panel.

    Attributes:
        id: of its element on the page.
        name: what the cursor calls it.
        base: what is taken off its values: the level of its base line in a panel of stacked lines.
        rows: rows of a map in the same drawing that this line is read from, none for most.
    """

    id: str
    name: str
    base: float = 0.0
    rows: tuple[int, ...] = ()


@dataclass(frozen=True)
class Panel:
    """A frame in a drawing.

    Attributes:
        box: left, top, right, bottom in the units of the SVG.
        x, y: value at the left (lower) edge, at the right (upper) edge, and whether the axis is logarithmic.
        xunit, yunit: units of the values.
        lines: what the cursor tells the values of.
        map: for a picture of forces instead of lines: `most`, the force in N that is black, and `rows`, what
            each row of pixels is called.
    """

    box: tuple[float, float, float, float]
    x: tuple[float, float, bool]
    y: tuple[float, float, bool]
    xunit: str
    yunit: str
    lines: tuple[Line, ...] = ()
    map: dict = field(default_factory=dict)


def scales(panels) -> str:
    """Value of the attribute `data-scales` of a figure, to be escaped by the template."""
    told = [asdict(panel) for panel in panels]
    for panel in told:
        panel["box"] = [round(edge, 3) for edge in panel["box"]]
        if not panel["map"]:
            del panel["map"]
    return json.dumps({"panels": told}, ensure_ascii=False, separators=(",", ":"))


def script() -> Markup:
    """The script, to stand once at the end of a page."""
    return Markup(files("sonicvacuum.report").joinpath("interactive.js").read_text(encoding="utf-8"))
