"""Draws of the posterior: against what is known in closed form, and against fits with a parameter held."""

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.special import ndtri

from sonicvacuum.blas import one_thread
from sonicvacuum.discover import draws, posterior, proposals
from sonicvacuum.discover.draws import Draws
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.verdict import parameters as told_of


def test_weights_of_equal_draws_are_all_worth_one():
    assert draws.effective(np.full(50, 0.3)) == pytest.approx(50.0)
    assert draws.effective(np.array([1.0, 0.0, 0.0])) == 1.0


@pytest.mark.parametrize("shape", [0.3, 0.5, 1.0])
def test_the_shape_of_pareto_weights_is_found(shape):
    """Weights u^-k have a tail of shape k (Pareto), here at the quantiles themselves."""
    weight = ((np.arange(4000) + 0.5) / 4000) ** -shape
    # 190 weights lie in the tail; the error of its shape is (1 + k) / sqrt(190), 0.1 to 0.15.
    assert draws.pareto_k(weight) == pytest.approx(shape, abs=0.15)


def test_few_heavy_weights_are_not_trusted():
    weight = np.where(np.arange(200) < 2, 1.0, 1e-6 * np.linspace(1.0, 2.0, 200))
    assert draws.pareto_k(weight) > draws.TRUSTED


def test_equal_weights_are_trusted_and_a_few_ties_change_nothing():
    assert draws.pareto_k(np.full(200, 0.005)) <= draws.TRUSTED
    weight = ((np.arange(4000) + 0.5) / 4000) ** -0.3
    tied = np.where((weight > 2.2) & (weight < 2.3), 2.2, weight)
    assert draws.pareto_k(tied) == pytest.approx(draws.pareto_k(weight), abs=0.1)  # less than its own error


def test_quantiles_of_weighted_draws_are_those_of_what_they_stand_for():
    """Uniform draws weighed by the density of a normal distribution."""
    value = np.linspace(-6.0, 6.0, 2001)
    one = Draws("a", "b", draws.SAMPLED, value[::-1], np.exp(-0.5 * value**2) / np.exp(-0.5 * value**2).sum())
    for share in (0.05, 0.5, 0.95):
        assert one.quantile(share) == pytest.approx(ndtri(share), abs=0.006)  # the draws' distance
    assert one.error == pytest.approx(1.0, abs=0.006)


@pytest.mark.parametrize("how", [draws.SAMPLED, draws.VALLEY, draws.PROFILE])
@pytest.mark.parametrize(("width", "told"), [(1.2, 1.0), (4.0, 4.0)])
def test_where_the_posterior_is_much_wider_than_its_gaussian_the_error_is_too(verdict, width, told, how):
    """Along a valley that bends, ± 0.003 stood beside 90 % that reach from -0.054 to +0.003."""
    fit = verdict.found.final
    ((effect, own),) = told_of(fit).items()
    (parameter, gaussian) = next(iter(own.items()))
    values = gaussian.value + width * gaussian.sigma * ndtri((np.arange(2000) + 0.5) / 2000)
    one = Draws(effect, parameter, how, values, np.full(2000, 1.0 / 2000))
    error = told_of(fit, (), [one])[effect][parameter].sigma
    assert error == pytest.approx(told * gaussian.sigma, rel=0.01)  # 2000 quantiles


def test_draws_are_of_the_distribution_that_they_claim(verdict):
    """Their density times the volume between them is one: weighed by the Gaussian over it, they are one."""
    fit = verdict.found.final
    u, log_density = posterior.proposed(fit, count=4000)
    z = (u - fit.u)[:, 0] / fit.sigma[0]
    weight = np.exp(-0.5 * z**2 - log_density)
    weight /= weight.sum()
    assert weight @ z == pytest.approx(0.0, abs=0.02)
    # Four thousand draws of a lattice: far below 1 / sqrt(4000) = 0.016.
    assert weight @ z**2 == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("seed", range(5))
def test_draws_of_one_coordinate_tell_the_quantiles_of_what_they_are_weighed_by(seed):
    scaled, log_density = proposals.student(proposals.even(posterior.OF_ONE, 1, seed))
    log_weight = -0.5 * scaled[:, 0] ** 2 - log_density
    weight = np.exp(log_weight - np.logaddexp.reduce(log_weight))
    one = Draws("a", "b", draws.SAMPLED, scaled[:, 0], weight)
    assert one.effective > 0.9 * posterior.OF_ONE
    for share in (0.025, 0.5, 0.975):
        # The draws' distance: of 96, two or three lie beyond an end.
        assert one.quantile(share) == pytest.approx(ndtri(share), abs=0.12)


def test_the_posterior_is_that_of_fits_with_the_parameter_held(verdict):
    """Nuisances followed to their minimum at each value, which takes six steps more."""
    forward, fit = verdict.found.forward, verdict.found.final
    values = fit.u + np.array([-3.0, -1.5, 0.0, 1.5, 3.0])[:, None] * fit.sigma
    quick = posterior.Around(forward, fit).log_posterior(values)
    hessian = fit.normal.total()[1][0]
    inner = np.linalg.inv(hessian[1:, 1:])
    point = np.concatenate([values, np.tile(fit.nu, (5, 1))], axis=1)
    for _ in range(6):
        point[:, 1:] += posterior.Around(forward, fit).misfit(point)[1][:, 1:] @ inner
    slow = -0.5 * posterior.Around(forward, fit).misfit(point)[0]
    # In natural logarithms: a tenth of what one standard error makes.
    assert quick - quick[2] == pytest.approx(slow - slow[2], abs=0.05)


def test_draws_of_a_record_of_very_many_runs_go_one_at_a_time(verdict, monkeypatch):
    forward, fit = verdict.found.forward, verdict.found.final
    point = np.tile(np.concatenate([fit.u, fit.nu]), (3, 1))
    whole = posterior.Around(forward, fit).misfit(point)
    monkeypatch.setattr(posterior, "CHUNK", 1)
    for one, other in zip(whole, posterior.Around(forward, fit).misfit(point), strict=True):
        # Last digits of chains may depend on those beside them.
        np.testing.assert_allclose(one, other, rtol=1e-8, atol=1e-5)


def test_nothing_is_better_than_the_fit_however_far_from_it(verdict):
    """A step of Gauss and Newton with the slopes of the fit, taken far away, may promise anything."""
    forward, fit = verdict.found.forward, verdict.found.final
    values = fit.u + np.linspace(-3.0, 3.0, 25)[:, None]
    found = posterior.Around(forward, fit).log_posterior(values)
    assert found.max() == pytest.approx(-0.5 * fit.objective, abs=0.05)  # the fit's own settling
    assert found.argmax() == 12
    assert found.max() <= -0.5 * fit.objective


def test_draws_lie_within_the_bounds_of_the_search(verdict):
    fit = verdict.found.final
    parts = fit.hypothesis.components[0]
    (own,) = parts.free
    near = replace(own, high=float(fit.u[0] + 0.5 * fit.sigma[0]))
    held = replace(fit, hypothesis=replace(fit.hypothesis, components=(replace(parts, free=(near,)),)))
    u, _ = posterior.proposed(held)
    assert len(u) == posterior.OF_ONE
    assert u.max() <= near.high


def test_draws_are_the_same_for_any_number_of_threads(verdict):
    again = Forward(verdict.found.forward.experiment, threads=2)
    # As a search does: threads of linear algebra add up in an order of their own, on some processors.
    (one,), (two,) = verdict.posterior, one_thread(posterior.posterior)(again, verdict.found.final)
    assert np.array_equal(one.value, two.value)
    assert np.array_equal(one.weight, two.weight)


def test_a_table_of_draws_is_read_as_it_was_written(verdict, tmp_path):
    draws.write(tmp_path, verdict.posterior)
    (kept,) = verdict.posterior
    (back,) = draws.read(tmp_path).values()
    assert (back.effect, back.parameter, back.how) == ("kuwabara-kono", "time_us", "sampled")
    assert back.quantile(0.05) == pytest.approx(kept.quantile(0.05), rel=1e-6)  # seven digits
    assert draws.pareto_k(back.weight) < draws.TRUSTED
    given = verdict.verdict.parameters["kuwabara-kono"]["time_us"]
    assert back.quantile(0.5) == pytest.approx(given.value, abs=0.2 * given.sigma)


def test_where_draws_are_not_trusted_the_profile_is_told(verdict, monkeypatch):
    monkeypatch.setattr(posterior, "TRUSTED", -np.inf)
    (one,) = posterior.posterior(verdict.found.forward, verdict.found.final)
    (drawn,) = verdict.posterior
    assert one.how == draws.PROFILE
    error = verdict.verdict.parameters["kuwabara-kono"]["time_us"].sigma
    for share in (0.05, 0.95):
        # Ten of 200 draws lie beyond either end: one more or less moves it by a tenth of a standard error.
        assert one.quantile(share) == pytest.approx(drawn.quantile(share), abs=0.2 * error)


def test_more_steps_are_taken_where_one_promises_too_much(monkeypatch):
    """One datum 2 (nu - d), which the fit takes for nu - d: a step from 0 promises 2 d² of 4 d², of which
    3.2 d² can be had; the next one would go too far.
    """
    d = np.array([0.01, 1.0, 3.0])

    def misfit(around, point):
        left = 2.0 * (d[point[:, 0].astype(int)] - point[:, 1])
        return left**2 + point[:, 1] ** 2, np.stack([0.0 * left, left - point[:, 1]], axis=1)

    monkeypatch.setattr(posterior.Around, "misfit", misfit)
    monkeypatch.setattr(posterior.Around, "inner", np.array([[0.5]]))
    around = posterior.Around(None, SimpleNamespace(u=np.zeros(1)))
    found = -2.0 * around.at_best(np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]), 0.0)
    assert found == pytest.approx([2.0 * d[0] ** 2, d[1] ** 2, d[2] ** 2])


def test_a_profile_that_does_not_hold_the_fit_is_not_believed(verdict, monkeypatch):
    """Far from the data its nuisances may miss their best: a rate of 668 1/s had 90 % from 523 to 651."""
    fit = verdict.found.final
    monkeypatch.setattr(posterior, "TRUSTED", -np.inf)
    at = fit.u[0] + np.linspace(0.0, 5.0, 6) * fit.sigma[0]
    monkeypatch.setattr(posterior.ridge, "profiles", lambda *_: [(at, np.linspace(0.0, 25.0, 6))])
    (one,) = posterior.posterior(verdict.found.forward, fit)
    assert one.how == draws.LINEAR
    value = verdict.verdict.parameters["kuwabara-kono"]["time_us"]
    assert one.quantile(0.5) == pytest.approx(value.value, abs=0.1 * value.sigma)  # grid of a sixth of it
    assert one.quantile(0.95) - one.quantile(0.05) == pytest.approx(2.0 * 1.645 * value.sigma, rel=0.05)


def test_nothing_named_has_no_draws(tmp_path):
    draws.write(tmp_path, ())
    assert draws.read(tmp_path) == {}
    assert list(tmp_path.iterdir()) == []


def test_a_point_that_its_nuisances_exclude_is_not_simulated(verdict, monkeypatch):
    """A search did not end: a modulus a thousand times what was stated, in the profile of a striker's error,
    asked for steps without end.
    """
    forward, fit = verdict.found.forward, verdict.found.final
    point = np.tile(np.concatenate([fit.u, fit.nu]), (3, 1))
    point[1, -1] = 650.0  # standard errors of a modulus: a hundredth of it each
    asked, sampled = [], forward.sampled
    monkeypatch.setattr(forward, "sampled", lambda h, u, nu: asked.append(len(u)) or sampled(h, u, nu))
    objective, gradient = posterior.Around(forward, fit).misfit(point)
    assert sum(asked) == 2
    assert np.isfinite(objective).tolist() == [True, False, True]
    assert np.isfinite(gradient).all(axis=1).tolist() == [True, False, True]


def test_nested_sampling_is_given_the_posterior_beside_the_nominal_model(verdict, monkeypatch):
    """With a stand-in for the sampler: at the fit half of what it gains, beyond the bounds nothing."""
    found, asked = verdict.found, {}

    class Sampler:
        def __init__(self, likelihood, prior, dimensions, **options):
            fit = found.final
            asked["values"] = [likelihood(u) for u in (fit.u, fit.u + 1e3)]
            self.results = SimpleNamespace(logz=[1.5], logzerr=[0.1], ncall=[2, 3])

        def run_nested(self, **options):
            pass

    monkeypatch.setitem(sys.modules, "dynesty", SimpleNamespace(NestedSampler=Sampler))
    script = Path(__file__).parents[2] / "workflow/bench/nested.py"
    spec = importlib.util.spec_from_file_location("nested", script)
    nested = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(nested)
    assert nested.sampled(found.forward, found.null, found.final, 100.0) == (1.5, 0.1, 5)
    gain = found.null.objective - found.final.objective
    assert asked["values"][0] == pytest.approx(0.5 * gain, abs=0.05)  # the fit's own settling
    assert asked["values"][1] == -1e10
