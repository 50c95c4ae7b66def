"""Fig. 6: what the wall feels below a chain of small coated beads, struck by a light and by a heavy ball."""

from collections.abc import Mapping

import pandas
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from sonicvacuum.figures import style
from sonicvacuum.observe.pulse import PROMINENCE
from sonicvacuum.simulation import Simulation
from sonicvacuum_paper.figures import looks, traces

COLUMNS = traces.COLUMNS
UNTIL_US = 600.0
# Lowest later peak that the paper would call a pulse, of the main one; as in the ledger, and so is its rise.
COUNTED = 0.15
# Models whose highest peak is below this part of the panel's stand in an inset as well: its frame, as parts
# of the panel, and its times in µs.
WEAK = 0.2
INSET, INSET_US = (0.52, 0.26, 0.46, 0.56), (200.0, UNTIL_US)
_TITLES = {"a": "(a) Steel ball, 0.036 g", "b": "(b) PTFE ball, 0.123 g"}

CAPTION = style.paragraph(f"""
Wall below 22 small beads struck at 0.89 m/s, simulated: models as in Fig. 3, the lossy one also with masses
by geometry (0.056 g a bead). Inset: enlarged. Legends count waves of at least {COUNTED:g} of the first behind
dips of {PROMINENCE:g}; the hump of the dashed line in (b) has less. The paper's traces are not available.
""")
# What the paper says of each panel.
_SEEN = {"a": "paper: one solitary wave", "b": "paper: one shock-like pulse"}


def table(simulations: Mapping[str, Simulation]) -> pandas.DataFrame:
    """The numbers drawn; columns in `traces`."""
    found = []
    for name, simulation in simulations.items():
        found += traces.rows(name.split(".")[0][-1], simulation, UNTIL_US, PROMINENCE)
    wall = traces.frame(found)
    return wall[wall.sensor == "wall"].reset_index(drop=True)


def placed(rows: pandas.DataFrame, table: pandas.DataFrame) -> pandas.DataFrame:
    """Digitised points stand where they were read."""
    return rows


def draw(table: pandas.DataFrame) -> Figure:
    """The figure of these numbers."""
    with style.context():
        figure = style.canvas(style.DOUBLE, 84.0)
        for panel, left in (("a", 13.0), ("b", 101.0)):
            axes, part = style.panel(figure, (left, 10.0, 70.0, 49.0)), table[table.panel == panel]
            highest = 1.12 * part.force_N.max()
            _panel(axes, part)
            _inset(axes, part)
            traces.points(axes, part, {"wall": 0.0})
            axes.set(xlim=(0, UNTIL_US), ylim=(-0.03 * highest, highest))
            axes.set_xlabel("Time after impact (µs)")
            axes.set_ylabel("Force on the wall (N)")
            style.title(figure, left - 12.0, _TITLES[panel])
            models = dict.fromkeys(part.model[part.series == "simulated"])
            handles = [_handle(part, model) for model in models]
            axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(-0.01, 1.4), borderaxespad=0.0)
            axes.annotate(
                _SEEN[panel], (0.98, 0.95), xycoords="axes fraction", ha="right", va="top", style="italic"
            )
    return figure


def _inset(axes, table):
    """What is weak beside the highest pulse, with its own scale of force; nothing where none is."""
    highest = table.groupby("model").force_N.max()
    weak = highest[highest < WEAK * highest.max()]
    if weak.empty:
        return
    inset, top = axes.inset_axes(INSET), 1.12 * weak.max()
    _panel(inset, table[table.model.isin(weak.index)], "-inset")
    inset.set(xlim=INSET_US, ylim=(-0.1 * top, top))
    inset.set_xlabel("µs", fontsize=7, labelpad=1.0)
    inset.annotate(
        "N", (0, 1), (0, 2), "axes fraction", "offset points", fontsize=7, ha="center", va="bottom"
    )
    inset.tick_params(labelsize=7)


def _panel(axes, table, name=""):
    axes.axhline(0.0, color=traces.BASE_LINE, lw=0.5, zorder=0.5)
    models = list(dict.fromkeys(table.model))
    drawn = table[table.series.isin(["simulated", "reflected"])]
    for (model, series), part in drawn.groupby(["model", "series"], sort=False):
        look = looks.look(model)
        axes.plot(
            part.time_us,
            part.force_N,
            **(look.line if series == "simulated" else look.pale),
            zorder=3.0 - 0.1 * models.index(model),
            gid=f"{series}-wall-{model}-{part.panel.iloc[0]}{name}",
        )


def _handle(table, model):
    """Line of a model in the legend, with how many waves it makes."""
    peaks = table.force_N[(table.model == model) & (table.series == "peak")]
    waves = int((peaks >= COUNTED * peaks.max()).sum())
    name = looks.look(model).name
    return Line2D([], [], **looks.look(model).line, label=f"{name}: {waves} wave{'s' if waves > 1 else ''}")
