"""The table of probabilities: `results/uncertainty.csv`."""

from collections.abc import Iterable
from dataclasses import dataclass, fields

from sonicvacuum.files import reading
from sonicvacuum_paper.rows import cells_of, write_lines


@dataclass(frozen=True)
class Agreement:
    """One statement under one model: 5 %, 50 % and 95 % of the draws, and the probability of agreement."""

    claim: str
    model: str
    low: float
    median: float
    high: float
    draws: int
    probability: float


def write(rows: Iterable[Agreement], path) -> None:
    """Write the table with exactly the columns of `Agreement`."""
    write_lines(rows, Agreement, path, digits=4)


def read(path) -> dict[str, dict[str, float]]:
    """Claim → model → probability, of a table that `write` wrote; InputError where it is none."""
    found: dict[str, dict[str, float]] = {}
    with reading(path, "run sonicvacuum paper uncertainty again"):
        for cells in cells_of(path, tuple(f.name for f in fields(Agreement))):
            share = float(cells[-1])
            if not 0.0 <= share <= 1.0:
                raise ValueError(f"{cells[0]}: probability is {share:g}, outside 0 to 1")
            found.setdefault(cells[0], {})[cells[1]] = share
    return found
