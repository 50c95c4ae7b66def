"""The benchmark's figures: cost against accuracy, and cost against the length and number of chains.

Drawn from the tables that `workflow/bench/measure.py` writes: bench_accuracy.csv (problem, contestant,
setting, median_s, peak_error, arrival_error_s), bench_length.csv (beads, contestant, median_s) and
bench_lanes.csv (chains, contestant, median_s).
"""

import numpy as np
import pandas
from matplotlib.figure import Figure

from sonicvacuum.figures import style

# Okabe and Ito's colours, marks and dashes by the code's name.
_LOOKS = {
    "engine, default": ("#0072B2", "o", "-"),
    "engine, Runge–Kutta": ("#56B4E9", "D", (0, (5, 1.2))),
    "engine, Verlet": ("#009E73", "^", (0, (5, 1.2, 1, 1.2))),
    "engine, 0.1 µs Verlet": ("#009E73", "^", (0, (5, 1.2, 1, 1.2))),
    "C DOP853": ("#D55E00", "s", (0, (3.5, 1.2))),
    "numbalsoda DOP853": ("#E69F00", "P", (0, (3.5, 1.2, 1, 1.2))),
    "scipy DOP853": ("#CC79A7", "v", (0, (1, 1))),
    "plain Numba, all beads": ("#CC79A7", "v", (0, (1, 1))),
    "limit: C, all beads": ("#000000", "s", (0, (3.5, 1.2))),
}
_GOAL = 1e-6


def draw_accuracy(table: pandas.DataFrame) -> Figure:
    """Time against error for P1 and P3, from bench_accuracy.csv."""
    with style.context():
        figure = style.canvas(style.DOUBLE, 84.0)
        for k, (problem, name) in enumerate((("P1", "(a) One chain"), ("P3", "(b) 1000 chains"))):
            axes = style.panel(figure, (14.0 + 86.0 * k, 27.0, 72.0, 50.0))
            style.title(figure, 14.0 + 86.0 * k, name)
            _accuracy_panel(axes, table[table.problem == problem])
        _legend(figure, 3)
    return figure


def _accuracy_panel(axes, rows):
    axes.axvline(_GOAL, color=style.BAND, lw=3.0, zorder=0)
    for name, points in rows.groupby("contestant", sort=False):
        points = points.sort_values("setting")
        _line(axes, points.peak_error, points.median_s, name)
        if name == "engine, default":
            chosen = points[points.setting == 1.0]
            color = _LOOKS[name][0]
            axes.plot(chosen.peak_error, 1e3 * chosen.median_s, "o", ms=8, mfc="none", mec=color, mew=0.8)
    axes.invert_xaxis()
    axes.set_xlabel("largest relative error of the peak force")
    axes.set_ylabel("time (ms)")


def draw_cost(length: pandas.DataFrame, lanes: pandas.DataFrame) -> Figure:
    """Time against length and number of chains, from bench_length.csv and bench_lanes.csv."""
    with style.context():
        figure = style.canvas(style.DOUBLE, 79.0)
        panels = (("(a) Length", length, "beads"), ("(b) Number", lanes, "chains"))
        for k, (name, table, what) in enumerate(panels):
            axes = style.panel(figure, (14.0 + 86.0 * k, 22.0, 72.0, 50.0))
            style.title(figure, 14.0 + 86.0 * k, name)
            _cost_panel(axes, table, what)
        engine = lanes[lanes.contestant == "engine, default"].sort_values("chains")
        number, seconds = engine.chains.to_numpy(float), engine.median_s.to_numpy()
        proportion = 1e3 * seconds[-1] / number[-1] * number
        axes.plot(number, proportion, color=style.GREY, lw=0.6, zorder=0)
        _legend(figure, 4)
    return figure


def _cost_panel(axes, table, what):
    for name, points in table.groupby("contestant", sort=False):
        points = points.sort_values(what)
        _line(axes, points[what], points.median_s, name)
    axes.set_xlabel(f"{what} in the chain" if what == "beads" else what)
    axes.set_ylabel("time (ms)")
    axes.set_xlim(0.7 * np.min(table[what]), 1.4 * np.max(table[what]))


def _line(axes, x, seconds, name):
    color, marker, dashes = _LOOKS[name]
    milliseconds = 1e3 * np.asarray(seconds)
    axes.loglog(
        np.asarray(x, float), milliseconds, color=color, marker=marker, ls=dashes, ms=3, lw=1, label=name
    )


def _legend(figure, columns):
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=columns, handlelength=3.2, borderaxespad=0.3)
