"""Long traces cut where the chain forgets how it was struck.

Waves that run to and fro in a chain that loses nothing meet again and again, and neighbouring impacts part
exponentially: after some passages a striker a hundredth faster has every gauge read something else. What a
model says of such times is no prediction, and parameters fitted to them fit the noise. An ordinary pulse only
grows and comes earlier with the striker's speed; where a reading changes more than both together can make it,
it is not used. Records whose waves have no time to come back often are left as they are, to the bit.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from msgspec import structs

from sonicvacuum.discover.model.accuracy import lasting
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.files import InputError
from sonicvacuum.physics.scales import STRIKER_POWER, WAVE_POWER
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.assemble import chain_of
from sonicvacuum.records.extent import check_extent
from sonicvacuum.records.signals import FEWEST

# Relative change of speeds that slopes are taken with: far above rounding, far below where readings bend.
CHANGE = 1e-5
# A pulse's force goes as v^{6/5}, its speed as v^{1/5}: Hertz contacts, the steepest of common laws.
GROWS = 1.0 / STRIKER_POWER
COMES = GROWS * WAVE_POWER
# So many times what a pulse can change, and with 1 % of the speed so much of the gauge's largest reading,
# tell a chain that has forgotten its striker; pulses of 190 records of two independent
# simulators and of nine foams stay below 1 and 0.2.
BEYOND, OF_PEAK = 2.0, 0.25


def predictable(record: Record, catalogue: Catalogue = CATALOGUE) -> tuple[Record, tuple[str, ...]]:
    """The record with traces cut where its chain can no longer be foretold, and a line on each.

    Args:
        record: a record.
        catalogue: holds effects that the record says act; others that it names count for nothing here.
    """
    lasting = {run.id: run.signals for run in record.runs if run.signals and _lasting(record, run)}
    if not lasting or not _simulated(record):
        return record, ()
    data = experiment(_known(record, catalogue), catalogue)
    here, beside = predicted(data), predicted(_faster(data))
    ends = {
        run.id: horizon(run.time, here[run.id], beside[run.id])
        for run in data.runs
        if run.id in lasting and run.id in here
    }
    cut = {run: (lasting[run], end) for run, end in ends.items() if end is not None}
    if not cut:
        return record, ()
    less = {run: _until(signals, end) for run, (signals, end) in cut.items()}
    notes = tuple(_note(run, signals.time_us, end) for run, (signals, end) in cut.items())
    return replace(record, signals=dict(record.signals) | less), notes


def _simulated(record) -> bool:
    """Whether a search would be let simulate it: one that asks too much is refused, or left as it is."""
    try:
        check_extent(record)
    except InputError:
        return False
    return True


def _known(record, catalogue) -> Record:
    """The record without a word of effects that the catalogue lacks."""
    if not record.block.priors:
        return record
    priors = {name: said for name, said in record.block.priors.items() if name in catalogue}
    return replace(record, block=structs.replace(record.block, priors=priors))


def horizon(
    time_s: np.ndarray, here: Mapping[str, np.ndarray], beside: Mapping[str, np.ndarray]
) -> int | None:
    """First sample of a run that cannot be foretold; None where all can.

    Args:
        time_s: (T,) instants in s after the impact.
        here: gauge → (T,) reading that the model foretells.
        beside: the same of a striker faster by `CHANGE`.
    """
    first = []
    for gauge, reading in here.items():
        peak = float(np.abs(reading).max())
        if peak == 0.0:
            continue
        change = np.abs(beside[gauge] - reading) / (CHANGE * peak)
        steepest = float(np.abs(np.gradient(reading, time_s)).max()) / peak
        pulse = GROWS + COMES * np.maximum(time_s, 0.0) * steepest
        lost = (change > BEYOND * pulse) & (0.01 * change > OF_PEAK)
        if lost.any():
            first.append(int(lost.argmax()))
    end = max(min(first, default=len(time_s)), FEWEST)
    return end if end < len(time_s) else None


def _note(run, time, end):
    return (
        f"run {run} cut at {time[end]:.4g} of {time[-1]:.4g} us: later a striker 1 % faster changes readings "
        f"by {100.0 * OF_PEAK:.0f} % of their peak and more, which no pulse does; waves have run to and fro "
        "so often by then that nothing can be foretold"
    )


def _lasting(record, run) -> bool:
    if not record.beads or run.signals.samples < FEWEST:
        return False
    return lasting(chain_of(record, [run]), float(run.signals.time_s[-1]))


def _faster(data: Experiment) -> Experiment:
    """The data set with strikers faster by `CHANGE`."""
    struck = [replace(b, chain=b.chain.struck_at(b.chain.speed * (1.0 + CHANGE))) for b in data.batches]
    return replace(data, batches=tuple(struck))


def _until(signals: Signals, end: int) -> Signals:
    return Signals(signals.time_us[:end], {g: v[:end] for g, v in signals.readings.items()})
