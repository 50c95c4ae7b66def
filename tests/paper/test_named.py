"""The model that discover makes of a record, put into a case: all of it, or what another chain shares."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from sonicvacuum import config, simulation
from sonicvacuum.card import ModelBlock, load
from sonicvacuum.cli.card import card as card_command
from sonicvacuum.cli.simulate import simulate
from sonicvacuum.discover.extended import extended
from sonicvacuum.discover.verdict import Model
from sonicvacuum.effects import CATALOGUE, trial
from sonicvacuum.files import InputError


def model(ratio=1.0, **effects):
    effects = {name.replace("_", "-"): given for name, given in effects.items()}
    return Model(record="r", effects=effects, speed_ratio={}, trigger_us={}, gain={}, modulus_ratio=ratio)


@pytest.fixture
def base(cases):
    return config.card(cases, "fig3a", "named")


MODEL = model(
    2.0,
    kuwabara_kono={"time_us": 1.5},
    mass_defect={"mass_ratio": 1.2, "bead": 13.0},
    static_preload={"force_N": 0.1},
)


def test_a_model_without_anything_leaves_the_card_alone(base):
    assert extended(base, model()) == base


def test_the_nominal_card_is_the_handbooks(base, cases):
    handbook = config.card(cases, "fig3a", "handbook")
    assert (base.bead, base.striker, base.effects) == (handbook.bead, handbook.striker, {})


def test_the_same_chain_takes_all_of_a_model(base):
    found = extended(base, MODEL)
    assert found.bead.surface.modulus_Pa == 2.0 * base.bead.surface.modulus_Pa
    assert (found.striker, found.wall) == (base.striker, base.wall)
    assert list(found.effects) == ["kuwabara-kono", "mass-defect", "static-preload"]
    chain = simulation.set_up(found).chain
    assert chain.masses(20)[13, 0] == pytest.approx(1.2 * chain.masses(20)[12, 0], rel=1e-12)  # rounding


def test_a_dynamic_modulus_is_the_modulus_of_the_card(base):
    found = extended(base, model(1.1, dynamic_modulus={"modulus_ratio": 3.0}))
    assert found.effects == {}
    assert found.bead.surface.modulus_Pa == pytest.approx(3.3 * base.bead.surface.modulus_Pa, rel=1e-15)
    # The effect on the handbook's chain and the card say the same.
    one, other = simulation.set_up(found).chain, simulation.set_up(extended(base, model(3.3))).chain
    assert one.first.surface.modulus[0] == pytest.approx(
        other.first.surface.modulus[0], rel=1e-15
    )  # rounding


def test_a_wall_of_the_beads_material_is_stiffened_along(cases):
    steel = config.card(cases, "fig3b", "ideal")
    assert extended(steel, model(1.1)).wall.modulus_Pa == pytest.approx(1.1 * 193e9, rel=1e-15)  # rounding


def test_another_chain_takes_the_contact_laws_only(cases):
    wanted = config.model(cases, "fig6a", "named")
    found = extended(config.card(cases, "fig6a", "named"), MODEL, wanted)
    assert list(found.effects) == ["kuwabara-kono"]
    assert found.bead.surface.modulus_Pa == 2.0 * 2.76e9


def test_the_lossless_twin_keeps_what_takes_no_energy(base):
    found = extended(base, MODEL, ModelBlock(record="r", losses="left-out"))
    assert list(found.effects) == ["mass-defect", "static-preload"]


def test_effects_of_the_material_sit_nowhere_and_touch_no_gauge():
    of_material = [e for e in CATALOGUE if e.of_material]
    assert {e.places for e in of_material} == {None}
    assert len(of_material) == 10
    setup = trial.sample(coated=True)
    for one in of_material:
        given = {p.name: p.at(1.0, setup) for p in one.parameters}
        assert one.apply(setup, **given).sensors is setup.sensors


def test_every_case_has_a_named_variant_of_a_known_record(cases):
    named = [case for case, block in cases.cases.items() if "named" in config.variant_names(block)]
    assert set(cases.cases) - set(named) == {"ratio-2", "ratio-5"}
    for case in named:
        assert config.model(cases, case, "named").record in cases.records
        assert config.model(cases, case, config.variant_names(cases.cases[case])[0]) is None


def test_a_model_of_no_record_is_refused(tmp_path, pytestconfig):
    path = tmp_path / "config.yaml"
    text = (pytestconfig.rootpath / "config.yaml").read_text()
    path.write_text(text.replace("record: daraio-nesterenko-2006-steel", "record: guess"))
    with pytest.raises(InputError, match=r"variant named: model\.record: is 'guess'; no such record"):
        config.read(path)


def test_two_records_of_one_folder_name_are_refused(tmp_path, pytestconfig):
    path = tmp_path / "config.yaml"
    text = (pytestconfig.rootpath / "config.yaml").read_text()
    first = "  - workflow/resources/measured/daraio-nesterenko-2006-coated\n"
    path.write_text(text.replace(first, first + "  - elsewhere/daraio-nesterenko-2006-coated\n"))
    with pytest.raises(InputError, match=r"discover\[0\]: .*another record has that folder name"):
        config.read(path)


@pytest.fixture
def written(tmp_path):
    path = tmp_path / "model.json"
    content = {"speed_ratio": {}, "trigger_us": {}, "gain": {}, "modulus_ratio": 1.5}
    effects = {"viscous-drag": {"rate_per_s": 300.0}}
    path.write_text(json.dumps({"record": "r", "effects": effects, **content}))
    return path


def test_the_command_puts_a_model_into_a_card(written, tmp_path, pytestconfig):
    call = ["--config", str(pytestconfig.rootpath / "config.yaml"), "--case", "fig5b", "--variant"]
    out = tmp_path / "card.json"
    done = CliRunner().invoke(card_command, [*call, "named", "--model", str(written), "--out", str(out)])
    assert done.exit_code == 0, done.output
    found = load(out.read_bytes())
    assert found.effects == {"viscous-drag": {"rate_per_s": 300.0}}
    assert found.bead.surface.modulus_Pa == 1.5 * 193e9
    without = CliRunner().invoke(card_command, [*call, "named"])
    assert "give --model with the model.json" in str(without.exception)
    needless = CliRunner().invoke(card_command, [*call, "nominal", "--model", str(written)])
    assert "takes no model" in str(needless.exception)


def test_simulate_takes_a_model(written, tmp_path, pytestconfig):
    card, plain, damped = (tmp_path / name for name in ("card.json", "plain.npz", "damped.npz"))
    call = ["--config", str(pytestconfig.rootpath / "config.yaml"), "--case", "fig3b", "--variant", "nominal"]
    CliRunner().invoke(card_command, [*call, "--out", str(card)], catch_exceptions=False)
    for out, more in ((plain, []), (damped, ["--model", str(written)])):
        CliRunner().invoke(simulate, [str(card), "--out", str(out), *more], catch_exceptions=False)
    strong, weak = (np.load(path)["force"].max() for path in (plain, damped))
    assert weak != strong
