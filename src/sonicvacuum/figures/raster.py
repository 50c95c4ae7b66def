"""A drawing as PNG, for slides and word processors: the marks of its SVG, painted by matplotlib."""

from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.transforms import Affine2D, Bbox, TransformedBbox

from sonicvacuum.figures.drawing import Curve, Dots, Drawing
from sonicvacuum.figures.style import DOTS_PER_INCH, canvas, context, save


def write(drawing: Drawing, path) -> None:
    """Paint a drawing into a file."""
    save(figure_of(drawing), path)


def figure_of(drawing: Drawing) -> Figure:
    """A figure that holds the marks of a drawing, where it has them."""
    with context():
        figure = canvas(drawing.width, drawing.height)
        figure.mm = Affine2D().scale(DOTS_PER_INCH / 25.4)
        for mark in drawing.marks:
            _painted(figure, mark)
    return figure


def _painted(figure, mark):
    if isinstance(mark, Curve):
        _curve(figure, mark)
    elif isinstance(mark, Dots):
        _dots(figure, mark)
    else:
        _text(figure, mark)


def _curve(figure, mark):
    if mark.fill:
        shape = Polygon(mark.points, facecolor=mark.fill, lw=0, alpha=mark.opacity, transform=figure.mm)
        _put(figure, shape, mark.clip)
    if mark.stroke:
        line = Line2D(*mark.points.T, transform=figure.mm, alpha=mark.opacity, **_line(mark.stroke))
        _put(figure, line, mark.clip)


def _line(stroke):
    dashes = (0, stroke.dashes) if stroke.dashes else "-"
    return {"color": stroke.color, "lw": stroke.width, "ls": dashes, "solid_capstyle": "butt"}


def _dots(figure, mark):
    edge, width = (mark.edge.color, mark.edge.width) if mark.edge else (mark.fill, 0.0)
    look = {
        "marker": "o",
        "ls": "",
        "ms": mark.size / 25.4 * 72.0,
        "mfc": mark.fill,
        "mec": edge,
        "mew": width,
    }
    _put(figure, Line2D(*mark.points.T, transform=figure.mm, **look), mark.clip)


def _put(figure, artist, box):
    figure.add_artist(artist)
    if box:
        artist.set_clip_box(TransformedBbox(Bbox.from_bounds(*box), figure.mm))


def _text(figure, mark):
    """Each line is moved from its place before it is turned about it."""
    for part, below in mark.lines():
        at = Affine2D().translate(0.0, -below * 25.4 / 72.0).rotate_deg(mark.turned)
        x, y = at.translate(mark.x, mark.y).transform((0.0, 0.0))
        side = {"centre": "center"}.get(mark.anchor, mark.anchor)
        figure.text(
            x, y, part, size=mark.size, color=mark.color, ha=side, va="baseline",
            rotation=mark.turned, rotation_mode="anchor", transform=figure.mm, parse_math=False,
        )  # fmt: skip
