"""Points that somebody read off the paper's figures, with who, how and by which scale; none are kept here.

A file of `workflow/resources/digitised` (format there, in README.md) is checked like a record of measured
data: closed schema, one sentence for each fault. `paper draw` puts its points into the figure, and what
each model leaves of them is told as chi²/N.
"""

import math
from typing import Annotated, Literal

import msgspec
import numpy as np
import pandas as pd
from msgspec import Meta, Struct

from sonicvacuum.files import InputError, check_values, convert, read_yaml

SERIES = "digitised"
# Figure → panels, and what stands on its axes.
AXES = {
    "fig3": ("time_us", "force_N"),
    "fig4": ("gauge_N", "speed_m_s"),
    "fig5": ("time_us", "force_N"),
    "fig6": ("time_us", "force_N"),
}
Text = Annotated[str, Meta(min_length=3)]
Spread = Annotated[float, Meta(gt=0)]


class _Block(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    pass


class Provenance(_Block):
    """Who read the points, how, and by which scale."""

    who: Text
    how: Text
    scale: Text
    date: Annotated[str, Meta(pattern=r"^\d{4}-\d{2}-\d{2}$")]


class Errors(_Block):
    """Standard errors of one point in the units of the axes, scale included."""

    x: Spread
    y: Spread


class Digitised(_Block):
    """One set of points of one panel; a trace names its gauge."""

    format: Literal[1]
    figure: Literal["fig3", "fig4", "fig5", "fig6"]
    panel: Literal["a", "b"]
    what: Text
    provenance: Provenance
    error: Errors
    points: Annotated[list[tuple[float, float]], Meta(min_length=1)]
    sensor: Literal["g9", "g5", "wall"] | None = None


def read(path) -> Digitised:
    """The points in a file; InputError names file, key, value and cure."""
    content = read_yaml(path)
    check_values(content, path)
    found = convert(content, Digitised, path)
    trace = found.figure != "fig4"
    if trace and found.sensor is None:
        raise InputError(f"{path}: sensor: is missing; a trace of {found.figure} needs g9, g5 or wall")
    if not trace and found.sensor is not None:
        raise InputError(f"{path}: sensor: is {found.sensor!r}; points of fig4 have none: drop the key")
    if found.figure == "fig6" and found.sensor != "wall":
        raise InputError(f"{path}: sensor: is {found.sensor!r}; fig6 shows the wall alone: write wall")
    if not trace and min(value for point in found.points for value in point) <= 0.0:
        raise InputError(f"{path}: points: forces and speeds of fig4 must be positive; remove the others")
    return found


def rows(points: Digitised) -> list[dict]:
    """Rows for the table of its figure."""
    x, y = AXES[points.figure]
    shared = {"panel": points.panel, "series": SERIES, "model": SERIES}
    if points.sensor:
        shared |= {"sensor": points.sensor, "time_error_us": points.error.x}
    else:
        shared |= {"speed_error_m_s": points.error.y}
    return [shared | {x: a, y: b} for a, b in points.points]


def left(points: Digitised, table: pd.DataFrame) -> dict[str, float]:
    """Model → chi²/N of the points about what the model shows, both errors counted; `table` is the figure's.

    A model's line is taken as straight between its own points, in logarithms for fig4; points outside it are
    left out, and a model that none of them meets is too.
    """
    x, y = AXES[points.figure]
    own = table[(table.panel == points.panel) & table.series.isin(["simulated", "reflected"])]
    if points.sensor:
        own = own[own.sensor == points.sensor]
    elif "orientation" in own:
        own = own[(own.orientation == "vertical") & (own[x] > 0.0) & (own[y] > 0.0)]
    found = {}
    for model, line in own.groupby("model", sort=False):
        # The reflection's line begins where the pulse's ends.
        line = line.dropna(subset=[x, y]).sort_values(x).drop_duplicates(x)
        off = _off(points, line, x, y) if len(line) > 1 else []
        if len(off):
            with np.errstate(over="ignore"):  # told only where it is finite
                found[model] = float(np.mean(np.square(off)))
    return found


def _off(points, line, x, y):
    """Differences over their errors, of the points within the line."""
    a, b = np.array(points.points).T
    u, v = line[x].to_numpy(), line[y].to_numpy()
    inside = (a >= u.min()) & (a <= u.max())
    if points.sensor is None:
        slope = np.gradient(np.log(v), np.log(u))
        wanted = np.exp(np.interp(np.log(a), np.log(u), np.log(v)))
        steep = np.interp(a, u, slope) * wanted / a
    else:
        wanted, steep = np.interp(a, u, v), np.interp(a, u, np.gradient(v, u))
    return ((b - wanted) / np.hypot(points.error.y, steep * points.error.x))[inside]


def schema() -> dict:
    """JSON schema of the file, for editors; made from the types that check it."""
    return msgspec.json.schema(Digitised)


def told(points: Digitised, table: pd.DataFrame) -> str:
    """One line for each model, the best first."""
    ranked = sorted(left(points, table).items(), key=lambda item: item[1])
    head = f"{points.figure}({points.panel}), {len(points.points)} points by {points.provenance.who}:"
    lines = [f"  {model}: chi2/N {value:.3g}" for model, value in ranked if math.isfinite(value)]
    return "\n".join([head, *(lines or ["  no model shows anything there"])])
