"""The traces of a verdict as a page holds them: few digits, one list for each line, read by `plots.js`.

A page stays small whatever the record: all its traces together keep `POINTS` samples at most, every k-th of
each, and readings are whole numbers of a ten-thousandth of the largest one.
"""

import json
from importlib.resources import files
from pathlib import Path

import numpy as np
from markupsafe import Markup

from sonicvacuum.files import reading
from sonicvacuum.tables import read_lines

# Samples of all traces, and of one.
POINTS, LONGEST = 60_000, 2_000
STEPS = 9_999
_LINES = ("measured", "nominal", "extended")
_PACKAGE = files("sonicvacuum.report")


def plots(path) -> list[dict]:
    """One entry for each run and gauge of `traces.csv`, in its order; [] without traces.

    Keys: run, sensor, unit, start and step of the times in us, step of the readings, every (which sample is
    kept), sigma (noise of one sample, in steps of the readings), and measured, nominal, extended, each in
    whole steps. Where nothing was added to the nominal model there is no `extended`; where samples are
    missing, `times` in us stand instead of start and step.
    """
    groups = _groups(path)
    most = min(LONGEST, max(200, POINTS // max(1, len(groups))))
    return [_plot(run, sensor, rows, most) for (run, sensor), rows in groups.items()]


def _groups(path):
    """(run, gauge) → its rows as text."""
    found: dict[tuple[str, str], list[list[str]]] = {}
    cure = "run sonicvacuum discover again"
    with reading(path, cure):
        for row in read_lines(path, cure)[1:]:
            found.setdefault((row[0], row[1]), []).append(row[2:])
    return found


def _plot(run, sensor, rows, most):
    unit = rows[0][5] if len(rows[0]) > 5 else "N"
    values = np.array([row[:5] for row in rows], dtype=float).T
    every = -(-values.shape[1] // most)
    time, *lines = values[:4, ::every]
    sigma = float(values[4, 0])
    step = max(float(np.abs(lines).max()), 1e-300) / STEPS
    found = {"run": run, "sensor": sensor, "unit": unit, "every": every, "value": _short(step)}
    found |= _times(time) | {"sigma": _short(sigma / step)}
    keep = _LINES if not np.array_equal(lines[1], lines[2]) else _LINES[:2]
    return found | {
        name: np.rint(line / step).astype(int).tolist() for name, line in zip(keep, lines, strict=False)
    }


def _times(time):
    """Start and step where times are equidistant, all of them where samples are missing between."""
    step = (time[-1] - time[0]) / max(1, len(time) - 1)
    even = time[0] + step * np.arange(len(time))
    if np.abs(time - even).max() <= 0.02 * step:
        return {"start": _short(float(time[0])), "step": _short(float(step))}
    return {"times": [_short(float(t)) for t in time]}


def _short(value):
    return float(f"{value:.6g}")


def script(found: list[dict]) -> Markup:
    """Data, library and program for the bottom of a page; nothing without traces."""
    if not found:
        return Markup("")
    # Within a script neither </script> nor <!-- may stand.
    data = json.dumps(found, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    parts = [
        f'<script type="application/json" id="traces-data">{data}</script>',
        f"<script>{_text('vendor/uPlot-1.6.32.min.js')}</script>",
        f"<script>{_text('plots.js')}</script>",
    ]
    return Markup("\n".join(parts))


def style() -> Markup:
    """Style sheet of the library."""
    return Markup(_text("vendor/uPlot-1.6.32.min.css"))


def _text(name):
    return Path(str(_PACKAGE.joinpath(name))).read_text(encoding="utf-8").strip()
