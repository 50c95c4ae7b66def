"""What each step from one model to the next turns in the ledger: which statements it wins or loses."""

from collections.abc import Mapping, Sequence

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
