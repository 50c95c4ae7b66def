"""A single bead that the nominal model has to make heavier than its tolerance allows is asked for."""

import numpy as np
import pytest
from made_records import made, with_keys

from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search.starts import strayed


def at(ratio, tolerance):
    record, _ = made(departures=[("mass", 4, ratio)], noise=0.5, seed=3)
    forward = Forward(experiment(with_keys(record, tolerances={"bead_mass_rel": tolerance})))
    return forward, nominal(forward)


def test_the_bead_that_strays_most_is_a_start_without_that_nuisance():
    forward, null = at(1.08, 0.01)
    (ratio, bead, nu), *_ = strayed(forward, null)
    assert bead == 4
    # The prior draws the nuisance a little to the stated mass, and the others with it.
    assert ratio == pytest.approx(1.08, abs=0.02)
    assert np.square(nu).sum() < 0.5 * np.square(null.nu).sum()


@pytest.mark.parametrize("tolerance", [0.0, 0.05])
def test_no_bead_strays_within_its_tolerance(tolerance):
    assert strayed(*at(1.05, tolerance)) == []
