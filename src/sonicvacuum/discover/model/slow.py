"""Baselines that are off, drift and pick-up: linear in the readings, marginalised as noise.

A gauge's baseline in a run is a constant with the standard error that the record states; its drift is a
Wiener process that starts at zero and has the stated standard deviation at the end of the trace, of which the
first terms of the Karhunen–Loève series are kept, √2 sin((k − ½) π t) with the variance ((k − ½) π)^−2
(Loève, Probability Theory II, 4th ed., Springer 1978, § 37). Their covariance is of low rank, and divided out
as that of a smooth discrepancy is (`experiment.Smooth`): the same as fitting the weights with their prior.

Of pick-up that was taken off, what its fit to a short stretch leaves open is a change of amplitude and phase
from the first sample to the last; frequency is known to less than that.
"""

from collections.abc import Mapping

import numpy as np

from sonicvacuum.discover.model.experiment import Experiment, Slow

# Terms of the series: 90 % of the variance with two, 95 % with four.
TERMS = 4


# (run id, gauge id) → amplitude in the gauge's unit and frequency in Hz of a pick-up that was taken off.
Lines = Mapping[tuple[str, str], tuple[float, float]]


def slow(experiment: Experiment, lines: Lines | None = None) -> Slow | None:
    """Baselines, drifts and rests of pick-up of all runs and gauges; None where there are none."""
    lines = lines or {}
    if not lines and not any(g.baseline_sigma or g.drift_sigma for g in experiment.gauges):
        return None
    runs = range(len(experiment.runs))
    gauges = range(len(experiment.gauges))
    return Slow(tuple(tuple(_block(experiment, run, s, lines) for s in gauges) for run in runs))


def columns(time: np.ndarray, baseline: float, drift: float) -> np.ndarray:
    """(T, n) changes of a trace by one standard error of each weight, in the unit of the two errors."""
    share = np.linspace(0.0, 1.0, len(time))[:, None]
    rates = (np.arange(TERMS) + 0.5) * np.pi
    terms = drift * np.sqrt(2.0) * np.sin(rates * share) / rates
    return np.concatenate([np.full_like(share, baseline), terms], axis=1)


def _line(time, amplitude, frequency):
    """(T, 4) cosine and sine, steady and growing."""
    angle = 2.0 * np.pi * frequency * (time - time[0])
    waves = amplitude * np.column_stack([np.cos(angle), np.sin(angle)])
    return np.concatenate([waves, np.linspace(0.0, 1.0, len(time))[:, None] * waves], axis=1)


def _block(experiment, run, s, lines):
    data, gauge = experiment.runs[run], experiment.gauges[s]
    traces = columns(data.time, gauge.baseline_sigma, gauge.drift_sigma)
    if (data.id, gauge.id) in lines:
        traces = np.concatenate([traces, _line(data.time, *lines[data.id, gauge.id])], axis=1)
    if not data.has_signals:
        return np.zeros((0, 0)), np.zeros(0)
    alone = np.zeros((traces.shape[1], len(experiment.gauges), len(data.time)))
    alone[:, s] = traces.T / experiment.sigma[s]
    white = experiment.noise_whitened(run, alone)[:, s]
    directions, values, _ = np.linalg.svd(white.T, full_matrices=False)
    kept = values > 1e-9 * max(values.max(), 1e-300)
    return directions[:, kept], np.square(values[kept])
