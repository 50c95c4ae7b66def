"""What a model makes of a record: readings at the record's own instants, and the scalars it reports.

The model is the record's nominal chain, with or without effects, under given nuisances (striker speed,
trigger, gains). Recorded time = true time + the run's trigger shift. Scalars are found on noise-free readings
by the functions that measure a simulated case (`observe.quantities`).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from sonicvacuum.effects.base import Setup
from sonicvacuum.forward import Seen, all_measured, passages, see, virtual
from sonicvacuum.observe.trace import Measured
from sonicvacuum.records.assemble import Batch, assemble, duration_of, interval_of
from sonicvacuum.records.record import Record


def nominal(setup: Setup) -> Setup:
    """The model without effects."""
    return setup


@dataclass(frozen=True)
class Conditions:
    """A model and its nuisances; R runs.

    Attributes:
        model: gives the chains and gauges of a batch their effects (parameters that are numbers, not arrays).
        speed_ratio: striker speed over the recorded one, one number or (R,).
        shift_s: trigger shift in s, one number or (R,).
        gain: sensor id → factor on its reading; 1 where not given.
        refine: divides the step of the simulation.
    """

    model: Callable[[Setup], Setup] = nominal
    speed_ratio: ArrayLike = 1.0
    shift_s: ArrayLike = 0.0
    gain: Mapping[str, float] = field(default_factory=dict)
    refine: float = 1.0

    def setup(self, record: Record, batch: Batch) -> Setup:
        """What is simulated and what reads it."""
        ratio = np.broadcast_to(np.asarray(self.speed_ratio, dtype=float), (len(record.runs),))
        chain = batch.chain.struck_at(batch.chain.speed * ratio[list(batch.runs)])
        made = self.model(Setup(chain, record.gauges))
        gauges = tuple(replace(s, gain=s.gain * self.gain.get(s.id, 1.0)) for s in made.sensors)
        return replace(made, sensors=gauges)


@dataclass(frozen=True)
class Prediction:
    """One run as predicted.

    Attributes:
        readings: sensor id → (S,) in the gauge's unit at the record's times; empty for a run without traces.
        observables: one for each observable of the run, SI; NaN with a reason where the model shows none.
    """

    readings: Mapping[str, np.ndarray]
    observables: tuple[Measured, ...]


def predict(record: Record, conditions: Conditions | None = None) -> tuple[Prediction, ...]:
    """Every run of a record under a model, by default the nominal one with the recorded numbers."""
    conditions = conditions or Conditions()
    found: dict[int, Prediction] = {}
    for batch in assemble(record):
        seen = _seen(record, batch, conditions)
        scalars = _numbers(record, batch, seen, conditions)
        for lane, place in enumerate(batch.runs):
            readings = dict(zip((g.id for g in seen.setup.sensors), seen.readings[lane], strict=True))
            at_record = _at_record(record, place, seen.history.time, readings, conditions)
            found[place] = Prediction(at_record, scalars[lane])
    return tuple(found[k] for k in range(len(record.runs)))


def numbers(record: Record, conditions: Conditions | None = None) -> list[tuple[Measured, ...]]:
    """The observables of every run alone, as `predict` has them."""
    conditions, found = conditions or Conditions(), {}
    for batch in assemble(record):
        scalars = _numbers(record, batch, _seen(record, batch, conditions), conditions)
        found.update(zip(batch.runs, scalars, strict=True))
    return [found[k] for k in range(len(record.runs))]


def _numbers(record, batch, seen: Seen, conditions) -> list[tuple[Measured, ...]]:
    """The observables of each run of a batch."""
    diameters = record.specimen.diameters
    shown = passages(seen, slice(None), seen.readings, seen.setup.sensors, diameters, through=True)
    return [
        all_measured(record.runs[place].observables, seen, lane, shown[lane], diameters, conditions.refine)
        for lane, place in enumerate(batch.runs)
    ]


def _seen(record, batch, conditions):
    """The batch's chains, integrated for as long and sampled as finely as its runs ask."""
    runs = [record.runs[k] for k in batch.runs]
    setup = conditions.setup(record, batch)
    return see(
        setup,
        duration_of(record, runs, setup.chain),
        interval_of(runs, setup.chain),
        besides=virtual(record.gauges, record.beads),
        striker=True,
        refine=conditions.refine,
    )


def at_times(
    time_s: np.ndarray, true_time: np.ndarray, values: np.ndarray, shift_s: float = 0.0
) -> np.ndarray:
    """Simulated values at recorded times, by a cubic spline; at rest before the impact.

    Args:
        time_s: (S,) recorded times in s.
        true_time: (T,) times of the simulation in s, from 0.
        values: (T, ...) at those.
        shift_s: recorded less true time.

    Returns:
        (S, ...) values.

    Raises:
        ValueError: when the simulation ends before the last instant.
    """
    from scipy.interpolate import CubicSpline

    wanted = np.asarray(time_s) - shift_s
    room = 1e-9 * true_time[-1]
    if wanted[-1] > true_time[-1] + room:
        raise ValueError(f"the simulation ends at {true_time[-1]:g} s, before {wanted[-1]:g} s")
    result = CubicSpline(true_time, values)(np.minimum(wanted, true_time[-1]))
    result[wanted < 0.0] = 0.0
    return result


def _at_record(record, place, time, readings, conditions):
    signals = record.runs[place].signals
    if signals is None:
        return {}
    shift = float(np.broadcast_to(conditions.shift_s, (len(record.runs),))[place])
    return {s: at_times(signals.time_s, time, r, shift) for s, r in readings.items()}
