"""Where the search for the size of a slip starts: slopes at the record as it is do not lead to a far one."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from sonicvacuum.discover.faults.judged import Model
from sonicvacuum.discover.faults.slips import Slip
from sonicvacuum.discover.faults.timing import gauge_delay
from sonicvacuum.physics.scales import STRIKER_POWER
from sonicvacuum.records import Record

# Run → gauge → (T,) predicted readings.
Predicted = Mapping[str, Mapping[str, np.ndarray]]
# A run's speed is not off by more, in its logarithm.
FARTHEST = math.log(30.0)
# Sizes below so many prior widths are found from none.
NEAR = {"gauge-delayed": 1.0, "run-off": 2.0}


def with_starts(slips: list[Slip], record: Record, predicted: Predicted, model: Model) -> list[Slip]:
    """Delays of single gauges start where the gauge's own traces fit best, and a run's speed where the fit
    has led it, or where its peaks are as high as the traces'.
    """
    return [_started(s, record, predicted, model) for s in slips]


def _started(slip, record, predicted, model):
    if slip.fault not in NEAR:
        return slip
    if slip.fault == "gauge-delayed":
        start = gauge_delay(slip, record, predicted)
    else:
        start = _speed(slip.run, record, predicted, model)
    return replace(slip, start=start) if abs(start) > NEAR[slip.fault] * slip.width else slip


def _speed(run, record, predicted, model):
    """Logarithm of a run's speed over the stated one, roughly."""
    forward = model.forward
    runs = [r.id for r in forward.experiment.runs]
    at = forward.layout.speed(runs.index(run))
    led = float(model.fit.nu[at] * forward.nuisance_sigma[at])
    higher = {k: _higher(record, k, predicted) for k in predicted}
    own, others = higher.pop(run, None), [v for v in higher.values() if v is not None]
    if own is None:
        return led
    # What all runs show is no slip of one; nor do peaks tell where the model has none in the record.
    seen = STRIKER_POWER * (own - (float(np.median(others)) if len(others) > 1 else 0.0))
    return max(led, seen if abs(seen) < FARTHEST else 0.0, key=abs)


def _higher(record, run, predicted):
    """Logarithm of the traces' peaks over the predicted ones, the median over gauges; None without any."""
    readings = record.signals[run].readings
    peaks = [(np.ptp(readings[g]), np.ptp(model)) for g, model in predicted[run].items() if g in readings]
    ratios = [np.log(trace / model) for trace, model in peaks if trace > 0.0 and model > 0.0]
    return float(np.median(ratios)) if ratios else None
