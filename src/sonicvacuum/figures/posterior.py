"""Posteriors of a verdict's parameters: how well the data say each, beside the range that was searched.

The numbers stand in `parameters.csv`, made from `verdict.json` and the catalogue before anything is drawn.
"""

import json
import math
from pathlib import Path

import numpy as np

from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.figures.style import BAND, DOUBLE, GREY, canvas, panel
from sonicvacuum.tables import write_csv

COLUMNS = ("effect", "parameter", "unit", "value", "sigma", "low", "high", "off")
BLUE, ORANGE = "#0072B2", "#D55E00"
# Half width of a 90 % interval in standard errors.
NINETY = 1.645
_HIGH = 24.0


def write_table(folder: Path, catalogue: Catalogue = CATALOGUE) -> Path:
    """Write `parameters.csv` beside a verdict: one row for each continuous parameter; `off` empty without."""
    verdict = json.loads((folder / "verdict.json").read_text(encoding="utf-8"))
    path = folder / "parameters.csv"
    given = verdict["parameters"].items()
    cells = (
        [name, key, *_row(one.parameter(key), found)]
        for name, values in given
        for one in (catalogue.effect(name),)
        for key, found in values.items()
        if key != one.places
    )
    write_csv(path, COLUMNS, cells)
    return path


def _row(parameter, found):
    off = parameter.off
    shown = "" if off is None or callable(off) else f"{off:g}"
    numbers = (found["value"], found["sigma"], parameter.low, parameter.high)
    return [parameter.unit, *(f"{x:.9g}" for x in numbers), shown]


def parameters(table: list[dict[str, str]]):
    """For each parameter its density on the left and the range searched on the right; None without any."""
    if not table:
        return None
    figure = canvas(DOUBLE, _HIGH * len(table) + 3.0)
    for k, row in enumerate(table):
        bottom = _HIGH * (len(table) - 1 - k) + 11.0
        numbers = [float(row[c]) for c in ("value", "sigma", "low", "high")]
        _density(panel(figure, (8.0, bottom, 70.0, 12.0)), row, *numbers[:2])
        _range(panel(figure, (95.0, bottom, 74.0, 12.0)), row["off"], *numbers)
    return figure


def _density(axes, row, value, sigma):
    """Gaussian of value and standard error, its 90 % interval shaded."""
    unit = "" if row["unit"] == "1" else f" ({row['unit'].replace('um', 'µm').replace('us', 'µs')})"
    width = sigma if sigma > 0.0 else max(abs(value), 1.0)
    x = np.linspace(value - 4.0 * width, value + 4.0 * width, 401)
    if sigma > 0.0:
        y = np.exp(-0.5 * ((x - value) / sigma) ** 2)
        inside = np.abs(x - value) <= NINETY * sigma
        axes.fill_between(x[inside], y[inside], color=BAND, lw=0)
        axes.plot(x, y, color=BLUE, lw=1.0)
    axes.axvline(value, color=BLUE, lw=0.8)
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(0.0, 1.15)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.set_xlabel(f"{row['effect']}: {row['parameter']}{unit}")


def _range(axes, off, value, sigma, low, high):
    """The range searched, logarithmic where it spans decades; value with its 90 % interval; cross: off."""
    axes.plot([low, high], [0.0, 0.0], color=BAND, lw=5.0, solid_capstyle="butt")
    if low > 0.0 and high / low > 30.0:
        axes.set_xscale("log")
        least = low
    else:
        least = -math.inf
    ends = [max(value - NINETY * sigma, least), value + NINETY * sigma]
    axes.plot(ends, [0.0, 0.0], color=BLUE, lw=1.4)
    axes.plot([value], [0.0], "o", color=BLUE, ms=4)
    if off and math.isfinite(float(off)) and (axes.get_xscale() == "linear" or float(off) > 0.0):
        axes.plot([float(off)], [0.0], "x", color=ORANGE, ms=5, mew=1.2)
    axes.set_ylim(-1.0, 1.0)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.set_xlabel("range searched", color=GREY)
