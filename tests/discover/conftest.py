"""What the tests of inference share: one setup, and records that are made once."""

import pytest
from made_records import DAMPING, made

from sonicvacuum.discover import session
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import singles


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
