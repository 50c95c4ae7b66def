"""Cards: what a user writes becomes SI once, variants change what they say and nothing else."""

import copy
import json
import math
import re

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from sonicvacuum.card import CaseBlock, dump, load, merged, resolve, variant_names
from sonicvacuum.cli.cards import read_card
from sonicvacuum.config import Config, card, card_names, read, schema
from sonicvacuum.files import InputError, convert
from sonicvacuum.laboratory.ranges import LaboratoryError

CASE = {
    "title": "a chain",
    "chain": {
        "beads": 5,
        "orientation": "vertical",
        "bead": {
            "diameter_mm": 4.86,
            "mass_g": 0.44,
            "material": "parylene-c",
            "coating_um": 50,
            "core": "stainless-steel",
        },
        "wall": {"material": "stainless-steel"},
    },
    "striker": {"shape": "flat", "material": "alumina", "mass_g": 0.47, "speed_m_s": 0.44},
    "sensors": [{"id": "g1", "kind": "embedded", "bead": 3}, {"id": "wall", "kind": "wall"}],
    "duration_us": 500,
    "variants": {
        "soft": {"materials": {"parylene-c": {"modulus_GPa": 2.0}}},
        "flat": {"chain": {"orientation": "horizontal"}},
    },
}


def altered(path, value):
    """The case with one key set, or removed by `...`."""
    case = copy.deepcopy(CASE)
    *parents, last = path
    block = case
    for key in parents:
        block = block[key]
    if value is ...:
        del block[last]
    else:
        block[last] = value
    return case


def resolved(case, variant="soft"):
    return card(Config(cases={"c": case}, ledger={}), "c", variant, "config.yaml")


def test_units_become_si():
    c = resolved(CASE)
    lengths = (c.bead.diameter_m, c.bead.mass_kg, c.bead.coating_m)
    assert lengths == pytest.approx((0.00486, 0.00044, 50e-6), rel=1e-15)  # one rounding in the division
    assert (c.duration_s, c.interval_s) == pytest.approx((500e-6, 0.5e-6), rel=1e-15)  # likewise
    assert c.bead.surface.modulus_Pa == 2e9


def test_overrides_leave_the_rest_of_the_table_alone():
    surface = resolved(CASE).bead.surface
    assert (surface.poisson, surface.density_kg_m3) == (0.388, 1289.0)
    assert resolved(CASE).wall.modulus_Pa == 193e9


def test_variants_change_only_what_they_name():
    soft, flat = resolved(CASE, "soft"), resolved(CASE, "flat")
    assert (soft.gravity_m_s2, flat.gravity_m_s2) == (9.81, 0.0)
    assert flat.bead.surface.modulus_Pa == 2.76e9
    assert soft.striker == flat.striker


def test_a_case_without_variants_is_nominal():
    case = altered(["variants"], ...)
    assert variant_names(case) == ["nominal"]
    assert resolved(case, "nominal").name == "c.nominal"


def test_merging_does_not_touch_what_was_written():
    before = copy.deepcopy(CASE)
    merged(CASE, "soft")
    assert before == CASE


def test_a_card_survives_its_file():
    assert load(dump(resolved(CASE))) == resolved(CASE)


@given(st.floats(0.2, 20.0), st.floats(100.0, 2e4), st.lists(st.floats(1e-3, 10.0), min_size=1, max_size=5))
def test_any_likely_numbers_survive(diameter, density, speeds):
    case = altered(["chain", "bead", "diameter_mm"], diameter)
    case["chain"]["bead"]["mass_g"] = density * 1e-6 * math.pi / 6.0 * diameter**3
    case["striker"]["speed_m_s"] = speeds
    c = resolved(case)
    assert load(dump(c)) == c
    assert c.striker.speeds_m_s == tuple(speeds)


UNLIKELY = [
    (["chain", "bead", "diameter_mm"], 0.00486, "chain.bead.diameter_mm", "looks like one in m"),
    (["chain", "bead", "mass_g"], 0.44e-3, "chain.bead.mass_g", "mass in kg"),
    (["striker", "mass_g"], 0.47e-3, "striker.mass_g", "looks like one in kg"),
    (["striker", "speed_m_s"], [0.4, 440.0], "striker.speed_m_s", "looks like one in mm/s"),
    (["materials"], {"parylene-c": {"modulus_GPa": 2.76e9}}, "materials.parylene-c.modulus_GPa", "in Pa"),
    (["chain", "static_force_N"], 2e5, "chain.static_force_N", "convert it to N"),
    (["duration_us"], math.inf, "duration_us", "inf"),
    (
        ["materials"],
        {"parylene-c": {"density_kg_m3": 1.289}},
        "materials.parylene-c.density_kg_m3",
        "in g/cm3",
    ),
    (["materials"], {"parylene-c": {"yield_MPa": 59e6}}, "materials.parylene-c.yield_MPa", "in Pa"),
    (["sensors", 0, "droop_us"], 1e-3, "sensors[0].droop_us", "in s or ms: convert it to us"),
    (["sensors", 0, "lowpass_us"], 2e4, "sensors[0].lowpass_us", "in ns: convert it to us"),
    (["sensors", 0, "id"], "time_us", "sensors[0].id", "column of the times"),
    (["sensors", 0, "id"], "run", "sensors[0].id", "column of the numbers of runs"),
]
# Keys of a case that hold a number which no range limits, and why.
FREE = {
    "beads", "bead", "bodies",  # counts and places, checked against the chain
    "duration_us", "sample_us", "amplitude_N",  # held against the impact, in simulation.check_scales
    "poisson",  # limited by its type
}  # fmt: skip


def numbers(schema, kind, path=()):
    """Paths of all numbers in a JSON schema, through the blocks that it refers to."""
    properties = schema["$defs"][kind].get("properties", {})
    for key, found in properties.items():
        text = json.dumps(found)
        if '"number"' in text or '"integer"' in text:
            yield (*path, key)
        for inner in re.findall(r"#/\$defs/(\w+)", text):
            if inner not in path:
                yield from numbers(schema, inner, (*path, key))


def test_no_number_of_a_case_is_without_a_range():
    """A number that no laboratory has is refused wherever it stands, so that no key was forgotten."""
    solid = {"modulus_GPa": 3.0, "poisson": 0.3}
    case = altered(["materials"], {"rubber": solid})
    places = {
        "chain": ["chain"],
        "materials": ["materials", "rubber"],
        "striker": ["striker"],
        "sensors": ["sensors", 0],
    }
    seen = set()
    for path in numbers(schema(), "CaseBlock"):
        if path[-1] in FREE or path[0] not in places or path[-1] in seen:
            continue
        seen.add(path[-1])
        inside = [*places[path[0]], *(key for key in path[1:-1] if key in ("bead",)), path[-1]]
        for value in (1e12, *([1e-12] if path[-1] not in ("static_force_N", "lowpass_us") else [])):
            block = copy.deepcopy(case)
            place = block
            for key in inside[:-1]:
                place = place[key]
            place[inside[-1]] = value
            if path == ("striker", "diameter_mm"):
                block["striker"]["shape"] = "sphere"
            with pytest.raises(InputError, match=path[-1].replace("_mm", "")):
                resolved(block)
    assert seen >= {
        "diameter_mm",
        "mass_g",
        "coating_um",
        "static_force_N",
        "speed_m_s",
        "droop_us",
        "lowpass_us",
    }
    assert seen >= {"modulus_GPa", "density_kg_m3", "yield_MPa"}


@pytest.mark.parametrize(("path", "value", "place", "hint"), UNLIKELY, ids=lambda p: str(p)[:30])
def test_what_no_laboratory_has_is_refused_as_in_records(tmp_path, path, value, place, hint):
    case = altered(path, value)
    del case["variants"]
    file = tmp_path / "config.yaml"
    file.write_text(yaml.safe_dump({"cases": {"c": case}, "ledger": {}}))
    with pytest.raises(InputError, match=re.escape(place) + ".*" + re.escape(hint)):
        read(file)


DAMAGED_CARDS = [
    (["striker", "aim"], {"sensor": "g7", "amplitude_N": 1.0}, "striker.aim.sensor.*'g7'"),
    (["sensors", 0, "bead"], 6, r"sensors\[0\].bead.*5 beads"),
    (["sensors", 0, "bead"], 0, r"sensors\[0\].bead: is 0.*5 beads, counted from 1"),
    (["sensors", 0, "bead"], None, r"sensors\[0\].bead"),
    (["sensors", 1, "id"], "g1", r"sensors\[1\].id.*'g1'"),
    (["sensors", 1, "id"], "wall\n", r"sensors\[1\].id"),
    (["sensors", 1, "kind"], "ear", r"sensors\[1\].kind.*'ear'"),
    (["case"], "../c", "case: is '../c'"),
    (["title"], "a\x1b[31m", "title.*control characters"),
    (["wall", "poisson"], 0.7, "wall.poisson.*0.7"),
    (["bead", "surface", "poisson"], -1.0, "bead.surface.poisson"),
    (["bead", "core"], None, "bead: coating_um is given without core"),
    (["bead", "diameter_m"], 4.86, "bead.diameter_mm.*outside"),
    (["striker", "speeds_m_s"], [1e4], "striker.speeds_m_s.*outside"),
    (["beads"], "5", "beads.*'5'"),
    (["duration_s"], -1.0, "duration_s"),
]


@pytest.mark.parametrize(("path", "value", "told"), DAMAGED_CARDS, ids=lambda p: str(p)[:30])
def test_a_card_handed_over_is_checked_as_a_case_is(tmp_path, path, value, told):
    content = json.loads(dump(resolved(CASE)))
    *parents, last = path
    block = content
    for key in parents:
        block = block[key]
    block[last] = value
    file = tmp_path / "card.json"
    file.write_text(json.dumps(content))
    with pytest.raises(InputError, match="card.json: " + told):
        read_card(file)


MISTAKES = [
    (["striker", "speed_m_s"], "1e-1", "striker.speed_m_s", "1.0e-1"),
    (["striker", "speed_m_s"], -0.4, "striker.speed_m_s", "-0.4"),
    (["striker", "speed_m_s"], [], "striker.speed_m_s", "[]"),
    (["striker", "shape"], "cone", "striker.shape", "cone"),
    (["striker", "shape"], "sphere", "striker.diameter_mm", "needs its diameter"),
    (["striker", "velocity"], 1.0, "striker.velocity", "unknown key"),
    (["striker", "material"], "kryptonite", "striker.material", "modulus_GPa"),
    (["striker", "aim"], {"sensor": "g7", "amplitude_N": 1.0}, "striker.aim.sensor", "g7"),
    (["chain", "bead", "mass_g"], ..., "chain.bead.mass_g", "missing"),
    (["chain", "bead", "core"], ..., "chain.bead", "coating_um is given without core"),
    (["chain", "bead", "coating_um"], 5000, "chain.bead.coating_um", "must be below half"),
    (["chain", "beads"], 0, "chain.beads", "0"),
    (["chain", "beads"], 2, "sensors[0].bead", "2 beads"),
    (["chain", "orientation"], False, "chain.orientation", "YAML reads"),
    (["sensors", 0, "bead"], ..., "sensors[0].bead", "embedded"),
    (["sensors", 1, "bead"], 2, "sensors[1].bead", "drop"),
    (["sensors", 1, "id"], "wall\n", "sensors[1].id", r"wall\n"),
    (["sensors"], [], "sensors", "[]"),
    (["title"], ..., "title", "missing"),
    (["variants"], ["soft"], "variants", "overrides"),
]


@pytest.mark.parametrize(("path", "value", "place", "hint"), MISTAKES)
def test_a_mistake_is_named_with_its_place_and_cure(path, value, place, hint):
    with pytest.raises(InputError) as error:
        resolved(altered(path, value))
    message = str(error.value)
    assert message.startswith(f"config.yaml: cases.c.{place}")
    assert hint in message
    assert "\n" not in message


def test_unknown_case_and_variant_list_the_known_ones():
    with pytest.raises(InputError, match=r"cases\.d: no such case; known: c"):
        card(Config(cases={"c": CASE}, ledger={}), "d", "soft")
    with pytest.raises(InputError, match=r"no variant 'hard'; known: soft, flat"):
        resolved(CASE, "hard")


def test_resolve_names_the_key_of_an_unsound_block():
    block = convert(altered(["variants"], ...) | {"variants": {}}, CaseBlock, "f")
    with pytest.raises(LaboratoryError, match=r"sensors\[0\]\.bead"):
        resolve("c", "nominal", convert(altered(["sensors", 0, "bead"], 9), CaseBlock, "f"))
    assert resolve("c", "nominal", block).beads == 5


def test_the_projects_own_configuration_is_sound(request):
    config = read(request.config.rootpath / "config.yaml")
    names = card_names(config)
    assert len(names) == len(set(names)) > 20
    assert {"fig3a.handbook", "fig3a.matched", "fig3b.nominal"} <= set(names)


def test_the_schema_in_git_is_the_one_that_checks(request):
    import json

    kept = request.config.rootpath / "workflow/schemas/config.schema.json"
    assert json.loads(kept.read_text()) == json.loads(json.dumps(schema()))


@pytest.mark.parametrize(
    ("folder", "cure"),
    [
        (".", "ends with the folder's name"),
        ("records/..", "ends with the folder's name"),
        ("-x", "write ./-x"),
        ("a{b}", "rename the folder"),
        ("a\nb", "rename the folder"),
        ("a ", "rename the folder"),
    ],
)
def test_a_folder_that_the_workflow_would_take_for_something_else_is_refused(tmp_path, folder, cure):
    path = tmp_path / "config.yaml"
    content = {"ledger": {}, "cases": {"one": CASE}, "discover": [folder]}
    path.write_text(json.dumps(content))
    with pytest.raises(InputError, match=r"discover\[0\].*" + re.escape(cure)):
        read(path)


def test_any_other_folder_is_taken(tmp_path):
    path = tmp_path / "config.yaml"
    name = "a b; $(x) 'q' \"d\" * ü"
    path.write_text(json.dumps({"ledger": {}, "cases": {"one": CASE}, "discover": ["records/" + name]}))
    assert list(read(path).records) == [name]


@pytest.mark.parametrize(
    ("cases", "told"),
    [
        ({"one": CASE, "One": CASE}, "cases: 'One' and 'one'"),
        ({"one": CASE | {"variants": {"soft": {}, "SOFT": {}}}}, "cases.one.variants: 'SOFT' and 'soft'"),
    ],
)
def test_names_that_would_be_one_file_are_refused(tmp_path, cases, told):
    path = tmp_path / "config.yaml"
    path.write_text(json.dumps({"cases": cases}))
    with pytest.raises(InputError, match=re.escape(told) + " would be one file"):
        read(path)
