"""Beads counted wrongly in chains with single beads that differ: never asked for before, so that a wall far
too stiff beside `unknown` stood for one bead less.
"""

import msgspec
import pytest
from made_records import block, made

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.faults.slips import hypotheses
from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse

INTRUDER = {5: {"diameter_mm": 9.72, "mass_g": 3.5}}


def content(bodies):
    """A horizontal chain of ten beads, some of them others."""
    given = block((0.3, 0.9))
    given["chain"]["bodies"] = bodies
    return given


def counted(bodies):
    """(beads, places of single beads, place of the first gauge) of all slips of counting of such a chain."""
    record = Record(parse(content(bodies)))
    found = [s.change(record, 0.0).block for s in hypotheses(record) if s.fault == "bead-count"]
    return {(b.chain.beads, *sorted(b.chain.bodies), b.sensors[0].bead) for b in found}


def test_single_beads_stand_where_they_are_counted_from_either_end():
    assert counted(INTRUDER) == {(9, 5, 4), (11, 5, 4), (9, 4, 3), (11, 6, 5)}


def test_a_bead_more_or_less_is_of_the_chain_s_own_kind():
    """Of a chain that ends with a bead of another kind no bead is missing or too many there."""
    assert counted({10: INTRUDER[5]}) == {(9, 9, 3), (11, 11, 5)}
    assert counted({1: INTRUDER[5]}) == {(9, 1, 4), (11, 1, 4)}
    assert counted({1: INTRUDER[5], 10: INTRUDER[5]}) == set()


@pytest.mark.parametrize("from_wall", [False, True])
def test_a_count_is_undone_with_its_single_beads(from_wall):
    record = Record(parse(content(INTRUDER)))
    more = changes.bead_count(record, 1, from_wall)
    assert msgspec.to_builtins(changes.bead_count(more, -1, from_wall).block) == msgspec.to_builtins(
        record.block
    )


def test_a_bead_too_many_is_told_in_a_chain_with_an_intruder():
    record, _ = made(seed=4, given=content(INTRUDER))
    v = session.discover(changes.bead_count(record, 1)).verdict
    assert [(f.fault, f.value) for f in v.faults if f.probability > 0.9] == [("bead-count", 10.0)]
    assert v.named == []
