"""The free-form contact law of a verdict: what it has beside the nominal force, with its standard error.

Drawn from law.csv, over compressions and rates that contacts went through; lines for three rates over the
compression, and for three compressions over the rate.
"""

import numpy as np

from sonicvacuum.figures.colours import BLUE, GREEN, GREY, ORANGE
from sonicvacuum.figures.drawing import DOUBLE, Drawing, Stroke
from sonicvacuum.figures.frame import Frame, Scale, legend

STROKES = (Stroke(BLUE, 1.0), Stroke(ORANGE, 1.0, (3.5, 1.2)), Stroke(GREEN, 1.0, (1.0, 1.0)))


def law(table: list[dict[str, str]]) -> Drawing | None:
    """Two panels; None without a table."""
    if not table:
        return None
    columns = {name: np.array([float(r[name]) for r in table]) for name in table[0]}
    depth, rate = (np.unique(columns[name]) for name in ("depth_um", "speed_m_s"))
    shape = (len(depth), len(rate))
    visited = columns["visited"].reshape(shape) > 0
    beside = np.where(visited, (columns["force_N"] - columns["hertz_N"]).reshape(shape), np.nan)
    band = columns["band_N"].reshape(shape)
    rates, depths = _spread(visited.any(axis=0)), _spread(visited.any(axis=1), first=1)
    page, half = Drawing(DOUBLE, 64.0), 0.5 * DOUBLE
    left, right = (18.0, 12.0, half - 26.0, 44.0), (half + 14.0, 12.0, half - 20.0, 44.0)
    told = [f"{'' if k else 'rate '}{_signed(rate[at])} m/s" for k, at in enumerate(rates)]
    _panel(page, left, "compression (µm)", told, depth, beside[:, rates].T, band[:, rates].T)
    told = [f"{'' if k else 'compression '}{depth[at]:.2g} µm" for k, at in enumerate(depths)]
    _panel(page, right, "rate of compression (m/s)", told, rate, beside[depths], band[depths])
    return page


def _panel(page, box, label, told, x, values, errors):
    """Lines (n, m) over x (m,) with their errors, and what each of them is of."""
    reach = [*(values + errors).flat, *(values - errors).flat, 0.0]
    frame = Frame(page, box, Scale.over(x), Scale.over(reach))
    for value, error, stroke in zip(values, errors, STROKES, strict=False):
        frame.fill(x, value - error, value + error, stroke.color, opacity=0.25)
    frame.level(0.0, Stroke(GREY, 0.6))
    for value, stroke in zip(values, STROKES, strict=False):
        frame.curve(x, value, stroke)
    frame.bottom(label)
    frame.left("force beside nominal (N)")
    legend(page, box[0] + box[2], box[1] + box[3] + 4.0, list(zip(STROKES, told, strict=False)))


def _signed(rate):
    return f"{rate:+.2g}".replace("-", "−") if abs(rate) > 1e-9 else "0"


def _spread(there, first=0):
    """Three of the places where something is: near both ends and in the middle."""
    places = np.flatnonzero(there)[first:]
    return [places[round(share * (len(places) - 1))] for share in (0.2, 0.5, 0.8)] if len(places) else []
