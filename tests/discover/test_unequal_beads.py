"""Beads that differ within their tolerance: no misfit, and followed in as many directions as data show."""

import numpy as np
from made_records import made, with_keys

from sonicvacuum.discover import verdict
from sonicvacuum.discover.fit import unequal
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.nuisances import SCATTER
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.model.scatter import DIRECTIONS


def test_heavier_beads_are_no_misfit_where_their_tolerance_allows():
    heavier = [("mass", bead, 1.03) for bead in range(1, 11)]
    record, _ = made(departures=heavier, noise=1.0, seed=5)
    sharp = {"parylene-c": {"modulus_rel_sigma": 0.001}}
    exact, open_ = (
        nominal(Forward(experiment(with_keys(record, materials=sharp, tolerances={"bead_mass_rel": sigma}))))
        for sigma in (0.0, 0.03)
    )
    data = 2 * 3 * 700
    # A χ² of 4200 data has the standard deviation 92.
    assert exact.objective > data + 5 * 92 and open_.objective < data + 3 * 92


def test_beads_that_differ_within_their_tolerance_are_no_misfit():
    """One bead lighter, the next heavier: what all beads have in common does not make up for that."""
    rng = np.random.default_rng(np.random.SeedSequence(9))
    ratios = np.exp(0.02 * rng.normal(size=10))
    unequal = [("mass", bead, float(ratio)) for bead, ratio in enumerate(ratios, start=1)]
    record, _ = made(departures=unequal, noise=1.0, seed=5)
    exact, open_ = (
        nominal(Forward(experiment(with_keys(record, tolerances={"bead_mass_rel": sigma}))))
        for sigma in (0.0, 0.02)
    )
    data = 2 * 3 * 700
    assert exact.objective > data + 5 * 92 and open_.objective < data + 3 * 92


def test_directions_that_data_do_not_show_are_empty(empty):
    """Errors of masses ten times smaller show in fewer directions, and the rest adds little to chi2."""

    def shown(sigma):
        data = experiment(with_keys(empty, tolerances={"bead_mass_rel": sigma}))
        return sum(any(one.weights) for one in data.shared if one.kind == SCATTER)

    assert shown(0.03) > shown(0.003) > shown(0.00003) == 0


def test_beads_that_differ_are_followed_to_a_lower_minimum():
    """A fit from beads that weigh alike ends 17 above one from draws about them; the same in any order."""
    rng = np.random.default_rng(np.random.SeedSequence(9))
    unequal_ = [("mass", bead, float(np.exp(0.02 * rng.normal()))) for bead in range(1, 11)]
    record, _ = made(departures=unequal_, noise=0.2, seed=5)
    forward, exact = (
        Forward(experiment(with_keys(record, tolerances={"bead_mass_rel": sigma}))) for sigma in (0.02, 0.0)
    )
    start = np.zeros((1, forward.layout.size))
    one = fit(forward, Hypothesis(), np.zeros((1, 0)), start)
    found = [unequal.lower(forward, one) for _ in range(2)]
    assert found[0].objective < one.objective - 10.0
    np.testing.assert_array_equal(found[0].nu, found[1].nu)
    alike = fit(exact, Hypothesis(), np.zeros((1, 0)), np.zeros((1, exact.layout.size)))
    assert unequal.lower(exact, alike) is alike


def test_single_beads_differ_in_as_many_directions_in_any_record(empty):
    """None of them moves all beads alike; where masses are exact there are none."""
    open_ = experiment(with_keys(empty, tolerances={"bead_mass_rel": 0.003}))
    weights = np.array([one.weights for one in open_.shared if one.kind == SCATTER])
    assert weights.shape == (DIRECTIONS, 10)
    shown = int(weights.any(axis=1).sum())
    assert 4 <= shown <= 9  # these data show half of the contrasts of ten beads, or more
    np.testing.assert_allclose(weights @ weights.T, np.diag(np.arange(DIRECTIONS) < shown), atol=1e-9)
    np.testing.assert_allclose(weights.sum(axis=1), 0.0, atol=1e-9)
    assert not any(one.kind == SCATTER for one in experiment(empty).shared)
    # What all beads have in common is told, patterns of many that nobody could weigh are not; those that the
    # data do not show take no simulation: modulus, mass of all, speed remain.
    forward = Forward(open_)
    assert len(forward.slopes.simulated) == 3 + shown
    assert len(forward.layout.empty) == DIRECTIONS - shown
    assert set(verdict.nuisances(forward, nominal(forward))) == {"bead-mass"}
