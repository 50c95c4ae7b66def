"""A drawing as what stands on paper: lines, dots and words at places in millimetres, and its SVG.

Written as text, which takes a thirtieth of the time in which a plotting library loads and lays axes out:
every `sonicvacuum discover` draws pictures. The same marks are painted as PNG by `raster`.
Places are (x, y) from the lower left corner of the page.
"""

from dataclasses import dataclass, field

import numpy as np
from markupsafe import escape

from sonicvacuum.files import replacing

SINGLE, DOUBLE = 85.0, 175.0  # widths of a journal column and of a page, mm
POINT = 25.4 / 72.0  # mm
INK = "#000000"
# DejaVu Sans and Verdana are equally wide; what stands in for them is narrower, and so never cut off.
FONTS = "DejaVu Sans, Verdana, Arial, Helvetica, sans-serif"
# Heights of letters above the line they stand on, over the size of the font: where `level` of a text lies.
LEVELS = {"base": 0.0, "middle": 0.36, "top": 0.76, "bottom": -0.24}
LEADING = 1.2  # from line to line, over the size of the font
ANCHORS = {"left": "start", "centre": "middle", "right": "end"}
# Widths of letters of DejaVu Sans over the size of the font; all others, about.
_WIDTHS = {0.3: "iljI.,:;|!' ", 0.4: "frt()-[]", 0.85: "mwMW%+−=<>±", 0.76: "OQGNHDU"}
_WIDTH_OF = {letter: width for width, letters in _WIDTHS.items() for letter in letters}

# (left, bottom, width, height) in mm.
Box = tuple[float, float, float, float]


@dataclass(frozen=True)
class Stroke:
    """How a line is drawn: colour, width in points, dashes and gaps in widths, none for a full line."""

    color: str = INK
    width: float = 0.6
    dashes: tuple[float, ...] = ()


@dataclass(frozen=True)
class Curve:
    """A line through (n, 2) places in mm, interrupted where they are not numbers; or the area within it."""

    points: np.ndarray
    stroke: Stroke | None = None
    fill: str | None = None
    opacity: float = 1.0
    clip: Box | None = None


@dataclass(frozen=True)
class Dots:
    """Discs of a diameter in mm at (n, 2) places in mm, with an edge or without."""

    points: np.ndarray
    size: float
    fill: str
    edge: Stroke | None = None
    clip: Box | None = None


@dataclass(frozen=True)
class Text:
    """Words, in as many lines as they have: size in points, `level` of the place, turned by degrees."""

    x: float
    y: float
    words: str
    size: float = 8.0
    color: str = INK
    anchor: str = "left"
    level: str = "base"
    turned: float = 0.0

    def lines(self) -> list[tuple[str, float]]:
        """Each line with how far below the place it stands, in points."""
        parts = self.words.split("\n")
        above = {"top": 0.0, "middle": 0.5}.get(self.level, float(self.level == "bottom"))
        first = (LEVELS[self.level] - above * LEADING * (len(parts) - 1)) * self.size
        return [(part, first + LEADING * self.size * k) for k, part in enumerate(parts)]


Mark = Curve | Dots | Text


@dataclass(frozen=True)
class Drawing:
    """A page of width × height mm with marks, the last on top."""

    width: float
    height: float
    marks: list[Mark] = field(default_factory=list)

    def add(self, *marks: Mark) -> None:
        """Put marks on top."""
        self.marks.extend(marks)

    def svg(self) -> str:
        """The drawing as SVG; its bytes depend on its marks only."""
        wide, high = (f"{side / POINT:.2f}".rstrip("0").rstrip(".") for side in (self.width, self.height))
        clips = list(dict.fromkeys(m.clip for m in self.marks if not isinstance(m, Text) and m.clip))
        parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide}pt" height="{high}pt" '
            f'viewBox="0 0 {wide} {high}" font-family="{FONTS}">',
            f'<path d="M0 0H{wide}V{high}H0z" fill="#ffffff"/>',
            *(self._clip(k, box) for k, box in enumerate(clips)),
            *(_WRITTEN[type(mark)](self, mark, clips) for mark in self.marks),
            "</svg>\n",
        ]
        return "\n".join(parts)

    def write(self, path) -> None:
        """Write the SVG."""
        with replacing(path) as stream:
            stream.write(self.svg())

    def places(self, points: np.ndarray) -> np.ndarray:
        """Places in mm as those of the SVG, which counts points from the upper left corner."""
        return (np.asarray(points, dtype=float) * (1.0, -1.0) + (0.0, self.height)) / POINT

    def _clip(self, k, box):
        (x, y), (right, top) = self.places([(box[0], box[1] + box[3]), (box[0] + box[2], box[1])])
        shape = f"M{x:.2f} {y:.2f}H{right:.2f}V{top:.2f}H{x:.2f}z"
        return f'<clipPath id="frame-{k}"><path d="{shape}"/></clipPath>'


def width_of(words: str, size: float) -> float:
    """About how wide words are, in mm; the widest line counts."""
    lines = words.split("\n")
    return size * POINT * max(sum(_WIDTH_OF.get(letter, 0.62) for letter in line) for line in lines)


def rectangle(left: float, bottom: float, width: float, height: float) -> np.ndarray:
    """(5, 2) corners in mm, the first again at the end."""
    right, top = left + width, bottom + height
    return np.array([(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)])


def _curve(page, mark, clips):
    parts = "".join(_path(run) for run in _unbroken(page.places(mark.points)))
    paint = f' fill="{mark.fill}"' if mark.fill else ' fill="none"'
    faint = f' opacity="{mark.opacity:g}"' if mark.opacity < 1.0 else ""
    return f'<path d="{parts}"{paint}{_stroked(mark.stroke)}{faint}{_clipped(mark, clips)}/>'


def _path(points):
    form = "M%.2f %.2fL" + "%.2f %.2f " * (len(points) - 1)
    return (form % tuple(points.ravel().tolist())).rstrip(" L")


def _unbroken(points):
    """The stretches of places that are numbers."""
    return [points[one] for one in stretches(np.isfinite(points).all(axis=1))]


def stretches(known: np.ndarray) -> list[slice]:
    """Where (n,) truths are true without a break."""
    ends = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(int)))
    return [slice(begin, end) for begin, end in ends.reshape(-1, 2).tolist()]


def _dots(page, mark, clips):
    """Discs without an edge are round ends of a line of no length, many in one path."""
    places = page.places(mark.points[np.isfinite(mark.points).all(axis=1)])
    if mark.edge is None:
        shape = ("M%.2f %.2fh0" * len(places)) % tuple(places.ravel().tolist())
        line = (
            f' fill="none" stroke="{mark.fill}" stroke-width="{mark.size / POINT:.2f}" stroke-linecap="round"'
        )
        return f'<path d="{shape}"{line}{_clipped(mark, clips)}/>'
    paint = (
        f' r="{0.5 * mark.size / POINT:.2f}" fill="{mark.fill}"{_stroked(mark.edge)}{_clipped(mark, clips)}'
    )
    return "\n".join(f'<circle cx="{x:.2f}" cy="{y:.2f}"{paint}/>' for x, y in places.tolist())


def _stroked(stroke):
    if stroke is None:
        return ""
    dashes = " ".join(f"{d * stroke.width:.3g}" for d in stroke.dashes)
    dashed = f' stroke-dasharray="{dashes}"' if dashes else ' stroke-linejoin="round"'
    return f' stroke="{stroke.color}" stroke-width="{stroke.width:g}"{dashed}'


def _clipped(mark, clips):
    return f' clip-path="url(#frame-{clips.index(mark.clip)})"' if mark.clip else ""


def _text(page, mark, clips):
    ((x, y),) = page.places([(mark.x, mark.y)])
    turned = f" rotate({-mark.turned:g})" if mark.turned else ""
    look = f'font-size="{mark.size:g}" text-anchor="{ANCHORS[mark.anchor]}" fill="{mark.color}"'
    return "\n".join(
        f'<text transform="translate({x:.2f} {y:.2f}){turned}" y="{below:.2f}" {look}>{escape(part)}</text>'
        for part, below in mark.lines()
    )


_WRITTEN = {Curve: _curve, Dots: _dots, Text: _text}
