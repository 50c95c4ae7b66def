"""The smooth discrepancy: exact whitening, evidence as that of the dense Gaussian, and what is inferred."""

from dataclasses import replace

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover import session
from sonicvacuum.discover.fit import smooth
from sonicvacuum.discover.fit.normal import linearise
from sonicvacuum.discover.fit.refit import Fit, polish
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.experiment import Smooth
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.rounds import investigate
from sonicvacuum.discover.search import several
from sonicvacuum.records import Record


def test_whitening_is_the_inverse_root_of_the_covariance():
    rng = np.random.default_rng(np.random.SeedSequence(1))
    u, _ = np.linalg.qr(rng.normal(size=(30, 4)))
    variances = np.array([9.0, 2.0, 0.5, 0.01])
    one = Smooth(0.1, 2.0, (((u, variances),),))
    root = one.whiten(0, np.eye(30)[:, None])[:, 0]
    covariance = np.eye(30) + 2.0 * (u * variances) @ u.T
    np.testing.assert_allclose(root @ covariance @ root.T, np.eye(30), atol=1e-12)  # rounding only


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
        return smooth._evidence(parts, size * variances, columns.T @ y, hessian)

    # The Hessian is held up by a part in 1e9.
    assert algebra(3.0) - algebra(0.0) == pytest.approx(dense(3.0) - dense(0.0), abs=1e-6)


def test_no_discrepancy_leaves_everything_as_it_is(empty):
    e = experiment(empty)
    assert smooth.with_size(e, 0.0).smooth is None
    assert smooth.with_size(smooth.with_size(e, 0.01), 0.0).smooth is None
    small = smooth.with_size(e, 1e-9)
    np.testing.assert_allclose(small.whitened(0), e.whitened(0), atol=1e-9)  # of a size of 1e-9


def test_nothing_smooth_is_found_in_noise(empty):
    forward = Forward(experiment(empty))
    assert not smooth.infer(forward, nominal(forward), smooth.blocks(forward.experiment)).found


@pytest.mark.parametrize("size", [0.02, 0.05])
def test_a_smooth_misfit_is_found_with_its_size(empty, size):
    record = with_systematics(empty, size)
    forward = Forward(experiment(record))
    seen = smooth.infer(forward, nominal(forward), smooth.blocks(forward.experiment))
    assert seen.found
    assert size / 2.0 < seen.size < size * 2.0  # some sixty directions, part of which nuisances take up


def test_a_rough_misfit_is_no_larger_smooth_one(empty):
    forward = Forward(experiment(roughened(with_systematics(empty, 0.02), 5.0)))
    null = nominal(forward)
    seen = smooth.infer(forward, null, smooth.blocks(forward.experiment))
    assert 0.01 < seen.size < 0.04  # within twice what is there
    assert 3.0 < seen.excess < 6.0  # noise of √(1 + 5²) in two thirds of the samples, tried in steps of 1.3
    counted = smooth.with_size(forward.experiment, seen.size, None, seen.excess)
    left = nominal(Forward(counted)).objective / sum(counted.size(k) for k in range(2))
    assert 0.5 < left < 2.0  # a step of 1.3 in the noise is 1.7 in its square


def test_an_effect_is_kept_beside_a_smooth_misfit():
    hidden = made([("viscous-drag", {"rate_per_s": 300.0})], seed=2)[0]
    v = session.discover(with_systematics(hidden, 0.01)).verdict
    assert v.named == ["viscous-drag", "unknown"]
    assert v.probabilities["viscous-drag + unknown"] > 0.9
    rate = v.parameters["viscous-drag"]["rate_per_s"]
    assert abs(rate.value - 300.0) < 4.0 * rate.sigma
    assert v.gap.fitted.after < v.gap.fitted.before
    assert 0.005 < v.fit.smooth_rel < 0.02  # as hidden: 1 % of the peak


def test_a_smooth_misfit_that_the_record_states_names_nothing(empty):
    e = replace(experiment(with_systematics(empty, 0.01)), model_floor_rel=0.01)
    found = investigate(e)
    assert found.named == []
    assert found.smooth == 0.0  # nothing beyond what is stated


def with_systematics(record: Record, size: float, seed=5) -> Record:
    """A record with a smooth error of `size` peaks in every trace, from the arrival on."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    signals = {}
    for run, one in record.signals.items():
        readings = {}
        for gauge, trace in one.readings.items():
            wide = smooth.width(np.abs(trace))
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


def test_the_width_of_a_pulse_is_that_at_half_height():
    time = np.arange(200.0)
    assert smooth.width(np.exp(-4.0 * np.log(2.0) * np.square((time - 90.0) / 20.0))) == pytest.approx(
        20, abs=1
    )


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
    forward = Forward(smooth.with_size(plain, 0.01, smooth.blocks(plain)), 1)
    strained = np.zeros(forward.layout.size)
    strained[forward.layout.modulus] = -40.0
    nothing = Hypothesis()
    here = Fit(nothing, linearise(forward, nothing, np.zeros((1, 0)), strained[None]))
    assert polish(forward, here).objective > 2.0 * nominal(forward).objective
    assert several.moved(forward, here).objective == pytest.approx(nominal(forward).objective, abs=0.1)
