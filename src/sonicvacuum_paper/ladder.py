"""The ladder of models: how the columns of the ledger are called, and how many statements each is left with.

The coating is a half-space (Hertz) or the bonded layer of 50 µm that the paper prints, with one of the static
moduli or with the 15 GPa that the paper fits, without loss or with one. A model is never credited with a
statement that it was fitted to: `claims.csv` names these models in its column `fitted`.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

# Kinds of statements. Only the first needs a simulation.
SIMULATION, THEORY, ARITHMETIC, TEXT = "simulation", "theory", "arithmetic", "text"
KINDS = (SIMULATION, THEORY, ARITHMETIC, TEXT)
LOSS = "loss"


@dataclass(frozen=True)
class Model:
    """A column of the ledger.

    Attributes:
        title: its name in tables.
        free: free parameters that were fitted, in words.
        counted: whether it takes part in the totals.
    """

    title: str
    free: str
    counted: bool = True


MODELS = {
    "handbook": Model("Hertz, 2.76 GPa", "0"),
    "layer": Model("layer, 2.76 GPa", "0"),
    "layer_membrane": Model("layer, 4.75 GPa", "0"),
    "matched": Model("Hertz, 15 GPa", "1: modulus"),
    "layer_loss": Model("layer, 2.76 GPa, loss", "1: loss"),
    "matched_loss": Model("Hertz, 15 GPa, loss", "2: modulus, loss"),
    "named": Model("as discovered", "as many as named"),
    "ideal": Model("layer, ideal gauges", "0", counted=False),
}
NAMED = "named"
COLUMNS = tuple(MODELS)
# The first of these that has a number decides: the printed layer, to which nothing is fitted.
DECIDING = ("layer", "matched", "handbook", "layer_membrane", "layer_loss", "matched_loss", "named")


@dataclass(frozen=True)
class Total:
    """How one model fares with the statements that need a simulation.

    Attributes:
        model: its column.
        agrees: statements that it reproduces without having been fitted to them.
        fitted: those that it reproduces after having been fitted to them.
        excluded: those that it contradicts.
        outside: those that it cannot show, or gives no number for.
    """

    model: str
    agrees: int
    fitted: int
    excluded: int
    outside: int


def title(column: str) -> str:
    """Name of a column in tables and sentences."""
    return MODELS[column].title if column in MODELS else column


def totals(ledger: Iterable[Mapping[str, str]]) -> list[Total]:
    """One total per model, in the order of the ladder; a model without any number is left out.

    Args:
        ledger: rows with the columns of `ledger.LedgerRow`, as text.
    """
    rows = [r for r in ledger if r["kind"] == SIMULATION]
    found = []
    for column, model in MODELS.items():
        if not model.counted or not any(r[column] for r in rows):
            continue
        agrees, fitted, excluded = (
            sum(column in members(r[part]) for r in rows) for part in ("agrees", "fitted", "excluded")
        )
        found.append(Total(column, agrees, fitted, excluded, len(rows) - agrees - fitted - excluded))
    return found


def members(cell: str) -> dict[str, str]:
    """Column → what stands behind it, of a cell like `handbook -4.3; layer +3.6; named`."""
    parts = (part.split() for part in cell.split(";") if part.strip())
    return {name: " ".join(rest) for name, *rest in parts}
