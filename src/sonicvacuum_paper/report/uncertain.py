"""What the report shows of the draws: how probable the main statements are under each model."""

import pandas as pd

from sonicvacuum.report.tables import number
from sonicvacuum_paper.ladder import MODELS, members, title
from sonicvacuum_paper.report.tables import FIRST
from sonicvacuum_paper.uncertainty.inputs import DRAWS, INPUTS

# Least probability that the draws give to a number, and to what holds in some of them: less than one draw.
FLOOR, NONE = 2.0 / (DRAWS + 1), f"< {1.0 / DRAWS:.2g}"
# What holds in all of them has no share of 1 either.
ALL = f"> {1.0 - 1.0 / DRAWS:.3f}"
# Below this a statement is shown beside the main ones.
IMPROBABLE = 0.05


def shown(row: dict) -> str:
    """The probabilities of a row of the ledger, models called as people read them."""
    return "; ".join(f"{title(c)}: {_share(p, row)}" for c, p in members(row["probability"]).items())


def _share(probability, row):
    """A probability, or the floor of the draws that it lies at; `row` has what the statement's `test` is."""
    share = float(probability)
    if share in (0.0, 1.0):
        return ALL if share else NONE
    equality = row["test"] == "equals" or (row["test"] == "within" and float(row["measured"]) != 0.0)
    return f"≤ {FLOOR:.2g}" if equality and share <= FLOOR else number(probability, 2)


def context(ledger: pd.DataFrame) -> dict:
    """What the section on the draws is made of; `ledger` as text, with the columns `statement` and `test`."""
    rows = {r["claim"]: r for r in ledger.to_dict("records") if r["probability"]}
    found = {claim: members(r["probability"]) for claim, r in rows.items()}
    statement = ledger.set_index("claim")["statement"].to_dict()
    told = [c for c, shares in found.items() if c in FIRST or min(map(float, shares.values())) < IMPROBABLE]
    told.sort(key=lambda c: list(FIRST).index(c) if c in FIRST else len(FIRST))
    present = {column for shares in found.values() for column in shares}
    return {
        "drawn_models": [(c, m.title) for c, m in MODELS.items() if c in present],
        "probable": [
            {"statement": FIRST.get(c, statement[c]), "shares": _marked(found[c], rows[c])} for c in told
        ],
        "inputs": INPUTS,
        "draws": DRAWS,
        "floors": (f"{FLOOR:.2g}", NONE.removeprefix("< ")),
        "all": ALL,
    }


def _marked(shares, row):
    """The shares, with what each model was fitted to said so."""
    fitted = members(row["fitted"])
    told = {c: _share(share, row) for c, share in shares.items()}
    return {c: f"{share} (fitted)" if c in fitted else share for c, share in told.items()}
