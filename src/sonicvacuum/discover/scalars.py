"""Observables of a run predicted from simulated readings, lane by lane; found as `records.predict` finds
them.
"""

import numpy as np

from sonicvacuum.discover import gauges
from sonicvacuum.gauges import needed
from sonicvacuum.observe.contacts import contact_duration, restitution
from sonicvacuum.observe.quantities import measure_run
from sonicvacuum.observe.run import Geometry, Run
from sonicvacuum.records.predict import virtual
from sonicvacuum.records.solitary import speed_at_amplitude

# Speeds grow as force to the power 1/6: a larger gain makes a given reading a smaller force.
_SPEED_POWER = -1.0 / 6.0
# Observables of the striker's own contact.
STRIKER = ("restitution", "contact_duration")


def gain_power(scalar, gauge: str) -> float:
    """d log(quantity) / d log(gain of a gauge)."""
    options = scalar.options
    if scalar.quantity == "amplitude":
        return float(options["sensor"] == gauge)
    if scalar.quantity == "decay":
        return float(options["to"] == gauge) - float(options["from"] == gauge)
    if scalar.quantity == "speed_at_amplitude" and options["sensor"] == gauge:
        return _SPEED_POWER
    return 0.0


def contacts_wanted(experiment) -> tuple[int, ...]:
    """Contacts that the scalars need besides those of the gauges."""
    if not any(r.scalars for r in experiment.runs):
        return ()
    extra = virtual(experiment.record)
    return (0, *needed(extra, experiment.beads)[0]) if extra else (0,)


def predict(experiment, run: int, lanes: slice, seen, signals: np.ndarray) -> np.ndarray:
    """(L, n) values of the scalars of a run in SI, 0 where the readings show no such thing.

    Args:
        experiment: the data set.
        run: index of the run.
        lanes: the run's lanes in the simulation.
        seen: the simulation.
        signals: (L, S, T') readings of this run in N.
    """
    wanted = experiment.runs[run].scalars
    if not wanted:
        return np.zeros((len(signals), 0))
    inside = any(s.quantity not in (*STRIKER, "speed_at_amplitude") for s in wanted)
    passages = _passages(experiment, lanes, seen, signals) if inside else [None] * len(signals)
    chosen = np.arange(seen.setup.chain.lanes)[lanes]
    rows = [
        [_value(experiment, one, seen, lane, passage) for one in wanted]
        for lane, passage in zip(chosen, passages, strict=True)
    ]
    return np.nan_to_num(np.array(rows, dtype=float), nan=0.0, posinf=0.0, neginf=0.0)


def _value(experiment, scalar, seen, lane, passage):
    """One scalar of one lane; no number where its motion does not stay finite."""
    try:
        return _measured(experiment, scalar, seen, lane, passage)
    except (FloatingPointError, ValueError):
        return np.nan


def _measured(experiment, scalar, seen, lane, passage):
    history = seen.history
    if scalar.quantity == "contact_duration":
        return contact_duration(history.time, history.of(0)[:, lane]).value
    if scalar.quantity == "restitution":
        chain = seen.setup.chain
        striker = chain.striker_mass[lane], chain.speed[lane], chain.gravity[lane]
        return restitution(history.time, history.of(0)[:, lane], *striker).value
    if scalar.quantity == "speed_at_amplitude":
        gauge = next(g for g in seen.setup.sensors if g.id == scalar.options["sensor"])
        chain = seen.setup.chain.take([lane])
        return speed_at_amplitude(
            experiment.record, chain, gauge.lane(lane), scalar.options["amplitude"]
        ).value
    return measure_run(scalar.quantity, passage, **scalar.options).value


def _passages(experiment, lanes, seen, signals):
    """One run as `observe` measures it for each lane, with the virtual gauges of `records.predict`."""
    extra = virtual(experiment.record)
    history = seen.history
    geometry = Geometry(experiment.beads, experiment.diameter, (*experiment.gauges, *extra))
    ids = [s.id for s in geometry.sensors]
    if extra:
        others = gauges.readings(extra, history.take(lanes), experiment.beads)
        signals = np.concatenate([signals, others], axis=1)
    return [Run(dict(zip(ids, lane, strict=True)), history.time, geometry) for lane in signals]
