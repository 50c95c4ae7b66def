"""The algebra of inference, held against exact results: interpolation, whitening, projection, held-out
fits.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sonicvacuum.discover import verdict
from sonicvacuum.discover.fit import evidence, heldout
from sonicvacuum.discover.fit.normal import Normal
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import locate
from sonicvacuum.discover.model import gauges
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.parameters import coordinate
from sonicvacuum.discover.model.whitening import lag_one
from sonicvacuum.effects import CATALOGUE, effect


@given(st.floats(-3e-6, 3e-6))
def test_readings_between_samples_are_exact_for_polynomials_of_degree_five(shift):
    interval = 1e-6
    coefficients = np.array([0.3, -1.0, 0.5, 0.02, -0.004, 1e-4])
    law = np.polynomial.Polynomial(coefficients)
    simulated = law(np.arange(80))[None, None]
    time = interval * np.arange(20.0, 60.0, 2.0)
    value, rate = gauges.shifted(simulated, interval, time, np.array([shift]))
    place = (time - shift) / interval
    # Six points fix a polynomial of degree five; rounding of numbers up to 1e5 is left.
    np.testing.assert_allclose(value[0, 0], law(place), rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(rate[0, 0] * interval, law.deriv()(place), rtol=1e-8, atol=1e-6)


def test_nothing_is_read_before_the_impact():
    value, rate = gauges.shifted(np.ones((1, 1, 50)), 1e-6, np.arange(-20.0, 20.0) * 1e-6, np.zeros(1))
    assert not value[0, 0, :15].any()
    assert not rate[0, 0, :15].any()
    assert value[0, 0, -1] == pytest.approx(1.0, abs=1e-12)  # weights add up to one


def test_correlation_of_neighbours_is_found():
    rng = np.random.default_rng(np.random.SeedSequence(1))
    noise = np.zeros(20000)
    for k in range(1, len(noise)):
        noise[k] = 0.6 * noise[k - 1] + rng.normal()
    assert lag_one(noise) == pytest.approx(0.6, abs=0.03)  # five standard errors of √(1 − ρ²)/√n


def test_a_run_that_alone_shows_an_effect_is_not_predicted_by_the_others(setup):
    """Slope 10 in the first run, 0.1 in the second: without the first, the deviation is below its error."""
    drag = effect("viscous-drag")
    free = variants(drag, setup)[0]
    hypothesis = Hypothesis((Component(drag, free),))
    slopes = np.array([10.0, 0.1])
    chi2 = np.array([[50.0], [40.0]])
    normal = Normal(
        np.array([[0.0]]),
        np.zeros((1, 0)),
        chi2,
        np.zeros((2, 1, 1)),
        np.square(slopes)[:, None, None, None],
    )
    nominal = heldout.HeldOut(np.array([150.0, 40.01]), np.array([50, 40]))
    found = heldout.held_out(Fit(hypothesis, normal), nominal.size, nominal)
    assert found.chi2 == pytest.approx([150.0, 40.0], abs=1e-9)  # the nominal model's, the fit's own


def test_what_the_nominal_model_leaves_of_a_run_left_out_is_what_its_fit_left():
    """Also far from the data, where the fit is held to the record and the linear model promises more."""
    chi2 = np.array([[500.0], [400.0]])
    gradient, hessian = np.full((2, 1, 1), 30.0), np.ones((2, 1, 1, 1))
    free = Normal(np.zeros((1, 0)), np.zeros((1, 1)), chi2, gradient, hessian)
    found = heldout.held_out(Fit(Hypothesis(), free), np.array([50, 40]))
    assert found.chi2.tolist() == [500.0, 400.0]
    assert found.mean == 10.0


def test_a_strength_over_its_error_counts_from_off_and_need_not_be_shown_where_it_is_stated(setup):
    """A logarithm is one unit from off wherever it stands, a deviation as far as it goes."""
    drag, gain = effect("viscous-drag"), effect("sensor-gain")
    stated = replace(drag, parameters=tuple(replace(p, known=(p.scale, 0.1)) for p in drag.parameters))
    parts = [Component(one, variants(one, setup)[0], {}, 0) for one in (drag, gain, stated)]
    u, error = np.array([-2.0, 0.3, 0.0]), np.array([0.5, 0.1, 0.5])
    assert Hypothesis(tuple(parts)).strengths(u, error) == pytest.approx([2.0, 3.0, np.inf])
    assert Hypothesis(tuple(parts[:2])).strengths(u[:2], error[:2], np.array([1.0, -0.5])) == pytest.approx(
        [4.0, 2.0]
    )


@given(st.floats(1e-12, 0.3), st.floats(1e-12, 0.3))
def test_a_worse_residual_makes_unknown_more_likely(p, q):
    low, high = sorted((p, q))
    assert evidence.unknown_odds(low) >= evidence.unknown_odds(high)


def test_probabilities_add_up_to_one():
    found = evidence.probabilities([], 0.5)
    assert sum(found.values()) == pytest.approx(1.0, abs=1e-12)
    assert found["none"] > found["unknown"]


@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.id)
def test_coordinates_and_values_are_each_others_inverse(effect, setup):
    for parameter in effect.parameters:
        c = coordinate(parameter, setup)
        for share in (0.1, 0.5, 0.9):
            u = c.low + share * (c.high - c.low)
            assert c.inverse(float(c.value(u))) == pytest.approx(u, rel=1e-9, abs=1e-9)  # rounding only
            # Bounds towards off are wider than the catalogue's.
            assert parameter.low / 101.0 - 1e-9 <= c.value(u) + 1e-9 or parameter.low < 0.0
            assert c.value(u) <= parameter.high * 101.0


def test_scalars_of_one_name_keep_what_is_left_of_each():
    def place(feature, z):
        return locate.Place("r1", "", feature, z, 1.0, 1.0, 0.0)

    before = [place("speed", 9.0), place("amplitude", 5.0), place("speed", 8.0), place("decay", 1.0)]
    after = [place("amplitude", 0.5), place("speed", 0.9), place("speed", 0.8)]
    assert locate.again(before, after)[:3] == [0.9, 0.5, 0.8]
    assert math.isnan(locate.again(before, after)[3])


def test_where_holds_every_run_and_gauge_that_disagrees():
    """At a strong effect one gauge alone fills the list with features of two runs."""
    cells = [
        locate.Place("r1", gauge, feature, size, 0.0, 0.0, 0.1)
        for gauge, size in (("g1", 500.0), ("g2", -20.0))
        for feature in locate.FEATURES
    ]
    cells.append(locate.Place("r1", "wall", "tail", 1.0, 0.3, 0.4, 0.1))
    told = verdict.where(cells, most=5)
    assert [abs(c.z) for c in told] == [500.0, 500.0, 500.0, 500.0, 20.0]
    assert {c.sensor for c in told} == {"g1", "g2"}
    assert len(verdict.where(cells)) == 18
