"""Fresh runs of laboratories whose records were looked into: how well the model found foretells a run that
the search never had, beside the nominal model; nothing is fitted but the fresh run's own errors.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum_blind import TRUTH
from sonicvacuum_blind.score import SummaryLine, found_in, whole
from sonicvacuum_blind.shares import counted, quantile, ratio_of_sums
from sonicvacuum_blind.stated import load, right_names

# Names told of a law of no particular form.
NEAREST = 3
# χ²/N of a fresh run above which it has a gap of its own to close; noise alone gives less.
LEAST = 1.1


@dataclass(frozen=True)
class Foretold:
    """One fresh run: mean squared residual over its noise, of the nominal model and of the one found.

    Attributes:
        id, kind, effects, d_prime: of the case.
        named: in its verdict, joined by `+`.
        exact: whether that is exactly what is hidden; for beside, the effect and unknown.
        law: whether the verdict holds a contact law of no particular form.
        nearest: names of the catalogue that come nearest to that law, with their distances.
        data: number of readings.
        before, after: of the nominal model, and of that of the verdict.
    """

    id: str
    kind: str
    effects: str
    d_prime: float
    named: str
    exact: int
    law: int
    nearest: str
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
        truth, verdict, one = load(truths[id]), load(verdicts[id]), load(compared[id])
        files = f"{compared[id]} (truth: {truths[id]}, verdict: {verdicts[id]})"
        with whole(files, "run sonicvacuum discover and compare again"):
            rows.append(_row(id, truth, verdict, one))
    return rows


def _row(id, truth, verdict, one):
    named, law, gap = verdict["named"], verdict.get("law"), one["gap"]
    return Foretold(
        id,
        truth["kind"],
        "+".join(truth["effects"]),
        float(truth["d_prime"]),
        "+".join(named),
        int(set(named) == set(_hidden(truth))),
        int(law is not None),
        _nearest(law["nearest"] if law else []),
        int(one["data"]),
        float(gap["before"]),
        float(gap["after"]),
    )


def _hidden(truth):
    """Names that make a verdict exact; of what is from outside the catalogue alone, none does."""
    return right_names(truth) if truth["kind"] == "beside" else truth["effects"]


def _nearest(near):
    return " ".join(f"{n['effect']} {n['distance']:.2f}" for n in near[:NEAREST])


def summary(rows: Iterable[Foretold]) -> list[SummaryLine]:
    """Medians of both models by kind of record, and the share of the gap that is closed, gaps added up."""
    lines, rows = [], list(rows)
    for kind in ("single", "pair", "set", "foreign", "beside"):
        chosen = [r for r in rows if r.kind == kind]
        if not chosen:
            continue
        for model, values in (
            ("nominal model", [r.before for r in chosen]),
            ("model found", [r.after for r in chosen]),
            ("model found, names exact", [r.after for r in chosen if r.exact]),
        ):
            lines.append(
                SummaryLine("chi2/N of a fresh run", f"{kind}, {model}, median", *quantile(values, 0.5))
            )
        lines.append(_closed(kind, chosen))
    return lines + _laws([r for r in rows if r.kind == "foreign"])


def _closed(group, rows):
    gaps = np.array([(r.data * (r.before - 1.0), r.data * (r.after - 1.0)) for r in rows])
    found = ratio_of_sums(gaps[:, 0] - gaps[:, 1], gaps[:, 0])
    return SummaryLine("gap closed on fresh runs", f"{group}, gaps added up", len(rows), *found)


def _each(group, rows):
    """The share of a record's own gap, in the median: strong effects do not decide it."""
    shares = [(r.before - r.after) / (r.before - 1.0) for r in rows if r.before > LEAST]
    return SummaryLine("gap closed on fresh runs", f"{group}, median", *quantile(shares, 0.5))


def _laws(rows):
    """What laws of no particular form foretell, all together and by what is hidden."""
    with_law = [r for r in rows if r.law]
    if not with_law:
        return []
    lines = [counted("free law kept", "foreign", [r.law for r in rows])]
    groups = {"foreign, free law": with_law}
    groups |= {
        f"foreign, {name}": [r for r in rows if r.effects == name]
        for name in sorted({r.effects for r in rows})
    }
    for group, chosen in groups.items():
        lines += [_closed(group, chosen), _each(group, chosen)]
    return lines
