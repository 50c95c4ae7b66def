"""The cards of all figures, simulated once, and the files made of them."""

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from sonicvacuum import config, simulation
from sonicvacuum_paper import figures


@pytest.fixture(scope="session")
def simulations(pytestconfig):
    """Card name → simulation."""
    cases = config.read(pytestconfig.rootpath / "config.yaml")
    cards = [card for name in figures.names() for card in figures.cards_of(name)]
    return {card: simulation.simulate(config.card(cases, *card.split("."))) for card in cards}


@pytest.fixture(scope="session")
def made(simulations, tmp_path_factory):
    """Figure name → paths of its CSV, SVG and PNG."""
    folder = tmp_path_factory.mktemp("figures")
    return {name: figures.make(name, simulations, folder) for name in figures.names()}


@pytest.fixture(scope="session")
def drawn(made):
    """Figure name → (table read back, figure drawn from it)."""
    import pandas

    found = {}
    for name, (path, *_) in made.items():
        figure = figures.draw(name, path)
        FigureCanvasAgg(figure).draw()
        found[name] = pandas.read_csv(path), figure
    return found
