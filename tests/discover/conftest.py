"""What the tests of inference share: one setup, and records that are made once."""

import pytest
from made_records import DAMPING, made

from sonicvacuum.discover import session
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import singles
from sonicvacuum.effects import effect


@pytest.fixture(scope="session")
def hidden():
    """A record with Kuwabara–Kono damping of 0.3 us."""
    return made([("kuwabara-kono", {"time_us": DAMPING})], seed=2)[0]


@pytest.fixture(scope="session")
def empty():
    """A record of the nominal model."""
    return made(seed=4)[0]


@pytest.fixture(scope="session")
def setup(empty):
    """The nominal setup of that record."""
    return singles.setup_of(Forward(experiment(empty)))


@pytest.fixture(scope="session")
def verdict(hidden):
    """What is found in the record with damping."""
    return session.discover(hidden)


@pytest.fixture(scope="session")
def nothing(empty):
    """What is found in the nominal record."""
    return session.discover(empty)


@pytest.fixture(scope="session")
def quiet():
    """A record of the nominal model, nuisances at zero, its noise left out."""
    return made(noise=0.0)[0]


@pytest.fixture
def two():
    """A hypothesis of one effect with two parameters, which nearly replace one another."""
    own = effect("relaxing-contact")
    (free,) = variants(own, None)
    return Hypothesis((Component(own, free),))
