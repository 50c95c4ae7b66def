"""One look for all figures, and bytes that depend on the numbers only.

Sizes in millimetres of the printed page. Line styles and widths say the same as colours, for print in grey.
"""

from io import BytesIO

import matplotlib
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from sonicvacuum.figures.colours import BAND as BAND
from sonicvacuum.figures.colours import BLUE as BLUE
from sonicvacuum.figures.colours import GREEN as GREEN
from sonicvacuum.figures.colours import GREY as GREY
from sonicvacuum.figures.colours import ORANGE as ORANGE
from sonicvacuum.figures.colours import PURPLE as PURPLE
from sonicvacuum.figures.colours import SKY as SKY
from sonicvacuum.figures.drawing import DOUBLE as DOUBLE
from sonicvacuum.figures.drawing import SINGLE as SINGLE
from sonicvacuum.files import replacing

DOTS_PER_INCH = 300
# Format of a picture → what is written into it about its making.
METADATA = {
    "svg": {"Date": None, "Creator": None},
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}

_SETTINGS = {
    "font.family": "DejaVu Sans",  # comes with matplotlib, so it is the same everywhere
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "mathtext.fontset": "dejavusans",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "lines.solid_capstyle": "round",
    "svg.hashsalt": "sonicvacuum",
    "svg.fonttype": "path",
}


def context():
    """The settings under which figures are made and written."""
    return matplotlib.rc_context({**matplotlib.rcParamsDefault, **_SETTINGS})


def canvas(width_mm: float, height_mm: float) -> Figure:
    """An empty figure of this size."""
    figure = Figure(figsize=(width_mm / 25.4, height_mm / 25.4), dpi=DOTS_PER_INCH)
    FigureCanvasAgg(figure)
    return figure


def panel(figure: Figure, box_mm: tuple[float, float, float, float]) -> Axes:
    """Axes whose frame is at (left, bottom, width, height) in mm."""
    width, height = (25.4 * size for size in figure.get_size_inches())
    left, bottom, wide, high = box_mm
    return figure.add_axes((left / width, bottom / height, wide / width, high / height))


def paragraph(text: str) -> str:
    """A caption written over several lines, as one."""
    return " ".join(text.split())


def title(figure: Figure, left_mm: float, text: str) -> None:
    """Title of a panel, "(a) …", at the top of the figure."""
    width, height = (25.4 * size for size in figure.get_size_inches())
    figure.text(left_mm / width, 1.0 - 3.0 / height, text, fontweight="bold", va="center")


def save(figure: Figure, *paths) -> None:
    """Write a figure, by the ending of each path as SVG, PNG or PDF; no date, no version, fixed ids."""
    with context():
        for path in paths:
            kind = str(path).rsplit(".", 1)[-1].lower()
            content = BytesIO()
            figure.savefig(content, format=kind, dpi=DOTS_PER_INCH, metadata=METADATA[kind])
            with replacing(path, "wb") as stream:
                stream.write(content.getvalue())
