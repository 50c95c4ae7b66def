"""Chains are simulated with the laws of the effects in force, and with no others."""

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import directions, unknown
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.effects import effect

TWO = ("plastic-contact", "relaxing-contact")


@pytest.fixture(scope="module")
def forward():
    return Forward(experiment(made()[0]))


def in_force(setup):
    return {term.name for term in setup.chain.laws().terms}


def changed(setup, ids):
    """The setup with some effects somewhere in their ranges."""
    parts = tuple(Component(effect(id), variants(effect(id), setup)[0]) for id in ids)
    middle = [0.3 * max(c.low, -3.0) + 0.7 * min(c.high, 3.0) for part in parts for c in part.free]
    lanes = np.zeros(setup.chain.lanes, dtype=int)
    return Hypothesis(parts).change(np.array([middle]))(setup, lanes)


@pytest.mark.parametrize("ids", [(), TWO[:1], TWO, (*TWO, "viscous-drag")])
def test_a_hypothesis_has_the_laws_of_its_effects(forward, ids):
    assert in_force(changed(setup_of(forward), ids)) == {"hertz", *ids}


def test_another_exponent_takes_the_place_of_hertz(forward):
    assert in_force(changed(setup_of(forward), ("contact-exponent", *TWO))) == {"power-contact", *TWO}


@pytest.mark.parametrize("second", ["tsuji", "guide-friction"])
def test_a_direction_beside_them_adds_its_own(forward, second):
    beside = changed(setup_of(forward), TWO)
    (family,) = directions.of_effect(effect(second), beside)
    # As slopes take them: the last chain is the one without, switched off.
    lanes = np.zeros(beside.chain.lanes, dtype=int)
    strengths = np.append(np.full(len(lanes) - 1, 0.1), 0.0)
    assert in_force(family.change(beside, lanes, strengths)) == {"hertz", *TWO, second}


def test_the_test_of_shapes_adds_a_law_of_no_form_alone(forward):
    beside = changed(setup_of(forward), TWO)
    family = unknown.families(forward)[0]
    lanes = np.zeros(beside.chain.lanes, dtype=int)
    flexible = {"flexible-contact", "flexible-drag"}
    assert in_force(family.change(beside, lanes, np.full(len(lanes), 0.1))) == {"hertz", *TWO, *flexible}


def test_an_effect_that_is_off_in_it_changes_nothing(forward):
    """Two steppers, one with a law at strength zero: the same motion within what steps may err."""
    null = nominal(forward)
    families = directions.of_effect(effect("tsuji"), setup_of(forward))
    changes = directions.finite(forward, null.hypothesis, null.u, null.nu, families[0], np.full(1, 1e-9))
    largest = max(float(np.abs(c).max()) for c in changes)
    assert largest < 1e-4  # of a standard error: rounding, and a little damping
