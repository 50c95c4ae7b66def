"""All cards of the configuration, simulated and read once for the tests of this folder (fifteen seconds)."""

from pathlib import Path

import pytest

from sonicvacuum import config, simulation
from sonicvacuum_paper.columns import Metrics
from sonicvacuum_paper.metrics import card_rows
from sonicvacuum_paper.stages import derived_rows

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def cases():
    """The configuration that the pipeline reads."""
    return config.read(ROOT / "config.yaml")


@pytest.fixture(scope="session")
def simulated(cases):
    """Card name → its rows."""
    cards = [config.card(cases, *name.split(".")) for name in config.card_names(cases)]
    return {c.name: card_rows(simulation.simulate(c)) for c in cards}


@pytest.fixture(scope="session")
def all_rows(cases, simulated):
    """Every row of results/metrics.csv."""
    rows = [r for of_card in simulated.values() for r in of_card]
    return [*rows, *derived_rows(rows, cases)]


@pytest.fixture(scope="session")
def metrics(cases, all_rows):
    """The rows by name, with the columns of the ledger."""
    return Metrics(all_rows, cases.ledger)
