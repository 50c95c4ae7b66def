"""Numbers of runs without traces, from no more of a simulation than settles them.

Where no trace is compared, a simulation lasts as long as the slowest conceivable chain may need
(`records.assemble.duration_of`), several times as long as most do. Chains are simulated for as long as
nominal ones need, with room; those in which a number may still change are simulated again, for `LONGER`
times as long, until all are settled or the whole duration has passed.
"""

import math
from bisect import bisect_left
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from sonicvacuum.discover.model.experiment import Batch, Experiment, Scalar
from sonicvacuum.forward import SOLITARY, Seen, measured, passages
from sonicvacuum.forward.columns import Columns, filled
from sonicvacuum.observe.contacts import BALL_QUANTITIES
from sonicvacuum.observe.trace import Unsettled

# Times as long as nominal chains need; a beginning is worth it where the whole lasts so many times longer.
ROOM, WORTH = 1.3, 1.25
LONGER = 2.0
# A signal has so many samples at least.
_FEWEST = 5


def begun(data: Experiment) -> Experiment:
    """The data set with what settles the numbers of its batches without traces."""
    from sonicvacuum.discover.model.forward import Forward

    forward = Forward(data)
    return replace(data, batches=tuple(replace(b, settled_s=_settled(forward, b)) for b in data.batches))


def _settled(forward, batch: Batch) -> float:
    """Time in s to simulate at first; infinite where that is the whole."""
    data = forward.experiment
    wanted = [data.runs[run].scalars for run in batch.runs]
    if any(data.runs[run].has_signals for run in batch.runs) or any(map(_of_the_end, wanted)):
        return math.inf
    seen = forward.simulate(batch, forward.nominal(batch, np.zeros((1, forward.layout.size))))

    def settled(samples):
        beginning = replace(seen, history=seen.history.until(samples), readings=seen.readings[..., :samples])
        return not inside(data, wanted, np.arange(len(wanted)), beginning, beginning.readings, True)[1].any()

    whole = len(seen.history.time)
    if not np.isfinite(seen.readings).all() or not settled(whole):
        return math.inf
    needed = ROOM * batch.interval * (_FEWEST + bisect_left(range(_FEWEST, whole), True, key=settled))
    return needed if WORTH * needed < batch.duration else math.inf


def _of_the_end(scalars):
    """Whether one of the numbers is the striker's, which every later impact may change."""
    return any(one.quantity in BALL_QUANTITIES for one in scalars)


def is_inside(scalar: Scalar) -> bool:
    """Whether a scalar is measured on readings of gauges in the chain."""
    return scalar.quantity not in (*BALL_QUANTITIES, SOLITARY)


def inside(
    experiment: Experiment,
    wanted: Sequence[Sequence[Scalar]],
    run: np.ndarray,
    seen: Seen,
    signals: np.ndarray,
    goes_on: bool,
) -> tuple[np.ndarray, np.ndarray]:
    """What gauges in the chain tell of C chains.

    Args:
        experiment: the data set.
        wanted: the n scalars of each of R runs.
        run: (C,) of which of these each chain is.
        seen: the simulation.
        signals: (C, S, T) readings.
        goes_on: whether these are the beginnings of longer ones.

    Returns:
        (C, n) values in SI, n the most of any run, NaN where there is none; (C,) whether more of the readings
        may change one of them.
    """
    values = np.full((len(run), max(map(len, wanted))), np.nan)
    unsettled = np.zeros(len(run), dtype=bool)
    if not any(is_inside(one) for scalars in wanted for one in scalars):
        return values, unsettled
    shown = passages(seen, slice(None), signals, experiment.gauges, experiment.diameter, goes_on, True)
    columns = Columns(shown)

    def closer(one):
        def value(lane):
            try:
                return measured(one, seen, lane, shown[lane], experiment.diameter).value
            except Unsettled:
                unsettled[lane] = True
            except (FloatingPointError, ValueError):
                pass  # a motion that does not stay finite has no number
            return np.nan

        return value

    for k, scalars in enumerate(wanted):
        lanes = np.flatnonzero(run == k)
        for n, one in enumerate(scalars):
            if is_inside(one):
                found = columns.of(one.quantity, one.options)[lanes]
                values[lanes, n] = filled(found, lanes, closer(one))
    return values, unsettled


def settled(
    experiment: Experiment,
    batch: Batch,
    seen: Seen,
    gain: np.ndarray,
    again: Callable[[np.ndarray, float], Seen],
) -> np.ndarray:
    """(C, n) what gauges in the chains of a batch tell, as `inside` has it, settled.

    Args:
        experiment: the data set.
        batch: what was simulated, for as long as it says at first.
        seen: the simulation, lane-major, run-minor.
        gain: (C, S) of the gauges in each chain.
        again: simulates chains of some lanes for so many seconds.
    """
    wanted = [experiment.runs[run].scalars for run in batch.runs]
    run = np.arange(len(gain)) % len(wanted)
    values = np.empty((len(gain), max(map(len, wanted))))
    lanes, duration = np.arange(len(gain)), batch.first_s
    while True:
        signals, goes_on = seen.readings * gain[lanes][..., None], duration < batch.duration
        values[lanes], unsettled = inside(experiment, wanted, run[lanes], seen, signals, goes_on)
        lanes = lanes[unsettled]
        if not len(lanes):
            return values
        duration = min(LONGER * duration, batch.duration)
        seen = again(lanes, duration)
