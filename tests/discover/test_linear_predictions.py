"""Limits, held-out runs and separations against closed forms of linear models with Gaussian noise."""

import math

import numpy as np
import pytest
from linear_models import Imagined, Linear, drawn, of_drag, screened
from scipy import stats

from sonicvacuum.discover import next_experiment
from sonicvacuum.discover.fit import heldout
from sonicvacuum.discover.judge import degenerate
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.search.directions import Direction

# --- limits


def limit(effect, parameter, scale, two_sided, setup, elsewhere=(), seed=4):
    """The limit of one effect, with estimate and error of its strength."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    column, data = rng.normal(size=(1, 60)), rng.normal(size=60)
    data += 2.0 * column[0]
    (one,) = degenerate.limits(
        screened(column, data, (Direction(effect, parameter, two_sided=two_sided, unit=scale),)),
        setup,
        elsewhere={(effect, parameter): elsewhere},
    )
    size = np.linalg.norm(column)
    return one, float(column[0] @ data / size**2), 1.0 / size


def test_a_one_sided_limit_is_the_gaussian_one(setup):
    """Estimate + 1.645 σ, the 95 % quantile of a Gaussian, times the typical deviation of 200 per s."""
    one, estimate, sigma = limit("viscous-drag", "rate_per_s", 200.0, False, setup)
    expected = 200.0 * (estimate + stats.norm.ppf(0.95) * sigma)
    assert one.value == pytest.approx(expected, rel=1e-4)  # 1.645 has four digits
    assert one.estimate == pytest.approx(200.0 * estimate, rel=1e-9)


def test_a_two_sided_limit_is_the_gaussian_one(setup):
    one, estimate, sigma = limit("dynamic-modulus", "modulus_ratio", 0.5, True, setup)
    expected = 1.0 + 0.5 * (estimate + stats.norm.ppf(0.975) * sigma)
    assert one.value == pytest.approx(expected, rel=1e-4)  # 1.96 has three digits


def test_a_limit_holds_over_all_explanations(setup):
    """Beyond it lie 5 % of what the final model and two explanations of 30 and 2 % say together."""
    others = [degenerate.Elsewhere(0.3, 900.0, 40.0), degenerate.Elsewhere(0.02, 4000.0, 90.0)]
    one, estimate, sigma = limit("viscous-drag", "rate_per_s", 200.0, False, setup, others)
    parts = [(0.68, 200.0 * estimate, 200.0 * sigma), (0.3, 900.0, 40.0), (0.02, 4000.0, 90.0)]
    beyond = sum(w * stats.norm.sf(one.value, s, e) for w, s, e in parts)
    assert beyond == pytest.approx(0.05, rel=1e-3)  # 1.645 has four digits
    assert 900.0 < one.value < 1000.0
    improbable, _, _ = limit("viscous-drag", "rate_per_s", 200.0, False, setup, others[1:])
    alone, _, _ = limit("viscous-drag", "rate_per_s", 200.0, False, setup)
    assert alone.value < improbable.value < alone.value + 0.5 * 200.0 * sigma


# --- runs held out


def left_out(model: Linear, run: int) -> float:
    """χ² of a run by explicit fits: without it; then with it, the parameters held, nuisances following."""
    free, others = model.free, [k for k in range(len(model.data)) if k != run]
    parameters = model.solved(others)[:free]
    rest = Linear(model.columns[..., free:], model.data - model.columns[..., :free] @ parameters, 0)
    nuisances = rest.solved(range(len(model.data)))
    return float(np.sum((rest.data[run] - rest.columns[run] @ nuisances) ** 2))


@pytest.mark.parametrize("seed", [1, 2])
def test_held_out_runs_are_what_explicit_refits_leave(setup, seed):
    model = drawn(seed=seed)
    found = heldout.held_out(model.fit(of_drag(setup)), np.full(3, 40))
    assert found.chi2 == pytest.approx([left_out(model, run) for run in range(3)], rel=1e-9)  # algebra


def evidence_of(model: Linear, runs, centre, width) -> float:
    """Log density of the data of some runs, parameters having the prior N(centre, width²)."""
    rows, known = np.concatenate(model.columns[runs]), np.concatenate(model.data[runs])
    spread = np.r_[np.square(width), np.ones(rows.shape[1] - len(width))]
    mean = rows[:, : len(width)] @ centre
    return float(stats.multivariate_normal.logpdf(known, mean, np.eye(len(rows)) + rows * spread @ rows.T))


def test_the_predictive_density_is_that_of_the_gaussian_model(setup):
    """log p(run | others) = log p(all) − log p(others), but for the constant of the run's 40 data."""
    model = drawn()
    fit = model.fit(of_drag(setup))
    centre, width = fit.u, heldout._width(fit)
    whole = evidence_of(model, [0, 1, 2], centre, width)
    exact = [whole - evidence_of(model, [k for k in range(3) if k != run], centre, width) for run in range(3)]
    found = heldout.predictive(fit) - 20.0 * math.log(2.0 * math.pi)
    assert found == pytest.approx(exact, rel=1e-9)  # two ways of one algebra


def contradicting(sign: float) -> Linear:
    """Two runs that show an effect of one size, with the same sign or with opposite ones."""
    rng = np.random.default_rng(np.random.SeedSequence(8))
    columns = rng.normal(size=(2, 50, 1))
    data = columns[..., 0] * np.array([[1.0], [sign]]) + rng.normal(size=(2, 50))
    return Linear(columns, data, 1)


def test_what_one_run_alone_supports_predicts_no_better(setup):
    """A free parameter that one run wants positive and the other negative predicts neither."""
    agreed = {}
    for sign in (1.0, -1.0):
        model = contradicting(sign)
        null = Linear(model.columns[..., :0], model.data, 0).fit(Hypothesis())
        agreed[sign] = heldout.better(null, model.fit(of_drag(setup)))
    assert agreed == {1.0: True, -1.0: False}


# --- a further run


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_separation_is_the_expected_misfit_in_closed_form(setup, seed):
    """missᵀ (1 + A P Aᵀ)⁻¹ miss with P what the data at hand leave of the rival and of shared nuisances."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    gauges, samples = 2, 30
    layout_columns = 1 + 3 + gauges  # parameter; modulus, speed, trigger, gains
    old = drawn(runs=1, nuisances=2 + gauges + 1, seed=seed)
    rival = old.fit(of_drag(setup))
    true = drawn(runs=1, free=0, nuisances=2 + gauges + 1, seed=seed).fit(Hypothesis())
    slopes, miss = rng.normal(size=(layout_columns, samples)), 3.0 * rng.normal(size=samples)
    other = np.vstack([miss, rng.normal(size=(layout_columns - 1, samples))])
    new = Imagined({"viscous-drag": np.vstack([np.zeros(samples), slopes]), "": other}, gauges)
    fits = [true, rival]
    (apart,) = next_experiment.separations(new, new, fits, [next_experiment.precision(new, f) for f in fits])
    found = apart[0, 1]
    known = np.linalg.inv(rival.normal.total()[1][0])
    # Columns: parameter, modulus, gains as the old data leave them; speed and trigger of the new run afresh.
    # Unknowns of the old fit: parameter, speed, trigger, gains, modulus.
    shared, where = [0, 1, 4, 5], [0, 5, 3, 4]
    spread = np.eye(layout_columns)
    spread[np.ix_(shared, shared)] = known[np.ix_(where, where)]
    exact = miss @ np.linalg.solve(np.eye(samples) + slopes.T @ spread @ slopes, miss)
    assert found == pytest.approx(exact, rel=1e-9)  # Woodbury's identity
    assert 0.0 < found < miss @ miss
    assert apart[0, 0] == apart[1, 1] == 0.0
    assert 0.0 < apart[1, 0] < miss @ miss
