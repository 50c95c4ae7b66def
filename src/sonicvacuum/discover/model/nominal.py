"""What the nominal model reads at the recorded numbers, before anything is fitted."""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis


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
