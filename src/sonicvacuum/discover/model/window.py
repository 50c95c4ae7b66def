"""Long or finely sampled traces cut to what the passage of the wave needs, before anything is inferred.

A recorder gives millions of samples; the wave crosses the chain and comes back within some hundred. What lies
far before the pulse or long after its echo says nothing, and samples closer than the pulse's shape needs say
it twice. Records of an ordinary size are left as they are, to the bit.
"""

import math
from dataclasses import replace

import numpy as np
from msgspec import structs

from sonicvacuum.discover.model import horizon
from sonicvacuum.discover.model.noise import as_recorded
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.physics.scales import passage_of
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.assemble import chain_of
from sonicvacuum.records.blocks import SUFFIXES
from sonicvacuum.scope import thin
from sonicvacuum.scope.quiet import Trace, look

# Traces with at most so many samples are taken as they are.
ENOUGH = 2000
# Rest that is kept before the first arrival: pulse widths, samples at least.
BEFORE, LEAST = 15, 200
# Kept after the first arrival: the time in which the wave crosses the chain and comes back, with this room;
# no more pulse widths than this; and so many after the last sample that stands out of the noise.
ROOM, LONGEST, AFTER = 1.2, 150, 10


def fitted(record: Record, catalogue: Catalogue = CATALOGUE) -> tuple[Record, tuple[str, ...]]:
    """The record with long traces cut and thinned, and cut where nothing can be foretold; what was done, one
    line each. The catalogue holds effects that the record says act.
    """
    passing, notes = _passing(record)
    told, more = horizon.predictable(passing, catalogue)
    return as_recorded(told), notes + more


def _passing(record):
    """The record with long traces as the passage needs them, and what was done."""
    long = [run for run in record.runs if run.signals and run.signals.samples > ENOUGH]
    if not long or not record.beads:
        return record, ()
    seen = {run.id: {g: look(v) for g, v in run.signals.readings.items()} for run in long}
    cut = {run.id: _window(record, run, seen[run.id]) for run in long}
    factor = min(_factor(run, seen[run.id], *cut[run.id]) for run in long)
    if len(long) < len(record.signals):
        factor = 1  # gauges have one noise in all runs
    signals = dict(record.signals)
    signals |= {run.id: _less(run.signals, seen[run.id], *cut[run.id], factor) for run in long}
    notes = [_cut_note(run, *cut[run.id]) for run in long if cut[run.id] != (0, run.signals.samples)]
    if factor > 1:
        step = long[0].signals.interval_s * 1e6
        notes.append(
            f"traces thinned by {factor}, from {step:.3g} to {step * factor:.3g} us between samples, behind "
            "a low-pass that leaves the pulse as it is and lasts too long for the first and last few"
        )
    block = _quieter(record.block, thin.noise_left(factor))
    return replace(record, block=block, signals=signals), tuple(notes)


def _window(record, run, seen: dict[str, Trace]) -> tuple[int, int]:
    """First sample to keep and the one after the last; all of them where no pulse is found."""
    samples = run.signals.samples
    found = [t for t in seen.values() if t.arrival is not None]
    if not found:
        return 0, samples
    first, width = min(t.arrival for t in found), max(t.width for t in found)
    passage = math.ceil(ROOM * passage_of(chain_of(record, [run])) / run.signals.interval_s)
    last = max(t.last for t in found)
    end = min(samples, first + passage, first + LONGEST * width, last + AFTER * width)
    return max(0, first - max(BEFORE * width, LEAST)), end


def _factor(run, seen, begin, end):
    """How much the samples of a run may be thinned."""
    if end - begin <= ENOUGH or any(t.clipped for t in seen.values()):
        return 1
    found = {g: t for g, t in seen.items() if t.arrival is not None}
    return thin.factor_for(
        [run.signals.readings[g][begin:end] - t.rest for g, t in found.items()],
        [t.width for t in found.values()],
        [t.arrival - begin for t in found.values()],
    )


def _less(signals: Signals, seen, begin, end, factor) -> Signals:
    left = thin.kept(begin, end, signals.samples, factor)
    readings = {
        g: thin.thinned(_plain(v, seen[g]) if factor > 1 else v, left) for g, v in signals.readings.items()
    }
    return Signals(signals.time_us[left], readings)


def _plain(values, trace):
    """Without single samples far off their neighbours, which a low-pass would smear."""
    values = values.copy()
    for k in trace.spikes:
        values[k] = np.median(values[max(0, k - 2) : k + 3])
    return values


def _cut_note(run, begin, end):
    time = run.signals.time_us
    return (
        f"run {run.id} cut to what the passage needs, {time[begin]:.4g} to {time[end - 1]:.4g} us of "
        f"{time[0]:.4g} to {time[-1]:.4g} us"
    )


def _quieter(block, share: float):
    """The block with the noise of a sample as the low-pass leaves it."""
    if share == 1.0:
        return block
    keys = [f"sigma_{suffix}" for suffix in SUFFIXES]
    sensors = [
        structs.replace(s, **{k: getattr(s, k) * share for k in keys if getattr(s, k)}) for s in block.sensors
    ]
    return structs.replace(block, sensors=sensors)
