"""A first estimate of the gains that nobody knows, so that a search starts near the data.

The nominal model is simulated once; the gain of an uncalibrated gauge is the least-squares factor of its
predicted readings on the measured ones, over all runs, each run shifted in time to where it fits best. It
becomes the gauge's nominal gain; the logarithm about it stays free within `gauges.base.UNKNOWN_GAIN` and is
marginalised like every other nuisance.
"""

from dataclasses import replace

import numpy as np
from scipy.signal import correlate

from sonicvacuum.discover.experiment import Experiment


def with_gains(data: Experiment) -> Experiment:
    """The data set with nominal gains for its uncalibrated gauges; the same object where there are none."""
    if all(g.calibrated for g in data.gauges) or not any(r.has_signals for r in data.runs):
        return data
    predicted = _nominal(data)
    ratio = {
        g.id: 1.0 if g.calibrated else _factor([_pair(data, k, s, p) for k, p in enumerate(predicted)])
        for s, g in enumerate(data.gauges)
    }

    def scaled(gauges):
        return gauges and tuple(replace(g, gain=g.gain * ratio[g.id]) for g in gauges)

    batches = tuple(replace(b, gauges=scaled(b.gauges)) for b in data.batches)
    return replace(data, gauges=scaled(data.gauges), batches=batches)


def _nominal(data):
    """(S, T) readings of each run as the nominal model has them, in units of the noise."""
    from sonicvacuum.discover.forward import Forward
    from sonicvacuum.discover.hypothesis import Hypothesis

    runs = tuple(replace(r, present=None, scalars=()) for r in data.runs)
    forward = Forward(replace(data, runs=runs, correlation=np.zeros(len(data.gauges))))
    found = forward.sampled(Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))
    return [value[0].reshape(len(data.gauges), -1) for value, _ in found]


def _pair(data, run, s, predicted):
    """Measured and predicted trace of a gauge in a run; what does not count is 0."""
    one = data.runs[run]
    return one.readings[s] * (1.0 if one.present is None else one.present[s]), predicted[s] * data.sigma[s]


def _factor(pairs):
    """Least-squares factor of predictions on measurements, each pair at its best shift; 1 where none fits."""
    product = power = 0.0
    for measured, predicted in pairs:
        if np.any(measured):
            product += float(correlate(measured, predicted).max())
            power += float(predicted @ predicted)
    return product / power if product > 0.0 and power > 0.0 else 1.0
