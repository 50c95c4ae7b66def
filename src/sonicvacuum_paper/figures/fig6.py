"""Fig. 6: what the wall feels below a chain of small coated beads, struck by a light and by a heavy ball."""

from collections.abc import Mapping

import pandas
from matplotlib.figure import Figure

from sonicvacuum.figures import style
from sonicvacuum.study import Study
from sonicvacuum_paper.figures import traces

COLUMNS = traces.COLUMNS
UNTIL_US = 600.0
_TITLES = {"a": "(a) Steel ball, 0.036 g", "b": "(b) PTFE ball, 0.123 g"}

CAPTION = style.paragraph("""
Force on the wall, less the static part, below a vertical chain of 22 small coated beads (2.48 mm, 0.04 g)
struck at 0.89 m/s by (a) a steel ball of 2 mm and 0.036 g, (b) a PTFE ball of 4.76 mm and 0.123 g.
Simulated, without losses, for three moduli of the coating; numbers (at 15 GPa) and pale lines
as in Fig. 5. In (b) the lossless chain splits the pulse; the paper saw one shock-like pulse. Masses are
those printed in the paper, although the geometry of a bead asks for 0.056 g. The paper prints neither
forces nor times of this figure and its measured traces are not available.
""")


def table(studies: Mapping[str, Study]) -> pandas.DataFrame:
    """The numbers drawn; columns in `traces`."""
    found = []
    for name, study in studies.items():
        found += traces.rows(name.split(".")[0][-1], study, UNTIL_US)
    wall = traces.frame(found)
    return wall[wall.sensor == "wall"].reset_index(drop=True)


def draw(table: pandas.DataFrame) -> Figure:
    """The figure of these numbers."""
    with style.context():
        figure = style.canvas(style.DOUBLE, 66.0)
        highest = 1.12 * table.force_N.max()
        for panel, left in (("a", 13.0), ("b", 101.0)):
            axes = style.panel(figure, (left, 10.0, 70.0, 49.0))
            _panel(axes, table[table.panel == panel])
            axes.set(xlim=(0, UNTIL_US), ylim=(-0.03 * highest, highest))
            axes.set_xlabel("Time after impact (µs)")
            axes.set_ylabel("Force on the wall (N)")
            style.title(figure, left - 12.0, _TITLES[panel])
            if panel == "a":
                axes.legend(loc="upper right", borderaxespad=0.2)
    return figure


def _panel(axes, table):
    axes.axhline(0.0, color=traces.BASE_LINE, lw=0.5, zorder=0.5)
    moduli = list(dict.fromkeys(table.modulus_GPa))
    for (modulus, series), part in table.groupby(["modulus_GPa", "series"], sort=False):
        if series == "peak":
            continue
        look = style.look(modulus)
        axes.plot(
            part.time_us,
            part.force_N,
            **(look.line if series == "simulated" else look.pale),
            label=look.label(modulus) if series == "simulated" else None,
            zorder=3.0 - 0.1 * moduli.index(modulus),
            gid=f"{series}-wall-{modulus:g}",
        )
    # Numbers at all three trains would lie on one another's lines.
    traces.number(axes, table[table.modulus_GPa == moduli[0]], {"wall": 0.0})
