"""Where the search for the size of a slip starts: slopes at the record as it is do not lead to a far one."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.faults.heard import heard
from sonicvacuum.discover.faults.judged import Model
from sonicvacuum.discover.faults.slips import WIDTH, Slip
from sonicvacuum.discover.faults.timing import gauge_delay
from sonicvacuum.physics.scales import STRIKER_POWER
from sonicvacuum.records import Record
from sonicvacuum.records.suspects import weights

# Run → gauge → (T,) predicted readings.
Predicted = Mapping[str, Mapping[str, np.ndarray]]
# A run's speed, and the recorder's time, are not off by more, in their logarithms; what all gauges share may
# be a unit: millivolts for volts, and more.
FARTHEST, FARTHEST_GAIN = math.log(30.0), math.log(3e3)
# What a ball's mass and its material's density speak of.
WEIGHED = ("bead-mass", "bead-size", "striker-mass")
# Pulses of one run that are as much longer than those of others, in logarithms, are no effect's.
STRETCHED = math.log(1.15)
# What all runs and gauges share: put right before any effect is known, which may have led its size.
FACTORS = ("gain-common", "clock")
# A pulse stands out of a trace by so many standard deviations of its noise.
CLEAR = 10.0
# Sizes below so many prior widths are found from none.
NEAR = {"gauge-delayed": 1.0, "run-off": 2.0, "gain-common": 2.0, "clock": 3.0}
# A gauge's delay is found from none only below this share of a pulse's width as well: small hard beads have
# pulses much shorter than delays err, and slopes know nothing of one that the trace's pulse is clear of.
OVERLAP = 0.25


def unfinished(record: Record, predicted: Predicted) -> bool:
    """Whether the record ends before most of the model's pulses have passed, though it has whole pulses: what
    is high and how long of those that are cut off tells nothing.
    """
    noise = heard(record)
    gauges = [(run, gauge) for run in predicted for gauge in record.gauges if gauge.id in predicted[run]]
    found = [
        _length(predicted[run][gauge.id]) is None
        for run, gauge in gauges
        if _shows(record.signals[run].readings.get(gauge.id), noise[gauge.id])
    ]
    return 2 * sum(found) > len(found)


def _shows(trace, sigma):
    """Whether a trace has a whole pulse that stands out of its noise."""
    return trace is not None and trace.max() > CLEAR * sigma and _length(trace) is not None


def with_starts(
    slips: list[Slip], record: Record, predicted: Predicted, model: Model, whole: Predicted | None = None
) -> list[Slip]:
    """Delays of single gauges start where the gauge's own traces fit best, a run's speed where the fit has
    led it, or where its peaks are as high as the traces'; a factor that all gauges share (a termination, a
    probe) where peaks of all runs are, and the recorder's time where pulses are as long. Sizes and masses of
    balls are asked for once more from where these weigh what their material does.

    `whole` are the predicted readings, read on until the pulses have passed, where they were cut off.
    """
    weighed = [(s, _weighed(record, s.fault)) for s in slips if s.fault in WEIGHED]
    started = [_started(s, record, predicted, model, whole or predicted) for s in slips]
    return started + [replace(s, start=start, expected=start) for s, start in weighed if start]


def _started(slip, record, predicted, model, whole):
    if slip.fault not in NEAR:
        return slip
    near = NEAR[slip.fault] * slip.width
    if slip.fault == "gauge-delayed":
        start = gauge_delay(slip, record, predicted)
        near = min(near, OVERLAP * _pulse_us(slip.sensor, record, predicted))
    elif slip.fault == "gain-common":
        start = _of_runs((_higher(record, run, whole) for run in whole), FARTHEST_GAIN)
    elif slip.fault == "clock":
        start = _of_runs((_longer(record, run, whole) for run in whole), FARTHEST)
    else:
        start = _speed(slip.run, record, whole, model)
    return replace(slip, start=start) if abs(start) > near else slip


def _weighed(record, fault):
    """Logarithm of the ratio that makes balls weigh what their material does, the median over kinds; 0 where
    they do.
    """
    balls = [one for one in weights(record) if one.striker == (fault == "striker-mass")]
    if not balls or not all(one.off for one in balls):
        return 0.0
    heavier = float(np.median([math.log(one.usual / one.given) for one in balls]))
    return -heavier / 3.0 if fault == "bead-size" else heavier


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


def _of_runs(seen: Iterable[float | None], farthest: float) -> float:
    """The median over runs; 0 where none tells anything, or it is farther than anything is off."""
    told = [value for value in seen if value is not None]
    middle = float(np.median(told)) if told else 0.0
    return middle if abs(middle) < farthest else 0.0


def _longer(record, run, predicted):
    """Logarithm of the pulses' lengths over those of the predicted ones, the median over gauges; None without
    any. Arrivals would tell more of it, and of a late trigger as well; predicted ones may lie behind the end.
    """
    readings = record.signals[run].readings
    lengths = [(_length(readings[g]), _length(model)) for g, model in predicted[run].items() if g in readings]
    ratios = [math.log(own / model) for own, model in lengths if own and model]
    return float(np.median(ratios)) if ratios else None


def run_clocks(record: Record, predicted: Predicted) -> list[Slip]:
    """Runs whose time runs otherwise than that of all others, as where one file was sampled at another rate:
    those whose pulses are longer or shorter by a factor that the others' do not show.
    """
    seen = {run: _longer(record, run, predicted) for run in predicted}
    longer = {run: own for run, own in seen.items() if own is not None}
    if len(longer) < 2 or np.ptp(list(longer.values())) < STRETCHED:
        return []
    # Of two runs the one whose pulses are not as long as predicted.
    usual = float(np.median(list(longer.values()))) if len(longer) > 2 else 0.0
    far = {run: own - usual for run, own in longer.items() if STRETCHED < abs(own - usual) < FARTHEST}
    return [replace(run_clock(run, len(longer)), start=start) for run, start in far.items()]


def run_clock(run: str, runs: int = 1) -> Slip:
    """The slip that time of one run of so many is not as stated."""
    change = partial(_one_clock, run)
    return Slip("clock", change, run, alternatives=runs, width=WIDTH["clock"], step=1e-3)


def _one_clock(run, record, size):
    return changes.clock(record, size, (run,))


def _pulse_us(id, record, predicted):
    """Length of the model's shortest pulse at a gauge, at half its height, in us; infinite without any."""
    own = ((_length(p[id]), record.signals[run].interval_s) for run, p in predicted.items() if id in p)
    return min((1e6 * interval * samples for samples, interval in own if samples), default=math.inf)


def _length(reading):
    """Samples for which the highest pulse is above half of its height; None where it is cut off."""
    half, top = 0.5 * reading.max(), int(np.argmax(reading))
    below = np.flatnonzero(reading < half)
    before, after = below[below < top], below[below > top]
    if not (len(before) and len(after)) or half <= 0.0:
        return None
    up, down = before[-1], after[0]
    rises = (half - reading[up]) / (reading[up + 1] - reading[up])
    falls = (half - reading[down]) / (reading[down - 1] - reading[down])
    return float(down - up - rises - falls)
