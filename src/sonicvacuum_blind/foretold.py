"""Fresh runs of laboratories whose records were looked into: how well the model found foretells a run that
the search never had, beside the nominal model; nothing is fitted but the fresh run's own errors.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum_blind import TRUTH
from sonicvacuum_blind.score import Line, found_in
from sonicvacuum_blind.shares import quantile, ratio_of_sums
from sonicvacuum_blind.stated import load


@dataclass(frozen=True)
class Foretold:
    """One fresh run: mean squared residual over its noise, of the nominal model and of the one found.

    Attributes:
        id, kind, effects, d_prime: of the case.
        exact: whether its verdict names exactly what is hidden.
        data: number of readings.
        before, after: of the nominal model, and of that of the verdict.
    """

    id: str
    kind: str
    effects: str
    d_prime: float
    exact: int
    data: int
    before: float
    after: float


def foretold(truth_folder, verdict_folder, compared_folder) -> list[Foretold]:
    """Rows of all fresh runs, by id, from what `sonicvacuum compare --json` wrote as `<id>/compared.json`.

    Raises:
        InputError: where there is none, or truth or verdict of one is missing or lacks a key.
    """
    compared = found_in(compared_folder, "compared.json")
    truths, verdicts = found_in(truth_folder, TRUTH), found_in(verdict_folder, "verdict.json")
    missing = sorted(set(compared) - (set(truths) & set(verdicts)))
    if missing or not compared:
        raise InputError(
            f"{compared_folder}: {f'no truth or verdict of {missing[0]}' if missing else 'is empty'}"
        )
    rows = []
    for id in sorted(compared):
        truth, named, one = load(truths[id]), load(verdicts[id])["named"], load(compared[id])
        try:
            exact = int(set(named) == set(truth["effects"]))
            sizes = one["gap"]["before"], one["gap"]["after"]
            rows.append(
                Foretold(
                    id,
                    truth["kind"],
                    "+".join(truth["effects"]),
                    truth["d_prime"],
                    exact,
                    one["data"],
                    *sizes,
                )
            )
        except KeyError as error:
            raise InputError(
                f"{compared[id]}: {error.args[0]}: missing; run sonicvacuum compare again"
            ) from None
    return rows


def summary(rows: Iterable[Foretold]) -> list[Line]:
    """Medians of both models by kind of record, and the share of the gap that is closed, gaps added up."""
    lines, rows = [], list(rows)
    for kind in ("single", "pair", "set", "foreign"):
        chosen = [r for r in rows if r.kind == kind]
        if not chosen:
            continue
        for model, values in (
            ("nominal model", [r.before for r in chosen]),
            ("model found", [r.after for r in chosen]),
            ("model found, names exact", [r.after for r in chosen if r.exact]),
        ):
            lines.append(Line("chi2/N of a fresh run", f"{kind}, {model}, median", *quantile(values, 0.5)))
        gaps = np.array([(r.data * (r.before - 1.0), r.data * (r.after - 1.0)) for r in chosen])
        found = ratio_of_sums(gaps[:, 0] - gaps[:, 1], gaps[:, 0])
        lines.append(Line("gap closed on fresh runs", f"{kind}, gaps added up", len(chosen), *found))
    return lines
