"""Cases as simpler rules see them: the tables that `discover` wrote of each, and the truth to score by."""

import math
from dataclasses import dataclass
from pathlib import Path

from sonicvacuum.files import InputError, reading
from sonicvacuum.tables import read_csv
from sonicvacuum_blind import TRUTH, score
from sonicvacuum_blind.score import Row
from sonicvacuum_blind.study import added

_CURE = "run sonicvacuum discover on the record again"


@dataclass(frozen=True)
class Single:
    """The fit of one effect: gain in χ² over the nominal model, free parameters (a place counts as one), and
    the cosine between its signature and the residual (NaN where the table has none).
    """

    effect: str
    gain: float
    parameters: int
    cosine: float


@dataclass(frozen=True)
class Cell:
    """One score of the nominal model's residual; `sensor` is empty for scalars."""

    run: str
    sensor: str
    feature: str
    z: float
    size: float


@dataclass(frozen=True)
class Case:
    """One case.

    Attributes:
        row: its score, which holds truth and verdict.
        singles: fits of single effects; those that the screen found hopeless are missing.
        data: number of data fitted.
        misfit: χ² per datum of the nominal model.
        cells: the disagreement map.
        record, truth: paths of the record's folder and of truth.json.
    """

    row: Row
    singles: tuple[Single, ...]
    data: int
    misfit: float
    cells: tuple[Cell, ...]
    record: Path
    truth: Path


def read(records, truths, verdicts, ideal=()) -> list[Case]:
    """All cases below three folders, by id; tables of the ideal rule beside.

    Raises:
        InputError: where a case lacks its record, its verdict or one of the verdict's tables.
    """
    rows = score.score(truths, verdicts, ideal, added)
    found = {p.parent.name: p.parent for p in Path(records).rglob("record.yaml")}
    told = {p.parent.name: p.parent for p in Path(verdicts).rglob("verdict.json")}
    known = {p.parent.name: p for p in Path(truths).rglob(TRUTH)}
    missing = [r.id for r in rows if r.id not in found]
    if missing:
        raise InputError(f"{records}: no record of {len(missing)} cases, first {missing[0]}; make them again")
    return [_case(row, found[row.id], told[row.id], known[row.id]) for row in rows]


def _case(row, record, verdict, truth):
    singles = _table(verdict / "candidates.csv", ("effects", "delta_chi2", "parameters"), _single)
    whole = _table(verdict / "gap.csv", ("run", "data", "before"), _all_runs)
    if not whole:
        raise InputError(f"{verdict / 'gap.csv'}: has no row 'all'; {_CURE}")
    cells = _table(verdict / "where.csv", ("run", "sensor", "feature", "z_before", "size"), _cell)
    return Case(row, singles, *whole[0], cells, record, truth)


def _all_runs(line):
    """Number of data and misfit of all runs together."""
    return (int(float(line["data"])), float(line["before"])) if line["run"] == "all" else None


def _single(line):
    if "+" in line["effects"]:
        return None
    names = {part.split()[1] for part in line["parameters"].split(";") if part.strip()}
    cosine = float(line.get("cosine") or math.nan)
    return Single(line["effects"], float(line["delta_chi2"]), len(names), cosine)


def _cell(line):
    numbers = (float(line[key] or math.nan) for key in ("z_before", "size"))
    return Cell(line["run"], line["sensor"], line["feature"], *numbers)


def _table(path, columns, made):
    """What is made of each line of a table, but for those of which nothing is made."""
    lines = read_csv(path, _CURE, columns)
    with reading(path, _CURE):
        return tuple(one for one in map(made, lines) if one is not None)
