"""Cases as simpler rules see them: the tables that `discover` wrote of each, and the truth to score by."""

import math
from dataclasses import dataclass
from pathlib import Path

from sonicvacuum.files import InputError
from sonicvacuum.tables import read_csv
from sonicvacuum_blind import TRUTH, score
from sonicvacuum_blind.score import Row
from sonicvacuum_blind.study import added


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
    singles = [_single(line) for line in _table(verdict / "candidates.csv") if "+" not in line["effects"]]
    whole = next((line for line in _table(verdict / "gap.csv") if line["run"] == "all"), None)
    if whole is None:
        raise InputError(f"{verdict / 'gap.csv'}: has no row 'all'; run sonicvacuum discover on it again")
    cells = [_cell(line) for line in _table(verdict / "where.csv")]
    return Case(
        row, tuple(singles), int(float(whole["data"])), float(whole["before"]), tuple(cells), record, truth
    )


def _single(line):
    names = {part.split()[1] for part in line["parameters"].split(";") if part.strip()}
    cosine = float(line.get("cosine") or math.nan)
    return Single(line["effects"], float(line["delta_chi2"]), len(names), cosine)


def _cell(line):
    numbers = (float(line[key] or math.nan) for key in ("z_before", "size"))
    return Cell(line["run"], line["sensor"], line["feature"], *numbers)


def _table(path):
    return read_csv(path, "run sonicvacuum discover on the record again")
