"""Fig. 3: the pulse of a light striker at two gauges and at the wall, in coated beads and in bare steel."""

from collections.abc import Mapping

import pandas
from matplotlib.figure import Figure

from sonicvacuum.figures import style
from sonicvacuum.study import Study
from sonicvacuum_paper.figures import traces
from sonicvacuum_paper.printed import PRINTED

COLUMNS = traces.COLUMNS
UNTIL_US = {"a": 1100.0, "b": 300.0}

CAPTION = style.paragraph(f"""
Pulses made by a 0.47 g alumina cylinder at 0.44 m/s in vertical chains of 21 beads: (a) steel beads
coated with Parylene-C, (b) bare steel beads. Simulated, without losses: readings, less the static part,
of gauges in the 9th and the 5th bead from the wall and at the wall, shifted upwards; the grey lines are
zero. In (a) for the modulus that the paper matches to its experiments and for the handbook's. Force bars
as in the paper ({PRINTED.coated_bar:g} N and {PRINTED.steel_bar:g} N). Pale lines: after the reflection
has come back. The gauges are ideal: the discharge of the paper's (time constant about 1 ms), which lowers
a peak by a few per cent and leaves an undershoot behind it, is left out. The legends give speeds from
peak to peak between the two beads. Printed in the paper: the speeds {PRINTED.speed_coated:.0f} and
{PRINTED.speed_steel:.0f} m/s with their 10 % (bars with whiskers: where the peak at the 5th bead would
then be, counted from the simulated one at the 9th bead) and the duration of about
{1e6 * PRINTED.duration_coated:.0f} µs, its level not given (bar, centred on the simulated peak). The
paper's measured traces are not available, so none is shown.
""")


def table(studies: Mapping[str, Study]) -> pandas.DataFrame:
    """The numbers drawn; columns in `traces`."""
    found = []
    for name, study in studies.items():
        panel = name.split(".")[0][-1]
        found += traces.rows(panel, study, UNTIL_US[panel])
    for panel, speed, duration in (
        ("a", PRINTED.speed_coated, 1e6 * PRINTED.duration_coated),
        ("b", PRINTED.speed_steel, None),
    ):
        first = next(s for n, s in studies.items() if n.startswith(f"fig3{panel}."))
        found += traces.paper_rows(panel, first, speed, duration)
    return traces.frame(found)


def draw(table: pandas.DataFrame) -> Figure:
    """The figure of these numbers."""
    bars = {"a": (PRINTED.coated_bar, 100.0), "b": (PRINTED.steel_bar, 50.0)}
    return traces.draw(table, bars)
