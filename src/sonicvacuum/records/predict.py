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
from sonicvacuum.gauges import Gauge, Motion, needed, reading
from sonicvacuum.observe.contacts import contact_duration, restitution
from sonicvacuum.observe.quantities import measure_run
from sonicvacuum.observe.run import Geometry
from sonicvacuum.observe.run import Run as Passage
from sonicvacuum.observe.trace import Measured
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.run import History, simulate
from sonicvacuum.records.assemble import Batch, assemble, duration_of, interval_of
from sonicvacuum.records.record import Record
from sonicvacuum.records.solitary import speed_at_amplitude


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
        chain = replace(batch.chain, speed=batch.chain.speed * ratio[list(batch.runs)])
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
        setup = conditions.setup(record, batch)
        history = simulated(record, batch, setup.chain, conditions.refine)
        readings = readings_of(setup.sensors, history, record.beads)
        for lane, place in enumerate(batch.runs):
            mine = {s: r[:, lane] for s, r in readings.items()}
            found[place] = Prediction(
                _at_record(record, place, history.time, mine, conditions),
                _scalars(record, place, setup, history, lane, mine, conditions.refine),
            )
    return tuple(found[k] for k in range(len(record.runs)))


def simulated(record: Record, batch: Batch, chain: Chain, refine: float = 1.0) -> History:
    """The batch's chains, integrated for as long and sampled as finely as its runs ask."""
    runs = [record.runs[k] for k in batch.runs]
    contacts, bodies = needed((*record.gauges, *virtual(record)), record.beads)
    return simulate(
        chain,
        sorted({0, *contacts}),
        duration_of(record, runs, chain),
        interval_of(record, runs, chain),
        bodies=bodies,
        refine=refine,
    )


def readings_of(sensors: tuple[Gauge, ...], motion: Motion, beads: int) -> dict[str, np.ndarray]:
    """Sensor id → (S, lanes) reading at the simulation's times."""
    return {s.id: reading(s, motion, beads) for s in sensors}


def virtual(record: Record) -> tuple[Gauge, ...]:
    """Gauges that only the simulation has, so that it is known when the reflection returns."""
    kinds = {s.kind for s in record.gauges}
    middle = Gauge(id="(middle)", kind="embedded", bead=max(1, record.beads // 2))
    end = Gauge(id="(end)", kind="wall", bead=None)
    if record.beads == 0:
        return ()
    return ((middle,) if "embedded" not in kinds else ()) + ((end,) if "wall" not in kinds else ())


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


def _scalars(record, place, setup, history, lane, readings, refine):
    """The observables of the run that is this lane."""
    chain, force, extra = setup.chain.take([lane]), history.of(0)[:, lane], virtual(record)
    others = {s: r[:, lane] for s, r in readings_of(extra, history, record.beads).items()}
    geometry = Geometry(record.beads, record.specimen.diameters, (*setup.sensors, *extra))
    passage = Passage({**readings, **others}, history.time, geometry)

    def value(o):
        if o.quantity == "restitution":
            striker = (float(n[0]) for n in (chain.striker_mass, chain.speed, chain.gravity))
            return restitution(history.time, force, *striker)
        if o.quantity == "contact_duration":
            return contact_duration(history.time, force)
        if o.quantity == "speed_at_amplitude":
            sensor = geometry.sensor(o.options["sensor"])
            return speed_at_amplitude(record, chain, sensor, o.options["amplitude"], refine)
        return measure_run(o.quantity, passage, **o.options)

    return tuple(value(o) for o in record.runs[place].observables)
