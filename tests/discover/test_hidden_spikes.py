"""Spikes that the flank of a pulse hides are told beside the model, and count for nothing."""

from dataclasses import replace

import made_tables
import msgspec
import numpy as np
import pytest
from made_records import SIGMA, made

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import strays
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model import masks
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.records import Signals

ASKED = ("hunt-crossley", "sensor-gain", "static-preload")
NOISE = np.random.default_rng(np.random.SeedSequence(11)).normal(size=400)


def test_a_single_sample_stands_out_of_noise_and_a_smooth_misfit_does_not():
    left = NOISE.copy()
    left[100], left[250], left[251] = 9.0, -30.0, -29.0
    left[150], left[152] = 14.0, 15.0
    left[300:320] += 40.0 * np.hanning(20)
    assert np.flatnonzero(strays.standing_out(left)).tolist() == [100, 150, 152]
    assert not strays.standing_out(NOISE).any()


def test_spikes_of_a_trace_are_counted_together_and_masked_besides():
    before = [
        Finding("spikes", "v0", "g4", 2.0),
        Finding("spikes", None, "wall", 3.0),
        Finding("drift", "v0", "g4"),
    ]
    rows = np.array([0.0, 9.0, 0.0])
    found = {("v0", "g4"): rows, ("v1", "wall"): rows, ("v1", "g7"): rows + np.array([8.0, 0.0, 0.0])}
    count = {(f.run, f.sensor): f.value for f in strays.told(before, found) if f.fault == "spikes"}
    assert count == {("v0", "g4"): 3.0, (None, "wall"): 4.0, ("v1", "g7"): 2.0}
    assert [f.fault for f in strays.told(before, found)].count("drift") == 1
    bench = strays.masked(Bench(None, {("v0", "g4"): np.array([True, False, False])}), found)
    assert bench.lost["v0", "g4"].tolist() == [True, True, False]
    assert bench.lost["v1", "g7"].tolist() == [True, True, False]


def spiked(record, *spikes):
    """The record with spikes (run, gauge, standard deviations) on flanks, where traces are steepest; none of
    them stands out of its trace.
    """
    signals = dict(record.signals)
    for run, gauge, size in spikes:
        trace = signals[run].readings[gauge].copy()
        trace[np.argmax(np.gradient(trace))] += size * SIGMA
        assert not masks.spikes(trace, SIGMA).any()
        signals[run] = Signals(signals[run].time_us, signals[run].readings | {gauge: trace})
    return replace(record, signals=signals)


@pytest.mark.parametrize(
    ("effects", "named"),
    [((), []), ((("hunt-crossley", {"damping_s_per_m": 0.01}),), ["hunt-crossley"])],
)
def test_hidden_spikes_are_told_and_nothing_unknown(effects, named):
    record, _ = made(effects, seed=4, speeds=(1.2,))
    # Few effects are asked for: what spikes of 25 standard deviations leave takes long to follow.
    excluded = {id: 0.0 for id in CATALOGUE.ids if id not in ASKED}
    record = replace(record, block=msgspec.structs.replace(record.block, priors=excluded))
    found = session.discover(spiked(record, ("v0", "g4", 25.0), ("v0", "g7", -12.0))).verdict
    assert found.named == named
    told = {(f.fault, f.run, f.sensor, f.value) for f in found.faults}
    assert told == {("spikes", "v0", "g4", 1.0), ("spikes", "v0", "g7", 1.0)}


def test_tails_of_the_noise_are_told_as_spikes_and_nothing_unknown():
    """Single samples of six standard deviations are no shape: empty records were unknown with 0.99."""
    record, _ = made(seed=4, speeds=(1.2,))
    excluded = {id: 0.0 for id in CATALOGUE.ids if id not in ASKED}
    record = replace(record, block=msgspec.structs.replace(record.block, priors=excluded))
    one = record.signals["v0"]
    trace = one.readings["g4"].copy()
    trace[[30, 60, 600, 650]] += 6.0 * SIGMA * np.array([1.0, -1.0, 1.0, -1.0])
    assert not masks.spikes(trace, SIGMA).any()
    signals = {"v0": Signals(one.time_us, one.readings | {"g4": trace})}
    found = session.discover(replace(record, signals=signals)).verdict
    assert found.named == []
    assert [(f.fault, f.sensor, f.value) for f in found.faults] == [("spikes", "g4", 4.0)]


def test_a_table_has_no_samples_that_could_be_spikes():
    """One of which something unknown was left ended in an error."""
    table = made_tables.chain(departures=[("mass", 2, 3.0)])
    forward = Forward(experiment(table))
    assert not strays.single_samples(forward, nominal(forward))
