"""Fig. 5: the waves of a heavy striker at two gauges and at the wall, in coated beads and in bare steel."""

from collections.abc import Mapping

import pandas
from matplotlib.figure import Figure

from sonicvacuum.figures import style
from sonicvacuum.simulation import Simulation
from sonicvacuum_paper.figures import traces
from sonicvacuum_paper.printed import PRINTED

COLUMNS = traces.COLUMNS
UNTIL_US = {"a": 1600.0, "b": 400.0}

CAPTION = style.paragraph(f"""
Trains made by a 1.23 g striker at 0.44 m/s, simulated: Hertz without losses, layer with loss. Gauges, bars
and pale lines as in Fig. 3. Numbers mark, on the highest train, waves of at least {traces.TRAIN:.2f} of the
first at the wall; (4) is a fourth below that. The paper counts three; its traces are not available.
""")


def table(simulations: Mapping[str, Simulation]) -> pandas.DataFrame:
    """The numbers drawn; columns in `traces`."""
    found = []
    for name, simulation in simulations.items():
        panel = name.split(".")[0][-1]
        found += traces.rows(panel, simulation, UNTIL_US[panel])
    return traces.frame(found)


def placed(rows: pandas.DataFrame, table: pandas.DataFrame) -> pandas.DataFrame:
    """Digitised points stand where they were read."""
    return rows


def draw(table: pandas.DataFrame) -> Figure:
    """The figure of these numbers."""
    bars = {"a": (PRINTED.coated_bar, 200.0), "b": (PRINTED.steel_bar, 50.0)}
    return traces.draw(table, bars)
