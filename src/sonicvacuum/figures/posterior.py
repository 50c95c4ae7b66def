"""Posteriors of a verdict's parameters: how well the data say each, beside the range that was searched.

The numbers stand in `posterior.csv`, which discover writes, and in `parameters.csv`, made from that,
`verdict.json` and the catalogue before anything is drawn.
"""

import json
import math
from pathlib import Path

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.draws import AVERAGED, SAMPLED, Draws, pareto_k, read
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.figures.colours import BAND, BLUE, GREY, ORANGE
from sonicvacuum.figures.drawing import DOUBLE, Drawing, Stroke
from sonicvacuum.figures.frame import Frame, Scale
from sonicvacuum.tables import write_csv

COLUMNS = ("effect", "parameter", "unit", "value", "sigma", "low", "high", "off")
# The 90 % interval, and how it was found: `sampled`, `profile` or, of a folder without draws, `gaussian`.
INTERVAL = ("from_90", "to_90", "how", "effective", "pareto_k")
_BINS = 24
_UNITS = {"um": "µm", "us": "µs", "1/s": "s⁻¹", "N (s/m)^alpha": "N (s/m)^α"}
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
        if key != one.sits
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
    if draws.how != SAMPLED:
        return [*ends, draws.how, "", ""]
    return [*ends, draws.how, f"{draws.effective:.0f}", f"{pareto_k(draws.weight):.2g}"]


def parameters(
    table: list[dict[str, str]],
    draws: dict[tuple[str, str], Draws] | None = None,
    catalogue: Catalogue = CATALOGUE,
) -> Drawing | None:
    """For each parameter its density on the left and the range searched on the right; None without any."""
    if not table:
        return None
    page = Drawing(DOUBLE, _HIGH * len(table) + 3.0)
    for k, row in enumerate(table):
        bottom = _HIGH * (len(table) - 1 - k) + 11.0
        own = (draws or {}).get((row["effect"], row["parameter"]))
        what = catalogue.effect(row["effect"]).parameter(row["parameter"]).help
        _density(page, (8.0, bottom, 70.0, 12.0), row, own, f"{row['effect']}: {what}")
        _range(page, (95.0, bottom, 74.0, 12.0), row)
    return page


def _density(page, box, row, draws: Draws | None, name):
    """The draws, or the profile, with the 90 % interval shaded; the Gaussian of value and error beside it."""
    value, sigma, low, high = (float(row[c]) for c in ("value", "sigma", "from_90", "to_90"))
    x, gaussian = density(row)
    edges, heights = _heights(draws, x) if draws is not None else (None, np.zeros(1))
    top = 1.05 * max(float(heights.max()), float(gaussian.max()) if sigma > 0.0 else 0.0, 1e-300)
    frame = Frame(page, box, Scale(x[0], x[-1]), Scale(0.0, top))
    if edges is not None:
        inside = (edges[1:] > low) & (edges[:-1] < high)
        shaded = np.where(inside, heights, 0.0)
        steps = np.repeat(edges, 2)[1:-1]
        frame.fill(steps, 0.0, np.repeat(shaded, 2), BAND)
        frame.curve(
            np.repeat(edges, 2), np.concatenate([[0.0], np.repeat(heights, 2), [0.0]]), Stroke(BLUE, 1.0)
        )
    if sigma > 0.0:
        if edges is None:
            inside = np.abs(x - value) <= policy.NINETY * sigma
            frame.fill(x[inside], 0.0, gaussian[inside], BAND)
        look = Stroke(BLUE, 1.0) if edges is None else Stroke(ORANGE, 1.0, (3.5, 1.2))
        frame.curve(x, gaussian, look)
    frame.curve([value, value], [0.0, top], Stroke(BLUE, 0.8))
    unit = "" if row["unit"] == "1" else f" ({_UNITS.get(row['unit'], row['unit'])})"
    frame.bottom(f"{name}{unit}")


def density(row: dict[str, str]) -> tuple[np.ndarray, np.ndarray]:
    """Values around a parameter's interval, and the Gaussian of its value and error there, 1 at its top."""
    value, sigma, low, high = (float(row[c]) for c in ("value", "sigma", "from_90", "to_90"))
    width = max(sigma, 0.5 * (high - low)) or max(abs(value), 1.0)
    x = np.linspace(min(low, value) - 2.0 * width, max(high, value) + 2.0 * width, 401)
    return x, np.exp(-0.5 * ((x - value) / sigma) ** 2) if sigma > 0.0 else np.zeros_like(x)


def _heights(draws, x):
    """Edges and heights of bars over the range drawn: of the weights of draws, or of a profile at its values;
    as high as a Gaussian of height 1 with the same area.
    """
    if draws.how not in (SAMPLED, AVERAGED):
        middle = 0.5 * (draws.value[1:] + draws.value[:-1])
        edges = np.concatenate([draws.value[:1], middle, draws.value[-1:]])
        return np.sort(edges), (draws.weight / draws.weight.max())[:: 1 if edges[-1] > edges[0] else -1]
    heights, edges = np.histogram(draws.value, _BINS, (x[0], x[-1]), weights=draws.weight, density=True)
    mean = draws.weight @ draws.value
    spread = math.sqrt(draws.weight @ np.square(draws.value - mean))
    return edges, heights * math.sqrt(2.0 * math.pi) * spread


def _range(page, box, row):
    """The range searched, logarithmic where it spans decades; value with its 90 % interval; cross: off."""
    value, low, high = (float(row[c]) for c in ("value", "low", "high"))
    log = low > 0.0 and high / low > 30.0
    begin, end = max(float(row["from_90"]), low if log else -math.inf), float(row["to_90"])
    marks = [x for x in (low, high, begin, end, value) if x > 0.0 or not log]
    off = row["off"]
    crossed = bool(off) and math.isfinite(float(off)) and (not log or float(off) > 0.0)
    scale = Scale.over([*marks, *([float(off)] if crossed else [])], log=log)
    frame = Frame(page, box, scale, Scale(-1.0, 1.0))
    frame.curve([low, high], [0.0, 0.0], Stroke(BAND, 5.0))
    frame.curve([begin, end], [0.0, 0.0], Stroke(BLUE, 1.4))
    frame.dots([value], [0.0], 4.0, BLUE, Stroke(BLUE, 0.6))
    if crossed:
        frame.cross(float(off), 0.0, 5.0, Stroke(ORANGE, 1.2))
    frame.bottom("range searched", color=GREY)
