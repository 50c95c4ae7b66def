"""Fig. 3: the pulse of a light striker at two gauges and at the wall, in coated beads and in bare steel."""

from collections.abc import Mapping

import pandas
from matplotlib.figure import Figure

from sonicvacuum.figures import style
from sonicvacuum.simulation import Simulation
from sonicvacuum_paper.figures import traces
from sonicvacuum_paper.printed import PRINTED

COLUMNS = traces.COLUMNS
UNTIL_US = {"a": 1100.0, "b": 300.0}

CAPTION = style.paragraph(f"""
Pulses of a 0.47 g striker at 0.44 m/s, simulated: Hertz and bonded layer without loss, layer with one.
Gauges: 9th and 5th bead from the bottom (13 and 17 from the striker), wall; bars {PRINTED.coated_bar:g}
and {PRINTED.steel_bar:g} N; pale: reflections. Crosses: arrivals by the printed speeds; bar: printed
duration, which calibrates the loss. The paper's traces are not available.
""")


def table(simulations: Mapping[str, Simulation]) -> pandas.DataFrame:
    """The numbers drawn; columns in `traces`."""
    found = []
    for name, simulation in simulations.items():
        panel = name.split(".")[0][-1]
        found += traces.rows(panel, simulation, UNTIL_US[panel])
    for panel, speed, duration in (
        ("a", PRINTED.speed_coated, 1e6 * PRINTED.duration_coated),
        ("b", PRINTED.speed_steel, None),
    ):
        first = next(s for n, s in simulations.items() if n.startswith(f"fig3{panel}."))
        found += traces.paper_rows(panel, first, speed, duration)
    return traces.frame(found)


def placed(rows: pandas.DataFrame, table: pandas.DataFrame) -> pandas.DataFrame:
    """Digitised points stand where they were read."""
    return rows


def draw(table: pandas.DataFrame) -> Figure:
    """The figure of these numbers."""
    bars = {"a": (PRINTED.coated_bar, 100.0), "b": (PRINTED.steel_bar, 50.0)}
    return traces.draw(table, bars)
