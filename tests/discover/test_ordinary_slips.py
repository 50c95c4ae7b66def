"""Slips that concern several gauges at once, one run's clock, or a number that another contradicts: each was
told as effects beside `unknown` before, after a minute or more.
"""

import math
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest
from made_records import block, made

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes, starts
from sonicvacuum.discover.faults.slips import hypotheses
from sonicvacuum.records import Record
from sonicvacuum.records.suspects import weights

G4, G7, G2 = (("gauge-misplaced", None, f"g{b}") for b in (4, 7, 2))


def told(record):
    """Slips of a verdict, (fault, run, gauge) → value, and what is named."""
    v = session.discover(record).verdict
    sure = [f for f in v.faults if f.probability > 0.9]
    gauges = [tuple(f.sensor) if isinstance(f.sensor, list) else f.sensor for f in sure]
    return {(f.fault, f.run, g): f.value for f, g in zip(sure, gauges, strict=True)}, v.named


def test_gauges_counted_from_the_wall_or_from_0_are_asked_for(empty):
    """Beads 4 and 7 of ten are 7 and 4 from the wall, which is one cable for the other."""
    ways = [s for s in hypotheses(empty) if s.each]
    assert [s.each for s in ways] == [{"g4": 5.0, "g7": 8.0}, {"g4": 3.0, "g7": 6.0}]
    sides = changes.gauges_at(empty, {"g4": 2})
    assert {"g4": 9.0, "g7": 4.0} in [s.each for s in hypotheses(sides) if s.each]
    outermost = changes.gauges_at(empty, {"g7": 10})
    assert [s.each for s in hypotheses(outermost) if s.each] == [
        {"g4": 3.0, "g7": 9.0},
        {"g4": 7.0, "g7": 1.0},
    ]


def test_a_gauge_alone_is_not_asked_for_twice(empty):
    alone = msgspec.structs.replace(empty.block, sensors=empty.block.sensors[:1])
    assert [s.each for s in hypotheses(Record(alone, empty.signals)) if s.each] == [{"g4": 7.0}]
    middle = changes.gauges_at(Record(alone, empty.signals), {"g4": 5})
    assert not [s for s in hypotheses(middle) if s.each]


@pytest.mark.parametrize("by", [1, -1])
def test_all_gauges_a_bead_off_are_told_one_by_one(empty, by):
    found, named = told(changes.gauges_at(empty, {"g4": 4 + by, "g7": 7 + by}))
    assert found == {G4: 4.0, G7: 7.0}
    assert named == []


def test_gauges_counted_from_the_wall_are_told():
    sensors = [
        {"id": f"g{b}", "kind": "embedded", "bead": b, "sigma_N": 0.02, "gain_rel_sigma": 0.02}
        for b in (2, 7)
    ]
    record, _ = made(seed=6, sensors=sensors)
    found, named = told(changes.gauges_at(record, {"g2": 9, "g7": 4}))
    assert found == {G2: 2.0, G7: 7.0}
    assert named == []


@pytest.mark.parametrize("names", [("g4", "g7", "wall"), ("g4", "wall", "g7")])
def test_cables_that_went_round_are_told(empty, names):
    round_ = dict(zip(names, names[1:] + names[:1], strict=True))
    found, named = told(changes.gauges_renamed(empty, round_))
    assert [(fault, set(gauges)) for fault, _, gauges in found] == [("gauges-swapped", set(names))]
    assert named == []


@pytest.mark.parametrize("factor", [pytest.param(2.0, marks=pytest.mark.long), 0.5])
def test_a_run_at_another_sampling_rate_is_told(factor):
    record, _ = made(seed=8, speeds=(0.3, 0.5, 0.9))
    found, named = told(changes.clock(record, -math.log(factor), ("v1",)))
    assert list(found) == [("clock", "v1", None)]
    assert found["clock", "v1", None] == pytest.approx(factor, rel=0.02)  # speeds are stated to 1 %
    assert named == []


def pulses(widths):
    """Run → gauge → a pulse of such a width in samples."""
    place = np.arange(200) - 100.0
    return {run: {"g": np.exp(-((place / width) ** 2))} for run, width in widths.items()}


@pytest.mark.parametrize(
    ("widths", "off"),
    [
        ({"a": 12.0, "b": 12.0, "c": 24.0}, ["c"]),
        # Damping makes all pulses longer.
        ({"a": 24.0, "b": 24.0, "c": 24.0}, []),
        ({"a": 24.0, "b": 24.0, "c": 12.0}, ["c"]),
        # Of two the one that is not as long as predicted.
        ({"a": 12.0, "b": 6.0}, ["b"]),
        ({"a": 12.0, "b": 13.0}, []),
        ({"a": 24.0}, []),
    ],
)
def test_a_run_is_asked_for_its_clock_where_its_pulses_are_of_another_length(widths, off):
    signals = {run: SimpleNamespace(readings=given) for run, given in pulses(widths).items()}
    found = starts.run_clocks(SimpleNamespace(signals=signals), pulses(dict.fromkeys(widths, 12.0)))
    assert [s.run for s in found] == off


def weighing(record, **bead):
    """The record with its beads of steel as heavy as they are, and these of their numbers changed."""
    chain = record.block.chain
    block = msgspec.structs.replace(chain.bead, material="stainless-steel", **bead)
    chain = msgspec.structs.replace(chain, bead=block)
    return Record(msgspec.structs.replace(record.block, chain=chain), record.signals)


def test_sizes_start_where_balls_weigh_what_their_material_does(empty):
    (usual,) = {w.usual for w in weights(weighing(empty)) if not w.striker}
    halved = weighing(empty, diameter_mm=2.43, mass_g=1e3 * usual)
    assert starts._weighed(halved, "bead-size") == pytest.approx(math.log(2.0))
    heavy = weighing(empty, mass_g=3e3 * usual)
    assert starts._weighed(heavy, "bead-mass") == pytest.approx(-math.log(3.0))
    assert starts._weighed(weighing(empty, mass_g=1.05e3 * usual), "bead-mass") == 0.0
    assert starts._weighed(halved, "striker-mass") == 0.0  # a flat striker has no size


@pytest.mark.parametrize("factor", [2.0, pytest.param(0.5, marks=pytest.mark.long)])
def test_radii_stated_for_diameters_are_told(factor):
    """Half the size makes contacts of 0.7 times the stiffness, which a modulus or a wall does nearly as well;
    that it is what the beads weigh tells them apart.
    """
    given = block((0.3, 0.5, 0.9))
    given["chain"]["bead"] = {"diameter_mm": 7.69, "mass_g": 0.5953, "material": "glass"}
    given["materials"] = {"glass": {"modulus_rel_sigma": 0.08}}
    for sensor in given["sensors"]:
        sensor["sigma_N"] *= 10.0
    record, _ = made(seed=9, given=given)
    assert not any(w.off for w in weights(record))
    v = session.discover(changes.beads(record, "diameter_mm", -math.log(factor))).verdict
    assert [f.fault for f in v.faults if f.probability > 0.9] == ["bead-size"]
    # The modulus is stated to 8 %, and contacts go as the root of the size.
    assert v.faults[0].value == pytest.approx(factor, rel=0.16)
    assert v.named == []
