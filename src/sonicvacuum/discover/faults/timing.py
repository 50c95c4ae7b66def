"""Slips of time: where each run, and each gauge in it, sits in time beside the model's readings."""

import math
from dataclasses import replace
from functools import partial

import numpy as np

from sonicvacuum.discover.correlation import correlated
from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.faults.slips import WIDTH, Slip
from sonicvacuum.records import Record

# A run is shifted where its traces fit best so many standard errors of its trigger off.
FAR = 8.0
# A pulse has arrived where it exceeds this share of its peak, as a scope's trigger level would have it.
ARRIVED = 0.1


def shifts(record: Record, predicted) -> dict[str, float]:
    """Run → by how many us its traces lie before the model's, all gauges together."""
    return {k: _lag(record, k, predicted, s.readings) for k, s in record.signals.items() if predicted.get(k)}


def _lag(record, run, predicted, ids):
    signals, total = record.signals[run], 0.0
    for id in ids:
        if id in predicted[run]:
            total = total + correlated(predicted[run][id], signals.readings[id]) / max(
                float(np.ptp(signals.readings[id])) * float(np.ptp(predicted[run][id])), 1e-300
            )
    lags = np.arange(1 - signals.samples, signals.samples)
    return float(lags[int(np.argmax(total))]) * signals.interval_s * 1e6 if np.ndim(total) else 0.0


def time_zero(record: Record, predicted) -> list[Slip]:
    """The slip that time was not counted from the impact, where all runs lie elsewhere in time."""
    late = shifts(record, predicted)
    sigma = record.trigger_sigma_s * 1e6
    interval = max((record.signals[k].interval_s * 1e6 for k in late), default=0.0)
    if not late or not all(abs(v) > FAR * max(sigma, interval) for v in late.values()):
        return []
    if not math.isfinite(sigma) or len({v > 0.0 for v in late.values()}) > 1:
        return []
    width = max(_width(record.signals[k], predicted[k]) for k in late)
    span = max(s.samples * s.interval_s * 1e6 for s in record.signals.values())
    change = partial(_from_there, late, width)
    mean = float(np.mean(list(late.values())))
    occam = -len(late) * math.log(span / interval)
    return [
        Slip(
            "time-zero",
            change,
            None,
            _triggered(record, late, predicted, width),
            value=lambda _: mean,
            occam=occam,
        )
    ]


def _from_there(late, width, record, _):
    return changes.time_zero(record, late, width)


def _width(signals, predicted):
    """Width of the narrowest predicted pulse at half its height in us."""
    counts = [np.count_nonzero(np.abs(p) > 0.5 * np.abs(p).max()) for p in predicted.values()]
    return max(1, min(counts)) * signals.interval_s * 1e6


def _triggered(record, late, predicted, width):
    """The gauge at which the model's pulse arrives when the recorded time is 0, None where there is none."""
    off = {}
    for g in record.gauges:
        arrivals = [
            abs(late[k] - _arrival(record.signals[k], predicted[k][g.id]))
            for k in late
            if g.id in predicted[k]
        ]
        if len(arrivals) == len(late):
            off[g.id] = max(arrivals)
    best = min(off, key=off.get, default=None)
    return best if best is not None and off[best] < 1.5 * width else None


def _arrival(signals, model):
    first = int(np.argmax(np.abs(model) > ARRIVED * np.abs(model).max()))
    return float(signals.time_us[first])


def with_starts(slips: list[Slip], record: Record, predicted) -> list[Slip]:
    """Delays of single gauges start where the gauge's own traces fit best, beside the other gauges'."""
    return [_started(s, record, predicted) if s.fault == "gauge-delayed" else s for s in slips]


def _started(slip, record, predicted):
    runs = [k for k, s in record.signals.items() if slip.sensor in s.readings and predicted.get(k)]
    others = {k: [i for i in record.signals[k].readings if i != slip.sensor] for k in runs}
    lags = [
        _lag(record, k, predicted, others[k]) - _lag(record, k, predicted, (slip.sensor,))
        for k in runs
        if others[k]
    ]
    start = float(np.median(lags)) if lags else 0.0
    return replace(slip, start=start) if abs(start) > WIDTH[slip.fault] else slip
