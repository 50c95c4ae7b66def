"""Which card stands for a case in a column of the ledger, and the metrics found under such names."""

from collections.abc import Iterable, Mapping

from sonicvacuum.card import Card, variant_names
from sonicvacuum.config import Config, card
from sonicvacuum_paper.rows import Row

# A variant with this ending is its namesake with the loss effects at their off value; where a column of the
# ledger is another one's model with a loss, that column serves.
LOSSLESS = "-lossless"
TWINS = {"layer_loss": "layer", "matched_loss": "matched"}


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
