"""What is left is told in words: pages read "a misfit in run is left", by the key of a group of shapes."""

import made_tables
import pytest

from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.judge.left import left
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import directions, screen, singles, unknown


def test_every_group_of_directions_has_its_words(empty):
    known = set()
    for record in (empty, made_tables.chain()):
        forward = Forward(experiment(record))
        fit = nominal(forward)
        families = directions.catalogue(singles.setup_of(forward), ())
        known |= set(unknown.shape_test(forward, fit, screen.screen(forward, fit, families)).groups)
    assert known == set(unknown.GROUPS)


@pytest.mark.parametrize("group", unknown.GROUPS)
def test_a_misfit_is_told_in_words(empty, group):
    forward = Forward(experiment(empty))
    seen = left(forward, nominal(forward), None)
    seen.shapes.__dict__["group"] = group
    assert seen.where == seen.shapes.misfit == f"a misfit {unknown.GROUPS[group]}"
