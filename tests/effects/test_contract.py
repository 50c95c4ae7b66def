"""What every effect owes, by simulation: limits, gradients, lanes, energy, and a second implementation."""

import math
from dataclasses import replace

import numpy as np
import pytest
import reference
from effect_cases import (
    DURATION,
    INTERVAL,
    OFF,
    SWITCHES,
    TYPICAL,
    WEAK,
    WEAKER,
    batch,
    in_lanes,
    nominal,
    place_of,
    run,
    size,
    values,
)

from sonicvacuum.effects import CATALOGUE, effect

every_switch = pytest.mark.parametrize(("id", "name"), SWITCHES)
TIMES = np.arange(math.floor(DURATION / INTERVAL * (1 + 1e-12)) + 1) * INTERVAL
SENSORS = (("embedded", 3), ("wall", None))
# In sonic vacuum a load at rest is no small perturbation: delta_0 = (F_0/K)^{2/3}, Hertz's law inverted.
LEADING_POWER = {"static-preload": 2 / 3, "gravity": 2 / 3}
# The dashpot's force jumps from 0 to c v where a contact closes, which costs either solver its order there.
# The layer's rational form departs from the exact solution by up to 6e-4 in force.
AGREEMENT = {"linear-dashpot": 3e-5, "coating-thickness": 1e-3}


def brings_a_term(id):
    """Whether an effect adds to the force law."""
    setup = nominal()
    typical = values(id, effect(id).parameters[0].name, [1.0], setup)
    return bool(effect(id).apply(setup, **typical, **place_of(id)).chain.actions)


WITH_TERMS = [e.id for e in CATALOGUE if brings_a_term(e.id)]


def plain(id, parameters, place, lane, base=None):
    """The plain chain with one lane's effect in it."""
    base = base or reference.Plain()
    numbers = {k: float(v[lane]) for k, v in parameters.items()}
    return replace(base, **reference.EFFECTS[id](base, **numbers, **place))


@every_switch
def test_agrees_with_a_second_implementation(id, name):
    b = batch(id, name)
    p = plain(id, b.parameters, b.place, TYPICAL)
    expected = reference.read(p, TIMES, reference.solve(p, TIMES), SENSORS)
    error = np.abs(b.readings[..., TYPICAL] - expected).max(axis=0) / np.abs(expected).max(axis=0)
    # Both solvers err by some 1e-6 of the peak; 1e-5 leaves room for filters by different quadratures.
    assert error.max() < AGREEMENT.get(id, 1e-5)


@every_switch
def test_contacts_never_pull(id, name):
    force = batch(id, name).history.force
    # Loads at rest are not in the recorded force; they are a fraction of a newton in any of the batches.
    at_rest = batch(id, name).setup.chain.static_forces(force.shape[1])
    assert np.all(force + at_rest >= -1e-12 * force.max())  # rounding of the load at rest
    assert force.max() > 0.5


@every_switch
def test_a_lane_in_which_it_is_off_is_nominal(id, name):
    b = batch(id, name)
    symplectic = b.setup.chain.laws().splits
    nominals = in_lanes(nominal(), len(b.readings[0, 0]))
    # One step for all, as each chain would choose its own.
    step = {"step": b.history.step[0], "refine": 1}
    _, readings = run(nominals, symplectic=symplectic, **step)
    _, lanes = run(b.setup, **step)
    # Rounding: 1e-16 per operation, grown by a few thousand steps.
    np.testing.assert_allclose(lanes[..., OFF], readings[..., OFF], rtol=0, atol=1e-10 * readings.max())


@every_switch
def test_fades_in_proportion_to_its_strength(id, name):
    b = batch(id, name)
    weak, weaker = (size(b.readings[..., lane] - b.readings[..., OFF]) for lane in (WEAK, WEAKER))
    assert weaker > 1e-7 * size(b.readings)
    # 1 % and 2 % of the typical strength: the second order still shows by a few per cent.
    assert math.log2(weak / weaker) == pytest.approx(LEADING_POWER.get(id, 1.0), abs=0.05)


@every_switch
def test_gradient_is_finite_and_does_not_depend_on_the_step(id, name):
    r = batch(id, name).readings
    narrow, wide = (r[..., 3] - r[..., 2]) / 2, (r[..., 5] - r[..., 4]) / 4
    assert np.all(np.isfinite(r))
    # One per cent of a typical effect moves some reading by well over the solver's error of 1e-6.
    assert size(narrow) > 1e-5 * size(r)
    # Central differences differ in second order of 1 %; jumps of the force where contacts close add to that.
    assert size(narrow - wide) < 0.05 * size(narrow)


@pytest.mark.parametrize("id", [i for i, _ in SWITCHES if i not in WITH_TERMS])
def test_lanes_are_single_runs(id):
    one = effect(id)
    setup, place = nominal(), place_of(id)
    strengths = [0.0, 1.0, 0.5, 0.25]
    parameters = values(id, one.parameters[0].name, strengths, setup)
    together = in_lanes(one.apply(setup, **parameters, **place), len(strengths))
    step = {"step": 5e-7, "refine": 1}
    _, lanes = run(together, **step)
    for k in range(len(strengths)):
        alone = one.apply(setup, **{n: float(v[k]) for n, v in parameters.items()}, **place)
        _, single = run(alone, **step)
        # Lanes take square roots to 2e-13 each; thousands of steps sum them up.
        np.testing.assert_allclose(lanes[..., k], single[..., 0], rtol=0, atol=1e-9 * lanes.max())


@pytest.mark.parametrize(
    ("id", "places"), [("mass-defect", (1, 3, 6)), ("contact-gap", (2, 3, 6)), ("sensor-gain", (0, 1, 0))]
)
def test_each_lane_may_have_its_own_place(id, places):
    one, setup, step = effect(id), nominal(), {"step": 5e-7, "refine": 1}
    p = one.parameters[0]
    given = np.array([p.at(s, setup) for s in (1.0, 0.5, 0.25)])
    together = one.apply(setup, **{p.name: given, one.places: np.array(places)})
    _, lanes = run(in_lanes(together, 3), **step)
    for k, place in enumerate(places):
        _, single = run(one.apply(setup, **{p.name: given[k], one.places: place}), **step)
        # Lanes take square roots to 2e-13 each; thousands of steps sum them up.
        np.testing.assert_allclose(lanes[..., k], single[..., 0], rtol=0, atol=1e-9 * lanes.max())


@pytest.fixture(scope="module")
def all_at_once():
    """A vertical chain with every force law in one set, and in each lane one of them switched on."""
    base = reference.Plain(gravity=9.81)
    setup, given = nominal(base), []
    for k, id in enumerate(WITH_TERMS):
        strengths = np.zeros(len(WITH_TERMS))
        strengths[k] = 1.0
        given.append(values(id, effect(id).parameters[0].name, strengths, setup))
        setup = effect(id).apply(setup, **given[-1])
    return base, setup, given, run(setup, refine=8)[1]


@pytest.mark.parametrize("id", WITH_TERMS)
def test_effects_share_a_vertical_chain_without_touching_each_other(id, all_at_once):
    base, _, given, readings = all_at_once
    k = WITH_TERMS.index(id)
    p = plain(id, given[k], {}, k, base)
    expected = reference.read(p, TIMES, reference.solve(p, TIMES), SENSORS)
    error = np.abs(readings[..., k] - expected).max(axis=0) / np.abs(expected).max(axis=0)
    # Like above; coefficients of absent laws are zeros here, not left out.
    assert error.max() < AGREEMENT.get(id, 1e-5)


def test_lanes_of_a_shared_law_set_are_single_runs(all_at_once):
    _, setup, _, _ = all_at_once
    step = {"step": 5e-7, "refine": 1}
    _, lanes = run(setup, **step)
    for k in range(len(WITH_TERMS)):
        _, single = run(replace(setup, chain=setup.chain.take(np.array([k]))), **step)
        # Lanes take square roots to 2e-13 each; thousands of steps sum them up.
        np.testing.assert_allclose(lanes[..., k], single[..., 0], rtol=0, atol=1e-9 * lanes.max())


# What is not a term of the force law, in a chain that bears its weight and a preload.
WITHOUT_TERMS = [
    i for i, n in SWITCHES if i not in WITH_TERMS and not i.startswith("sensor") and n != "mass_ratio"
]


@pytest.mark.parametrize("id", [*WITHOUT_TERMS, "mass-defect"])
def test_effects_without_terms_act_in_a_loaded_chain_too(id):
    base = reference.Plain(gravity=9.81, preload=0.05)
    setup, place = nominal(base), place_of(id)
    given = values(id, effect(id).parameters[0].name, [1.0, 0.5, 0.25], setup)
    readings = run(effect(id).apply(setup, **given, **place))[1]
    p = plain(id, given, place, 0, base)
    expected = reference.read(p, TIMES, reference.solve(p, TIMES), SENSORS)
    error = np.abs(readings[..., 0] - expected).max(axis=0) / np.abs(expected).max(axis=0)
    assert error.max() < 1e-5  # as above


REMEMBERS = ("plastic-contact", "relaxing-contact")


@pytest.mark.parametrize("id", [e.id for e in CATALOGUE if e.dissipative and e.id not in REMEMBERS])
def test_a_dissipative_law_takes_energy_at_every_moment(id):
    energy = batch(id, effect(id).parameters[0].name).history.energy
    start = energy[0, TYPICAL]
    # Carpenter and Kennedy's scheme at this step holds the energy of a lossless chain to 1e-7.
    assert np.diff(energy[:, TYPICAL]).max() < 1e-7 * start
    assert energy[-1, TYPICAL] < energy[-1, WEAK] < energy[-1, OFF] * (1 - 1e-6)


@pytest.mark.parametrize("id", REMEMBERS)
def test_a_law_with_memory_never_gives_back_more_than_it_took(id):
    energy = batch(id, effect(id).parameters[0].name).history.energy
    # The balance counts the loading curve's energy only; what the memory stores besides is taken from it.
    assert energy[:, TYPICAL].max() < energy[0, TYPICAL] * (1 + 1e-7)
    assert energy[-1, TYPICAL] < energy[-1, WEAK] < energy[-1, OFF] * (1 - 1e-6)


LOSSLESS = [(i, n) for i, n in SWITCHES if not effect(i).dissipative]


@pytest.mark.parametrize(("id", "name"), LOSSLESS)
def test_a_lossless_effect_keeps_the_energy(id, name):
    energy = batch(id, name).history.energy
    # Blanes and Moan's scheme at a quarter of the default step.
    np.testing.assert_allclose(energy, np.broadcast_to(energy[0], energy.shape), rtol=1e-6)
