"""The free-form contact law of a verdict: what it has beside the nominal force, with its standard error.

Drawn from law.csv, over compressions and rates that contacts went through; lines for three rates over the
compression, and for three compressions over the rate.
"""

import numpy as np

from sonicvacuum.figures.style import BLUE, DOUBLE, GREEN, GREY, ORANGE, canvas, panel

COLOURS = (BLUE, ORANGE, GREEN)
STYLES = ("-", (0, (3.5, 1.2)), (0, (1.0, 1.0)))


def law(table: list[dict[str, str]]):
    """Two panels; None without a table."""
    if not table:
        return None
    columns = {name: np.array([float(r[name]) for r in table]) for name in table[0]}
    depth, rate = (np.unique(columns[name]) for name in ("depth_um", "speed_m_s"))
    shape = (len(depth), len(rate))
    beside = (columns["force_N"] - columns["hertz_N"]).reshape(shape)
    band, visited = columns["band_N"].reshape(shape), columns["visited"].reshape(shape) > 0
    figure = canvas(DOUBLE, 62.0)
    left = panel(figure, (16.0, 12.0, 0.5 * DOUBLE - 24.0, 44.0))
    right = panel(figure, (0.5 * DOUBLE + 12.0, 12.0, 0.5 * DOUBLE - 18.0, 44.0))
    for k, at in enumerate(_spread(visited.any(axis=0))):
        label = f"{'' if k else 'rate '}{_signed(rate[at])} m/s"
        _line(left, k, depth, beside[:, at], band[:, at], visited[:, at], label)
    for k, at in enumerate(_spread(visited.any(axis=1), first=1)):
        label = f"{'' if k else 'compression '}{depth[at]:.2g} µm"
        _line(right, k, rate, beside[at], band[at], visited[at], label)
    for axes, label in ((left, "compression (µm)"), (right, "rate of compression (m/s)")):
        axes.axhline(0.0, color=GREY, lw=0.6)
        axes.set_xlabel(label)
        # Above the panel: inside it, the bands leave no room.
        axes.legend(
            loc="lower center",
            bbox_to_anchor=(0.5, 1.0),
            ncol=3,
            fontsize=7,
            columnspacing=1.0,
            borderaxespad=0.2,
        )
    left.set_ylabel("force beside nominal (N)")
    return figure


def _signed(rate):
    return f"{rate:+.2g}".replace("-", "−") if abs(rate) > 1e-9 else "0"


def _spread(there, first=0):
    """Three of the places where something is: near both ends and in the middle."""
    places = np.flatnonzero(there)[first:]
    return [places[round(share * (len(places) - 1))] for share in (0.2, 0.5, 0.8)] if len(places) else []


def _line(axes, k, x, value, error, visited, label):
    shown, low, high = (np.where(visited, v, np.nan) for v in (value, value - error, value + error))
    axes.fill_between(x, low, high, color=COLOURS[k], alpha=0.25, lw=0)
    axes.plot(x, shown, color=COLOURS[k], ls=STYLES[k], lw=1.0, label=label)
