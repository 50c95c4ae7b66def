"""Chains of unlike beads: one way to write them in config.yaml, cards and records, one meaning."""

import copy
import math
from itertools import pairwise

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sonicvacuum.card import CaseBlock, dump, load, resolve
from sonicvacuum.files import InputError
from sonicvacuum.gauges import Gauge
from sonicvacuum.laboratory.bodies import Bodies, to_wall
from sonicvacuum.laboratory.ranges import LaboratoryError
from sonicvacuum.observe.run import Geometry
from sonicvacuum.physics.assemble import assemble
from sonicvacuum.records.reader import parse
from sonicvacuum.records.record import Record
from sonicvacuum.records.writer import dump as written

LARGE = {"diameter_mm": 19.05, "mass_g": 28.2, "material": "stainless-steel"}
SMALL = {"diameter_mm": 9.52, "mass_g": 3.6, "material": "stainless-steel"}
COATED = LARGE | {"material": "parylene-c", "coating_um": 50, "core": "stainless-steel"}
STRIKER = {
    "shape": "sphere", "material": "stainless-steel", "mass_g": 28.2, "diameter_mm": 19.05, "speed_m_s": 0.5
}  # fmt: skip
FOAM = {"bone-foam": {"modulus_GPa": 0.016, "poisson": 0.3, "density_kg_m3": 160.0}}


def chain(**parts):
    return {"beads": 9, "orientation": "vertical", "wall": {"material": "bone-foam"}, **parts}


def case(chain, striker=STRIKER):
    sensors = [{"id": "wall", "kind": "wall"}]
    block = {"title": "t", "chain": chain, "striker": striker, "sensors": sensors, "duration_us": 100.0}
    return resolve("c", "nominal", msgspec.convert(block | {"materials": FOAM}, CaseBlock))


def record(chain, striker=STRIKER):
    scalar = {"quantity": "amplitude", "sensor": "wall", "value": 100.0, "sigma": 1.0, "unit": "N"}
    return Record(
        parse(
            {
                "format": 1,
                "title": "t",
                "chain": chain,
                "materials": FOAM,
                "sensors": [{"id": "wall", "kind": "wall"}],
                "runs": [{"id": "r", "striker": striker, "observables": [scalar]}],
            }
        )
    )


SENSOR_BODY = chain(bead=LARGE, bodies={4: {"mass_g": 29.85, "faces": "flat"}})
DIMER = chain(pattern=[LARGE, SMALL, LARGE])
MIXED = chain(pattern=[LARGE, COATED], bodies={2: {"material": "brass", "coating_um": None, "core": None}})


@pytest.mark.parametrize("block", [SENSOR_BODY, DIMER, MIXED, chain(bead=LARGE)])
def test_a_card_and_a_record_make_the_same_chain(block):
    block = copy.deepcopy(block)
    card, data = load(dump(case(block))), record(block)
    one = assemble(card.specimen, card.strikers())
    other = assemble(data.specimen, [r.striker for r in data.runs])
    for table in ("masses", "stiffnesses", "static_forces", "reduced_radii"):
        assert np.array_equal(getattr(one, table)(10), getattr(other, table)(10))
    assert parse(written(data)) == data.block


def test_a_single_body_differs_in_what_is_said_of_it_only():
    bodies = record(SENSOR_BODY).specimen.bodies
    assert (bodies[4].mass_kg, bodies[4].diameter_m, bodies[4].flat) == (29.85e-3, 19.05e-3, True)
    assert not bodies[3].flat and bodies[3] == bodies[9]
    bare = record(MIXED).specimen.bodies
    assert (bare[2].surface.name, bare[2].core, bare[2].coating_m) == ("brass", None, None)
    assert bare[4].core.name == "stainless-steel"


def test_a_ball_on_flat_faces_is_stiffer_by_root_two():
    # R* of a ball on a flat is R, of two balls R/2, and K goes as its root (Johnson 1985, Eq. 4.23).
    card = case(SENSOR_BODY)
    stiffness = assemble(card.specimen, card.strikers()).stiffnesses(9)[:, 0]
    np.testing.assert_allclose(stiffness[[3, 4]] / stiffness[2], math.sqrt(2.0), rtol=1e-14)  # rounding


def test_a_uniform_card_is_written_as_before():
    text = dump(case(chain(bead=LARGE)))
    assert not any(word in text for word in (b"pattern", b"bodies", b"faces"))


@pytest.mark.parametrize(
    ("block", "parts"),
    [
        (chain(), ["chain.bead", "missing"]),
        (chain(bead=LARGE, pattern=[SMALL]), ["chain.bead", "beside chain.pattern"]),
        (chain(pattern=[]), ["chain.pattern", "length"]),
        (chain(bead=LARGE, bodies={12: {"mass_g": 1.0}}), ["chain.bodies.12", "9 beads"]),
        (chain(bead=LARGE, bodies={2: {"weight_g": 1.0}}), ["bodies", "weight_g"]),
        (chain(pattern=[LARGE, COATED | {"core": None}]), ["chain.pattern[1]", "without core"]),
        (chain(bead=LARGE, bodies={4: {"material": "jelly"}}), ["chain.bodies.4.material", "jelly"]),
        (chain(bead=LARGE, bodies={9: {"faces": "flat"}}), ["last bead", "wall"]),
        (chain(bead=LARGE, bodies={3: {"faces": "flat"}, 4: {"faces": "flat"}}), ["chain", "flat faces"]),
        (chain(bead=LARGE, bodies={4: {"faces": "round"}}), ["faces", "round"]),
    ],
)
def test_chains_that_cannot_be_are_refused_alike(block, parts):
    for make in (case, record):
        with pytest.raises((LaboratoryError, InputError, msgspec.ValidationError)) as caught:
            make(block)
        assert all(part in str(caught.value) for part in parts)


def test_a_flat_striker_on_flat_faces_is_refused():
    flat = {k: v for k, v in STRIKER.items() if k != "diameter_mm"} | {"shape": "flat"}
    for make in (case, record):
        with pytest.raises((LaboratoryError, InputError), match="strike with a sphere"):
            make(chain(bead=LARGE, bodies={1: {"faces": "flat"}}), flat)


def test_a_mass_in_kg_at_one_bead_is_found():
    with pytest.raises(InputError, match=r"chain\.bodies\.5\.mass_g: .* mass in kg"):
        record(chain(bead=LARGE, bodies={5: {"mass_g": 0.0282}}))


@given(
    pattern=st.lists(st.floats(1e-3, 1e-1), min_size=1, max_size=5),
    exceptions=st.dictionaries(st.integers(1, 30), st.floats(1e-3, 1e-1), max_size=6),
    beads=st.integers(1, 30),
    data=st.data(),
)
def test_a_row_of_bodies_is_what_its_list_would_be(pattern, exceptions, beads, data):
    bodies = Bodies(tuple(pattern), exceptions)
    row = [exceptions.get(b, pattern[(b - 1) % len(pattern)]) for b in range(1, beads + 1)]
    assert [bodies[b] for b in range(1, beads + 1)] == row
    assert [bodies.kinds[k] for k in bodies.kinds_of(beads)] == row
    bead = data.draw(st.integers(1, beads))
    found = [bodies.kinds[k] for k in sorted(bodies.counts(bead, beads).elements())]
    assert sorted(found) == sorted(row[bead - 1 :])
    assert to_wall(bodies, bead, beads) == pytest.approx(row[bead - 1] / 2 + sum(row[bead:]))
    pairs = {(bodies.kinds[a], bodies.kinds[b]) for a, b in bodies.neighbours(beads)}
    assert pairs == (set(pairwise(row)) if beads > 1 else {(row[0], row[0])})


def test_gauges_stand_where_the_beads_put_them():
    sensors = (Gauge("a", "embedded", 2), Gauge("b", "embedded", 4), Gauge("w", "wall", None))
    place = Geometry(4, Bodies((3.0, 1.0)), sensors)
    assert [place.position(s.id) for s in sensors] == [4.5, 0.5, 0.0]
    assert place.length == 8.0
    assert place.diameter_between("a", "b") == 2.0
