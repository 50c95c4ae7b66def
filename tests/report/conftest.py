"""Folders of verdicts that the tests of pages read."""

import datetime

import pytest
from made_chains import record
from made_verdicts import KINDS, write

from sonicvacuum.discover import given
from sonicvacuum.discover.verdict import write_json
from sonicvacuum.figures import discovery
from sonicvacuum.report.record import write_page


@pytest.fixture
def folder(tmp_path):
    """A verdict of one effect, with the origin of its data; without pictures and page."""
    made = write(tmp_path / "made", "single")
    source = {"date": datetime.date(2026, 5, 1), "licence": "CC0"}
    write_json(given.inputs((record(source=source),), ("g1: 3 spikes left out",)), made / given.FILE)
    return made


@pytest.fixture(scope="session")
def folders(tmp_path_factory):
    """Kind of outcome → its folder with pictures and page."""
    root = tmp_path_factory.mktemp("discover")
    made = {kind: write(root / kind, kind) for kind in KINDS}
    for folder in made.values():
        discovery.draw(folder)
        write_page(folder)
    return made
