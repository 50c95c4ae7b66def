"""The table of probabilities: `results/uncertainty.csv`."""

from collections.abc import Iterable
from dataclasses import dataclass, fields

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
    """Claim → model → probability, of a table that `write` wrote."""
    found: dict[str, dict[str, float]] = {}
    for cells in cells_of(path, tuple(f.name for f in fields(Agreement))):
        found.setdefault(cells[0], {})[cells[1]] = float(cells[-1])
    return found
