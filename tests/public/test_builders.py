"""Cases built in Python: the same cards as from mappings, masses from densities, mistakes named."""

import numpy as np
import pytest
import yaml
from ball import RECORD as ON_A_WALL

import sonicvacuum as sv
from sonicvacuum import card
from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse

STEEL = {"diameter_mm": 5.0, "mass_g": 0.5, "material": "bearing-steel"}
BALL = sv.bead(**STEEL)
WALL = sv.gauge("wall")
RECORD = Record(parse(yaml.safe_load(ON_A_WALL)))


def test_builders_and_mappings_give_the_same_card():
    built = sv.case(
        sv.chain(pattern=[BALL, sv.bead(**STEEL | {"mass_g": 0.4})], beads=8, bodies={3: {"mass_g": 0.6}}),
        sv.striker(BALL, speed_m_s=0.5),
        [sv.gauge("velocity", bead=4, id="laser", lowpass_us=1.0)],
        duration_us=200,
    )
    mapped = sv.case(
        chain={
            "beads": 8,
            "orientation": "horizontal",
            "pattern": [STEEL, STEEL | {"mass_g": 0.4}],
            "bodies": {3: {"mass_g": 0.6}},
            "wall": {"material": "bearing-steel"},
        },
        striker={"shape": "sphere", **STEEL, "speed_m_s": 0.5},
        sensors=[{"id": "laser", "kind": "velocity", "bead": 4, "lowpass_us": 1.0}],
        duration_us=200,
    )
    assert card.dump(built) == card.dump(mapped)


def test_a_bead_in_place_of_another_replaces_it_whole():
    coated = sv.bead(diameter_mm=5.0, material="parylene-c", coating_um=50.0, core="bearing-steel")
    made = sv.case(
        sv.chain(bead=coated, beads=5, bodies={2: BALL}),
        sv.striker(BALL, speed_m_s=0.5),
        [WALL],
        duration_us=9,
    )
    assert made.wall.name == "bearing-steel"  # the core's material
    assert made.bodies[2].coating_m is None
    assert made.bead.coating_m == 50e-6


@pytest.mark.parametrize(
    ("coating", "mass_g"),
    [
        ({}, np.pi / 6 * 0.02**3 * 7810e3),
        # A shell of parylene, 1289 kg/m³, around a core that is 0.1 mm thinner across: Eq. (2) of the paper.
        (
            {"material": "parylene-c", "coating_um": 50, "core": "bearing-steel"},
            np.pi / 6 * (0.0199**3 * 7810e3 + (0.02**3 - 0.0199**3) * 1289e3),
        ),
    ],
)
def test_masses_follow_from_densities(coating, mass_g):
    made = sv.bead(**({"diameter_mm": 20.0, "material": "bearing-steel"} | coating))
    assert made.mass_g == pytest.approx(mass_g, rel=1e-12)  # rounding


def test_numbers_of_numpy_are_numbers():
    balls = [sv.bead(diameter_mm=d, material="glass") for d in 10 * 0.9 ** np.arange(6)]
    hit = sv.striker(balls[0], speed_m_s=np.array([0.1, 0.2]))
    made = sv.case(sv.chain(pattern=balls), hit, [sv.gauge("velocity", bead=np.int64(3))], duration_us=10.0)
    assert made.beads == 6
    assert made.striker.speeds_m_s == (0.1, 0.2)


def whole(**changes):
    parts = {
        "chain": sv.chain(bead=BALL, beads=3),
        "striker": sv.striker(BALL, speed_m_s=1.0),
        "sensors": [WALL],
    }
    return sv.case(**parts | changes, duration_us=10.0)


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: sv.bead(diameter_mm=-1, material="glass"), r"bead: diameter_mm: is -1: .*> 0"),
        (lambda: sv.bead(diameter_mm="5", material="glass"), "bead: diameter_mm: is '5': .*without quotes"),
        (lambda: sv.bead(diameter_mm=5, material="glas"), "bead: mass_g: missing; .*'glas'"),
        (lambda: sv.bead(diameter_mm=5, material="glass", mass_g=0), "bead: mass_g: is 0"),
        (lambda: sv.bead(diameter_mm=5, material="glass", faces="flat"), "bead: mass_g: missing; only that"),
        (lambda: sv.bead(diameter_mm=5, material="parylene-c", coating_um=50), r"bead.*core"),
        (
            lambda: sv.bead(diameter_mm=5, material="parylene-c", coating_um=5000, core="glass"),
            r"bead\.coating_um: .*5000",
        ),
        (lambda: sv.bead(diameter_mm=1e308, material="glass"), r"bead\.diameter_mm: is 1e\+308 mm, outside"),
        (lambda: sv.bead(diameter_mm=float("inf"), material="glass"), "bead: diameter_mm: is inf"),
        (lambda: sv.gauge("velocity", bead=1.5), r"gauge: bead: is 1\.5"),
        (lambda: sv.chain(pattern=3, beads=3), "chain: pattern: is a int"),
        (lambda: sv.chain(bead=BALL, beads=3, bodies=[BALL]), "chain: bodies: is a list"),
        (lambda: sv.simulate("card.json"), "simulate: is given 'card.json'; give a card"),
        (lambda: sv.discover("rec"), r"discover: is given 'rec' as a record; give what sv\.read"),
        (lambda: sv.compare("model.json", "rec"), r"compare: is given 'rec' as a record; give what sv\.read"),
        (
            lambda: sv.discover([RECORD]),
            r"discover: is given a list of records; .*\(\*records\)$",
        ),
        (lambda: sv.discover(RECORD, threads=0), "discover: threads: is 0; give a whole number from 1 on"),
        (lambda: sv.discover(RECORD, threads=1.5), r"discover: threads: is 1\.5; give a whole number"),
        (
            lambda: sv.compare("model.json", RECORD, threads=-1),
            "compare: threads: is -1; give a whole number",
        ),
        (
            lambda: sv.simulate(whole(), model=3),
            "simulate: is given 3 as a model; give what discover returned",
        ),
        (lambda: sv.read(""), "the path of a record is empty"),
        (lambda: sv.chain(beads=3), "chain: bead: missing"),
        (lambda: sv.chain(bead=BALL), "chain: beads: missing"),
        (lambda: sv.striker(speed_m_s=1.0, shape="flat", material="glass"), "striker: mass_g: missing"),
        (lambda: sv.striker(BALL, speed_m_s=object()), "striker: holds a object"),
        (lambda: whole(sensors=[sv.gauge("velocity", bead=9)]), r"case: sensors\[0\]\.bead"),
        (lambda: whole(sensors=[{"id": "g", "kind": "speed"}]), r"case: sensors\[0\]\.kind: .*velocity"),
        (lambda: sv.gauge("speed", bead=2), r"gauge: kind: is 'speed'; the kinds of gauges are .*velocity"),
        (
            lambda: sv.gauge("velocity"),
            "gauge: bead: missing; a velocity sensor needs",
        ),
        (lambda: sv.gauge("wall", bead=2), "gauge: bead: is 2; the wall sensor sits in no bead"),
        (
            lambda: sv.bead(diameter_mm=5.0, material="steel"),
            "mass_g: missing; .* no density of 'steel': give mass_g, or one of .*bearing-steel",
        ),
        (lambda: whole(chain=sv.chain(bead=BALL, beads=3, bodies={9: BALL})), r"case: chain\.bodies\.9"),
    ],
)
def test_mistakes_are_named_with_key_value_and_cure(make, told):
    with pytest.raises(sv.InputError, match=told):
        make()


def test_a_pattern_may_be_any_series_of_beads():
    balls = [sv.bead(diameter_mm=d, material="glass") for d in (5.0, 4.0, 3.0)]
    assert sv.chain(pattern=(ball for ball in balls)) == sv.chain(pattern=balls)
    assert sv.chain(pattern=np.array(balls, dtype=object)) == sv.chain(pattern=balls)
