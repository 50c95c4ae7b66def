"""Fig. 4: speed of the wave against its amplitude, simulated, by the long-wave theory, and as printed.

Table, one row per point: panel, series, modulus_GPa, orientation, striker_speed_m_s, gauge_N, static_N,
force_N, speed_m_s, speed_error_m_s. `force_N` is the contact force above rest, F_m − F_0; Eqs. (6) and
(7) are for the total F_m. `gauge_N` is the mean reading of the two gauges, which is smaller: each
averages two contacts. Series: `simulated`; `eq6`, `eq7`; `paper` (printed speed at a printed reading,
taken as the reading that it is), `paper-as-read` (the same with the reading taken as the contact force);
`paper-speed` (amplitude not printed).
"""

from collections.abc import Mapping

import numpy as np
import pandas
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from sonicvacuum.figures import style
from sonicvacuum.observe.pulse import main_pulse
from sonicvacuum.physics import theory
from sonicvacuum.study import Study
from sonicvacuum_paper.one_run import OneRun
from sonicvacuum_paper.printed import PRINTED

COLUMNS = [
    "panel",
    "series",
    "modulus_GPa",
    "orientation",
    "striker_speed_m_s",
    "gauge_N",
    "static_N",
    "force_N",
    "speed_m_s",
    "speed_error_m_s",
]
# Range of the force axis in N, of the speed axis in m/s and its ticks.
FORCES = {"a": (0.06, 30.0), "b": (0.3, 60.0)}
SPEEDS = {"a": (40.0, 300.0), "b": (260.0, 800.0)}
TICKS = {"a": (40, 50, 70, 100, 150, 200, 300), "b": (300, 400, 500, 600, 800)}
POINTS = 81
_TITLES = {"a": "(a) Coated beads", "b": "(b) Bare steel beads"}

CAPTION = style.paragraph(f"""
Speed of the solitary wave between the 9th and the 5th bead against its amplitude, the largest contact
force above rest there: (a) steel beads coated with Parylene-C, (b) bare steel beads; logarithmic axes.
Marks: simulated, without losses, alumina cylinder of 0.47 g at 0.02 to 1 m/s; filled: vertical chain,
open: horizontal chain. Solid lines: long-wave theory with the weight of the beads, Eq. (7) with F_m the
total force and F_0 the mean static force on the contacts between the two beads; broken lines: without it,
Eq. (6). Printed in the paper, with 10 % error: in (a) {PRINTED.speed_low:.0f} m/s at a gauge reading of
about {PRINTED.amplitude_low:g} N (black circle: at the contact force which gives that reading in the
simulation; white circle: with the reading taken as the contact force) and {PRINTED.speed_coated:.0f} m/s
(grey band, amplitude not printed); in (b) {PRINTED.speed_steel:.0f} m/s (grey band, likewise). The other
measured points of the paper's figure are not available.
""")


def table(studies: Mapping[str, Study]) -> pandas.DataFrame:
    """The numbers drawn; columns as above."""
    found = []
    for name, study in studies.items():
        found += _simulated(name.split(".")[0][-1], study)
    for panel in "ab":
        found += _theory(panel, [s for n, s in studies.items() if n.startswith(f"fig4{panel}.")])
    found += _paper(pandas.DataFrame(found))
    return pandas.DataFrame(found, columns=COLUMNS)


def _simulated(panel: str, study: Study):
    for lane, speed in enumerate(study.speeds):
        run = OneRun(study, lane)
        contacts = run.contacts_between_gauges()
        yield {
            "panel": panel,
            "series": "simulated",
            "modulus_GPa": study.card.bead.surface.modulus_Pa / 1e9,
            "orientation": _orientation(study),
            "striker_speed_m_s": speed,
            "gauge_N": np.mean([run.view.main(s.id).force for s in run.span]),
            "static_N": np.mean([run.static_force(c) for c in contacts]),
            "force_N": max(main_pulse(run.contact(c)).force for c in contacts),
            "speed_m_s": run.speed().value,
        }


def _orientation(study):
    return "vertical" if study.card.gravity_m_s2 > 0.0 else "horizontal"


def _theory(panel: str, studies: list[Study]):
    """Eq. (7) for each modulus of a vertical chain, Eq. (6) for each of a horizontal one."""
    force = np.geomspace(*FORCES[panel], POINTS)
    for study in studies:
        bead, run = study.card.bead, OneRun(study)
        beads = (bead.surface.modulus_Pa, bead.surface.poisson, bead.diameter_m, bead.mass_kg)
        static = np.mean([run.static_force(c) for c in run.contacts_between_gauges()])
        speed = theory.speed_with_precompression(force + static, static, *beads)
        shared = {
            "panel": panel,
            "series": "eq7" if static > 0.0 else "eq6",
            "modulus_GPa": bead.surface.modulus_Pa / 1e9,
            "orientation": _orientation(study),
            "static_N": static,
        }
        yield from (shared | {"force_N": f, "speed_m_s": v} for f, v in zip(force, speed, strict=True))


def _paper(rows: pandas.DataFrame):
    """What the text prints; the force at the printed reading is read off the stiffest vertical chain."""
    upright = rows[(rows.series == "simulated") & (rows.panel == "a") & (rows.orientation == "vertical")]
    reading = PRINTED.amplitude_low
    yield _printed("a", "paper-as-read", PRINTED.speed_low, gauge_N=reading, force_N=reading)
    for _, sweep in list(upright.sort_values("gauge_N").groupby("modulus_GPa"))[-1:]:
        # Outside the sweep the force is not known, and the point is left out.
        if sweep.gauge_N.min() <= reading <= sweep.gauge_N.max():
            force = np.exp(np.interp(np.log(reading), np.log(sweep.gauge_N), np.log(sweep.force_N)))
            yield _printed("a", "paper", PRINTED.speed_low, gauge_N=reading, force_N=force)
    yield _printed("a", "paper-speed", PRINTED.speed_coated)
    yield _printed("b", "paper-speed", PRINTED.speed_steel)


def _printed(panel, series, speed, **where):
    error = PRINTED.speed_error * speed
    return {"panel": panel, "series": series, "speed_m_s": speed, "speed_error_m_s": error, **where}


def draw(table: pandas.DataFrame) -> Figure:
    """The figure of these numbers."""
    with style.context():
        figure = style.canvas(style.DOUBLE, 92.0)
        for panel, left in (("a", 13.0), ("b", 101.0)):
            axes = style.panel(figure, (left, 11.0, 60.0, 74.0))
            part = table[table.panel == panel]
            _axes(axes, panel)
            _curves(axes, part)
            _marks(axes, part)
            _paper_marks(axes, part)
            _legend(axes, part)
            style.title(figure, left - 12.0, _TITLES[panel])
    return figure


def _axes(axes, panel):
    axes.set(xscale="log", yscale="log", xlim=FORCES[panel], ylim=SPEEDS[panel])
    plain = FuncFormatter(lambda value, _: f"{value:g}")
    axes.xaxis.set_major_formatter(plain)
    axes.yaxis.set_major_locator(FixedLocator(TICKS[panel]))
    axes.yaxis.set_major_formatter(plain)
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("Contact force above rest, $F_m - F_0$ (N)")
    axes.set_ylabel("Speed (m/s)")


def _curves(axes, table):
    for (series, modulus), curve in table[table.series.isin(["eq6", "eq7"])].groupby(
        ["series", "modulus_GPa"]
    ):
        line = {"lw": 1.2, "ls": "-"} if series == "eq7" else {"lw": 0.8, "ls": (0, (4, 2))}
        color = style.look(modulus).color
        axes.plot(curve.force_N, curve.speed_m_s, color=color, **line, zorder=2, gid=f"{series}-{modulus:g}")
        if series == "eq7":
            end = curve.iloc[-1]
            axes.annotate(
                f"{modulus:g} GPa",
                (end.force_N, end.speed_m_s),
                (4, 0),
                textcoords="offset points",
                va="center",
                color=color,
                annotation_clip=False,
            )


def _marks(axes, table):
    simulated = table[table.series == "simulated"]
    for (modulus, orientation), sweep in simulated.groupby(["modulus_GPa", "orientation"]):
        look = style.look(modulus)
        axes.plot(
            sweep.force_N,
            sweep.speed_m_s,
            ls="none",
            marker=look.marker,
            ms=3.6,
            mew=0.8,
            color=look.color,
            mfc=look.color if orientation == "vertical" else "white",
            zorder=3 if orientation == "vertical" else 2.5,
            gid=f"simulated-{modulus:g}-{orientation}",
        )


_PAPER = {
    "paper": {"marker": "o", "color": "black", "ms": 4.6, "mew": 0.9},
    "paper-as-read": {"marker": "o", "color": "black", "ms": 4.6, "mew": 0.9, "mfc": "white"},
}


def _paper_marks(axes, table):
    for band in table[table.series == "paper-speed"].itertuples():
        low, high = band.speed_m_s - band.speed_error_m_s, band.speed_m_s + band.speed_error_m_s
        axes.axhspan(low, high, color=style.BAND, lw=0, zorder=0)
        axes.axhline(band.speed_m_s, color=style.GREY, lw=0.7, zorder=0.1)
        axes.annotate(
            f"paper: {band.speed_m_s:.0f} m/s ± {100 * band.speed_error_m_s / band.speed_m_s:.0f} %",
            (0.02, band.speed_m_s),
            (0, 2),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            fontsize=7,
        )
    for point in table[table.series.isin(list(_PAPER))].itertuples():
        axes.errorbar(
            point.force_N,
            point.speed_m_s,
            yerr=point.speed_error_m_s,
            **_PAPER[point.series],
            elinewidth=0.9,
            capsize=2,
            zorder=4,
        )


def _legend(axes, table):
    look = style.look(table.modulus_GPa.dropna().iloc[0])
    mark = {"ls": "none", "marker": look.marker, "ms": 3.6, "mew": 0.8, "color": look.color}
    handles = [
        Line2D([], [], color=look.color, lw=1.2, label="Eq. (7), weight of the beads"),
        Line2D([], [], color=look.color, lw=0.8, ls=(0, (4, 2)), label="Eq. (6), no weight"),
        Line2D([], [], **mark, label="simulated, vertical"),
        Line2D([], [], **mark, mfc="white", label="simulated, horizontal"),
    ]
    lower = axes.legend(handles=handles, loc="lower right", borderaxespad=0.1)
    points = []
    for point in table[table.series.isin(list(_PAPER))].sort_values("series").itertuples():
        text = f"paper: {point.speed_m_s:.0f} m/s, gauge reading {point.gauge_N:g} N"
        if point.series == "paper-as-read":
            text = "the same, reading as contact force"
        points.append(Line2D([], [], ls="none", **_PAPER[point.series], label=text))
    if points:
        axes.add_artist(lower)
        axes.legend(handles=points, loc="upper left", borderaxespad=0.1, handlelength=1.0, fontsize=7)
