"""The smooth discrepancy: exact whitening, evidence as that of the dense Gaussian, and what is inferred."""

from dataclasses import replace

import numpy as np
import pytest
from made_records import made
from made_slips import altered

from sonicvacuum.discover import policy, session
from sonicvacuum.discover.fit import discrepancy, goodness, smooth
from sonicvacuum.discover.fit.normal import linearise
from sonicvacuum.discover.fit.refit import Fit, polish
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.judge import beside, gross
from sonicvacuum.discover.model.experiment import Part, Smooth
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.rounds import investigate
from sonicvacuum.discover.search import restart
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.effects import effect
from sonicvacuum.records import Record, Signals


def test_whitening_is_the_inverse_root_of_the_covariance():
    """Of two runs of 30 and 20 samples that have something in common, and a scalar beside them."""
    rng = np.random.default_rng(np.random.SeedSequence(1))
    first, second = (np.linalg.qr(rng.normal(size=(n, 3)))[0] for n in (30, 20))
    mixing, _ = np.linalg.qr(rng.normal(size=(6, 4)))
    variances = np.array([9.0, 2.0, 0.5, 0.01])
    one = Smooth(0.1, 2.0, (Part((first, second), mixing, variances),))
    every = np.eye(51)
    root = np.concatenate(one.divided([every[:, :31], every[:, 31:]]), axis=1)
    u = np.zeros((51, 6))
    u[:30, :3], u[31:, 3:] = first, second
    covariance = np.eye(51) + 2.0 * (u @ mixing * variances) @ (u @ mixing).T
    np.testing.assert_allclose(root @ covariance @ root.T, np.eye(51), atol=1e-12)  # rounding only


@pytest.mark.parametrize("kernel", [discrepancy.KERNELS[0], discrepancy.STATED, discrepancy.KERNELS[-1]])
def test_the_covariance_is_that_of_bumps_alike_in_like_runs(empty, kernel):
    """Trace by trace from the bumps themselves: the peak's share squared, and as much less between runs."""
    e = experiment(empty)
    (part, *_), (speed, other) = discrepancy.Shapes(e).parts(kernel), e.batches[0].chain.speed
    ends = np.cumsum([d.shape[1] for d in part.directions])[:-1]
    rows = np.split(part.mixing, ends)
    own, others = (d @ r for d, r in zip(part.directions, rows, strict=True))
    traces = [discrepancy._Trace(e, run, 0) for run in range(2)]
    bumps = [t.height * t._bumps(*kernel.onset, kernel.length) / e.sigma[0] for t in traces]
    common = min(b.shape[1] for b in bumps)
    alike = kernel.shared * np.exp(-0.5 * (np.log(speed / other) / 0.7) ** 2)
    one, both = bumps[0].max() ** 2, bumps[0].max() * bumps[1].max()
    # Directions in which bumps have less than a thousandth of what they have in the first are left out.
    np.testing.assert_allclose(own * part.variances @ own.T, bumps[0] @ bumps[0].T, atol=0.01 * one)
    expected = alike * bumps[0][:, :common] @ bumps[1][:, :common].T
    np.testing.assert_allclose(own * part.variances @ others.T, expected, atol=0.01 * both)


def test_fits_beside_a_discrepancy_are_those_of_the_dense_gaussian(empty):
    """Gradient and Hessian of speeds, gains and all else, whose data hang together."""
    plain = experiment(empty)
    counted = smooth.with_size(plain, 0.02, None, 1.0, discrepancy.KERNELS[-1])
    nothing, u, nu = Hypothesis(), np.zeros((1, 0)), np.full((1, Forward(plain).layout.size), 0.1)
    forward = Forward(plain)
    columns = forward.columns(nothing, u, nu)
    whole = [np.zeros((1 + nu.shape[1], c.shape[2])) for c in columns]
    for run, (wide, own) in enumerate(zip(whole, columns, strict=True)):
        wide[0] = forward.data(run) - own[0, 0]
        wide[1 + forward.local(run)] = own[0, 1:]
    joined = np.concatenate(whole, axis=1)
    covariance = np.eye(joined.shape[1])
    starts = np.cumsum([0, *(w.shape[1] for w in whole[:-1])])
    for s, part in enumerate(counted.smooth.parts):
        rows = np.split(part.mixing, np.cumsum([d.shape[1] for d in part.directions])[:-1])
        along = np.zeros((len(covariance), len(part.variances)))
        for start, directions, row in zip(starts, part.directions, rows, strict=True):
            first = start + s * len(directions)
            along[first : first + len(directions)] = directions @ row
        covariance += counted.smooth.variance * (along * part.variances) @ along.T
    dense = joined @ np.linalg.solve(covariance, joined.T)
    found = linearise(Forward(counted), nothing, u, nu)
    # Steps of integration and of differences follow the norm of the data, which the discrepancy lowers: by
    # 0.05 in it, whose square is 88.
    np.testing.assert_allclose(found.chi2.sum(), dense[0, 0], rtol=1e-3)
    np.testing.assert_allclose(
        found.hessian.sum(axis=0)[0], dense[1:, 1:], rtol=0.02, atol=1e-3 * dense.max()
    )


def test_the_evidence_is_that_of_the_dense_gaussian():
    rng = np.random.default_rng(np.random.SeedSequence(2))
    u, _ = np.linalg.qr(rng.normal(size=(25, 3)))
    variances, columns, y = np.array([4.0, 1.0, 0.2]), rng.normal(size=(25, 2)), rng.normal(size=25)
    parts = np.column_stack([u.T @ y, u.T @ columns])
    hessian = columns.T @ columns + np.eye(2)

    def dense(size):
        c = np.eye(25) + size * (u * variances) @ u.T + columns @ columns.T
        return y @ np.linalg.solve(c, y) + np.linalg.slogdet(c)[1]

    def algebra(size):
        return sum(smooth._evidence(parts, size * variances, columns.T @ y, hessian))

    # The Hessian is held up by a part in 1e9.
    assert algebra(3.0) - algebra(0.0) == pytest.approx(dense(3.0) - dense(0.0), abs=1e-6)


def test_an_effect_that_moves_nothing_stands_in_no_discrepancys_way(empty):
    """The equations of a gain of a gauge that is stuck have no solution, with which a search ended."""
    forward = Forward(experiment(altered(empty, "g4", lambda y: np.full_like(y, 3.0))))
    (free,) = variants(effect("sensor-gain"), setup_of(forward))[0]
    gain = Hypothesis((Component(effect("sensor-gain"), (free,), place=0),))
    nuisances = nominal(forward).nu[None]
    moved = Fit(gain, linearise(forward, gain, np.array([[0.5]]), nuisances))
    without = Fit(Hypothesis(), linearise(forward, Hypothesis(), np.zeros((1, 0)), nuisances))
    known = discrepancy.Shapes(forward.experiment)
    assert smooth.infer(forward, moved, known) == smooth.infer(forward, without, known)


def test_no_discrepancy_leaves_everything_as_it_is(empty):
    e = experiment(empty)
    assert smooth.with_size(e, 0.0).smooth is None
    assert smooth.with_size(smooth.with_size(e, 0.01), 0.0).smooth is None
    small = smooth.with_size(e, 1e-9)
    # Of a size of 1e-9.
    np.testing.assert_allclose(Forward(small).data(0), Forward(e).data(0), atol=1e-9)


def test_nothing_smooth_is_found_in_noise(empty):
    forward = Forward(experiment(empty))
    assert not smooth.infer(forward, nominal(forward), discrepancy.Shapes(forward.experiment)).found


@pytest.mark.parametrize("size", [0.02, 0.05])
def test_a_smooth_misfit_is_found_with_its_size(empty, size):
    record = with_systematics(empty, size)
    forward = Forward(experiment(record))
    seen = smooth.infer(forward, nominal(forward), discrepancy.Shapes(forward.experiment))
    assert seen.found
    assert size / 2.0 < seen.size < size * 2.0  # some sixty directions, part of which nuisances take up


def test_a_misfit_far_above_the_noise_is_none_beside_what_is_smooth(empty):
    """Unless speeds are hardly known, which take up what a discrepancy does."""
    record = with_systematics(empty, 0.03)
    forward = Forward(experiment(record))
    null, known = nominal(forward), discrepancy.Shapes(forward.experiment)
    assert gross.gross(forward, null)
    assert not gross.gross(forward, null, known)
    # Two thirds of the samples are five times as noisy: χ² per datum of 18 beside whatever is smooth.
    rough = Forward(experiment(roughened(record, 5.0)))
    assert gross.gross(rough, nominal(rough), discrepancy.Shapes(rough.experiment))
    runs = tuple(replace(run, speed_rel_sigma=0.3) for run in forward.experiment.runs)
    unsure = replace(forward.experiment, runs=runs)
    assert gross.gross(Forward(unsure), null, known)


def test_a_rough_misfit_is_no_larger_smooth_one(empty):
    forward = Forward(experiment(roughened(with_systematics(empty, 0.02), 5.0)))
    null = nominal(forward)
    seen = smooth.infer(forward, null, discrepancy.Shapes(forward.experiment))
    assert 0.01 < seen.size < 0.04  # within twice what is there
    assert 3.0 < seen.excess < 6.0  # noise of √(1 + 5²) in two thirds of the samples, tried in steps of 1.3
    counted = smooth.with_size(forward.experiment, seen.size, None, seen.excess, seen.kernel)
    left = nominal(Forward(counted)).objective / sum(counted.size(k) for k in range(2))
    assert 0.5 < left < 2.0  # a step of 1.3 in the noise is 1.7 in its square


@pytest.mark.long
def test_an_effect_is_kept_beside_a_smooth_misfit():
    hidden = made([("viscous-drag", {"rate_per_s": 300.0})], seed=2)[0]
    v = session.discover(with_systematics(hidden, 0.01)).verdict
    assert v.named == ["viscous-drag", "unknown"]
    # Evidence alone would say nearly 1; no name beside a smooth misfit is held surer than this.
    assert v.probabilities["viscous-drag + unknown"] == pytest.approx(policy.SMOOTH_BESIDE)
    rate = v.parameters["viscous-drag"]["rate_per_s"]
    assert abs(rate.value - 300.0) < 4.0 * rate.sigma
    assert v.gap.fitted.after < v.gap.fitted.before
    assert 0.005 < v.fit.smooth_rel < 0.02  # as hidden: 1 % of the peak


def test_a_smooth_misfit_that_the_record_states_names_nothing(empty):
    e = replace(experiment(with_systematics(empty, 0.01)), model_floor_rel=0.01)
    found = investigate(e)
    assert found.named == []
    assert found.smooth == 0.0  # nothing beyond what is stated


@pytest.mark.parametrize("size", [0.01, 0.05])
def test_a_smooth_misfit_that_is_stated_and_not_there_leaves_nothing_unknown(size):
    """Whitened by more than there is, what is slow comes out too small: whiteness had p of 1e-5 and 3e-12."""
    record, _ = made(speeds=(0.3, 0.6, 0.9, 1.2))
    every = slice(None, None, 3)
    signals = {
        run: Signals(one.time_us[every], {id: trace[every] for id, trace in one.readings.items()})
        for run, one in record.signals.items()
    }
    e = replace(experiment(replace(record, signals=signals)), model_floor_rel=size)
    forward = Forward(smooth.with_size(e, size))
    assert goodness.goodness(forward, nominal(forward)).tests["whiteness"] > 0.01


def with_systematics(record: Record, size: float, seed=5) -> Record:
    """A record with a smooth error of `size` peaks in every trace, from the arrival on."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    signals = {}
    for run, one in record.signals.items():
        readings = {}
        for gauge, trace in one.readings.items():
            wide = discrepancy.width(np.abs(trace))
            kernel = np.exp(-np.square(np.arange(-4 * wide, 4 * wide + 1) / (0.6 * wide)))
            kernel /= np.linalg.norm(kernel)
            drawn = np.convolve(rng.normal(size=len(trace) + 8 * wide), kernel, mode="valid")[: len(trace)]
            later = np.arange(len(trace)) > trace.argmax() - 1.5 * wide
            readings[gauge] = trace + size * trace.max() * later * drawn
        signals[run] = replace(one, readings=readings)
    return replace(record, signals=signals)


def roughened(record: Record, sigmas: float) -> Record:
    """A record with white noise of so many standard errors more from a third of every trace on."""
    rng = np.random.default_rng(np.random.SeedSequence(6))
    sigma = {g.id: g.sigma for g in record.gauges}
    signals = {
        run: replace(
            one,
            readings={
                g: y + sigmas * sigma[g] * (np.arange(len(y)) > len(y) / 3) * rng.normal(size=len(y))
                for g, y in one.readings.items()
            },
        )
        for run, one in record.signals.items()
    }
    return replace(record, signals=signals)


def test_a_pulse_that_is_reflected_higher_is_not_taken_for_the_first():
    time = np.arange(300.0)
    arriving, reflected = (np.exp(-4.0 * np.log(2.0) * np.square((time - t) / 20.0)) for t in (80.0, 190.0))
    peak, wide = discrepancy.first_pulse(0.7 * arriving + reflected)
    assert peak == 80
    # To a sample at either end.
    assert wide == pytest.approx(20, abs=1)


def test_the_width_of_a_pulse_is_that_at_half_height():
    time = np.arange(200.0)
    assert discrepancy.width(np.exp(-4.0 * np.log(2.0) * np.square((time - 90.0) / 20.0))) == pytest.approx(
        20, abs=1
    )


@pytest.mark.parametrize("shown", [slice(None), slice(1, None), slice(None, -1), slice(1, -1)])
def test_a_pulse_that_touches_the_edge_is_as_wide(shown):
    """Five samples of half the peak or more, between two that are lower or beyond either end of the trace."""
    trace = np.array([0.2, 0.6, 0.9, 1.0, 0.9, 0.6, 0.2])[shown]
    assert discrepancy.width(trace) == 5
    assert discrepancy.first_pulse(trace) == (int(trace.argmax()), 5)


def test_records_of_one_laboratory_hand_on_what_was_hidden():
    """The helper itself: errors begin with the pulse and have the size asked for."""
    record, _ = made(noise=0.0)
    other = with_systematics(record, 0.05)
    (run, before), (_, after) = next(iter(record.signals.items())), next(iter(other.signals.items()))
    change = after.readings["wall"] - before.readings["wall"]
    assert not change[: int(0.3 * before.readings["wall"].argmax())].any(), run
    assert change.std() < 0.1 * before.readings["wall"].max()


def test_what_a_misfit_strained_does_not_stand_in_the_way_once_it_counts_as_noise(empty):
    """From a modulus forty errors off slopes lead nowhere: pulses no longer overlap."""
    plain = experiment(with_systematics(empty, 0.01))
    forward = Forward(smooth.with_size(plain, 0.01), 1)
    strained = np.zeros(forward.layout.size)
    strained[forward.layout.modulus] = -40.0
    nothing = Hypothesis()
    here = Fit(nothing, linearise(forward, nothing, np.zeros((1, 0)), strained[None]))
    assert polish(forward, here).objective > 2.0 * nominal(forward).objective
    assert restart.moved(forward, here).objective == pytest.approx(nominal(forward).objective, abs=0.1)


@pytest.mark.parametrize("idle", [True, False])
def test_an_effect_whose_size_is_none_within_its_error_is_no_name_beside_what_is_left(empty, idle):
    """`viscous-drag` was named beside `unknown` with 0.01 ± 78 per s, the least that a search looks at."""
    forward = Forward(experiment(empty))
    one = effect("viscous-drag")
    hypothesis = Hypothesis((Component(one, variants(one, setup_of(forward))[0]),))
    (rate,) = hypothesis.coordinates
    u = np.array([[rate.low + 1e-6 if idle else 1.0]])
    at = linearise(forward, hypothesis, u, np.zeros((1, forward.layout.size)))
    assert beside._idle(Fit(hypothesis, at)) == idle
