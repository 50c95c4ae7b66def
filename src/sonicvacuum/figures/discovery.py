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

from sonicvacuum.discover import draws
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.figures import disagreement, force_law, posterior
from sonicvacuum.figures.style import (
    BAND,
    BLUE,
    DOUBLE,
    GREEN,
    GREY,
    ORANGE,
    SINGLE,
    canvas,
    context,
    panel,
    save,
)
from sonicvacuum.tables import read_csv

_MOST = 8


def draw(folder: Path, catalogue: Catalogue = CATALOGUE, png: bool = False) -> list[Path]:
    """Draw all pictures that the tables in the folder give; the SVG files written.

    The catalogue knows the effects that are named. With `png` each is kept as PNG as well, which takes as
    long again. Those of an earlier verdict that this one does not have are removed.
    """
    folder = Path(folder)
    posterior.write_table(folder, catalogue)
    verdict = json.loads((folder / "verdict.json").read_text(encoding="utf-8"))
    pictures = {
        "where": lambda: disagreement.where(read_csv(folder / "where.csv")),
        "scalars": lambda: disagreement.scalars(read_csv(folder / "where.csv")),
        "traces": lambda: traces(read_csv(folder / "traces.csv"), verdict["named"]),
        "candidates": lambda: candidates(verdict["probabilities"]),
        "parameters": lambda: posterior.parameters(read_csv(folder / "parameters.csv"), draws.read(folder)),
        "gap": lambda: gap(read_csv(folder / "gap.csv")),
        "law": lambda: force_law.law(read_csv(folder / "law.csv") if (folder / "law.csv").exists() else []),
    }
    written = []
    with context():
        for name, make in pictures.items():
            paths = [folder / f"{name}.{kind}" for kind in ("svg", "png")]
            figure = make()
            wanted = paths[: 0 if figure is None else 1 + png]
            if wanted:
                save(figure, *wanted)
                written.append(wanted[0])
            for path in paths[len(wanted) :]:
                path.unlink(missing_ok=True)
    return written


def traces(table: list[dict[str, str]], named: list[str]):
    """Measured and predicted traces with residuals below, for the first and the last run; None without
    traces.
    """
    runs = list(dict.fromkeys(r["run"] for r in table))
    if not runs:
        return None
    chosen = list(dict.fromkeys((runs[0], runs[-1])))
    sensors = list(dict.fromkeys(r["sensor"] for r in table))[:4]
    high = 34.0
    figure = canvas(DOUBLE, 16.0 + high * len(sensors))
    wide = (DOUBLE - 18.0 - 14.0 * (len(chosen) - 1) - 4.0) / len(chosen)
    for j, run in enumerate(chosen):
        for i, sensor in enumerate(sensors):
            part = [r for r in table if r["run"] == run and r["sensor"] == sensor]
            left, bottom = 16.0 + j * (wide + 14.0), 11.0 + high * (len(sensors) - 1 - i)
            _signal(panel(figure, (left, bottom + 12.0, wide, high - 16.0)), part, f"{run}, {sensor}")
            _residual(panel(figure, (left, bottom, wide, 10.5)), part, i == len(sensors) - 1)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    extended = "nearest model" if named == ["unknown"] else " + ".join(named) or "nominal"
    labels = [label.replace("extended", extended) for label in labels]
    figure.legend(handles, labels, loc="upper right", ncols=3, fontsize=7, borderaxespad=0.1)
    return figure


def _columns(part):
    end = "" if "unit" in part[0] else "_N"
    names = ("time_us", *(f"{name}{end}" for name in ("measured", "nominal", "extended", "sigma")))
    return [np.array([float(r[name]) for r in part]) for name in names]


def label_of(unit: str) -> str:
    """What stands at an axis of readings in this unit."""
    name = {"N": "force", "m/s": "velocity", "m/s2": "acceleration"}.get(unit, "reading")
    return f"{name} ({unit.replace('s2', 's²')})"


def _signal(axes, part, text):
    time, measured, nominal, extended, _ = _columns(part)
    axes.plot(time, measured, ".", color=GREY, ms=1.0, label="measured", rasterized=True)
    axes.plot(time, nominal, color=ORANGE, lw=0.9, ls=(0, (3.5, 1.2)), label="nominal")
    axes.plot(time, extended, color=BLUE, lw=0.9, label="extended")
    axes.set_ylabel(label_of(part[0].get("unit", "N")))
    axes.set_xlim(time[0], time[-1])
    axes.set_xticklabels([])
    axes.text(0.02, 0.9, text, transform=axes.transAxes, ha="left", va="top", fontsize=7)


def _residual(axes, part, last):
    time, measured, nominal, extended, sigma = _columns(part)
    count = max(1, len(time) // 60)
    axes.axhspan(-2.0, 2.0, color=BAND, lw=0)
    for model, color, style in ((nominal, ORANGE, (0, (3.5, 1.2))), (extended, BLUE, "-")):
        mean, middle = running((measured - model) / sigma, count), running(time, count)
        axes.plot(middle, mean * np.sqrt(count), color=color, lw=0.9, ls=style)
    axes.set_ylabel("resid./σ", fontsize=6.5)
    axes.set_xlim(time[0], time[-1])
    if last:
        axes.set_xlabel("time (µs)")
    else:
        axes.set_xticklabels([])


def running(values: np.ndarray, count: int) -> np.ndarray:
    """Means of so many neighbours; times √count their white noise is that of one value."""
    return np.convolve(values, np.full(count, 1.0 / count), mode="valid")


def candidates(probabilities: dict[str, float]):
    """Bars of the most probable explanations."""
    best = sorted(probabilities.items(), key=lambda item: -item[1])[:_MOST]
    best = [one for k, one in enumerate(best) if k < 3 or one[1] >= 0.005][::-1]
    figure = canvas(SINGLE, 13.0 + 5.0 * len(best))
    axes = panel(figure, (30.0, 10.0, SINGLE - 40.0, 5.0 * len(best)))
    names, values = zip(*best, strict=True)
    axes.barh(names, values, color=[GREY if n in ("none", "unknown") else BLUE for n in names], height=0.65)
    for k, value in enumerate(values):
        told = f"{value:.2f}" if value >= 0.005 else "< 0.01"
        axes.text(value + 0.015, k, told, va="center", fontsize=7)
    axes.set_xlim(0.0, 1.0)
    axes.set_xlabel("probability")
    axes.tick_params(axis="y", length=0)
    return figure


def _broken(name):
    """A model's name over several lines."""
    return name.replace("+", " +\n") if "+" in name else name.replace("-", "-\n")


def gap(table: list[dict[str, str]]):
    """Excess misfit after each round, per datum."""
    steps = [r for r in table if r["run"].startswith("round ")]
    if not steps:
        return None
    values = [float(r["after"]) for r in steps]
    figure = canvas(SINGLE, 54.0)
    axes = panel(figure, (17.0, 15.0, SINGLE - 22.0, 36.0))
    axes.axhline(1.0, color=GREEN, lw=0.9, ls=(0, (5, 1.2, 1, 1.2)))
    axes.text(len(values) - 0.55, 1.0, "noise", color=GREEN, fontsize=7, ha="right", va="bottom")
    axes.plot(range(len(values)), values, "o-", color=BLUE, lw=1.0, ms=4)
    axes.margins(y=0.12)
    if max(values) > 5.0:
        axes.set_yscale("log")
    axes.set_xticks(range(len(values)), [_broken(r["run"].split(": ")[1]) for r in steps], fontsize=7)
    axes.set_xlim(-0.5, len(values) - 0.5)
    axes.set_ylabel("$\\chi^2$ per datum")
    axes.set_xlabel("best model of each round")
    return figure
