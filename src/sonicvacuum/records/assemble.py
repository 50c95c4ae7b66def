"""From a record to the chains that the stepper integrates: one lane for each run.

Runs whose strikers are alike in shape, size and material share a batch; masses and speeds differ from lane to
lane. The engine takes one striker radius and one striker material for a batch: the name of a material decides
which contacts an effect on that material moves.
"""

import math
from dataclasses import dataclass

from sonicvacuum.physics.assemble import assemble as assembled
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.scales import COUNTING, CROSSINGS, passage_of, sampling_of
from sonicvacuum.records.record import Record, Run

# Simulated beyond the last instant asked for, in standard errors of the trigger: shifts need no new run.
TRIGGER_ROOM = 6.0
# Quantities that need the reflection.
REFLECTED = ("pulse_count", "echo_delay", "echo_ratio")


@dataclass(frozen=True, eq=False)
class Batch:
    """Runs that are integrated together.

    Attributes:
        runs: places in `record.runs`; lane k of the chain is run `runs[k]`.
        chain: the nominal model, without effects.
    """

    runs: tuple[int, ...]
    chain: Chain


def assemble(record: Record) -> tuple[Batch, ...]:
    """The nominal chains of a record in as few batches as its strikers allow, in the order of first runs."""
    groups: dict[tuple, list[int]] = {}
    for k, run in enumerate(record.runs):
        groups.setdefault((run.striker.radius_m, run.striker.surface), []).append(k)
    return tuple(
        Batch(tuple(places), chain_of(record, [record.runs[k] for k in places])) for places in groups.values()
    )


def chain_of(record: Record, runs: list[Run]) -> Chain:
    """The nominal chains of runs whose strikers are alike in shape, size and material, one lane each."""
    return assembled(record.specimen, [run.striker for run in runs])


def duration_of(record: Record, runs: list[Run], chain: Chain) -> float:
    """Time in s to simulate: the runs' traces and room for the trigger, or what their scalars need."""
    ends = [r.signals.time_s[-1] + TRIGGER_ROOM * record.trigger_width_s for r in runs if r.signals]
    if not math.isfinite(record.trigger_sigma_s):
        # Wherever time zero is: what the trace shows begins before the wave has passed the chain.
        spans = [r.signals.time_s[-1] - r.signals.time_s[0] for r in runs if r.signals]
        ends = [max(spans) + passage_of(chain, 1)] if spans else []
    if any(r.observables for r in runs):
        counted = any(o.quantity in REFLECTED for r in runs for o in r.observables)
        ends.append(passage_of(chain, COUNTING if counted else CROSSINGS))
    return max(ends)


def interval_of(runs: list[Run], chain: Chain, coarser: float = 1.0) -> float:
    """Sampling interval in s: the traces' own divided by a whole number, or `sampling_of` without any.

    At most `coarser` times as long as `sampling_of`.
    """
    fine = coarser * sampling_of(chain)
    own = min((r.signals.interval_s for r in runs if r.signals), default=fine)
    return own / max(1, math.ceil(own / fine))
