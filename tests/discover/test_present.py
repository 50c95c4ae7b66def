"""Effects that a record says act: part of the nominal model, with what is open of them as a nuisance."""

import numpy as np
import pytest
from test_told_fully import FORCE, SPEED, block, record

from sonicvacuum.discover import verdict
from sonicvacuum.discover.compare import compare
from sonicvacuum.discover.fit.normal import linearise
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.verdict import Model
from sonicvacuum.effects import effect
from sonicvacuum.files import InputError

LAYER = "coating-thickness"
BEAD = {
    "diameter_mm": 4.86,
    "mass_g": 0.44,
    "material": "parylene-c",
    "coating_um": 50,
    "core": "stainless-steel",
}
CHAIN = block([0.3])["chain"] | {"bead": BEAD}
GIVEN = [SPEED | {"value": 200.0, "sigma": 2.0}, FORCE | {"value": 3.0, "sigma": 0.3}]
TOLERANCES = {"coating_rel": 0.1}


@pytest.fixture(scope="module")
def layered():
    known = record(*GIVEN, chain=CHAIN, tolerances=TOLERANCES, priors={LAYER: "present"})
    return Forward(experiment(known))


@pytest.fixture(scope="module")
def plain():
    return Forward(experiment(record(*GIVEN, chain=CHAIN, tolerances=TOLERANCES)))


def shown(forward, hypothesis=None, nu=0.0, place=None):
    """The whitened predictions, one nuisance off."""
    at = np.zeros((1, forward.layout.size))
    at[0, place if place is not None else 0] = nu
    return forward.sampled(hypothesis or Hypothesis(), np.zeros((1, 0)), at)[0][0]


def with_layer(thickness):
    return Hypothesis((Component(effect(LAYER), (), {"layer_thickness_um": thickness}),))


def test_it_acts_in_the_nominal_model_and_is_not_searched_for(layered, plain):
    np.testing.assert_allclose(shown(layered), shown(plain, with_layer(50.0)), rtol=1e-12)  # um to m and back
    assert LAYER in plain.experiment.catalogue.ids and LAYER not in layered.experiment.catalogue.ids
    assert LAYER in layered.experiment.catalogue  # whoever reads a model with it finds it


def test_its_thickness_is_open_within_what_the_record_states(layered, plain):
    (place,) = layered.layout.other("coating")
    assert layered.nuisance_sigma[place] == 0.1 and not plain.layout.other("coating")
    off = shown(plain, with_layer(50.0 * np.exp(0.2)))
    np.testing.assert_allclose(
        shown(layered, nu=2.0, place=place), off, rtol=1e-12
    )  # rounding of one product


def test_the_model_that_is_written_holds_it_as_fitted(layered):
    nu = np.zeros((1, layered.layout.size))
    nu[0, layered.layout.other("coating")] = 1.0
    one = Fit(Hypothesis(), linearise(layered, Hypothesis(), np.zeros((1, 0)), nu))
    assert verdict.present(layered, one) == {LAYER: {"layer_thickness_um": pytest.approx(50.0 * np.exp(0.1))}}


@pytest.mark.parametrize(
    ("chain", "name", "cure"),
    [
        (CHAIN, "kuwabara-kono", "does not say how well time_us is known"),
        (block([0.3])["chain"], LAYER, "no coating is stated"),
    ],
)
def test_what_cannot_be_known_to_act_is_refused(chain, name, cure):
    known = record(*GIVEN, chain=chain, tolerances=TOLERANCES, priors={name: "present"})
    with pytest.raises(InputError, match=rf"priors\.{name}: cannot be present: .*{cure}"):
        experiment(known)


def test_a_thickness_without_an_error_is_refused():
    with pytest.raises(InputError, match="give coating_um and tolerances"):
        experiment(record(*GIVEN, chain=CHAIN, priors={LAYER: "present"}))


def test_a_model_that_holds_it_is_compared_as_it_is(layered):
    fitted = {"speed_ratio": {}, "trigger_us": {}, "gain": {}, "modulus_ratio": 1.0}
    model = Model(record="made", effects={LAYER: {"layer_thickness_um": 50.0}}, **fitted)
    found = compare(model, layered.experiment.record)
    assert found.effects == [LAYER] and found.gap.after == found.gap.before
