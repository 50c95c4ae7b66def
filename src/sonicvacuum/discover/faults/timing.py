"""Slips of time: where each run, and each gauge in it, sits in time beside the model's readings."""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from sonicvacuum.discover.correlation import correlated
from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.faults.found import Finding
from sonicvacuum.discover.faults.judged import Model
from sonicvacuum.discover.faults.slips import WIDTH, Slip, constant, ignoring
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.records import Record

# A run is shifted where its traces fit best so many standard errors of its trigger off.
FAR = 8.0
# A run's own time zero is asked for where the fit has moved it by so many standard errors.
STRAINED = 3.0
# No gauge is late by more than this share of a record.
MOST = 0.5
# Time zeros of so many runs or more that differ from their mean by less than this share of it are off alike.
FEWEST, SHARED = 3, 0.25
# A pulse has arrived where it exceeds this share of its peak, as a scope's trigger level would have it.
ARRIVED = 0.1


def shifts(record: Record, predicted) -> dict[str, float]:
    """Run → by how many us its traces lie before the model's, all gauges together."""
    return {k: lag(record, k, predicted, s.readings) for k, s in record.signals.items() if predicted.get(k)}


def arrival(time_us, reading) -> float:
    """When a reading (T,) at times (T,) is highest, in us."""
    return float(time_us[int(np.argmax(np.abs(reading)))])


def lag(record: Record, run: str, predicted, ids) -> float:
    """By how many us the traces of some gauges of a run lie before the model's, together; 0 where none is
    like it anywhere, or none moves.
    """
    signals, total = record.signals[run], np.zeros(1)
    for id in ids:
        if id in predicted[run]:
            scale = float(np.ptp(signals.readings[id])) * float(np.ptp(predicted[run][id]))
            if scale > 0.0:
                total = total + correlated(predicted[run][id], signals.readings[id]) / max(scale, 1e-300)
    if not total.max() > 0.0:
        return 0.0
    lags = np.arange(1 - signals.samples, signals.samples)
    return float(lags[int(np.argmax(total))]) * signals.interval_s * 1e6


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


def unknown_zeros(record: Record, predicted) -> list[Slip]:
    """The slip that time zeros of the runs are not known as well as stated: each run has its own, somewhere
    within a pulse's width of the stated one.
    """
    sigma = record.trigger_sigma_s * 1e6
    runs = [k for k in record.signals if predicted.get(k)]
    width = max((_width(record.signals[k], predicted[k]) for k in runs), default=0.0)
    if not FAR * sigma < width:
        return []
    interval = max(record.signals[k].interval_s for k in runs) * 1e6
    change = partial(ignoring, changes.time_zero, {}, width)
    occam = -len(runs) * math.log(width / interval)
    return [Slip("time-zero", change, value=partial(constant, None), occam=occam)]


def delay_left_open(record: Record, id: str, predicted) -> Record:
    """A record in which a gauge was put earlier, its delay known to a pulse's width from there on: it was
    told by the nominal model's pulses, which an effect that is not known yet makes earlier or later.
    """
    shown = [k for k, s in record.signals.items() if id in s.readings and predicted.get(k)]
    width = max((_width(record.signals[k], predicted[k]) for k in shown), default=0.0)
    return changes.delay_known_to(record, id, float(width))


def counted_on(findings: Sequence[Finding], found: Investigation) -> tuple[Finding, ...]:
    """Slips, the time zero of all runs and the delays of gauges with what the effects found ask for besides:
    how late pulses are was told by the nominal model's. Of time zeros that each run has for itself, by how
    much they are off where all turn out to be off alike.
    """
    layout, runs = found.forward.layout, found.forward.experiment.runs
    late = 1e6 * found.final.nu * found.forward.nuisance_sigma
    places = [layout.trigger(k) for k, run in enumerate(runs) if run.has_signals]
    zero = float(np.mean(late[places])) if places else 0.0
    delays = {layout.named(k): float(late[k]) for k in layout.other("delay")}

    def counted(finding):
        if not finding.corrected or finding.run is not None:
            return finding
        if finding.value is None:
            alike = finding.fault == "time-zero" and _alike(late[places])
            return replace(finding, value=-zero) if alike else finding
        more = {"time-zero": -zero, "gauge-delayed": delays.get(finding.sensor, 0.0)}
        return replace(finding, value=finding.value + more.get(finding.fault, 0.0))

    return tuple(counted(f) for f in findings)


def _alike(late):
    """Whether the time zeros (R,) of all runs are off by about as much."""
    if len(late) < FEWEST:
        return False
    return bool(np.abs(late - late.mean()).max() < SHARED * abs(float(late.mean())))


def late_runs(record: Record, model: Model, predicted) -> list[Slip]:
    """Runs whose own trigger came late or early while others' did not, where the data ask for that.

    Each starts from where the fit has led its time zero, or where its traces fit best.
    """
    sigma = record.trigger_sigma_s * 1e6
    if not math.isfinite(sigma) or len(record.signals) < 2:
        return []
    layout, late = model.forward.layout, shifts(record, predicted)
    far = {k: abs(v) > FAR * max(sigma, record.signals[k].interval_s * 1e6) for k, v in late.items()}
    found = []
    for place, run in enumerate(model.forward.experiment.runs):
        strain = float(model.fit.nu[layout.trigger(place)])
        if run.id not in late or not (abs(strain) > STRAINED or (far[run.id] and not all(far.values()))):
            continue
        # What the fit adds to true times is taken off the recorded ones.
        start = -strain * sigma if abs(strain) > STRAINED else late[run.id]
        found.append(late_run(record, run.id, start))
    return found


def late_run(record: Record, run: str, start: float) -> Slip:
    """The slip that one run's own trigger came late or early, by about so many us."""
    return Slip(
        "time-zero",
        partial(_one_late, run, max(record.trigger_sigma_s * 1e6, 0.0)),
        run,
        alternatives=len(record.signals),
        width=WIDTH["time-zero"],
        step=0.05,
        value=float,
        start=start,
        instead="trigger",
    )


def _one_late(run, sigma, record, size):
    return changes.time_zero(record, {run: size}, sigma)


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


def gauge_delay(slip: Slip, record: Record, predicted) -> float:
    """By how many us a gauge's traces are late where they fit best, beside the other gauges' traces."""
    runs = [k for k, s in record.signals.items() if slip.sensor in s.readings and predicted.get(k)]
    others = {k: [i for i in record.signals[k].readings if i != slip.sensor] for k in runs}
    lags = [
        lag(record, k, predicted, others[k]) - lag(record, k, predicted, (slip.sensor,))
        for k in runs
        if others[k]
    ]
    late = float(np.median(lags)) if lags else 0.0
    # Put right by more, a trace would hardly hold a reading.
    return late if abs(late) < MOST * min((_span_us(record.signals[k]) for k in runs), default=0.0) else 0.0


def _span_us(signals):
    return 1e6 * signals.samples * signals.interval_s
