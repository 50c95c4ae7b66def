"""Posteriors of a verdict's parameters: how well the data say each, beside the range that was searched.

The numbers stand in `posterior.csv`, which discover writes, and in `parameters.csv`, made from that,
`verdict.json` and the catalogue before anything is drawn.
"""

import json
import math
from pathlib import Path

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.draws import PROFILE, Draws, pareto_k, read
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.figures.style import BAND, BLUE, DOUBLE, GREY, ORANGE, canvas, panel
from sonicvacuum.tables import write_csv

COLUMNS = ("effect", "parameter", "unit", "value", "sigma", "low", "high", "off")
# The 90 % interval, and how it was found: `sampled`, `profile` or, of a folder without draws, `gaussian`.
INTERVAL = ("from_90", "to_90", "how", "effective", "pareto_k")
_BINS = 24
_HIGH = 24.0


def write_table(folder: Path, catalogue: Catalogue = CATALOGUE) -> Path:
    """Write `parameters.csv` beside a verdict: one row for each continuous parameter; `off` empty without."""
    verdict = json.loads((folder / "verdict.json").read_text(encoding="utf-8"))
    path, draws = folder / "parameters.csv", read(folder)
    given = verdict["parameters"].items()
    cells = (
        [name, key, *_row(one.parameter(key), found), *_interval(found, draws.get((name, key)))]
        for name, values in given
        for one in (catalogue.effect(name),)
        for key, found in values.items()
        if key != one.places
    )
    write_csv(path, (*COLUMNS, *INTERVAL), cells)
    return path


def _row(parameter, found):
    off = parameter.off
    shown = "" if off is None or callable(off) else f"{off:g}"
    numbers = (found["value"], found["sigma"], parameter.low, parameter.high)
    return [parameter.unit, *(f"{x:.9g}" for x in numbers), shown]


def _interval(found, draws: Draws | None):
    if draws is None:
        half = policy.NINETY * found["sigma"]
        return [f"{found['value'] - half:.9g}", f"{found['value'] + half:.9g}", "gaussian", "", ""]
    ends = [f"{draws.quantile(share):.9g}" for share in (0.05, 0.95)]
    if draws.how == PROFILE:
        return [*ends, draws.how, "", ""]
    return [*ends, draws.how, f"{draws.effective:.0f}", f"{pareto_k(draws.weight):.2g}"]


def parameters(table: list[dict[str, str]], draws: dict[tuple[str, str], Draws] | None = None):
    """For each parameter its density on the left and the range searched on the right; None without any."""
    if not table:
        return None
    figure = canvas(DOUBLE, _HIGH * len(table) + 3.0)
    for k, row in enumerate(table):
        bottom = _HIGH * (len(table) - 1 - k) + 11.0
        own = (draws or {}).get((row["effect"], row["parameter"]))
        _density(panel(figure, (8.0, bottom, 70.0, 12.0)), row, own)
        _range(panel(figure, (95.0, bottom, 74.0, 12.0)), row)
    return figure


def _density(axes, row, draws: Draws | None):
    """The draws, or the profile, with the 90 % interval shaded; the Gaussian of value and error beside it."""
    value, sigma, low, high = (float(row[c]) for c in ("value", "sigma", "from_90", "to_90"))
    width = max(sigma, 0.5 * (high - low)) or max(abs(value), 1.0)
    x = np.linspace(min(low, value) - 2.0 * width, max(high, value) + 2.0 * width, 401)
    if draws is not None:
        edges, heights = _heights(draws, x)
        inside = (edges[1:] > low) & (edges[:-1] < high)
        axes.stairs(np.where(inside, heights, 0.0), edges, fill=True, color=BAND, lw=0)
        axes.stairs(heights, edges, color=BLUE, lw=1.0)
    if sigma > 0.0:
        y = np.exp(-0.5 * ((x - value) / sigma) ** 2)
        if draws is None:
            inside = np.abs(x - value) <= policy.NINETY * sigma
            axes.fill_between(x[inside], y[inside], color=BAND, lw=0)
        axes.plot(
            x,
            y,
            color=BLUE if draws is None else ORANGE,
            lw=1.0,
            ls="-" if draws is None else (0, (3.5, 1.2)),
        )
    axes.axvline(value, color=BLUE, lw=0.8)
    _bare(axes)
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(0.0, None)
    unit = "" if row["unit"] == "1" else f" ({row['unit'].replace('um', 'µm').replace('us', 'µs')})"
    axes.set_xlabel(f"{row['effect']}: {row['parameter']}{unit}")


def _heights(draws, x):
    """Edges and heights of bars over the range drawn: of the weights of draws, or of a profile at its values;
    as high as a Gaussian of height 1 with the same area.
    """
    if draws.how == PROFILE:
        middle = 0.5 * (draws.value[1:] + draws.value[:-1])
        edges = np.concatenate([draws.value[:1], middle, draws.value[-1:]])
        return np.sort(edges), (draws.weight / draws.weight.max())[:: 1 if edges[-1] > edges[0] else -1]
    heights, edges = np.histogram(draws.value, _BINS, (x[0], x[-1]), weights=draws.weight, density=True)
    mean = draws.weight @ draws.value
    spread = math.sqrt(draws.weight @ np.square(draws.value - mean))
    return edges, heights * math.sqrt(2.0 * math.pi) * spread


def _range(axes, row):
    """The range searched, logarithmic where it spans decades; value with its 90 % interval; cross: off."""
    value, low, high = (float(row[c]) for c in ("value", "low", "high"))
    axes.plot([low, high], [0.0, 0.0], color=BAND, lw=5.0, solid_capstyle="butt")
    if low > 0.0 and high / low > 30.0:
        axes.set_xscale("log")
    least = low if axes.get_xscale() == "log" else -math.inf
    axes.plot([max(float(row["from_90"]), least), float(row["to_90"])], [0.0, 0.0], color=BLUE, lw=1.4)
    axes.plot([value], [0.0], "o", color=BLUE, ms=4)
    off = row["off"]
    if off and math.isfinite(float(off)) and (axes.get_xscale() == "linear" or float(off) > 0.0):
        axes.plot([float(off)], [0.0], "x", color=ORANGE, ms=5, mew=1.2)
    _bare(axes)
    axes.set_ylim(-1.0, 1.0)
    axes.set_xlabel("range searched", color=GREY)


def _bare(axes):
    """No axis of heights: they are only shapes."""
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
