"""The columns of the pipeline's tables, and what the report counts in the ledger."""

from dataclasses import fields

import pandas as pd

from sonicvacuum.files import InputError
from sonicvacuum.report.tables import number, read
from sonicvacuum_paper.assumptions import AssumptionRow
from sonicvacuum_paper.ladder import ARITHMETIC, SIMULATION, THEORY, members, title
from sonicvacuum_paper.ladder import COLUMNS as LADDER
from sonicvacuum_paper.ledger import LedgerRow
from sonicvacuum_paper.rows import COLUMNS
from sonicvacuum_paper.verdict import DISAGREES, INCONSISTENT, OUTSIDE, REPRODUCED, VERDICTS

__all__ = ["number", "read"]

LEDGER = [field.name for field in fields(LedgerRow)]
ASSUMPTIONS = [field.name for field in fields(AssumptionRow)]
METRICS = list(COLUMNS)
# Columns of the ledger that hold numbers.
NUMBERS = [field.name for field in fields(LedgerRow) if field.type in (float, "float")]
# What a reader asks first: claim, and what it is called in the first table.
FIRST = {
    "fig3a-speed": "197 m/s, coated beads, Fig. 3a",
    "low-speed": "130 m/s at 0.25 N",
    "fig3a-duration": "130 µs long",
    "fig3a-width": "5.3 diameters wide",
    "force-level": "force, about 3 N if Fig. 7 tells the largest",
    "fig3b-speed": "578 m/s, bare steel",
}


def read_ledger(path) -> pd.DataFrame:
    """The ledger, text as text; InputError where it is none, or a claim stands in it twice."""
    ledger = read(path, LEDGER, NUMBERS)
    twice = ledger["claim"][ledger["claim"].duplicated()]
    if len(twice):
        raise InputError(f"{path}: {twice.iloc[0]} stands here twice; run sonicvacuum paper ledger again")
    return ledger


def shown(excluded: str) -> str:
    """The models that a row excludes, called as people read them."""
    # Titles hold commas.
    return "; ".join(f"{title(c)}: {d} σ" if d else title(c) for c, d in members(excluded).items())


def headline(ledger: pd.DataFrame) -> str:
    """How many statements there are, how many of them need a simulation, and what came of all."""
    part = ledger[ledger["kind"] == SIMULATION]
    found, beside = counts(part), ledger[ledger["kind"] == THEORY]
    printed = ledger[ledger["kind"] == ARITHMETIC]
    agree = counts(beside)[REPRODUCED]
    return (
        f"Of {len(ledger)} statements {len(part)} need a simulation: the printed layer, with nothing "
        f"fitted, reproduces {found[REPRODUCED]} and contradicts {found[DISAGREES]}; {found[OUTSIDE]} need "
        f"a loss and are outside it. Of {len(beside)} that follow from the equations {agree} hold; of "
        f"{len(printed)} checks of printed numbers {counts(printed)[INCONSISTENT]} contradict the paper "
        f"itself. {_rest(ledger)}"
    )


def _rest(ledger):
    """What stands in the ledger besides: misprints, and what cannot be tested."""
    others = ledger[~ledger["kind"].isin((SIMULATION, THEORY, ARITHMETIC))]
    misprints = counts(others)[INCONSISTENT]
    untested = len(others) - misprints
    return f"{misprints} are misprints; {untested} cannot be tested by what is printed."


def asked(ledger: pd.DataFrame) -> bool:
    """Whether any statement that needs a simulation has the number of some model: not where all cases are of
    the user's own.
    """
    return bool((ledger.loc[ledger["kind"] == SIMULATION, list(LADDER)] != "").any(axis=None))


def first(ledger: pd.DataFrame) -> list[dict]:
    """The table of a first look: what is printed, and each model's number with what became of it."""
    known = ledger.set_index("claim")
    return [
        {"printed": text, "cells": [_cell(known.loc[claim], c) for c in LADDER if c != "ideal"]}
        for claim, text in FIRST.items()
        if claim in known.index
    ]


def _cell(row, column):
    """A number; `fitted` after what the model was fitted to, the difference after what excludes it."""
    if not row[column]:
        return "–"
    excluded = members(row["excluded"])
    mark = " (fitted)" if column in members(row["fitted"]) else ""
    if column in excluded:
        mark = f" ({excluded[column]} σ)" if excluded[column] else " (excluded)"
    return number(row[column]) + mark


def counts(ledger: pd.DataFrame) -> dict[str, int]:
    """Verdict → number of claims."""
    return {verdict: int((ledger["verdict"] == verdict).sum()) for verdict in VERDICTS}


def disagreements(ledger: pd.DataFrame) -> pd.DataFrame:
    """Rows that disagree, the largest difference in standard errors first, those without one last."""
    rows = ledger[ledger["verdict"] == DISAGREES].copy()
    size = pd.to_numeric(rows["difference_sigma"], errors="coerce").abs().fillna(-1.0)
    return rows.loc[size.sort_values(ascending=False, kind="stable").index]
