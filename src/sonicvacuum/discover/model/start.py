"""A first estimate of gains and time zeros that nobody knows, so that a search starts near the data.

The nominal model is simulated once. Where time zero is not known, a run is shifted to where its predicted
readings, all gauges together, resemble the measured ones most. The gain of an uncalibrated gauge is the
least-squares factor of its predicted readings on the measured ones, over all runs. Both become nominal; about
them they stay free, the gain's logarithm within `gauges.base.UNKNOWN_GAIN`, time zero within
`Record.trigger_width_s`, and are marginalised like every other nuisance.
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.correlation import correlated
from sonicvacuum.discover.model.experiment import Experiment

# A run is shifted by what suits all runs, within so many widths of its pulse, if it resembles the predicted
# one there by this share of what it does where it resembles it most.
NEAR, SUITS = 3, 0.7


def started(data: Experiment, time_zero_unknown: bool = False) -> Experiment:
    """The data set with nominal gains and shifts for what is not known; the same object where all is."""
    unknown = [not g.calibrated for g in data.gauges]
    if not (any(unknown) or time_zero_unknown) or not any(r.has_signals for r in data.runs):
        return data
    pairs = _pairs(data)
    if time_zero_unknown:
        shifts = _lags(pairs)
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

    # What is not known is looked for: no step need be cut for gains that are none.
    forward = Forward(data, cut=1.0)
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


def _lags(pairs) -> dict[int, int]:
    """Samples by which the measured traces of each run are best shifted, all gauges together.

    An echo may resemble the predicted pulse more than the measured pulse does. Runs are mostly triggered
    alike, so that each run's shift is taken near the one that suits all, unless it suits it badly.
    """
    alike = {run: _alike(found) for run, found in pairs.items()}
    own = {run: int(np.argmax(a)) for run, (_, a) in alike.items()}
    zeros = {run: zero for run, (zero, _) in alike.items()}
    best = {run: at - zeros[run] for run, at in own.items()}
    if len(alike) < 2:
        return best
    least, most = -min(zeros.values()), min(len(a) - zeros[run] for run, (_, a) in alike.items())
    whole = sum(a[zeros[run] + least : zeros[run] + most] for run, (_, a) in alike.items())
    common = int(np.argmax(whole)) + least
    for run, (zero, a) in alike.items():
        near = NEAR * max(_width(found) for found in pairs[run])
        first = max(0, zero + common - near)
        at = first + int(np.argmax(a[first : zero + common + near + 1]))
        if a[at] > SUITS * a[own[run]]:
            best[run] = at - zero
    return best


def _alike(found):
    """How much the traces of a run resemble the predicted ones at each shift, upside down or not, and the
    place of no shift.
    """
    total = 0.0
    for measured, predicted in found:
        size = np.linalg.norm(measured) * np.linalg.norm(predicted)
        total = total + np.abs(correlated(measured, predicted)) / (size or 1.0)
    return len(found[0][1]) - 1, total


def _width(pair) -> int:
    """Samples for which the predicted trace of a gauge exceeds half its peak, 1 at least."""
    size = np.abs(pair[1])
    return max(1, int(np.count_nonzero(size > 0.5 * size.max(initial=0.0))))


def _shifted(run, lag):
    """A run whose time zero is searched about a shift of so many samples."""
    return run if lag is None else replace(run, shift=float(run.time[0] + lag * run.interval))


def _factor(pairs):
    """Least-squares factor of predictions on measurements, each pair at its best shift; 1 where none fits.

    A trace may be upside down: the little that noise has of the pulse the right way up would make the model's
    too small to tell.
    """
    product = power = 0.0
    for measured, predicted in pairs:
        if np.any(measured):
            product += float(np.abs(correlated(measured, predicted)).max())
            power += float(predicted @ predicted)
    return product / power if product > 0.0 and power > 0.0 else 1.0
