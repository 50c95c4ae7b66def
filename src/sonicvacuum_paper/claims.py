"""The tables of claims and assumptions: what is asked, row by row; see `workflow/resources/claims.md`."""

from dataclasses import dataclass, fields

from sonicvacuum.files import InputError
from sonicvacuum_paper.ladder import ARITHMETIC, SIMULATION, TEXT, THEORY
from sonicvacuum_paper.rows import cells_of
from sonicvacuum_paper.verdict import UNTESTED


@dataclass(frozen=True)
class Claim:
    """One line of `claims.csv`; see `claims.md`.

    `needs` is `loss` where no model without losses can show the statement; `fitted` names the columns whose
    models were fitted to it; `reading` is the standard error that the printed number keeps once gauges,
    levels and calibration are drawn, where it is less than sigma.
    """

    claim: str
    section: str
    statement: str
    quantity: str
    unit: str
    value: str
    sigma: str
    sigma_source: str
    test: str
    metric: str
    note: str
    needs: str = ""
    fitted: str = ""
    reading: str = ""

    @property
    def kind(self) -> str:
        """What tests it: a simulation, the equations, arithmetic on printed numbers, or nothing."""
        if self.test in UNTESTED:
            return TEXT
        return {"theory": THEORY, "paper": ARITHMETIC, "audit": ARITHMETIC}.get(
            self.metric.split("/")[0], SIMULATION
        )


def read_table(path, kind: type) -> list:
    """The lines of a table of claims or assumptions; InputError names file, line and cure."""
    rows = [kind(*cells) for cells in cells_of(path, tuple(f.name for f in fields(kind)))]
    names = [getattr(r, fields(kind)[0].name) for r in rows]
    for name in names:
        if names.count(name) > 1:
            raise InputError(
                f"{path}: {name} stands here {names.count(name)} times; rename or remove all but one"
            )
    return rows
