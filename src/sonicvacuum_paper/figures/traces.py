"""Stacked traces: gauge readings above one another, as in Figs. 3 and 5 of the paper, with bars for scale.

Table, one row per point: panel, series, sensor, model (variant of the case), modulus_GPa, pulse, time_us,
time_error_us, force_N,
speed_m_s. Series: `simulated` (a reading until the reflection comes back, at the wall from the top),
`reflected` (the same afterwards), `peak` (separate pulses before that, numbered; the main one of the
lower gauge carries the speed from the upper one), `small` (the first smaller one after
a train of three), `paper-arrival` and `paper-duration` (printed values,
placed by the main pulse of the upper gauge), `digitised` (read off the paper's figure by somebody).
"""

import re

import numpy as np
import pandas
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from sonicvacuum.figures import style
from sonicvacuum.gauges import Gauge
from sonicvacuum.observe.pulse import pulses
from sonicvacuum.observe.shape import onset
from sonicvacuum.simulation import Simulation
from sonicvacuum_paper import digitised
from sonicvacuum_paper.figures import looks
from sonicvacuum_paper.one_run import OneRun
from sonicvacuum_paper.printed import PRINTED

COLUMNS = [
    "panel",
    "series",
    "sensor",
    "model",
    "modulus_GPa",
    "pulse",
    "time_us",
    "time_error_us",
    "force_N",
    "speed_m_s",
]
POINTS = 600  # per trace: two for each pixel of a column on a screen
HEIGHT = 106.0  # mm
# Lowest later peak that counts in a train, of the main one; as in the ledger.
TRAIN = 0.05
# Lowest rise of what is named as following the train, of the main pulse.
SMALL = 0.01


def rows(panel: str, simulation: Simulation, until_us: float, rise: float = SMALL) -> list[dict]:
    """The traces of a card's gauges until a time, with their peaks: those that rise by `rise` of the main."""
    run = OneRun(simulation)
    modulus = simulation.card.bead.surface.modulus_Pa / 1e9
    found = []
    for sensor in run.gauges:
        shared = {"panel": panel, "sensor": sensor.id, "model": model_of(simulation), "modulus_GPa": modulus}
        found += [shared | point for point in _trace(run, sensor, until_us)]
        found += [shared | peak for peak in _peaks(run, sensor, until_us, rise)]
    return found


def paper_rows(
    panel: str, simulation: Simulation, speed: float, duration_us: float | None = None
) -> list[dict]:
    """Printed speed (m/s) and duration, where the simulated pulse would show them.

    The arrival at the lower gauge that the printed speed means, counted from the simulated peak at the upper
    one, and the printed duration centred on that peak.
    """
    view, (upper, lower) = OneRun(simulation).view, OneRun(simulation).span
    start = 1e6 * view.main(upper.id).time
    travel = 1e6 * (view.geometry.position(upper.id) - view.geometry.position(lower.id)) / speed
    modulus = simulation.card.bead.surface.modulus_Pa / 1e9
    shared = {"panel": panel, "model": model_of(simulation), "modulus_GPa": modulus}
    arrival = {
        "series": "paper-arrival",
        "sensor": lower.id,
        "time_us": start + travel,
        "time_error_us": PRINTED.speed_error * travel,
        "force_N": view.main(lower.id).force,
        "speed_m_s": speed,
    }
    found = [shared | arrival]
    if duration_us is not None:
        ends = (start - 0.5 * duration_us, start + 0.5 * duration_us)
        found += [
            shared | {"series": "paper-duration", "sensor": upper.id, "time_us": t, "force_N": 0.0}
            for t in ends
        ]
    return found


def model_of(simulation: Simulation) -> str:
    """Variant of its case that a card is."""
    return simulation.card.name.split(".")[1]


def frame(found: list[dict]) -> pandas.DataFrame:
    """The rows as a table, forces below 1e-9 N as zero."""
    table = pandas.DataFrame(found, columns=COLUMNS)
    return table.assign(force_N=table.force_N.round(9) + 0.0, time_us=table.time_us.round(6) + 0.0)


def _trace(run: OneRun, sensor: Gauge, until_us: float):
    trace, end = run.view.trace(sensor.id), _free_until(run, sensor) * 1e6
    time = trace.interval * 1e6 * np.arange(len(trace.force))
    step = int(np.ceil(np.count_nonzero(time <= until_us) / POINTS))
    before = 0.0
    for t, force in zip(time[::step], trace.force[::step], strict=True):
        if t > until_us:
            return
        point = {"time_us": t, "force_N": force}
        if before <= end < t:
            yield {"series": "simulated", **point}  # joins the two lines
        yield {"series": "reflected" if t > end else "simulated", **point}
        before = t


def _free_until(run: OneRun, sensor: Gauge) -> float:
    """Foot of the reflection (at the wall: of the wave back from the top) in s; infinite where not known.

    The main pulse's return, less 2.5 times its rise from half height.
    """
    main, back = run.view.main(sensor.id), run.view.reflection_time(sensor.id)
    if not (main.found and back.known):
        return np.inf
    rise = main.time - onset(run.view.trace(sensor.id), main, 0.5).value
    return back.value - 2.5 * rise


def _peaks(run: OneRun, sensor: Gauge, until_us: float, rise: float):
    trace, main = run.view.trace(sensor.id), run.view.main(sensor.id)
    end = min(_free_until(run, sensor), until_us * 1e-6)
    counted = pulses(trace, main, end, TRAIN, rise)
    for number, pulse in enumerate(counted, start=1):
        peak = {"series": "peak", "pulse": number, "time_us": 1e6 * pulse.time, "force_N": pulse.force}
        if number == 1 and run.span and sensor == run.span[1]:
            peak["speed_m_s"] = run.speed().value
        yield peak
    # By its rise and not its height: the gauges' discharge has drawn the line below zero by then.
    later = [p for p in pulses(trace, main, end, -np.inf, SMALL) if counted and p.time > counted[-1].time]
    if len(counted) > 2 and later:
        small = {"series": "small", "pulse": len(counted) + 1, "force_N": later[0].force}
        yield {**small, "time_us": 1e6 * later[0].time}


def draw(table: pandas.DataFrame, bars: dict[str, tuple[float, float]]) -> Figure:
    """Panels (a) and (b) side by side, each with its bars of force (N) and time (µs)."""
    with style.context():
        figure = style.canvas(style.DOUBLE, HEIGHT)
        for panel, left, title in (("a", 16.0, "(a) Coated beads"), ("b", 104.5, "(b) Bare steel beads")):
            part = table[table.panel == panel]
            axes = style.panel(figure, (left, 10.0, 66.0, 70.0))
            draw_panel(axes, part, *bars[panel])
            legend(axes, part)
            style.title(figure, left - 15.0, title)
    return figure


def draw_panel(axes: Axes, table: pandas.DataFrame, force_bar: float, time_bar: float) -> dict[str, float]:
    """Draw the rows of one panel; returns the height of each gauge's base line in the axes' newtons."""
    bases = base_lines(table)
    _lines(axes, table, bases)
    _paper(axes, table, bases)
    points(axes, table, bases)
    number(axes, table, bases)
    # The last sample may lie just before the round end of the axis.
    until = 50.0 * np.ceil(table.time_us.max() / 50.0)
    top = max(bases.values()) + 1.05 * table.force_N[table.sensor == next(iter(bases))].max()
    axes.set(xlim=(0.0, until), ylim=(-0.06 * top, top), yticks=[])
    axes.set_xlabel("Time after impact (µs)")
    axes.spines["left"].set_visible(False)
    _scale_bars(axes, table.panel.iloc[0], until, bases, force_bar, time_bar)
    return bases


def legend(axes: Axes, table: pandas.DataFrame) -> None:
    """One line for each model, with its simulated speed, and one for the printed speed, above the panel."""
    handles = []
    for model, traces in table[table.series == "peak"].groupby("model", sort=False):
        look, speed = looks.look(model), traces.speed_m_s.dropna()
        text = f": {speed.iloc[0]:.0f} m/s" if len(speed) else ""
        handles.append(Line2D([], [], **look.line, label=look.name + text))
    for mark in table[table.series == "paper-arrival"].itertuples():
        label = f"printed in the paper: {mark.speed_m_s:.0f} m/s ± {100 * PRINTED.speed_error:.0f} %"
        handles.append(Line2D([], [], **_MARK, ms=7, label=label))
    axes.legend(
        handles=handles, loc="upper left", bbox_to_anchor=(-0.01, 1.26), borderaxespad=0, handlelength=2.4
    )


BASE_LINE = "#bfbfbf"
# Room between two gauges, of the sum of their heights.
GAP = 0.14
_MARK = {"color": "black", "lw": 0.9, "marker": "|", "mew": 1.2}


def base_lines(table: pandas.DataFrame) -> dict[str, float]:
    """Gauge → base line in the axes' newtons.

    The lowest gauge stands at 0, each other one above the highest force of the one below it.
    """
    order = list(dict.fromkeys(table.sensor))
    heights = table.groupby("sensor").force_N.max()
    gap = GAP * heights.sum()
    bases, level = {}, 0.0
    for sensor in reversed(order):
        bases[sensor] = level
        level += heights[sensor] + gap
    return {sensor: bases[sensor] for sensor in order}


def _lines(axes, table, bases):
    for sensor, base in bases.items():
        axes.axhline(base, color=BASE_LINE, lw=0.5, zorder=0.5)
        axes.annotate(
            label_of(sensor),
            (0, base),
            (-4, 0),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            ha="right",
            va="center",
            annotation_clip=False,
        )
    drawn = table[table.series.isin(["simulated", "reflected"])]
    models = list(dict.fromkeys(drawn.model))
    for (sensor, series, model), part in drawn.groupby(["sensor", "series", "model"], sort=False):
        look = looks.look(model)
        axes.plot(
            part.time_us,
            part.force_N + bases[sensor],
            **(look.line if series == "simulated" else look.pale),
            zorder=3.0 - 0.1 * models.index(model),
            gid=f"{series}-{sensor}-{model}",
        )


def points(axes: Axes, table: pandas.DataFrame, bases: dict[str, float]) -> None:
    """What somebody read off the paper's figure, as crosses on the base line of its gauge."""
    read = table[table.series == digitised.SERIES]
    for sensor, part in read.groupby("sensor"):
        axes.plot(
            part.time_us, part.force_N + bases[sensor], "x", color="#CC0000", ms=3.0, mew=0.8, gid="digitised"
        )


def label_of(sensor: str) -> str:
    """`g9` → "9th bead"; the wall and other names as they are."""
    found = re.fullmatch(r"g(\d+)", sensor)
    return f"{found.group(1)}th bead" if found else sensor


def _paper(axes, table, bases):
    gap = GAP * table.groupby("sensor").force_N.max().sum()
    for mark in table[table.series == "paper-arrival"].itertuples():
        level = bases[mark.sensor] + table.force_N[table.sensor == mark.sensor].max() + 0.33 * gap
        axes.errorbar(
            mark.time_us,
            level,
            xerr=mark.time_error_us,
            capsize=1.5,
            capthick=0.9,
            elinewidth=0.9,
            ms=6,
            zorder=4,
            **_MARK,
        )
    bar = table[table.series == "paper-duration"]
    if len(bar):
        level = bases[bar.sensor.iloc[0]] - 0.45 * gap
        axes.plot(bar.time_us, [level, level], color="black", lw=0.9, marker="|", ms=4, mew=0.9, zorder=4)
        length = bar.time_us.max() - bar.time_us.min()
        axes.annotate(
            f"{length:.0f} µs (paper)",
            (bar.time_us.min(), level),
            (-4, 0),
            textcoords="offset points",
            ha="right",
            va="center",
            fontsize=7,
        )


def number(axes: Axes, table: pandas.DataFrame, bases: dict[str, float]) -> None:
    """Number the waves of each train at the lowest gauge."""
    peaks = table[table.series.isin(["peak", "small"]) & (table.sensor == list(bases)[-1])]
    # Numbers of a lower train would lie on the lines of the highest.
    highest = peaks.model[peaks.force_N.idxmax()] if len(peaks) else None
    for model, train in peaks[peaks.model == highest].groupby("model", sort=False):
        for peak in train.itertuples() if len(train) > 1 else ():
            axes.annotate(
                f"{peak.pulse:.0f}" if peak.series == "peak" else f"({peak.pulse:.0f})",
                (peak.time_us, bases[peak.sensor] + peak.force_N),
                (0, 2),
                textcoords="offset points",
                ha="center",
                va="bottom",
                color=looks.look(model).color,
                fontweight="bold",
                fontsize=7,
            )


def _scale_bars(axes, panel, until, bases, force, time):
    """An upright bar of `force` N and a level one of `time` µs from one corner, left of the wall's pulse."""
    x = 0.1 * until
    y = min(bases.values()) + 0.12 * axes.get_ylim()[1]
    line = {"color": "black", "lw": 1.2, "solid_capstyle": "butt"}
    axes.plot([x, x], [y, y + force], **line, gid=f"force-bar-{panel}")
    axes.plot([x, x + time], [y, y], **line, gid=f"time-bar-{panel}")
    near = {"textcoords": "offset points", "fontsize": 7}
    axes.annotate(f"{force:g} N", (x, y + force / 2), (-3, 0), ha="right", va="center", **near)
    axes.annotate(f"{time:g} µs", (x + time / 2, y), (0, -2), ha="center", va="top", **near)
