"""Statistics of inference against closed forms: linear models, Gaussian noise, Gaussian priors."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from linear_models import drawn, of_drag, screened
from scipy import integrate, stats

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import calibration, evidence
from sonicvacuum.discover.fit.calibration import Calibration
from sonicvacuum.discover.fit.evidence import Candidate
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import behind, left
from sonicvacuum.discover.model.experiment import Experiment, RunData
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.noise import noise
from sonicvacuum.discover.search.directions import Direction
from sonicvacuum.discover.search.screen import Screen
from sonicvacuum.effects import IDS
from sonicvacuum.gauges import Gauge
from sonicvacuum.records import Record, Signals


def test_the_normal_equations_lead_to_the_least_squares_solution_from_anywhere():
    model = drawn()
    at = np.random.default_rng(np.random.SeedSequence(5)).normal(size=5)
    normal = model.normal(at)
    gradient, hessian = normal.total()
    best = model.solved(range(3))
    np.testing.assert_allclose(at + np.linalg.solve(hessian[0], gradient[0]), best, rtol=1e-9)  # rounding
    rest = model.data - model.columns @ at
    assert normal.objective[0] == pytest.approx(np.sum(rest**2) + np.sum(at[1:] ** 2), rel=1e-12)
    assert normal.weighted(np.array([3.0]))[0] == pytest.approx(np.sum(rest**2) + 3.0 * np.sum(at[1:] ** 2))


# --- evidence


@pytest.mark.parametrize("two_sided", [False, True])
@pytest.mark.parametrize("z", [6.0, 12.0, 30.0])
def test_evidence_of_a_strength_is_the_integral_over_its_prior(z, two_sided):
    """Likelihood exp(−(d − z)²/2) of a strength d in standard errors, prior flat in log |d| from 1 to 100."""
    span = math.log(evidence.STRONG / evidence.WEAK) * (2.0 if two_sided else 1.0)

    def integrand(d):
        return math.exp(-0.5 * (d - z) ** 2) / (d * span)

    exact, _ = integrate.quad(integrand, evidence.WEAK, evidence.STRONG, points=[z], limit=200)
    # Laplace's approximation takes the prior as flat over the peak: its next term is 1/z².
    assert evidence.occam_strength(z * z, two_sided) == pytest.approx(math.log(exact), abs=1.5 / z**2)


def test_evidence_of_a_gaussian_shape_is_exact():
    """A flat prior over 4 whose peak is Gaussian with σ = 0.1: the share √(2π) σ/4."""
    c = SimpleNamespace(
        low=-2.0, high=2.0, two_sided=True, parameter=SimpleNamespace(switches=False, known=None)
    )
    fit = SimpleNamespace(hypothesis=SimpleNamespace(coordinates=(c,)), sigma=np.array([0.1]))
    exact, _ = integrate.quad(lambda x: math.exp(-0.5 * (x / 0.1) ** 2) / 4.0, -2.0, 2.0, points=[0.0])
    assert evidence.log_bayes(fit, 50.0) == pytest.approx(25.0 + math.log(exact), abs=1e-9)  # both exact


def test_the_bayes_factor_of_an_effect_holds_gain_and_occam_factor(setup):
    model = drawn(free=1, nuisances=0, strength=0.8)
    one, null = model.fit(of_drag(setup)), float(np.sum(model.data**2))
    z2 = null - one.objective
    column = model.columns[..., 0].ravel()
    assert z2 == pytest.approx((column @ model.data.ravel()) ** 2 / (column @ column), rel=1e-9)  # projection
    expected = 0.5 * z2 + evidence.occam_strength(z2, False)
    assert evidence.log_bayes(one, z2) == pytest.approx(expected, rel=1e-12)
    assert evidence.log_bayes(one, z2) < 0.5 * z2 - 2.0  # the factor is e^−2 and less beyond d′ of 5


# --- probabilities


def candidates(**log_bayes):
    """Candidates with these log Bayes factors; underscores stand for hyphens."""
    return [Candidate(k.replace("_", "-"), None, 2.0 * v, v) for k, v in log_bayes.items()]


def test_probabilities_without_calibration_are_bayes_theorem():
    found = evidence.probabilities(candidates(tsuji=3.0, gravity=1.0), 1.0, Calibration())
    each = (1.0 - evidence.PRIOR_NONE - evidence.PRIOR_UNKNOWN) / 22
    weights = {"none": 0.3, "tsuji": each * math.exp(3.0), "gravity": each * math.exp(1.0)}
    for a in weights:
        for b in weights:
            assert found[a] / found[b] == pytest.approx(weights[a] / weights[b], rel=1e-12)
    assert sum(found.values()) == pytest.approx(1.0, abs=1e-12)


def test_tempering_takes_log_odds_in_proportion():
    """And the package's own calibration does, which was found on the training study and is no identity."""
    own = calibration.of_package()
    assert own.cases > 100
    assert abs(own.temper - 1.0) > 0.01
    for temper, given in ((0.5, Calibration(temper=0.5)), (own.temper, None)):
        found = evidence.probabilities(candidates(tsuji=9.0, gravity=3.0), 1.0, given)
        assert math.log(found["tsuji"] / found["gravity"]) == pytest.approx(temper * 6.0, rel=1e-9)


def test_prior_odds_of_a_user_multiply_the_usual_prior():
    both = candidates(tsuji=3.0, gravity=3.0)
    found = evidence.probabilities(both, 1.0, Calibration(), {"tsuji": 10.0})
    assert found["tsuji"] / found["gravity"] == pytest.approx(10.0, rel=1e-9)
    assert "gravity" not in evidence.probabilities(both, 1.0, Calibration(), {"gravity": 0.0})


def test_an_effect_of_ones_own_has_the_usual_prior_and_stands_last():
    found = evidence.probabilities(candidates(my_law=3.0, tsuji=3.0), 1.0, Calibration())
    assert found["my-law"] == pytest.approx(found["tsuji"], rel=1e-12)
    assert list(found) == ["none", "unknown", "tsuji", "my-law"]


# --- thresholds


def test_the_threshold_lets_pure_noise_pass_once_in_a_hundred():
    """Twenty orthogonal two-sided directions: P(max z² < t) = (1 − p)^20 with p of a χ² of one degree."""
    directions = tuple(Direction(f"e{k}", "s", two_sided=True) for k in range(20))
    seen = screened(np.eye(20), np.zeros(20), directions)
    passed = 1.0 - stats.chi2.cdf(seen.threshold(policy.FALSE_ALARM), 1) ** 20
    assert passed == pytest.approx(0.01, abs=0.0065)  # five standard errors of 60 among 6000 draws


@pytest.mark.parametrize(("p", "sure"), [(5e-4, True), (2e-3, False)])
def test_a_misfit_without_a_name_is_called_unknown_below_one_in_a_thousand(p, sure):
    assert left.sure(SimpleNamespace(p=p)) is sure


# --- what hides behind what was named


def hidden_odds(model, column, two_sided):
    """Odds of one more effect of (R, T) `column` beside the model's, by direct integration of its likelihood.

    Its size d′ is that of its change with nuisances alone fitted; the model follows at each size.
    """
    rows = np.concatenate([*model.columns, model.prior_rows])
    known = np.concatenate([*model.data, np.zeros(len(model.prior_rows))])
    more = np.r_[column.ravel(), np.zeros(len(model.prior_rows))]

    def left(data, rows):
        return data - rows @ np.linalg.lstsq(rows, data, rcond=None)[0]

    unit = np.linalg.norm(left(more, rows[:, model.free :]))
    least = np.sum(left(known, rows) ** 2)

    def likelihood(log_size):
        sizes = [np.exp(log_size), -np.exp(log_size)][: 1 + two_sided]
        chi2 = [np.sum(left(known - d / unit * more, rows) ** 2) for d in sizes]
        return np.mean(np.exp(-0.5 * (np.array(chi2) - least)))

    total, _ = integrate.quad(likelihood, math.log(4.0), math.log(20.0))
    return total / math.log(evidence.STRONG / evidence.WEAK) * 0.6 / len(IDS)


def beside(model, apart: float, two_sided=False):
    """The slope of an effect that differs so much from the model's own, and its screen at the best fit."""
    other = np.random.default_rng(np.random.SeedSequence(8)).normal(size=model.data.shape)
    column = model.columns[..., 0] + apart * other
    at = model.solved(range(3))
    scores = Screen(
        (Direction("tsuji", "alpha", two_sided=two_sided),),
        np.einsum("rt,rt->r", column, model.data - model.columns @ at)[:, None],
        np.einsum("rtn,rt->rn", model.columns, column)[:, :, None],
        np.einsum("rt,rt->r", column, column)[:, None, None],
        model.normal(at),
        Fit(Hypothesis(), model.normal(at)),
    )
    return column, scores


@pytest.mark.parametrize("two_sided", [False, True])
@pytest.mark.parametrize("apart", [0.02, 0.1, 0.5])
def test_odds_of_an_effect_that_hides_are_the_integral_of_its_likelihood(apart, two_sided):
    model = drawn(strength=2.0)
    column, scores = beside(model, apart, two_sided)
    found = behind.odds(scores, 20.0**2, 4.0**2, {"tsuji": 1.0})
    exact = hidden_odds(model, column, two_sided)
    assert found["tsuji"] == pytest.approx(exact, rel=2e-3)  # the trapezoid rule on 65 points


@pytest.mark.parametrize(("apart", "hidden"), [(0.02, True), (0.4, True), (2.0, False), (50.0, False)])
def test_an_effect_hides_where_little_of_its_change_is_left(apart, hidden):
    """Of a change that differs by `apart` times another of the same length, apart/√(1 + apart²) is left."""
    _, scores = beside(drawn(strength=2.0), apart)
    assert behind.hides(scores, "tsuji") is hidden


def test_what_hides_takes_its_share_from_all_explanations():
    before = {"none": 0.0, "unknown": 0.01, "tsuji": 0.79, "gravity": 0.1, "gravity + tsuji": 0.1}
    after = behind.told(before, ["tsuji"], {"gravity": 0.3, "kuwabara-kono": 0.05, "gap": 1e-6})
    assert set(after) - set(before) == {"kuwabara-kono + tsuji"}
    assert sum(after.values()) == pytest.approx(1.0, rel=1e-12)  # rounding
    assert after["kuwabara-kono + tsuji"] == pytest.approx(0.05 * after["tsuji"])
    assert after["tsuji"] / after["gravity"] == pytest.approx(7.9)
    unheard = behind.told(before, ["hunt-crossley"], {"gap": 0.3})
    assert all(unheard[name] == pytest.approx(p) for name, p in before.items())


def test_nothing_hides_among_effects_that_are_hardly_seen():
    scores = screened(np.eye(4), np.ones(4), (Direction("tsuji", "alpha"),) * 4)
    assert behind.odds(scores, 15.0, 16.0, {}) == {}


# --- noise


def correlated(rho: float, sigma: float, shape, seed=6) -> np.ndarray:
    """Stationary AR(1) noise along the last axis."""
    white = np.random.default_rng(np.random.SeedSequence(seed)).normal(size=shape)
    result = white.copy()
    for k in range(1, shape[-1]):
        result[..., k] = rho * result[..., k - 1] + math.sqrt(1.0 - rho**2) * white[..., k]
    return sigma * result


def test_whitening_turns_the_covariance_of_correlated_noise_into_unity():
    rho, sigma, count = 0.7, 0.3, 25
    run = RunData("r", 1e-6 * np.arange(count), np.zeros((1, count)))
    one = Experiment(
        *("e", (run,), (), (Gauge("g", "wall"),), np.array([sigma]), np.array([rho])),
        *(np.zeros(1), 0.0, 0.0, 1e-3),
    )
    matrix = one.whiten(0, np.eye(count)[:, None], np.zeros((count, 0))).T
    lags = np.abs(np.subtract.outer(np.arange(count), np.arange(count)))
    covariance = sigma**2 * rho**lags
    np.testing.assert_allclose(matrix @ covariance @ matrix.T, np.eye(count), atol=1e-12)  # rounding


@pytest.mark.parametrize("rho", [0.0, 0.6])
def test_correlation_of_the_quiet_stretch_is_taken(empty, rho):
    signals = {}
    for k, (run, given) in enumerate(empty.signals.items()):
        drawn_ = correlated(rho, 0.02, (len(given.readings), len(given.time_s)), seed=k)
        signals[run] = Signals(given.time_s, dict(zip(given.readings, drawn_, strict=True)))
    _, correlation = noise((Record(empty.block, signals, "noise"),))
    # Two runs of three gauges with 490 quiet samples each: four standard errors of √(1 − ρ²)/√2940.
    assert correlation == pytest.approx(np.full(3, rho), abs=0.075)
