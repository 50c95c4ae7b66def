"""A card from simulation to readings: errors shrink with the step, aims are met, effects are simulated."""

import json

import msgspec
import numpy as np
import pytest
from click.testing import CliRunner

from sonicvacuum import simulation
from sonicvacuum.card import AimBlock, Card, CardSensor, CardStriker, dump
from sonicvacuum.cli import simulate as verb
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.files import InputError
from sonicvacuum.laboratory.specimen import Bead, Material

STEEL = Material(name="steel", modulus_Pa=193e9, poisson=0.3)


def card(**changes):
    values = {
        "case": "c",
        "variant": "nominal",
        "title": "Eight steel beads",
        "beads": 8,
        "bead": Bead(diameter_m=5e-3, mass_kg=0.5e-3, surface=STEEL),
        "wall": STEEL,
        "striker": CardStriker(mass_kg=0.5e-3, surface=STEEL, speeds_m_s=(0.5,)),
        "gravity_m_s2": 0.0,
        "static_force_N": 0.0,
        "sensors": (CardSensor(id="g", kind="embedded", bead=5), CardSensor(id="wall", kind="wall")),
        "duration_s": 150e-6,
        "interval_s": 0.25e-6,
    }
    return Card(**(values | changes))


def test_the_error_from_half_the_step_bounds_the_true_error():
    done = simulation.simulate(card())
    fine = simulation._simulate(card(), done.speeds, done.contacts, refine=8.0)
    estimate = np.abs(done.force - done.refined).max()
    truth = np.abs(done.refined - fine.force).max()
    # An order above one halves the error at least, so the finer run is off by less than the difference.
    assert truth < estimate
    assert estimate < 1e-4 * done.force.max()  # the accuracy promised by default


def test_energy_and_momentum_stay_in_balance():
    done = simulation.simulate(card(gravity_m_s2=9.81))
    assert np.ptp(done.energy[:, 0]) < 1e-4 * done.energy[0, 0]  # the splitting method's bounded error
    assert np.ptp(done.momentum[:, 0]) < 1e-11 * done.momentum[0, 0]  # exact but for rounding in 1e3 steps


def test_a_sweep_keeps_the_contacts_between_its_gauges_only():
    striker = CardStriker(mass_kg=0.5e-3, surface=STEEL, speeds_m_s=(0.2, 0.4, 0.8))
    upper = CardSensor(id="u", kind="embedded", bead=4)
    sweep = card(striker=striker, sensors=(upper, *card().sensors))
    assert simulation.recorded_contacts(sweep) == (3, 4, 5, 8)
    assert simulation.recorded_contacts(card()) == tuple(range(9))
    assert simulation.recorded_contacts(card(striker=striker)) == tuple(range(9))
    assert simulation.simulate(sweep).force.shape == (601, 4, 3)


def test_the_aimed_amplitude_is_met():
    striker = CardStriker(
        mass_kg=0.5e-3, surface=STEEL, speeds_m_s=(0.5,), aim=AimBlock(sensor="g", amplitude_N=2.0)
    )
    done = simulation.simulate(card(striker=striker))
    assert done.readings()["g"].max() == pytest.approx(
        2.0, rel=1e-5
    )  # tolerance of the aim, and the sampling
    assert 0.0 < done.speeds[0] < 0.5


def test_an_aim_out_of_reach_is_said():
    striker = CardStriker(
        mass_kg=0.5e-3, surface=STEEL, speeds_m_s=(0.5,), aim=AimBlock(sensor="wall", amplitude_N=1.0)
    )
    # The wave is not at the wall by then.
    with pytest.raises(InputError, match=r"c\.nominal: striker\.aim: no speed found"):
        simulation.simulate(card(striker=striker, duration_s=20e-6))


@pytest.mark.parametrize(("amplitude", "cure"), [(5e4, "one in mN: convert it to N"), (2e-2, "one in kN")])
def test_an_aim_in_another_unit_is_suspected(amplitude, cure):
    aim = AimBlock(sensor="g", amplitude_N=amplitude)
    striker = CardStriker(mass_kg=0.5e-3, surface=STEEL, speeds_m_s=(0.5,), aim=aim)
    with pytest.raises(InputError, match=r"c\.nominal: striker\.aim\.amplitude_N: is .*" + cure):
        simulation.simulate(card(striker=striker))


def test_effects_of_a_card_are_simulated():
    plain = simulation.simulate(card()).readings()["g"].max()
    damped = simulation.simulate(card(effects={"kuwabara-kono": {"time_us": 0.5}})).readings()["g"].max()
    louder = (
        simulation.simulate(card(effects={"sensor-gain": {"gain_ratio": 1.5, "sensor": "g"}}))
        .readings()["g"]
        .max()
    )
    assert damped < 0.95 * plain
    assert louder == pytest.approx(1.5 * plain, rel=1e-12)  # the same simulation, times a number


@pytest.mark.parametrize(
    ("effects", "hint"),
    [
        ({"phlogiston": {}}, "phlogiston"),
        ({"kuwabara-kono": {"time_s": 1.0}}, "no parameter time_s"),
        ({"mass-defect": {"mass_ratio": 2.0}}, "bead"),
    ],
)
def test_an_effect_that_cannot_be_is_refused(effects, hint):
    with pytest.raises(InputError, match=f"c.nominal: effects.*{hint}"):
        simulation.simulate(card(effects=effects))


def test_a_study_survives_its_file(tmp_path):
    done = simulation.simulate(card())
    simulation.save(done, tmp_path / "h.npz")
    read = simulation.load(card(), tmp_path / "h.npz")
    for name in ("speeds", "time", "force", "refined", "energy", "momentum"):
        assert np.array_equal(getattr(read, name), getattr(done, name))
    assert read.contacts == done.contacts


def test_a_card_with_effects_survives_its_file():
    from sonicvacuum.card import dump, load

    with_effects = msgspec.structs.replace(card(), effects={"mass-defect": {"mass_ratio": 1.1, "bead": 3.0}})
    assert load(dump(with_effects)) == with_effects


@pytest.mark.parametrize(
    ("times", "told"),
    [
        (
            {"duration_s": 150e-12},
            "duration_us: is 0.00015 us, while a contact lasts .* one in s: convert it",
        ),
        ({"duration_s": 150e-9}, "duration_us: is 0.15 us, .* one in ms or s: convert it to us"),
        (
            {"interval_s": 250e-6},
            "sample_us: is 250 us, while a contact lasts .* one in ns: convert it to us",
        ),
    ],
)
def test_times_in_another_unit_are_suspected(times, told):
    with pytest.raises(InputError, match=told):
        simulation.check_scales(card(**times))
    simulation.check_scales(card())


ALONE = {"beads": 0, "sensors": (CardSensor(id="wall", kind="wall"),)}
# Where an effect cannot act, effect by effect: on solid beads, on one ball, without gauges.
BARE = [
    (one, changes, simulation.set_up(card(**changes)))
    for changes in ({}, ALONE, {"sensors": ()})
    for one in CATALOGUE
]
IDLE = [(one, changes, why) for one, changes, setup in BARE if (why := one.why_not(setup))]


def stated(one):
    """An effect at a usual strength, as a card states it."""
    setup = simulation.set_up(card())
    return {one.id: {p.name: p.at(1.0, setup) for p in one.parameters}}


@pytest.mark.parametrize(("one", "changes", "why"), IDLE, ids=lambda x: getattr(x, "id", None))
def test_an_effect_that_cannot_act_in_its_chain_is_refused_with_its_value_and_the_cure(one, changes, why):
    told = rf"c\.nominal: effects\.{one.id}: {one.parameters[0].name} is .*, but {why}; state what it acts on"
    with pytest.raises(InputError, match=told):
        simulation.set_up(card(effects=stated(one), **changes))


def test_an_effect_that_is_off_acts_nowhere_and_is_refused_nowhere():
    assert {one.lacks for one in CATALOGUE if one.lacks} == {one.lacks for one, _, _ in IDLE if one.lacks}
    for one, changes, _ in IDLE:
        simulation.set_up(card(effects={one.id: {}}, **changes))


def test_the_commands_name_the_file_whose_effect_cannot_act(tmp_path):
    layer = next(one for one in CATALOGUE if one.stated)
    path, model = tmp_path / "c.json", tmp_path / "model.json"
    told = f"c.nominal: effects.{layer.id}: layer_thickness_um is 100, but no coating is stated"
    path.write_bytes(dump(card(effects=stated(layer))))
    ended = CliRunner().invoke(verb.simulate, [str(path), "--out", str(tmp_path / "h.npz")])
    assert str(ended.exception).startswith(f"{path}: {told}")
    path.write_bytes(dump(card()))
    nuisances = {"speed_ratio": {}, "trigger_us": {}, "gain": {}, "modulus_ratio": 1.0}
    content = {"format": 1, "record": "other", "effects": stated(layer), **nuisances}
    model.write_text(json.dumps(content))
    given = [str(path), "--model", str(model), "--out", str(tmp_path / "h.npz")]
    assert str(CliRunner().invoke(verb.simulate, given).exception).startswith(f"{path} with {model}: {told}")
