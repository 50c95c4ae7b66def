"""Discovery with gauges of other kinds, of unknown gain, and with readings that are not there."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover import session, written
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.noise import flicker, noise
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.model.whitening import whitened_gaps
from sonicvacuum.figures.discovery import label_of
from sonicvacuum.records import Record, Signals, read, write
from sonicvacuum.records.reader import parse

VIBROMETER = [
    {"id": "laser", "kind": "velocity", "bead": 4, "sigma_m_s": 0.0005, "gain_rel_sigma": 0.02},
    {"id": "far", "kind": "velocity", "bead": 7, "sigma_m_s": 0.0005, "gain_rel_sigma": 0.02},
    {"id": "wall", "kind": "wall", "sigma_N": 0.04, "gain_rel_sigma": 0.02},
]
DROOP = [("sensor-droop", {"tau_us": 150.0})]
DAMPING = [("kuwabara-kono", {"time_us": 0.3})]
# Volts per newton of two gauges that nobody calibrated.
VOLTS = {"g4": 0.037, "g7": 2.1}


def test_a_vibrometer_record_is_written_read_and_discovered(tmp_path):
    record, _ = made(DROOP, seed=3, sensors=VIBROMETER)
    write(record, tmp_path / "in")
    result = session.discover(read(tmp_path / "in"))
    assert result.verdict.named == ["sensor-droop"]
    found = result.verdict.parameters["sensor-droop"]["tau_us"]
    assert found.value == pytest.approx(150.0, abs=4.0 * found.sigma)
    assert result.verdict.gap.fitted.after == pytest.approx(
        1.0, abs=0.1
    )  # 4200 data: 4 errors of the mean square
    header, rows = written.trace_rows(result)
    assert header == ["run", "sensor", "time_us", "measured", "nominal", "extended", "sigma", "unit"]
    assert {(r[1], r[-1]) for r in rows} == {("laser", "m/s"), ("far", "m/s"), ("wall", "N")}


def test_force_records_keep_their_columns(nothing):
    header, _ = written.trace_rows(nothing)
    assert header == ["run", "sensor", "time_us", "measured_N", "nominal_N", "extended_N", "sigma_N"]


def in_volts(record):
    """The record as its gauges in beads show it in volts, their gains and noise not stated."""
    sensors = [
        msgspec.structs.replace(s, gain_rel_sigma="unknown", sigma_N=None) if s.id in VOLTS else s
        for s in record.block.sensors
    ]
    shown = {
        run: Signals(t.time_us, {g: r * VOLTS.get(g, 1.0) for g, r in t.readings.items()})
        for run, t in record.signals.items()
    }
    return Record(msgspec.structs.replace(record.block, sensors=sensors), shown, record.name)


def test_gains_that_nobody_knows_start_near_the_truth(hidden):
    gauges = {g.id: g for g in experiment(in_volts(hidden)).gauges}
    for name, volts in VOLTS.items():
        # Hidden damping lowers the pulse by a few per cent, errors of speed and modulus change it as much.
        assert gauges[name].gain == pytest.approx(volts, rel=0.15)
    assert gauges["wall"].gain == 1.0


def test_gauges_in_volts_find_the_effect_that_calibrated_ones_find(hidden, verdict):
    result = session.discover(in_volts(hidden))
    found, calibrated = result.verdict, verdict.verdict
    family = {"kuwabara-kono", *(name for names in calibrated.confusable for name in names)}
    assert found.named
    assert set(found.named) <= family
    assert found.gap.fitted.after == pytest.approx(calibrated.gap.fitted.after, abs=0.05)
    header, rows = written.trace_rows(result)
    assert header[-1] == "unit"
    assert {(r[1], r[-1]) for r in rows} == {("g4", "as recorded"), ("g7", "as recorded"), ("wall", "N")}
    assert label_of("as recorded") == "reading (as recorded)"


def test_a_gauge_that_a_run_lacks_counts_for_nothing(empty):
    run = empty.block.runs[0].id
    less = {g: r for g, r in empty.signals[run].readings.items() if g != "g7"}
    lacking = replace(empty, signals={**empty.signals, run: Signals(empty.signals[run].time_us, less)})
    data = experiment(lacking)
    whole = experiment(empty)
    assert data.size(0) == whole.size(0) - 700
    assert data.length(0) == whole.length(0)
    fitted = nominal(Forward(data, 1))
    assert fitted.normal.chi2[0, 0] / data.size(0) == pytest.approx(1.0, abs=0.12)  # 4 errors of 1400 squares
    assert not data.whitened(0)[700:1400].any()


@pytest.mark.parametrize("correlated", [0.0, 0.6])
def test_samples_that_do_not_count_change_nothing(empty, correlated):
    data = replace(experiment(empty), correlation=np.full(3, correlated))
    present = np.ones((3, 700), dtype=bool)
    present[1, 200:230] = present[0, ::7] = False
    kept = replace(data.runs[0], present=present)
    spoilt = np.where(present, kept.readings, 1e3)
    one = replace(data, runs=(kept, data.runs[1]))
    other = replace(data, runs=(replace(kept, readings=spoilt), data.runs[1]))
    assert one.size(0) == 3 * 700 - 30 - 100
    np.testing.assert_array_equal(one.whitened(0), other.whitened(0))
    fits = [nominal(Forward(e, 1)) for e in (one, other)]
    assert fits[0].objective == fits[1].objective


@pytest.mark.parametrize("rho", [0.0, 0.4, 0.95])
def test_whitening_across_gaps_is_the_exact_gaussian_likelihood(rho):
    random = np.random.default_rng(3)
    present = random.random((2, 60)) < 0.6
    noise_ = random.normal(size=(4, 2, 60))
    white = whitened_gaps(noise_, np.array([rho, 0.2]), present)
    for s, r in enumerate((rho, 0.2)):
        at = np.flatnonzero(present[s])
        # Dense covariance of a stationary first-order autoregression at the samples that are there.
        covariance = r ** np.abs(at[:, None] - at[None, :])
        kept = noise_[:, s, at]
        exact = np.einsum("li,ij,lj->l", kept, np.linalg.inv(covariance), kept)
        np.testing.assert_allclose(
            np.square(white[:, s]).sum(axis=1), exact, rtol=1e-10
        )  # rounding, condition < 1e3
        assert not white[:, s, ~present[s]].any()


def test_whitening_without_gaps_is_that_of_full_records():
    noise_ = np.random.default_rng(4).normal(size=(2, 3, 50))
    rho = np.array([0.3, 0.0, 0.7])
    full = whitened_gaps(noise_, rho, None)
    np.testing.assert_allclose(whitened_gaps(noise_, rho, np.ones((3, 50), dtype=bool)), full, atol=1e-14)


def test_a_run_without_samples_is_white():
    """Runs of scalars alone stand beside others with correlated noise."""
    assert whitened_gaps(np.zeros((2, 3, 0)), np.full(3, 0.5), None).shape == (2, 3, 0)


def test_noise_that_is_not_stated_is_seen(empty):
    sensors = [msgspec.structs.replace(s, sigma_N=None) for s in empty.block.sensors]
    silent = replace(empty, block=msgspec.structs.replace(empty.block, sensors=sensors))
    stated, seen = noise((empty,))[0], noise((silent,))[0]
    # From 40 to some hundred quiet samples a gauge: 1/√(2n) is 11 % at most.
    np.testing.assert_allclose(seen, stated, rtol=0.35)


def test_flicker_is_the_noise_of_a_smooth_signal():
    random = np.random.default_rng(5)
    pulse = 5.0 / np.cosh((np.arange(4000) - 2000) / 40.0) ** 2
    noisy = pulse + random.normal(0.0, 0.02, 4000)
    assert flicker(noisy) == pytest.approx(0.02, rel=0.08)  # median of 4000 dependent values: 2.5 % each
    assert flicker(pulse) < 1e-4


def test_a_record_without_any_gauge_of_its_own_in_some_runs_parses():
    record, _ = made(seed=1, sensors=VIBROMETER)
    again = parse(msgspec.to_builtins(record.block))
    assert [g.kind for g in Record(again).gauges] == ["velocity", "velocity", "wall"]
