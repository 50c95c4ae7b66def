"""Chains that lose much: pulses so broad and low that rest, a level or a drift may be taken for them."""

from types import SimpleNamespace

import numpy as np
import pytest
from made_records import SIGMA, made
from made_slips import altered
from scipy import signal, stats

from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.fit import goodness
from sonicvacuum.discover.model.noise import noise
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import together
from sonicvacuum.discover.model.weak import wanders

SEED = np.random.SeedSequence(47)
SPEEDS = 0.05, 0.1, 0.3, 0.9
LOSSES = {
    "linear-dashpot": ("damping_kg_s", (30.0, 60.0, 200.0)),
    "kuwabara-kono": ("time_us", (100.0,)),
    "tsuji": ("alpha", (10.0,)),
    "hunt-crossley": ("damping_s_per_m", (30.0,)),
}


@pytest.fixture(
    scope="module",
    params=[(effect, name, value) for effect, (name, values) in LOSSES.items() for value in values],
    ids=lambda p: f"{p[0]} {p[2]:g}",
)
def lossy(request):
    """A record of a chain that loses much, and what the nominal model reads."""
    effect, name, value = request.param
    record = made([(effect, {name: value})], seed=3, speeds=SPEEDS)[0]
    return record, predicted(together((record,)))


def test_a_broad_pulse_is_no_slip(lossy):
    """Gauges were told upside down, drifting, and resting off 0, with 0.999 each."""
    assert examine(*lossy)[1] == []


def test_a_broad_pulse_is_no_noise(lossy):
    """It was taken for noise twice as loud, with neighbours correlated by 0.3 to 0.6."""
    sigma, correlation = noise([lossy[0]])
    assert sigma == pytest.approx([SIGMA, SIGMA, 2.0 * SIGMA], rel=0.01)  # a floor of the model is added
    np.testing.assert_array_equal(correlation, 0.0)


def test_a_level_is_told_in_a_lossy_chain_too():
    record = made([("linear-dashpot", {"damping_kg_s": 30.0})], seed=3, speeds=SPEEDS)[0]
    raised = altered(record, "wall", lambda y: y + 8.0 * SIGMA, "v3")
    found = examine(raised, predicted(together((record,))))[1]
    assert [(f.fault, f.run, f.sensor) for f in found] == [("baseline", "v3", "wall")]


@pytest.mark.parametrize(
    ("damping", "speeds"), [(30.0, SPEEDS), (60.0, (0.1, 0.3)), (100.0, (0.02, 0.2)), (200.0, SPEEDS)]
)
def test_rest_ends_before_the_pulse_of_the_faster_shot(damping, speeds):
    """What slow shots read where faster ones have their pulses was taken for noise of up to 1.8 times the
    stated size, or correlated by 0.6.
    """
    record = made([("linear-dashpot", {"damping_kg_s": damping})], seed=5, speeds=speeds)[0]
    sigma, correlation = noise([record])
    assert sigma == pytest.approx([SIGMA, SIGMA, 2.0 * SIGMA], rel=0.01)  # a floor of the model is added
    np.testing.assert_array_equal(correlation, 0.0)


def test_correlated_noise_does_not_wander_and_a_bump_does():
    white = np.random.default_rng(SEED).normal(size=(400, 300))
    bump = np.sin(np.pi * np.clip((np.arange(300) - 100.0) / 150.0, 0.0, 1.0)) ** 2
    for rho in (0.0, 0.5, 0.8):
        draws = signal.lfilter([np.sqrt(1.0 - rho**2)], [1.0, -rho], white)
        # One in a thousand of white noise, and up to one in a hundred for what an estimate of ρ adds; of 400
        # beyond 11 by chance once in a thousand.
        assert sum(map(wanders, draws)) <= stats.binom.isf(1e-3, len(draws), 1e-2)
    # As high as a sample's noise, over half of the stretch: some 50 are gained where 26 suffice.
    assert np.mean([wanders(one + bump) for one in white]) > 0.9


def test_oscillations_are_asked_for_where_the_model_has_its_pulse():
    """Where nothing but noise is read, its largest sample is no beginning of one."""
    rng = np.random.default_rng(SEED)
    found = []
    for _ in range(60):
        traces = rng.normal(size=(4, 400))
        own = [(SimpleNamespace(readings=[r]), r, np.zeros(400)) for r in traces]
        found.append(goodness._together(own, 0))
    assert sum(p < 0.05 for p in found) <= stats.binom.isf(1e-3, len(found), 0.05)
