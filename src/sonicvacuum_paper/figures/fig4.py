"""Fig. 4: speed of the wave against its amplitude, simulated, by the long-wave theory, and as printed.

Table, one row per point: panel, series, model (variant of the case), modulus_GPa, orientation,
striker_speed_m_s, gauge_N, static_N,
force_N, speed_m_s, speed_error_m_s. `force_N` is the contact force above rest, F_m − F_0; Eqs. (6) and
(7) are for the total F_m. `gauge_N` is the mean reading of the two gauges, which is smaller: each
averages two contacts. Series: `simulated`; `eq6`, `eq7`; `paper` (printed speed at a printed reading,
taken as the reading that it is), `paper-as-read` (the same with the reading taken as the contact force);
`cracks` (the reading at which the paper saw cracks, without a speed);
`digitised` (read off the paper's figure by somebody: `sonicvacuum_paper.digitised`).
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
from sonicvacuum.simulation import Simulation
from sonicvacuum_paper import digitised
from sonicvacuum_paper.figures import looks, traces
from sonicvacuum_paper.one_run import OneRun
from sonicvacuum_paper.printed import PRINTED

COLUMNS = [
    "panel",
    "series",
    "model",
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
SPEEDS = {"a": (50.0, 550.0), "b": (260.0, 1000.0)}
TICKS = {"a": (50, 70, 100, 150, 200, 300, 400), "b": (300, 400, 500, 600, 800)}
POINTS = 81
_TITLES = {"a": "(a) Coated beads", "b": "(b) Bare steel beads"}

CAPTION = style.paragraph("""
Speed between the gauges against contact force above rest. Marks: simulated, striker at 0.02 to 1 m/s (open:
no weight); thin: marks joined; thick: Eq. (7); broken: Eq. (6). Red: printed speeds, 10 % bounds, at the
force simulated there (with loss in (a)), open at the printed reading. Dotted: gauges read 3 N. The paper's
points are not available.
""")
CRACKS = 3.0  # N, reading from which on the paper saw cracks
# Striker of Fig. 3, m/s: where in the sweep the printed speeds stand.
STRUCK = 0.44


def table(simulations: Mapping[str, Simulation]) -> pandas.DataFrame:
    """The numbers drawn; columns as above."""
    found = []
    for name, simulation in simulations.items():
        found += _simulated(name.split(".")[0][-1], simulation)
    for panel in "ab":
        found += _theory(panel, [s for n, s in simulations.items() if n.startswith(f"fig4{panel}.")])
    found += _paper(pandas.DataFrame(found))
    return pandas.DataFrame(found, columns=COLUMNS)


def _simulated(panel: str, simulation: Simulation):
    for lane, speed in enumerate(simulation.speeds):
        run = OneRun(simulation, lane)
        contacts = run.contacts_between_gauges()
        yield {
            "panel": panel,
            "series": "simulated",
            "model": traces.model_of(simulation),
            "modulus_GPa": simulation.card.bead.surface.modulus_Pa / 1e9,
            "orientation": _orientation(simulation),
            "striker_speed_m_s": speed,
            "gauge_N": np.mean([run.view.main(s.id).force for s in run.span]),
            "static_N": np.mean([run.static_force(c) for c in contacts]),
            "force_N": max(main_pulse(run.contact(c)).force for c in contacts),
            "speed_m_s": run.speed().value,
        }


def _orientation(simulation):
    return "vertical" if simulation.card.gravity_m_s2 > 0.0 else "horizontal"


def _theory(panel: str, simulations: list[Simulation]):
    """Eq. (7) for each modulus of a vertical chain, Eq. (6) for each of a horizontal one."""
    force = np.geomspace(*FORCES[panel], POINTS)
    for simulation in (s for s in simulations if not s.card.effects):
        bead, run = simulation.card.bead, OneRun(simulation)
        beads = (bead.surface.modulus_Pa, bead.surface.poisson, bead.diameter_m, bead.mass_kg)
        static = np.mean([run.static_force(c) for c in run.contacts_between_gauges()])
        speed = theory.speed_with_precompression(force + static, static, *beads)
        shared = {
            "panel": panel,
            "series": "eq7" if static > 0.0 else "eq6",
            "model": traces.model_of(simulation),
            "modulus_GPa": bead.surface.modulus_Pa / 1e9,
            "orientation": _orientation(simulation),
            "static_N": static,
        }
        yield from (shared | {"force_N": f, "speed_m_s": v} for f, v in zip(force, speed, strict=True))


def _paper(rows: pandas.DataFrame):
    """What the text prints, at the force of the first vertical sweep of each panel.

    That at 0.25 N stands where the gauges read this, the others where the striker has the speed of Fig. 3.
    """
    reading = PRINTED.amplitude_low
    yield _printed("a", "paper-as-read", PRINTED.speed_low, gauge_N=reading, force_N=reading)
    for panel, speed in (("a", PRINTED.speed_coated), ("b", PRINTED.speed_steel)):
        upright = rows[
            (rows.series == "simulated") & (rows.panel == panel) & (rows.orientation == "vertical")
        ]
        for _, sweep in list(upright.groupby("model", sort=False))[:1]:
            yield from _at(sweep, panel, "paper", "striker_speed_m_s", STRUCK, speed)
            if panel == "a":
                yield from _at(sweep, panel, "paper", "gauge_N", reading, PRINTED.speed_low, gauge_N=reading)
                yield from _at(sweep, panel, "cracks", "gauge_N", CRACKS, np.nan, gauge_N=CRACKS)


def _at(sweep, panel, series, key, value, speed, **where):
    """A printed speed at the force that the sweep has where `key` is `value`; nothing outside the sweep."""
    sweep = sweep.sort_values(key)
    if sweep[key].min() <= value <= sweep[key].max():
        force = np.exp(np.interp(np.log(value), np.log(sweep[key]), np.log(sweep.force_N)))
        yield _printed(panel, series, speed, force_N=force, **where)


def _printed(panel, series, speed, **where):
    error = PRINTED.speed_error * speed
    return {"panel": panel, "series": series, "speed_m_s": speed, "speed_error_m_s": error, **where}


def placed(rows: pandas.DataFrame, table: pandas.DataFrame) -> pandas.DataFrame:
    """Digitised points stand at the contact force that the first sweep of their panel has at that reading."""
    placed = rows.copy()
    for panel, part in rows.groupby("panel"):
        upright = (table.series == "simulated") & (table.panel == panel) & (table.orientation == "vertical")
        sweep = next(iter(table[upright].groupby("model", sort=False)))[1].sort_values("gauge_N")
        force = np.interp(np.log(part.gauge_N), np.log(sweep.gauge_N), np.log(sweep.force_N))
        placed.loc[part.index, "force_N"] = np.exp(force)
    return placed


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
    drawn = table[table.series.isin(["eq6", "eq7"])]
    for (series, model), curve in drawn.groupby(["series", "model"], sort=False):
        line = {"lw": 1.2, "ls": "-"} if series == "eq7" else {"lw": 0.8, "ls": (0, (4, 2))}
        color = looks.look(model).color
        axes.plot(curve.force_N, curve.speed_m_s, color=color, **line, zorder=2, gid=f"{series}-{model}")
        if series == "eq7":
            end = curve.iloc[-1]
            axes.annotate(
                f"{end.modulus_GPa:g} GPa",
                (end.force_N, end.speed_m_s),
                (4, 0),
                textcoords="offset points",
                va="center",
                color=color,
                annotation_clip=False,
            )


def _marks(axes, table):
    simulated = table[table.series == "simulated"]
    theory = set(table.model[table.series.isin(["eq6", "eq7"])])
    for (model, orientation), sweep in simulated.groupby(["model", "orientation"], sort=False):
        look = looks.look(model)
        axes.plot(
            sweep.force_N,
            sweep.speed_m_s,
            # A model without a theory of its own is joined by a line.
            ls="none" if model in theory else "-",
            lw=0.8,
            marker=look.marker,
            ms=3.4,
            mew=0.8,
            color=look.color,
            mfc=look.color if orientation == "vertical" else "white",
            zorder=3 if orientation == "vertical" else 2.5,
            gid=f"simulated-{model}-{orientation}",
        )


_PAPER = {
    "paper": {"marker": "o", "color": "#CC0000", "ms": 5.0, "mew": 1.0},
    "paper-as-read": {"marker": "o", "color": "#CC0000", "ms": 5.0, "mew": 1.0, "mfc": "white"},
    digitised.SERIES: {"marker": "x", "color": "#CC0000", "ms": 4.0, "mew": 1.0},
}


def _paper_marks(axes, table):
    for point in table[table.series.isin(list(_PAPER))].itertuples():
        axes.errorbar(
            point.force_N,
            point.speed_m_s,
            yerr=point.speed_error_m_s,
            **_PAPER[point.series],
            elinewidth=1.0,
            capsize=2.5,
            zorder=4,
        )
    for level in table[table.series == "cracks"].itertuples():
        axes.axvline(level.force_N, ymax=0.68, color=style.GREY, lw=0.8, ls=(0, (1, 1.5)), zorder=0)
        axes.annotate(
            f"gauges read\n{level.gauge_N:g} N: cracks",
            (level.force_N, SPEEDS["a"][0]),
            (-3, 5),
            textcoords="offset points",
            ha="right",
            color=style.GREY,
        )


def _legend(axes, table):
    handles = []
    simulated = table[table.series == "simulated"]
    for (model, orientation), _ in simulated.groupby(["model", "orientation"], sort=False):
        look = looks.look(model)
        label = look.name if orientation == "vertical" else f"{look.name}, no weight"
        face = look.color if orientation == "vertical" else "white"
        mark = {"ls": "none", "marker": look.marker, "ms": 3.4, "mew": 0.8, "color": look.color}
        handles.append(Line2D([], [], **mark, mfc=face, label=label))
    texts = {"paper": "printed speed, simulated force", "paper-as-read": "the same, at the gauge reading"}
    texts[digitised.SERIES] = "read off the paper's figure"
    for series in (s for s in texts if (table.series == s).any()):
        handles.append(Line2D([], [], ls="none", **_PAPER[series], label=texts[series]))
    axes.legend(handles=handles, loc="upper left", borderaxespad=0.1, handlelength=1.0, fontsize=7)
