"""Gains of single traces: one gauge reads otherwise in one run, as where a range was set for that shot.

Effects act on a gauge in all runs, or on all gauges of a run. A trace that is higher or lower than its gauge
reads in other runs, and other gauges in its run, is no effect's.
"""

import math
from collections.abc import Iterable
from dataclasses import replace
from functools import partial

import numpy as np

from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.faults.exchanges import MENDED, Readings, higher
from sonicvacuum.discover.faults.found import Finding
from sonicvacuum.discover.faults.heard import heard
from sonicvacuum.discover.faults.judged import Model
from sonicvacuum.discover.faults.slips import WIDTH, Slip, constant, ignoring
from sonicvacuum.discover.faults.starts import CLEAR, FARTHEST_GAIN
from sonicvacuum.discover.faults.traces import NOISE_FACTOR
from sonicvacuum.discover.model.noise import flicker
from sonicvacuum.discover.search.unknown import raw
from sonicvacuum.records import Record

# Steps of ranges, attenuators and probes within a decade; what is nearer to none than to the least is none.
STEPS = np.log([1.0, 2.0, 5.0, 10.0])
LEAST = 0.5 * math.log(2.0)


def gains_of_one(record: Record, predicted: Readings) -> list[Slip]:
    """The slips that one gauge reads so many times the force in one run, where the heights of all other
    traces over those of the model agree: by a step of a range, and by any factor.

    Args:
        record: as far as it was put right.
        predicted: what the nominal model reads, until the pulses have passed.
    """
    heights = _heights(record, predicted)
    runs, gauges = ({at[side] for at in heights} for side in (0, 1))
    if len(runs) < 2 or len(gauges) < 2:
        return []
    before, found = _off(heights, None)[1], []
    for at in heights:
        off, left = _off(heights, at)
        if LEAST < abs(off) < FARTHEST_GAIN and left < MENDED * before:
            found += _slips(record, *at, off, len(heights))
    return found


def _slips(record, run, id, off, alternatives):
    """One trace by the nearest step of a range, and by the factor that its height tells."""
    where = {"alternatives": alternatives, "shown": True}
    if _noise(record, run, id, off) > NOISE_FACTOR:
        return [replace(_left_out(record, run, id), start=off, **where)]
    plain, height = (_by(record, run, id, one) for one in (_step(off), off))
    price = plain.occam + _price(record, run, id, off)
    return [replace(plain, **where), replace(height, **where, occam=price)]


def _price(record, run, id, off):
    """Log of the Occam factor of a factor that a trace's height tells, as well as its noise lets it, and of
    what its noise has less, or more, than with the nearest step: that tells nothing of a factor.
    """
    trace = record.signals[run].readings[id]
    by_step, by_height = (_noise(record, run, id, one) ** 2 for one in (_step(off), off))
    known = math.log(max(flicker(trace) / float(np.ptp(trace)), 1e-12) / WIDTH["gauge-gain"])
    return min(0.0, known) - 0.5 * len(trace) * (by_step - by_height)


def _step(off):
    """The step of a range that is nearest to a factor, both as logarithms."""
    decades = math.log(10.0) * math.floor(off / math.log(10.0))
    return decades + float(min(STEPS, key=lambda one: abs(off - decades - one)))


def _by(record, run, id, log_ratio):
    """The slip that one gauge reads so many times the force in one run."""
    change = partial(ignoring, changes.trace_scaled, run, id, math.exp(-log_ratio))
    # Noise that was not multiplied along is made less, which is no gain.
    less = max(0.0, 1.0 - (NOISE_FACTOR * _noise(record, run, id, log_ratio)) ** 2)
    occam = -0.5 * less * record.signals[run].samples
    return Slip("gauge-gain", change, run, id, value=partial(constant, math.exp(log_ratio)), occam=occam)


def _left_out(record, run, id):
    """The same where the trace is too noisy to be multiplied: it is left out, as if it were noise."""
    change, trace = partial(ignoring, changes.trace_scaled, run, id, 0.0), record.signals[run].readings[id]
    seen = partial(_seen, run, id, trace)
    return Slip("gauge-gain", change, run, id, width=WIDTH["gauge-gain"], seen=seen)


def _noise(record, run, id, log_ratio):
    """Noise of a trace over a ratio, as a share of its gauge's. It stays where a range was changed, and
    with it what the recorder's counts are multiplied by.
    """
    return flicker(record.signals[run].readings[id]) * math.exp(-log_ratio) / heard(record)[id]


def _seen(run, id, trace, model):
    return _times(trace, beside(model)[run][id])


def _times(trace, read):
    """How many times the force a gauge reads, by its trace and by what a model reads."""
    return float(trace @ read) / float(read @ read)


def beside(model: Model) -> Readings:
    """What a fitted model reads at every gauge, whether a run has it or not."""
    experiment, read = model.forward.experiment, raw(model.forward, model.fit)
    return {
        run.id: {g.id: own for g, own in zip(experiment.gauges, readings, strict=True)}
        for run, readings in zip(experiment.runs, read, strict=True)
        if run.has_signals
    }


def rough_gains(findings: Iterable[Finding], model: Model) -> list[Slip]:
    """Gains of single traces that were put right by what heights told, asked for once more beside effects: a
    trace beside what the model reads tells more of it.
    """
    record = model.bench.record
    rough = [f for f in findings if f.corrected and f.fault == "gauge-gain" and not _is_step(f.value)]
    there = [f for f in rough if f.sensor in record.signals[f.run].readings]
    read = beside(model) if there else {}
    again = []
    for one in there:
        times = _times(record.signals[one.run].readings[one.sensor], read[one.run][one.sensor])
        again += [_by(record, one.run, one.sensor, math.log(times))] if times > 0.0 else []
    return again


def _is_step(value):
    return bool(np.isclose(np.exp(_step(math.log(value))), value))


def _heights(record, predicted):
    """(run, gauge) → logarithm of its peak over the model's, of traces that stand out of their noise."""
    found = {}
    for run, own in higher(record, predicted).items():
        read = record.signals[run].readings
        # Noise may have been multiplied along, or not.
        found |= {(run, id): v for id, v in own.items() if np.ptp(read[id]) > CLEAR * flicker(read[id])}
    return found


def _off(heights, left_out):
    """By how much one height is off those of its run and of its gauge, and the most by which another one is:
    a factor of each run times one of each gauge. With none left out, the most of all.
    """
    known = [at for at in heights if at != left_out]
    runs, gauges = ({one: k for k, one in enumerate(sorted({at[side] for at in known}))} for side in (0, 1))

    def row(at):
        own = np.zeros(len(runs) + len(gauges))
        own[[runs[at[0]], len(runs) + gauges[at[1]]]] = 1.0
        return own

    table, values = np.array([row(at) for at in known]), np.array([heights[at] for at in known])
    best = np.linalg.lstsq(table, values, rcond=None)[0]
    left = float(np.abs(values - table @ best).max())
    if left_out is None or left_out[0] not in runs or left_out[1] not in gauges:
        return 0.0, left
    return heights[left_out] - float(row(left_out) @ best), left
