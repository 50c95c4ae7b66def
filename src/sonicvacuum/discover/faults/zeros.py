"""Time zeros of all runs that are not known as well as stated, or that of one run alone.

What each run's own time zero explains holds what one late run does: where no more than that run is off, that
one is told, and the others' zeros are as stated.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.faults.judged import Judged, Model
from sonicvacuum.discover.faults.judging import Judge
from sonicvacuum.discover.faults.policy import log_prior
from sonicvacuum.discover.faults.timing import late_run
from sonicvacuum.discover.faults.weights import ALIKE
from sonicvacuum.records import Record


def stated_again(record: Record, given: Record) -> Record | None:
    """A record whose time zeros are known as well as stated once more; None where nothing was changed."""
    before = given.block.trigger_sigma_us
    return None if record.block.trigger_sigma_us == before else changes.triggered(record, before)


def cost(record: Record) -> float:
    """What more χ² time zeros as stated may leave than those of a record that knows them less well: as much
    as a time zero of their own in each run must gain.
    """
    return len(record.signals) * _cost_of_one(record) - 2.0 * log_prior(1)


def _cost_of_one(record):
    interval = max(s.interval_s for s in record.signals.values()) * 1e6
    return 2.0 * math.log(max(record.block.trigger_sigma_us / interval, 1.0))


def simplest(judged: Sequence[Judged]) -> tuple[list[Judged], list[Judged]]:
    """Slips that were fitted, without a time zero of each run's own where another says more: that of one run,
    which explains as much but for what those of the others must gain, or by how much all are off. What was
    put aside for one run.
    """
    own = next((j for j in judged if _of_all(j) and j.slip.value(j.size) is None), None)
    if own is None:
        return list(judged), []
    others = [j for j in judged if j is not own]
    late = max((j.gain for j in others if j.slip.fault == "time-zero" and j.slip.run), default=-math.inf)
    if late > own.gain - _cost_of_others(own.model.bench.record):
        return others, [own]
    far = next((j for j in others if _of_all(j)), None)
    if far is None:
        return list(judged), []
    if far.gain < own.gain - ALIKE:
        return [j for j in judged if j is not far], []
    return [_as_cheap(far, own) if j is far else j for j in others], []


def _of_all(judged):
    return judged.slip.fault == "time-zero" and judged.slip.run is None


def _as_cheap(far, own):
    """Time zeros that are off by some value, which near the stated ones cost what they do without a value."""
    if own.log_bayes < far.log_bayes:
        return far
    return replace(far, slip=replace(far.slip, occam=own.slip.occam), log_bayes=own.log_bayes)


def _cost_of_others(record):
    return max((len(record.signals) - 1) * _cost_of_one(record), ALIKE)


def one_late(judge: Judge, unknown: Model) -> Judged | None:
    """The only run that is late beside effects, the others' time zeros being as stated, where that leaves
    as little as a model in which each run has its own, but for what those of the others must gain.

    Args:
        judge: of the record with all time zeros as stated, beside the same effects.
        unknown: that model.
    """
    forward, record = unknown.forward, judge.model.bench.record
    layout, runs = forward.layout, forward.experiment.runs
    places = [layout.trigger(k) for k, run in enumerate(runs) if run.has_signals]
    if len(places) < 2:
        return None
    off = 1e6 * unknown.fit.nu[places] * forward.nuisance_sigma[places]
    most = int(np.argmax(np.abs(off)))
    ids = [run.id for run in runs if run.has_signals]
    # What the fit adds to true times is taken off the recorded ones.
    slip = late_run(record, ids[most], -float(off[most]))
    (late,) = judge.follow_all([Judged(slip, slip.start, 0.0, 0.0)])
    left = late.model.fit.objective - unknown.fit.objective
    return late if left < _cost_of_others(unknown.bench.record) else None
