"""Two implementations of the same contract: the hidden-effect laws against the engine with the catalogue."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from sonicvacuum.effects import CATALOGUE, effect
from sonicvacuum.records.predict import Conditions
from sonicvacuum.records.predict import predict as engine
from sonicvacuum_blind import catalogue, design
from sonicvacuum_blind.prediction import predict
from sonicvacuum_blind.record import as_record

# Largest difference over the largest reading: errors of peaks and arrivals of the engine's step.
USUAL = 3e-5
CLOSE = {
    "guide-friction": 1e-2,  # below 1 mm/s a straight line here and a cubic there
    "sensor-lowpass": 5e-4,  # two grids on which the force is taken as linear
    "coating-thickness": 1e-3,  # two solutions of the layer, each put into a formula good to 6e-4
    "linear-dashpot": 1e-4,  # the force jumps where contacts close
}


@pytest.fixture(scope="module")
def record():
    """A drawn design: a horizontal coated chain, two speeds."""
    drawn = (design.draw("traces", np.random.default_rng(seed)) for seed in range(200))
    chosen = next(d for d in drawn if d.coating is not None and not d.reference.gravity)
    return replace(chosen, runs=chosen.runs[:2])


def readings(made, model):
    found = engine(as_record(made, np.zeros((2, 3, made.samples)), np.zeros(0), "compared"), model)
    return np.array([[run.readings[g.id] for g in made.reference.gauges] for run in found])


def test_both_know_the_same_effects_and_parameters():
    assert [e.id for e in catalogue.ENTRIES] == [e.id for e in CATALOGUE]
    for entry, other in zip(catalogue.ENTRIES, CATALOGUE, strict=True):
        assert entry.places == other.places


def test_nominal_chains_agree(record):
    mine = predict(record, tolerance=1e-10).traces
    assert np.abs(mine - readings(record, Conditions())).max() < USUAL * np.abs(mine).max()


@pytest.mark.parametrize("entry", catalogue.ENTRIES, ids=lambda e: e.id)
def test_effects_agree(record, entry):
    plan = record.reference
    shape = entry.shapes(plan)[-1]
    place = entry.where(plan)[0] if entry.places == "sensor" else plan.gauges[0].bead - 2
    place = place if entry.places else None
    strength = 0.7 if entry.id == "gravity" else 5.0 * entry.start
    parameters = entry.values(strength, plan, shape)
    given = parameters | ({entry.places: place} if entry.places else {})
    mine = predict(record, catalogue.hidden(entry, strength, shape, place, plan), tolerance=1e-10).traces
    other = readings(record, Conditions(model=lambda setup: effect(entry.id).apply(setup, **given)))
    largest = np.abs(mine).max()
    assert np.abs(mine - other).max() < CLOSE.get(entry.id, USUAL) * largest
    assert np.abs(mine - predict(record).traces).max() > 0.01 * largest


CONTACT_LAWS = (
    "contact-exponent",
    "coating-thickness",
    "plastic-contact",
    "linear-dashpot",
    "hunt-crossley",
    "kuwabara-kono",
    "tsuji",
    "velocity-power",
    "relaxing-contact",
)


@pytest.mark.parametrize("ids", list(itertools.combinations(CONTACT_LAWS, 2)), ids="+".join)
def test_laws_of_contact_join_alike(record, ids):
    plan = record.reference
    both = [next(e for e in catalogue.ENTRIES if e.id == id) for id in ids]
    shapes = [e.shapes(plan)[-1] for e in both]
    hides = [
        catalogue.hidden(e, 5.0 * e.start, shape, None, plan) for e, shape in zip(both, shapes, strict=True)
    ]
    given = [e.values(5.0 * e.start, plan, shape) for e, shape in zip(both, shapes, strict=True)]

    def model(setup):
        for id, parameters in zip(ids, given, strict=True):
            setup = effect(id).apply(setup, **parameters)
        return setup

    mine = predict(record, lambda p: hides[1](hides[0](p)), tolerance=1e-10).traces
    other = readings(record, Conditions(model=model))
    # As alone; contacts of a layer that lose energy are off by as much again.
    close = 2.0 * max(CLOSE.get(id, USUAL) for id in ids)
    assert np.abs(mine - other).max() < close * np.abs(mine).max()


def test_scalars_mean_the_same():
    made = design.draw("scalars", np.random.default_rng(7))
    mine = predict(made, tolerance=1e-10).scalars
    found = engine(as_record(made, np.zeros((0, 0, 0)), mine, "compared"))
    other = np.concatenate([[o.value for o in run.observables] for run in found])
    # Peaks between samples: parabolas here, other fits there.
    assert np.abs(mine / other - 1.0).max() < 2e-3


def test_one_ball_means_the_same():
    made = design.draw("ball", np.random.default_rng(7))
    mine = predict(made, tolerance=1e-10).scalars
    found = engine(as_record(made, np.zeros((0, 0, 0)), mine, "compared"))
    other = np.concatenate([[o.value for o in run.observables] for run in found])
    assert np.abs(mine / other - 1.0).max() < 1e-4  # durations from samples
