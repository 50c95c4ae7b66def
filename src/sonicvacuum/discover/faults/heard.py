"""Noise of one sample of each gauge, as slips are told by: the stated one, or what is heard where none is.

A record may leave its noise out. What nobody stated is no 0, beside which every sample would stand out, and
is worked out of the record as it is at the moment, so that it is right beside every slip that is tried.
"""

from statistics import median_low

import numpy as np

from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.model.noise import MODEL_FLOOR, noise, rounding
from sonicvacuum.records import Record

# Noise of a gauge whose traces are all at rest, so that it is a noise all the same.
LEAST = 1e-12
# Parts of a trace, most of which hold no pulse.
PARTS = 11


def heard(record: Record) -> dict[str, float]:
    """Gauge → noise of one sample, in its unit: what samples flicker by, where none is stated.

    Levels, drifts and hum, which are yet to be put right, hardly show in it; of several traces the middle one
    counts, as one of them may have been recorded in another range.
    """
    return {g.id: g.sigma or _flickering(record, g.id) for g in record.gauges}


def at_rest(record: Record, bare: bool = False) -> dict[str, float]:
    """The same with all that the quiet stretches show, as the search has it: neighbours may be alike, so that
    they flicker by less than a gauge without a pulse swings. `bare`: beside the level and the drift of each
    stretch, which are yet to be taken off.
    """
    if all(g.sigma for g in record.gauges):
        return heard(record)
    if bare:
        found = noise((changes.looser(record, {g.id: {"baseline": 1.0} for g in record.gauges}),))[0]
    else:
        found = noise((record,))[0]
    return {g.id: g.sigma or float(own) for g, own in zip(record.gauges, found, strict=True)}


def _flickering(record, id):
    read = [s.readings[id] for s in record.signals.values() if id in s.readings]
    # A trace that never moves says nothing of noise.
    found = [_of_trace(trace) for trace in read if np.ptp(trace) > 0.0]
    return max(median_low(found), LEAST) if found else LEAST


def _of_trace(trace):
    return max(_flicker(trace), rounding(trace), MODEL_FLOOR * float(np.abs(trace).max()))


def _flicker(trace):
    """Noise of a sample from third differences, as `noise.flicker` has it, of whose medians few steps of a
    recorder make one of few values: means of squares do not jump, and the middle one of several parts of a
    trace has no pulse in it.
    """
    parts = [part for part in np.array_split(np.diff(trace, 3), PARTS) if len(part)]
    return float(np.sqrt(np.median([part @ part / len(part) for part in parts]) / 20.0)) if parts else 0.0
