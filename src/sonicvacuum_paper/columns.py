"""Which card stands for a case in a column of the ledger, and the metrics found under such names."""

from collections.abc import Iterable, Mapping
from difflib import get_close_matches

from sonicvacuum import config as configuration
from sonicvacuum.card import Card, variant_names
from sonicvacuum.config import Config, card
from sonicvacuum.files import InputError
from sonicvacuum.schema_errors import likely
from sonicvacuum_paper.ladder import COLUMNS
from sonicvacuum_paper.rows import Row

# A variant with this ending is its namesake with the loss effects at their off value; where a column of the
# ledger is another one's model with a loss, that column serves.
LOSSLESS = "-lossless"
TWINS = {"layer_loss": "layer", "matched_loss": "matched"}
# Names as alike as this are one, misspelt: `handbok`. Those of the paper's own variants are less alike.
MISSPELT = 0.8


def read(path) -> Config:
    """The configuration in a file, with the columns of its ledger checked: a misspelt one would stay empty.

    Raises:
        InputError: as of `config.read`; for a column that the ledger does not have, and for a variant that no
            case has and one has with nearly that name. Others may be missing: a case need not have them all.
    """
    config = configuration.read(path)
    known = list(dict.fromkeys(v for case in config.cases.values() for v in variant_names(case)))
    for column, variants in config.ledger.items():
        place = f"{path}: ledger.{column}"
        if column not in COLUMNS:
            cure = likely(column, COLUMNS) or f"the columns are {', '.join(COLUMNS)}"
            raise InputError(f"{place}: the ledger has no such column; {cure}")
        for number, variant in enumerate(variants):
            near = [] if variant in known else get_close_matches(variant, known, 1, MISSPELT)
            if near:
                told = f"is {variant!r}, which no case has as a variant"
                raise InputError(f"{place}[{number}]: {told}; did you mean {near[0]}?")
    return config


class Metrics:
    """Metrics by case, quantity and sensor, a case being looked up in a column of the ledger.

    Args:
        rows: all metrics.
        columns: column → variants that stand for it, the first that a case has being taken.
    """

    def __init__(self, rows: Iterable[Row], columns: Mapping[str, list[str]]):
        self.columns = dict(columns)
        self._rows = {r.key: r for r in rows}
        self._cases = {r.case for r in self._rows.values()}

    def name(self, case: str, column: str) -> str | None:
        """Name under which a case's metrics stand in a column: `case.variant`, `case.column` or `case`."""
        names = [f"{case}.{v}" for v in self.columns.get(column, [])] + [f"{case}.{column}", case]
        return next((n for n in names if n in self._cases), None)

    def find(self, case: str, column: str, quantity: str, sensor: str = "") -> Row | None:
        """The metric of a case in a column; a pseudo-case may hold some per column and some for all."""
        named = self.name(case, column)
        for name in dict.fromkeys(n for n in (named, case) if n):
            if row := self._rows.get((name, quantity, sensor)):
                return row
        return None

    def at(self, name: str, quantity: str, sensor: str = "") -> Row | None:
        """The metric of a card by its full name."""
        return self._rows.get((name, quantity, sensor))


def lossless_twin(metrics: Metrics, case: str, column: str, quantity: str, sensor: str = "") -> Row | None:
    """The metric of the same model without its losses; None where it was not simulated."""
    if column in TWINS:
        return metrics.find(case, TWINS[column], quantity, sensor)
    name = metrics.name(case, column)
    return name and metrics.at(name + LOSSLESS, quantity, sensor)


def column_cards(config: Config, case: str) -> dict[str, Card]:
    """Column of the ledger → the card that stands for a case; a column that has none is left out."""
    if case not in config.cases:
        return {}
    known = variant_names(config.cases[case])
    chosen = {c: next((v for v in variants if v in known), None) for c, variants in config.ledger.items()}
    return {column: card(config, case, variant) for column, variant in chosen.items() if variant}
