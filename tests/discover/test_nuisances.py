"""Nuisances: columns against finite differences, closed forms of what is marginalised, exact means exact."""

import math

import numpy as np
import pytest
from made_records import TOLERANCES, block, made, with_keys

from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.nuisances import SCATTER, Layout, Shared
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.model.scatter import DIRECTIONS
from sonicvacuum.discover.model.slow import columns
from sonicvacuum.discover.search import directions, screen
from sonicvacuum.discover.search.singles import setup_of
from sonicvacuum.files import InputError
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.reader import parse


def test_every_column_is_the_slope_of_the_predictions(quiet):
    open_ = with_keys(
        quiet,
        sensors={"delay_sigma_us": 0.4},
        materials={"stainless-steel": {"modulus_rel_sigma": 0.1}, "alumina": {"modulus_rel_sigma": 0.1}},
        tolerances=TOLERANCES,
        clock_rel_sigma=1e-4,
    )
    forward = Forward(experiment(open_))
    kinds = [one.kind for one in forward.layout.others]
    assert kinds.count("modulus") == 2 and kinds.count("delay") == 3 and len(kinds) == 11 + DIRECTIONS
    at = 0.3 * np.ones((1, forward.layout.size))
    found = forward.columns(Hypothesis(), np.zeros((1, 0)), at, precise=True)
    step, (mass,) = 1e-3, forward.layout.other("bead-mass")
    around = np.concatenate([at + step * np.eye(at.size), at - step * np.eye(at.size)])
    values = forward.sampled(Hypothesis(), np.zeros((len(around), 0)), around)
    for run, value in enumerate(values):
        slopes = (value[: at.size] - value[at.size :]) / (2.0 * step)
        for column, place in enumerate(forward.layout.local(run)):
            error = np.linalg.norm(found[run][0, 1 + column] - slopes[place])
            # The clock and delays move readings by interpolation of degree 5, whose slopes are good to 1 %.
            # Beads that differ make up for one another: steps are for what they change together.
            single = place in forward.layout.other(SCATTER)
            whole = np.linalg.norm(slopes[mass if single else place])
            assert error < (0.03 if single else 0.01) * whole + 1e-6, (run, place)


def test_what_is_exact_has_no_column_and_changes_nothing(quiet):
    exact = with_keys(quiet, tolerances=dict.fromkeys(TOLERANCES, 0.0), clock_rel_sigma=0.0)
    assert experiment(exact).shared == () == experiment(with_keys(quiet)).shared
    known = with_keys(quiet, materials={"parylene-c": {"modulus_rel_sigma": 0.0}})
    forward = Forward(experiment(known))
    assert forward.nuisance_sigma[forward.layout.modulus] == 0.0
    one = forward.columns(Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))[0]
    assert not np.any(one[0, 1])


def test_places_of_shared_and_local_ones_agree():
    layout = Layout(3, 2, (Shared("bead-mass", 0.01), Shared("clock", 1e-4), Shared("delay", 1e-6, "g", 1)))
    assert layout.size == 2 * 3 + 2 + 1 + 3
    np.testing.assert_array_equal(np.delete(layout.local(1), [1, 2]), layout.shared)
    assert sorted({int(k) for run in range(3) for k in layout.local(run)}) == list(range(layout.size))
    assert layout.simulated == [layout.modulus, layout.other("bead-mass")[0]]


def test_a_baseline_and_a_drift_weigh_as_their_covariance_says():
    errors = {"baseline_sigma_N": 0.05, "drift_sigma_N": 0.1}
    e = experiment(with_keys(made()[0], sensors=errors))
    assert not np.any(e.correlation)
    rng = np.random.default_rng(np.random.SeedSequence(4))
    trace = rng.normal(size=len(e.runs[0].time))
    alone = np.zeros((1, len(e.gauges), len(trace)))
    alone[0, 0] = trace
    part = columns(e.runs[0].time, 0.05, 0.1)
    covariance = e.sigma[0] ** 2 * np.eye(len(trace)) + part @ part.T
    white = e.whiten(0, alone, np.zeros((1, 0)))[0]
    assert white @ white == pytest.approx(trace @ np.linalg.solve(covariance, trace), rel=1e-9)


def test_drift_begins_at_zero_and_ends_as_stated():
    part = columns(np.linspace(0.0, 1.0, 200), 0.0, 2.0)
    variance = np.square(part).sum(axis=1)
    assert variance[0] == pytest.approx(0.0, abs=1e-20)
    # Four terms of the series hold 95 % of the variance at the end: Σ 2/((k − ½) π)² = 0.95.
    assert variance[-1] == pytest.approx(4.0, rel=0.06)


def test_speeds_that_are_high_together_are_no_striker_error_where_that_may_be():
    record, _ = made([("striker-error", {"speed_ratio": 1.048, "mass_ratio": 1.0})], seed=6)

    def score(tolerances):
        forward = Forward(experiment(with_keys(record, tolerances=tolerances)))
        fit = nominal(forward)
        seen = screen.screen(forward, fit, directions.catalogue(setup_of(forward), ()))
        names = [(d.effect, d.strength) for d in seen.directions]
        return abs(seen.z[names.index(("striker-error", "speed_ratio"))]), forward, fit

    alone, _, _ = score({})
    together, forward, fit = score({"speed_common_rel": 0.02})
    place = forward.layout.other("speed-common")[0]
    assert together < 0.6 * alone
    assert fit.nu[place] * forward.nuisance_sigma[place] == pytest.approx(math.log(1.048), abs=0.02)


def delayed(record: Record, shifts) -> Record:
    """The record with the time zero of each run moved, in µs, and unknown."""
    content = block([r.striker.speed_m_s for r in record.block.runs])
    moved = {
        r: Signals(s.time_us + shift, s.readings)
        for (r, s), shift in zip(record.signals.items(), shifts, strict=True)
    }
    return Record(parse({**content, "trigger_sigma_us": "unknown"}), moved, "free")


def test_a_time_zero_that_nobody_knows_is_found():
    record, _ = made(noise=0.0, seed=8)
    shifts = (-83.4, 212.7)
    e = experiment(delayed(record, shifts))
    known = nominal(Forward(experiment(record)))
    forward = Forward(e)
    free = nominal(forward)
    found = [
        1e6 * (r.shift + free.nu[forward.layout.trigger(k)] * e.trigger_sigma) for k, r in enumerate(e.runs)
    ]
    np.testing.assert_allclose([1e6 * r.shift for r in e.runs], shifts, atol=2.0)  # two samples
    np.testing.assert_allclose(found, shifts, atol=0.5)  # what noise and interpolation leave
    assert free.objective < known.objective + 10.0


@pytest.mark.parametrize("late", [{}, {"delay_sigma_us": 3.0}])
def test_no_more_is_simulated_than_is_read(late):
    """A time zero that nobody knows asks for long chains only until it is found."""
    sensors = [{**sensor, **late} for sensor in block([0.3])["sensors"]]
    record, _ = made(seed=8, sensors=sensors)
    content = block([r.striker.speed_m_s for r in record.block.runs], sensors=sensors)
    free = Record(parse({**content, "trigger_sigma_us": "unknown"}), record.signals, "free")

    class Whole(Forward):
        def _lasting(self, batch, nu):
            return batch.first_s

    class Told(Forward):
        def simulate(self, batch, setup, duration=None):
            lasted.append(duration / batch.first_s)
            return super().simulate(batch, setup, duration)

    lasted, e = [], experiment(free)
    forward = Told(e)
    random = np.random.default_rng(np.random.SeedSequence(5))
    nu = random.standard_normal((6, forward.layout.size))
    u = np.zeros((6, 0))
    for own, whole in zip(
        forward.sampled(Hypothesis(), u, nu), Whole(e).sampled(Hypothesis(), u, nu), strict=True
    ):
        # In standard errors of single samples; chains are dealt to lanes otherwise, which is rounding.
        np.testing.assert_allclose(own, whole, rtol=0.0, atol=1e-6)
    assert max(lasted) < 0.9
    # Where time zero lies far before the trace there is no end to what is read but that of the simulation.
    far = np.zeros((1, forward.layout.size))
    far[0, forward.layout.trigger(0)] = -1e3
    forward.sampled(Hypothesis(), u[:1], far)
    assert lasted[-1] == 1.0


def test_the_speed_may_be_known_to_a_third_only():
    record, _ = made([("striker-error", {"speed_ratio": 1.25, "mass_ratio": 1.0})], seed=9)
    content = block([r.striker.speed_m_s for r in record.block.runs])
    for run in content["runs"]:
        run["striker"]["speed_rel_sigma"] = 0.3
    free = nominal(Forward(experiment(Record(parse(content), record.signals, "free"))))
    data = 2 * 3 * 700
    assert free.settled and free.objective < data + 3 * 92  # three standard deviations of χ²
    # The speeds were drawn with 1 %; gains and modulus leave them open by about as much.
    np.testing.assert_allclose(np.exp(0.3 * free.nu[:2]), 1.25, rtol=0.04)


def test_priors_of_the_record_reach_the_search(quiet):
    stated = experiment(with_keys(quiet, priors={"coating-thickness": 10.0, "tsuji": 0}))
    assert stated.prior_odds == {"coating-thickness": 10.0, "tsuji": 0.0}
    assert stated.excluded == ("tsuji",)
    setup = setup_of(Forward(stated))
    asked = {e.id for e in setup.catalogue.candidates(setup, stated.excluded)}
    assert "tsuji" not in asked
    assert "kuwabara-kono" in asked
    with pytest.raises(InputError, match=r"/record.yaml: priors\.gremlins: is 2: no such effect"):
        experiment(with_keys(quiet, priors={"gremlins": 2.0}))
