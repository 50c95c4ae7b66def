"""Traces that belong elsewhere: to another run, where those of one gauge are exchanged or one was taken for
both runs, or where all runs are in another order than their strikers; or to another gauge of their run, in
all runs or in one.
"""

import itertools
import math
from collections.abc import Collection, Iterator, Mapping
from functools import partial

import numpy as np

from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.faults.slips import Slip, constant, ignoring
from sonicvacuum.discover.faults.timing import arrival, lag
from sonicvacuum.records import Record
from sonicvacuum.records.suspects import copied, twins

# Run → gauge → (T,) readings.
Readings = Mapping[str, Mapping[str, np.ndarray]]
# A gauge's peaks over the model's, beside those of other gauges, differ between runs by as much (in
# logarithms), and by less than this share of it were two of its traces exchanged.
OFF, MENDED = math.log(1.1), 0.5
# Models of peaks that are as near each other do not tell which of two runs a trace belongs to.
APART = math.log(1.05)
# In a run whose cables were exchanged one gauge is as far ahead of the other as it should be behind, within
# this share of it.
REVERSED = 0.5
# Of two gauges with the same trace it is that one's where it comes so many times nearer to when it should.
SOONER = 3.0


def exchanged_traces(record: Record, predicted: Readings) -> list[Slip]:
    """The slips that two traces of one gauge are in each other's run, where their heights beside those of
    other gauges would be right so.

    Args:
        record: as far as it was put right.
        predicted: what the nominal model reads.
    """
    highest, found = higher(record, predicted), []
    alternatives = math.comb(len(highest), 2) * len(record.gauges)
    for gauge in record.gauges:
        id, own, traces = gauge.id, {}, {}
        for run, all_ in highest.items():
            if others := [value for g, value in all_.items() if g != id and id in all_]:
                own[run], traces[run] = all_[id] - float(np.median(others)), record.signals[run]
        before = _spread(own)
        for a, b in itertools.combinations(own, 2) if before > OFF else ():
            # The model's peaks and those of other gauges stay with their runs.
            more = math.log(np.ptp(traces[b].readings[id]) / np.ptp(traces[a].readings[id]))
            after = _spread(own | {a: own[a] + more, b: own[b] - more})
            if after < MENDED * before and _same_times(traces[a], traces[b]):
                change, value = partial(ignoring, changes.traces_swapped, id, a, b), partial(constant, None)
                where = f"{a} and {b}", id, alternatives
                found.append(Slip("runs-swapped", change, *where, value=value, shown=True))
    return found


def exchanged_gauges(record: Record, predicted: Readings) -> list[Slip]:
    """The slips that two gauges are in each other's place in one run, where the pulse comes first to the one
    that it should come to last, as in no other run.
    """
    ahead = {}
    for one, two in itertools.combinations([g.id for g in record.gauges], 2):
        for run, model in predicted.items():
            signals = record.signals[run]
            if one in model and two in model and one in signals.readings and two in signals.readings:
                read, due = (
                    _begins(signals, own[two]) - _begins(signals, own[one])
                    for own in (signals.readings, model)
                )
                ahead[run, one, two] = abs(read + due) < REVERSED * abs(due)
    found = []
    for run, one, two in (at for at, backward in ahead.items() if backward):
        others = [backward for (r, *pair), backward in ahead.items() if r != run and pair == [one, two]]
        if others and not any(others):
            change = partial(ignoring, changes.gauges_swapped_in, run, one, two)
            where, value = (run, (one, two), len(ahead)), partial(constant, None)
            found.append(Slip("gauges-swapped", change, *where, value=value, shown=True))
    return found


def _begins(signals, reading):
    """When a reading first comes to half of its largest, in us: of echoes one may be as high as the pulse."""
    size = np.abs(reading)
    return float(signals.time_us[int(np.argmax(size >= 0.5 * size.max()))])


def other_order(record: Record, predicted: Readings) -> list[Slip]:
    """The slip that runs, three or more, are in another order than their strikers, as where files are counted
    from another one: the striker by which the model's pulses are highest made the highest, and so on.

    Nothing is said where runs that would change places are struck alike.
    """
    runs = [run.id for run in record.block.runs if predicted.get(run.id)]
    highest = higher(record, {run: predicted[run] for run in runs})
    everywhere = set.intersection(*(set(own) for own in highest.values())) if highest else set()
    if not everywhere:
        return []

    def heights(readings):
        return {
            run: float(np.median([math.log(np.ptp(readings[run][g])) for g in everywhere])) for run in runs
        }

    read, model = heights({run: record.signals[run].readings for run in runs}), heights(predicted)
    struck = dict(zip(sorted(runs, key=read.__getitem__), sorted(runs, key=model.__getitem__), strict=True))
    others = {run: other for run, other in struck.items() if run != other}
    apart = [abs(own[a] - own[b]) for own in (read, model) for a, b in itertools.combinations(others, 2)]
    before = _spread({run: read[run] - model[run] for run in runs})
    after = _spread({run: read[run] - model[struck[run]] for run in runs})
    if len(others) < 3 or min(apart) < APART or before < OFF or after > MENDED * before:
        return []
    *first, last = sorted(others, key=runs.index)
    change, where = partial(ignoring, changes.runs_struck, others), f"{', '.join(first)} and {last}"
    count = math.factorial(len(runs))
    return [Slip("runs-swapped", change, where, None, count, value=partial(constant, None), shown=True)]


def _spread(own):
    return max(own.values()) - min(own.values()) if own else 0.0


def _same_times(one, other):
    """Whether two runs were sampled at the same times."""
    return one.samples == other.samples and bool(np.allclose(one.time_us, other.time_us))


def higher(record, predicted, left_out: Collection[tuple[str, str]] = ()):
    """Run → gauge → logarithm of its peak over the model's."""
    found = {}
    for run, model in predicted.items():
        read = record.signals[run].readings
        peaks = {g: (np.ptp(read[g]), np.ptp(m)) for g, m in model.items() if g in read}
        found[run] = {
            g: math.log(own / of)
            for g, (own, of) in peaks.items()
            if own > 0.0 and of > 0.0 and (run, g) not in left_out
        }
    return found


def taken_twice(
    record: Record, predicted: Readings, silent: Collection[tuple[str, str]] = ()
) -> Iterator[tuple[str, str, str, list[str]]]:
    """Traces that two runs share sample by sample, and the run of the two that they do not belong to, as
    their height beside that of all others is farther from the model's.

    Nothing is said of runs struck alike, nor of traces without a pulse, `silent` (run, gauge).

    Yields:
        Run, a later one, that of both in which they are another's, and gauges.
    """
    loud = [
        (a, b, [id for id in ids if not {(a, id), (b, id)} & set(silent)]) for a, b, ids in copied(record)
    ]
    shared = [one for one in loud if one[2]]
    doubtful = {(run, id) for a, b, ids in shared for run in (a, b) for id in ids}
    every, sound = higher(record, predicted), higher(record, predicted, doubtful)
    usual = [value for own in sound.values() for value in own.values()]
    for a, b, ids in shared:
        off = {}
        for run in (a, b):
            near = list(sound.get(run, {}).values()) or usual or [0.0]
            own = [every[run][id] - float(np.median(near)) for id in ids if id in every.get(run, {})]
            off[run] = float(np.median(own)) if own else math.nan
        if abs(off[a] - off[b]) > APART:
            yield a, b, max(off, key=lambda run: abs(off[run])), ids


def read_twice(
    record: Record, predicted: Readings, silent: Collection[tuple[str, str]] = ()
) -> Iterator[tuple[str, str, str]]:
    """Two gauges that share their traces sample by sample, and that of both whose traces do not come when the
    model's do, beside those of all others.

    Nothing is said where both would come as well, or in a part of the runs only, nor of traces without a
    pulse, `silent` (run, gauge).
    """
    for one, two, runs in twins(record):
        if any({(run, one), (run, two)} & set(silent) for run in runs):
            continue
        seen = [run for run in runs if one in predicted.get(run, {}) and two in predicted[run]]
        if len(runs) < len(record.signals) or not seen:
            continue
        off = {
            id: float(np.median([_off(record, run, predicted, id, (one, two)) for run in seen]))
            for id in (one, two)
        }
        right, wrong = sorted((one, two), key=off.__getitem__)
        if off[wrong] > SOONER * max(off[right], 1e6 * record.signals[seen[0]].interval_s):
            yield one, two, wrong


def _off(record, run, predicted, id, doubtful):
    """By how many us a gauge's trace comes when it should not, as far as those beyond doubt tell: they come
    early or late because all do, or because the wave is fast or slow.
    """
    own, time = predicted[run], record.signals[run].time_us
    sound = [g for g in record.signals[run].readings if g not in doubtful and g in own]
    early = lag(record, run, predicted, [id])
    if not sound:
        return abs(early)
    usual = lag(record, run, predicted, sound)
    way = arrival(time, own[id]) / max(float(np.median([arrival(time, own[g]) for g in sound])), 1e-300)
    return min(abs(early - usual), abs(early - usual * way))
