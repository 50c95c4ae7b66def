"""Fig. 5: the waves of a heavy striker at two gauges and at the wall, in coated beads and in bare steel."""

from collections.abc import Mapping

import pandas
from matplotlib.figure import Figure

from sonicvacuum.figures import style
from sonicvacuum.study import Study
from sonicvacuum_paper.figures import traces
from sonicvacuum_paper.printed import PRINTED

COLUMNS = traces.COLUMNS
UNTIL_US = {"a": 1600.0, "b": 400.0}

CAPTION = style.paragraph(f"""
Trains of solitary waves made by a 1.23 g alumina cylinder at 0.44 m/s in vertical chains of 21 beads: (a)
steel beads coated with Parylene-C, (b) bare steel beads. Simulated, without losses; gauges, shifts, bars
({PRINTED.coated_bar:g} N and {PRINTED.steel_bar:g} N) and pale lines as in Fig. 3. Numbers: the separate
waves at the wall that reach at least {traces.TRAIN:.2f} of the first. The legends give the speed of the
first wave between the two beads; the paper prints none for these runs, and its measured traces are not
available.
""")


def table(studies: Mapping[str, Study]) -> pandas.DataFrame:
    """The numbers drawn; columns in `traces`."""
    found = []
    for name, study in studies.items():
        panel = name.split(".")[0][-1]
        found += traces.rows(panel, study, UNTIL_US[panel])
    return traces.frame(found)


def draw(table: pandas.DataFrame) -> Figure:
    """The figure of these numbers."""
    bars = {"a": (PRINTED.coated_bar, 200.0), "b": (PRINTED.steel_bar, 50.0)}
    return traces.draw(table, bars)
