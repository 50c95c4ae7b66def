"""How well moduli, walls and static forces are known where a record states it, and where it does not."""

import msgspec
import pytest
from made_records import TOLERANCES, block, made, with_keys

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.model.nuisances import assumed, exact
from sonicvacuum.discover.model.problem import experiment, together
from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse


def test_what_counts_as_exact_is_said(empty):
    bodies = "the beads' mass, the beads' diameter, the striker's mass"
    assert exact(empty, experiment(empty).shared) == f"{bodies}: taken as exact, no tolerance being stated"
    some = with_keys(empty, tolerances={"bead_mass_rel": 0.002, "bead_diameter_rel": 0.0005})
    words = exact(some, experiment(some).shared)
    assert words == "the striker's mass: taken as exact, no tolerance being stated"
    assert exact(some, experiment(with_keys(empty, tolerances=TOLERANCES)).shared) == ""


def test_what_is_taken_of_moduli_is_said(empty):
    chains = [batch.chain for batch in experiment(empty).batches]
    taken = "errors of moduli taken, none being stated"
    assert assumed(empty, chains) == f"{taken}: alumina 5 %, stainless-steel 1 %"
    given = {name: {"modulus_rel_sigma": 0.02} for name in ("alumina", "stainless-steel")}
    assert (
        assumed(with_keys(empty, materials={"alumina": given["alumina"]}), chains)
        == f"{taken}: stainless-steel 1 %"
    )
    assert assumed(with_keys(empty, materials=given), chains) == ""
    steel = wall_of(empty, "stainless-steel", {"modulus_rel_sigma": 0.0}, "bearing-steel")
    unstated = msgspec.structs.replace(steel.block, materials={})
    assert "bearing-steel 5 %" in assumed(
        Record(unstated, empty.signals, "other"), [experiment(steel).batches[0].chain]
    )


def test_a_static_force_has_an_error_where_there_is_one(empty):
    chain = {**block((0.3, 0.9))["chain"], "static_force_N": 2.0}
    pressed = Record(parse({**block((0.3, 0.9)), "chain": chain}), empty.signals, "pressed")
    kinds = {one.kind: one.sigma for one in experiment(pressed).shared}
    assert kinds["static-force"] == 0.02
    assert "static-force" not in {one.kind for one in experiment(empty).shared}
    assert "static force 2 %" in assumed(pressed, [b.chain for b in experiment(pressed).batches])
    known = with_keys(pressed, tolerances={"static_force_rel": 0.0})
    assert "static-force" not in {one.kind for one in experiment(known).shared}
    assert "static force" not in assumed(known, [b.chain for b in experiment(known).batches])


def test_materials_of_all_strikers_are_open_in_an_order_of_their_own():
    """Where runs are exchanged their strikers are; what a slip is weighed in must stay as it is."""
    given = block((0.3, 0.6, 0.9))
    for run, material in zip(given["runs"], ("ptfe", "nylon", "delrin"), strict=True):
        run["striker"] = {**run["striker"], "material": material}
    record, _ = made(seed=5, given=given)
    names = [one.of for one in experiment(record).shared if one.kind == "modulus"]
    assert names == ["delrin", "nylon", "ptfe"]
    turned = changes.runs_swapped(record, "v0", "v2")
    assert [one.of for one in experiment(turned).shared if one.kind == "modulus"] == names
    assert session.discover(turned).verdict.faults[0].fault == "runs-swapped"


def wall_of(record: Record, name: str, given: dict | None, bead: str = "brass") -> Record:
    """The record with solid beads of `bead` on a wall of a material, of which `given` is stated."""
    content = block([r.striker.speed_m_s for r in record.block.runs])
    solid = {k: v for k, v in content["chain"]["bead"].items() if k not in ("coating_um", "core")}
    content["chain"] |= {"bead": solid | {"material": bead}, "wall": {"material": name}}
    content["materials"] = {bead: {"modulus_rel_sigma": 0.05}} | ({name: given} if given else {})
    return Record(parse(content), record.signals, "other")


@pytest.mark.parametrize(
    ("name", "given", "error"),
    [
        ("stainless-steel", None, 0.01),  # 20 samples within 1 %, see materials.py
        ("stainless-steel", {"modulus_GPa": 193.0}, 0.01),  # key by key: the error stays the table's
        ("tool-steel", {"modulus_GPa": 207.0, "poisson": 0.3}, 0.01),
        ("glass", None, 0.05),
        ("plate", {"modulus_GPa": 207.0, "poisson": 0.3}, 0.05),
        ("stainless-steel", {"modulus_rel_sigma": 0.1}, 0.1),
    ],
)
def test_a_wall_is_as_well_known_as_its_material(quiet, name, given, error):
    moduli = {o.of: o.sigma for o in experiment(wall_of(quiet, name, given)).shared if o.kind == "modulus"}
    assert moduli[name] == error


def test_beads_without_a_stated_error_are_known_to_a_twentieth_whatever_they_are_made_of(quiet):
    content = wall_of(quiet, "glass", None, "stainless-steel").block
    unstated = msgspec.structs.replace(content, materials={})
    assert experiment(Record(unstated, quiet.signals, "other")).modulus_rel_sigma == 0.05


def test_so_are_beads_of_every_material_of_a_pattern(quiet):
    given = block((0.3, 0.9))
    bead = given["chain"].pop("bead")
    given["chain"]["pattern"] = [{**bead, "material": name} for name in ("delrin", "stainless-steel")]
    record = Record(parse({**given, "materials": {}}), quiet.signals, "dimer")
    assert (
        record.taken_modulus_rel_sigma("delrin") == record.taken_modulus_rel_sigma("stainless-steel") == 0.05
    )
    assert record.taken_modulus_rel_sigma("bearing-steel") == 0.01


def test_a_static_force_of_any_record_of_several_is_open():
    records = []
    for force in (0.0, 2.0):
        given = block((0.3, 0.9))
        given["chain"]["static_force_N"] = force
        records.append(made(seed=7, given=given)[0])
    for order in (records, records[::-1]):
        assert [one.kind for one in together(order).shared] == ["static-force"]
