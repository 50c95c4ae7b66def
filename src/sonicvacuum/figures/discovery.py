"""The pictures of one verdict, each drawn from the tables that `sonicvacuum discover` wrote beside it.

where: disagreement of the nominal model by run, gauge and feature. scalars: the same for quantities measured
without traces, before and after. traces: measured and predicted, with running means of the residuals over
their own standard error (band: two of them). candidates: how probable each explanation is. parameters: their
posteriors. gap: misfit of each round, falling to the noise. law: the free-form contact law, where one was
needed.
"""

import json
from pathlib import Path

import numpy as np

from sonicvacuum.discover import draws, quantities
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.figures import disagreement, force_law, posterior
from sonicvacuum.figures.colours import BAND, BLUE, GREEN, GREY, ORANGE
from sonicvacuum.figures.drawing import (
    DOUBLE,
    POINT,
    SINGLE,
    Curve,
    Dots,
    Drawing,
    Stroke,
    Text,
    rectangle,
    width_of,
)
from sonicvacuum.figures.frame import TICK_LABEL, Frame, Scale, legend
from sonicvacuum.tables import read_csv

NOMINAL, EXTENDED = Stroke(ORANGE, 0.9, (3.5, 1.2)), Stroke(BLUE, 0.9)
_MOST = 8
_GRAIN = 1.6  # dot of a measured sample, points
_APART = 17.0  # of panels of two runs, mm: room for the numbers and the label of an axis


def draw(folder: Path, catalogue: Catalogue = CATALOGUE, png: bool = False) -> list[Path]:
    """Draw all pictures that the tables in the folder give; the SVG files written.

    The catalogue knows the effects that are named. With `png` each is kept as PNG as well, which takes
    matplotlib and seconds. Those of an earlier verdict that this one does not have are removed.
    """
    folder = Path(folder)
    posterior.write_table(folder, catalogue)
    verdict = json.loads((folder / "verdict.json").read_text(encoding="utf-8"))
    pictures = {
        "where": lambda: disagreement.where(read_csv(folder / "where.csv")),
        "scalars": lambda: disagreement.scalars(
            read_csv(folder / "where.csv"), _kept(folder / quantities.FILE)
        ),
        "traces": lambda: traces(read_csv(folder / "traces.csv"), verdict["named"]),
        "candidates": lambda: candidates(verdict["probabilities"]),
        "parameters": lambda: posterior.parameters(
            read_csv(folder / "parameters.csv"), draws.read(folder), catalogue
        ),
        "gap": lambda: gap(read_csv(folder / "gap.csv")),
        "law": lambda: force_law.law(_kept(folder / "law.csv")),
    }
    written = []
    for name, make in pictures.items():
        paths = [folder / f"{name}.{kind}" for kind in ("svg", "png")]
        drawing = make()
        wanted = paths[: 0 if drawing is None else 1 + png]
        if wanted:
            drawing.write(wanted[0])
            written.append(wanted[0])
        if len(wanted) > 1:
            from sonicvacuum.figures import raster

            raster.write(drawing, wanted[1])
        for path in paths[len(wanted) :]:
            path.unlink(missing_ok=True)
    return written


def _kept(path):
    """Rows of a table that not every verdict has."""
    return read_csv(path) if path.exists() else []


def traces(table: list[dict[str, str]], named: list[str]) -> Drawing | None:
    """Measured and predicted traces with residuals below, for the first and the last run; None without
    traces.

    Four gauges at most, those first that both runs have. A run may lack one, or have none of its samples
    believed: that is said in its place.
    """
    if not table:
        return None
    chosen = list(dict.fromkeys((table[0]["run"], table[-1]["run"])))
    panels: dict[tuple[str, str], list] = {}
    for row in table:
        panels.setdefault((row["run"], row["sensor"]), []).append(row)
    sensors = list(dict.fromkeys(sensor for run, sensor in panels if run in chosen))
    kept = sorted(sensors, key=lambda s: sum((run, s) not in panels for run in chosen))[:4]
    sensors = [s for s in sensors if s in kept]
    last = {run: next((s for s in reversed(sensors) if (run, s) in panels), None) for run in chosen}
    high = 35.5
    page = Drawing(DOUBLE, 16.0 + high * len(sensors))
    wide = (DOUBLE - 18.0 - _APART * (len(chosen) - 1) - 4.0) / len(chosen)
    for j, run in enumerate(chosen):
        for i, sensor in enumerate(sensors):
            left, bottom = 16.0 + j * (wide + _APART), 11.0 + high * (len(sensors) - 1 - i)
            if not (part := panels.get((run, sensor))):
                page.add(Text(left, bottom + 0.5 * high, f"{run}, {sensor}: no trace", 7.0, GREY))
                continue
            _signal(page, (left, bottom + 12.0, wide, high - 17.5), part, f"{run}, {sensor}")
            _residual(page, (left, bottom, wide, 10.5), part, sensor == last[run])
    told = [(Dots(np.empty((0, 2)), _GRAIN * POINT, GREY), "measured"), (NOMINAL, "nominal")]
    if named:
        told.append((EXTENDED, "nearest model" if named == ["unknown"] else " + ".join(named)))
    legend(page, DOUBLE - 4.0, page.height - 2.5, told)
    return page


def _columns(part):
    end = "" if "unit" in part[0] else "_N"
    names = ("time_us", *(f"{name}{end}" for name in ("measured", "nominal", "extended", "sigma")))
    return [np.array([float(r[name]) for r in part]) for name in names]


def label_of(unit: str) -> str:
    """What stands at an axis of readings in this unit."""
    name = {"N": "force", "m/s": "velocity", "m/s2": "acceleration"}.get(unit, "reading")
    return f"{name} ({unit.replace('s2', 's²')})"


def _apart(nominal, extended):
    """The models that differ, each with its look."""
    return [(nominal, NOMINAL), (extended, EXTENDED)][: 1 if np.array_equal(nominal, extended) else 2]


def _signal(page, box, part, text):
    time, measured, nominal, extended, _ = _columns(part)
    scale = Scale.over(np.concatenate([measured, nominal, extended]))
    frame = Frame(page, box, Scale(time[0], time[-1]), scale)
    frame.dots(time, measured, _GRAIN, GREY)
    for values, stroke in _apart(nominal, extended):
        frame.curve(time, values, stroke)
    frame.bottom(numbers=False)
    frame.left(label_of(part[0].get("unit", "N")))
    # Above the frame: within it, a pulse may be anywhere.
    frame.note(0.0, 1.0, text, size=7.0, level="bottom")


def _residual(page, box, part, last):
    time, measured, nominal, extended, sigma = _columns(part)
    count = max(1, len(time) // 60)
    middle = running(time, count)
    left = [
        (running((measured - model) / sigma, count) * np.sqrt(count), stroke)
        for model, stroke in _apart(nominal, extended)
    ]
    scale = Scale.over(np.concatenate([values for values, _ in left] + [np.array([-2.0, 2.0])]))
    frame = Frame(page, box, Scale(time[0], time[-1]), scale)
    frame.band(-2.0, 2.0, BAND)
    for values, stroke in left:
        for joined in neighbours(time, count):
            frame.curve(middle[joined], values[joined], stroke)
    frame.left("resid./σ", label_size=6.5)
    frame.bottom("time (µs)" if last else "", numbers=last)


def running(values: np.ndarray, count: int) -> np.ndarray:
    """Means of so many neighbours; times √count their white noise is that of one value."""
    return np.convolve(values, np.full(count, 1.0 / count), mode="valid")


def neighbours(time: np.ndarray, count: int) -> list[np.ndarray]:
    """Which running means of so many samples belong to one line: samples that do not count are left out, and
    no line joins what they part.
    """
    if len(time) < 2:
        return [np.arange(len(time))]
    longest = 3.0 * count * float(np.median(np.diff(time)))
    whole = np.flatnonzero(time[count - 1 :] - time[: len(time) - count + 1] <= longest)
    apart = (np.diff(whole) > 1) | (np.diff(time[whole]) > longest)
    return [part for part in np.split(whole, np.flatnonzero(apart) + 1) if len(part) > 1]


def candidates(probabilities: dict[str, float]) -> Drawing:
    """Bars of the most probable explanations."""
    best = sorted(probabilities.items(), key=lambda item: -item[1])[:_MOST]
    best = [one for k, one in enumerate(best) if k < 3 or one[1] >= 0.005]
    names = [" +\n".join(part.strip() for part in name.split("+")) for name, _ in best]
    heights = [1.8 + 3.2 * (1 + name.count("\n")) for name in names]
    left = 6.0 + max(width_of(name, TICK_LABEL) for name in names)
    page = Drawing(SINGLE, 13.0 + sum(heights))
    box = (left, 10.0, SINGLE - left - 10.0, sum(heights))
    frame = Frame(page, box, Scale(0.0, 1.0), Scale(0.0, 1.0))
    for k, (name, value) in enumerate(best):
        middle = 10.0 + sum(heights[k:]) - 0.5 * heights[k]
        bar = rectangle(left, middle - 1.6, box[2] * value, 3.2)
        page.add(Curve(bar, fill=GREY if name in ("none", "unknown") else BLUE))
        told = "> 0.99" if value > 0.995 else f"{value:.2f}" if value >= 0.005 else "< 0.01"
        page.add(Text(left + box[2] * value + 0.7, middle, told, 7.0, level="middle"))
        page.add(Text(left - 1.5, middle, names[k], TICK_LABEL, anchor="right", level="middle"))
    frame.left(ticks=[])
    frame.bottom("probability")
    return page


def _broken(name):
    """A model's name over several lines."""
    return name.replace("+", " +\n") if "+" in name else name.replace("-", "-\n")


def gap(table: list[dict[str, str]]) -> Drawing | None:
    """Excess misfit after each round, per datum."""
    steps = [r for r in table if r["run"].startswith("round ")]
    if not steps:
        return None
    values = [float(r["after"]) for r in steps]
    page = Drawing(SINGLE, 54.0)
    scale = Scale.over([*values, 1.0], 0.12, log=max(values) > 5.0 and min(values) > 0.0)
    frame = Frame(page, (17.0, 15.0, SINGLE - 22.0, 36.0), Scale(-0.5, len(values) - 0.5), scale)
    frame.level(1.0, Stroke(GREEN, 0.9, (5.0, 1.2, 1.0, 1.2)))
    above = float(scale.at(1.0)) + 0.02
    frame.note(1.0, above, "noise", color=GREEN, size=7.0, anchor="right", level="bottom")
    frame.curve(range(len(values)), values, Stroke(BLUE, 1.0))
    frame.dots(range(len(values)), values, 4.0, BLUE, Stroke(BLUE, 0.6))
    frame.left("χ² per datum")
    frame.bottom(
        "best model of each round",
        [(k, _broken(r["run"].split(": ")[1])) for k, r in enumerate(steps)],
        size=7.0,
    )
    return page
