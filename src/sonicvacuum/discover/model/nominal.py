"""What the nominal model reads at the recorded numbers, before anything is fitted."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.gauges import Gauge


def predicted(experiment: Experiment, threads: int = 1) -> dict[str, dict[str, np.ndarray]]:
    """Run → gauge → (T,) reading of the nominal model at the recorded numbers, for the gauges of each run."""
    bare = tuple(replace(r, present=None, scalars=()) for r in experiment.runs)
    forward = Forward(replace(experiment, runs=bare, correlation=np.zeros(len(experiment.gauges))), threads)
    found = forward.sampled(Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))
    result = {}
    for run, value in zip(experiment.runs, found, strict=True):
        rows = value[0].reshape(len(experiment.gauges), -1) * experiment.sigma[:, None]
        result[run.id] = {
            g.id: row
            for s, (g, row) in enumerate(zip(experiment.gauges, rows, strict=True))
            if run.has_signals and (run.present is None or run.present[s].any())
        }
    return {k: v for k, v in result.items() if v}


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
