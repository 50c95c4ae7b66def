"""What the nominal model reads at the recorded numbers, before anything is fitted."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.masks import stuck
from sonicvacuum.gauges import Gauge
from sonicvacuum.physics.scales import passage_of

# Times as long as a record that a wave is waited for: no clock is off by more.
MOST = 30


def predicted(experiment: Experiment, threads: int = 1) -> dict[str, dict[str, np.ndarray]]:
    """Run → gauge → (T,) reading of the nominal model at the recorded numbers, for the gauges of each run; of
    those whose samples do not count, for the ones that are stuck.
    """
    bare = tuple(replace(r, present=None, scalars=()) for r in experiment.runs)
    forward = Forward(replace(experiment.uncoloured, runs=bare), threads)
    found = forward.sampled(Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))
    result = {}
    for run, value in zip(experiment.runs, found, strict=True):
        rows = value[0].reshape(len(experiment.gauges), -1) * experiment.sigma[:, None]
        result[run.id] = {
            g.id: row
            for s, (g, row) in enumerate(zip(experiment.gauges, rows, strict=True))
            if run.has_signals and (run.present is None or run.present[s].any() or stuck(run.readings[s]))
        }
    return {k: v for k, v in result.items() if v}


def read_to_the_end(experiment: Experiment, threads: int = 1) -> dict[str, dict[str, np.ndarray]]:
    """The same, read on in time until the wave has passed the chain: longer where the record ends before, at
    most `MOST` times.
    """
    runs, batches = list(experiment.runs), []
    for batch in experiment.batches:
        passage = passage_of(batch.chain, 1.0)
        for run in batch.runs:
            runs[run] = _until(runs[run], passage)
        last = max(runs[run].time[-1] for run in batch.runs)
        batches.append(replace(batch, duration=max(batch.duration, float(last)), settled_s=np.inf))
    return predicted(
        replace(experiment, runs=tuple(runs), batches=tuple(batches), slow=None, smooth=None), threads
    )


def _until(run, end):
    """A run that was recorded until then, at least."""
    samples = min(math.ceil((end - run.time[0]) / run.interval), MOST * len(run.time))
    if samples <= len(run.time):
        return replace(run, present=None)
    time = run.time[0] + run.interval * np.arange(samples)
    return replace(run, time=time, readings=np.zeros((len(run.readings), samples)), present=None)


def read_at(
    experiment: Experiment, gauges: Sequence[Gauge], threads: int = 1
) -> dict[str, dict[str, np.ndarray]]:
    """Run → gauge → (T,) reading of the nominal model at the recorded numbers, of gauges that nobody had."""
    count = len(gauges)
    runs = tuple(replace(r, readings=np.zeros((count, len(r.time))), present=None) for r in experiment.runs)
    batches = tuple(replace(b, gauges=None) for b in experiment.batches)
    bare = {"sigma": np.ones(count), "gain_rel_sigma": np.zeros(count), "shared": (), "slow": None}
    return predicted(
        replace(experiment, runs=runs, batches=batches, gauges=tuple(gauges), smooth=None, **bare), threads
    )
