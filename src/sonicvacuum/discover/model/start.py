"""A first estimate of gains and time zeros that nobody knows, so that a search starts near the data.

The nominal model is simulated once. Where time zero is not known, a run is shifted to where its predicted
readings, all gauges together, resemble the measured ones most. The gain of an uncalibrated gauge is the
least-squares factor of its predicted readings on the measured ones, over all runs. Both become nominal; about
them they stay free, the gain's logarithm within `gauges.base.UNKNOWN_GAIN`, time zero within
`Record.trigger_width_s`, and are marginalised like every other nuisance.
"""

from dataclasses import replace

import numpy as np
from scipy.signal import correlate

from sonicvacuum.discover.model.experiment import Experiment


def started(data: Experiment, time_zero_unknown: bool = False) -> Experiment:
    """The data set with nominal gains and shifts for what is not known; the same object where all is."""
    unknown = [not g.calibrated for g in data.gauges]
    if not (any(unknown) or time_zero_unknown) or not any(r.has_signals for r in data.runs):
        return data
    pairs = _pairs(data)
    if time_zero_unknown:
        shifts = {run: _lag(found) for run, found in pairs.items()}
        data = replace(data, runs=tuple(_shifted(r, shifts.get(k)) for k, r in enumerate(data.runs)))
    ratio = {
        g.id: _factor([found[s] for found in pairs.values()]) if unknown[s] else 1.0
        for s, g in enumerate(data.gauges)
    }

    def scaled(gauges):
        return gauges and tuple(replace(g, gain=g.gain * ratio[g.id]) for g in gauges)

    batches = tuple(replace(b, gauges=scaled(b.gauges)) for b in data.batches)
    return replace(data, gauges=scaled(data.gauges), batches=batches)


def _pairs(data):
    """Run → measured and predicted trace of each gauge; what does not count is 0, the predicted one begins at
    the impact.
    """
    from sonicvacuum.discover.model.forward import Forward

    forward = Forward(data)
    result = {}
    for batch in data.batches:
        seen = forward.simulate(batch, forward.nominal(batch, np.zeros((1, forward.layout.size))))
        for lane, run in enumerate(batch.runs):
            one = data.runs[run]
            if one.has_signals:
                stride = round(one.interval / batch.interval)
                counts = one.readings if one.present is None else one.readings * one.present
                result[run] = list(zip(counts, seen.readings[lane, :, ::stride], strict=True))
    return result


def _lag(found) -> int:
    """Samples by which the measured traces of a run are best shifted, all gauges together."""
    total = 0.0
    for measured, predicted in found:
        size = np.linalg.norm(measured) * np.linalg.norm(predicted)
        total = total + correlate(measured, predicted) / (size or 1.0)
    return int(np.argmax(total)) - (len(found[0][1]) - 1)


def _shifted(run, lag):
    """A run whose time zero is searched about a shift of so many samples."""
    return run if lag is None else replace(run, shift=float(run.time[0] + lag * run.interval))


def _factor(pairs):
    """Least-squares factor of predictions on measurements, each pair at its best shift; 1 where none fits."""
    product = power = 0.0
    for measured, predicted in pairs:
        if np.any(measured):
            product += float(correlate(measured, predicted).max())
            power += float(predicted @ predicted)
    return product / power if product > 0.0 and power > 0.0 else 1.0
