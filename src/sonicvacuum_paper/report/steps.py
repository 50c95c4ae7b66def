"""What each step from one model to the next turns in the ledger: which statements it wins or loses."""

import math
from collections.abc import Mapping, Sequence

import pandas as pd

from sonicvacuum.report.tables import number
from sonicvacuum_paper.ladder import SIMULATION, members, title

# From one column of the ledger to another, and what alone differs between them.
STEPS = (
    ("handbook", "layer", "the coating as the printed layer, not as a half-space"),
    ("handbook", "matched", "15 GPa fitted"),
    ("ideal", "layer", "gauges that discharge, and a wall of brass"),
    ("layer", "layer_membrane", "4.75 GPa instead of 2.76"),
    ("layer", "layer_loss", "one loss"),
    ("matched", "matched_loss", "one loss"),
)

# What settings change by less than this is not told.
TOLD = 0.005
# Quantity of Fig. 6 and its gauges → words; each is told of both balls, with and without the loss.
OF_MASSES = {
    ("speed", "g9-g5"): "speed, m/s",
    ("amplitude", "wall"): "peak at the wall, N",
    ("duration_half", "wall"): "duration at half height at the wall, µs",
    ("pulse_count", "wall"): "waves at the wall",
}


def steps(ledger: Sequence[Mapping[str, str]]) -> list[dict]:
    """One row for each step: models, cause, and the statements that agree only after (or only before) it.

    Args:
        ledger: rows with the columns of `ledger.LedgerRow`, as text; a statement agrees, is excluded, or is
            outside the model. Only statements that both have a number for, and that neither was fitted to.
    """
    found = []
    for before, after, cause in STEPS:
        rows = [r for r in ledger if r["kind"] == SIMULATION and _open(r, before) and _open(r, after)]
        won = [r["claim"] for r in rows if _agrees(r, after) and not _agrees(r, before)]
        lost = [r["claim"] for r in rows if _agrees(r, before) and not _agrees(r, after)]
        models = f"{title(before)} → {title(after)}"
        found.append({"models": models, "cause": cause, "won": won, "lost": lost})
    return found


def _open(row, column):
    return bool(row[column]) and column not in members(row["fitted"])


def _agrees(row, column):
    return column in members(row["agrees"])


def settings(ledger: Sequence[Mapping[str, str]]) -> list[dict]:
    """Statements whose number moves with the gauges' discharge and the brass wall: without both, with both.

    Rows of the ledger as in `steps`, under the layer; changes of half a per cent and more.
    """
    found = []
    for row in ledger:
        plain, real = (_value(row[c]) for c in ("ideal", "layer"))
        if row["kind"] == SIMULATION and abs(real - plain) > TOLD * abs(plain):
            cells = [number(row[c]) for c in ("measured", "ideal", "layer")]
            found.append({"claim": row["claim"], "unit": row["unit"], "cells": cells})
    return found


def masses(metrics: pd.DataFrame) -> list[list[str]]:
    """What Fig. 6 shows with the printed masses and with those of geometry: case, quantity, four numbers.

    The layer without and with its loss. `metrics` is `results/metrics.csv` as text; no row without both.
    """
    value = metrics.set_index(["case", "quantity", "sensor"])["value"].to_dict()
    found = []
    for case, name in (("fig6a", "Fig. 6(a)"), ("fig6b", "Fig. 6(b)")):
        for of, words in OF_MASSES.items():
            models = (f"{case}.{m}" for m in ("layer", "layer-geometry", "layer-loss", "layer-loss-geometry"))
            cells = [value.get((model, *of), "") for model in models]
            if all(cells):
                found.append([f"{name}, {words}", *(number(cell) for cell in cells)])
    return found


def _value(text: str) -> float:
    """A number of the ledger; NaN, which differs from nothing, where there is none."""
    try:
        return float(text)
    except ValueError:
        return math.nan
