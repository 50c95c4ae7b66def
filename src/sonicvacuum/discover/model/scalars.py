"""Observables of a run predicted from simulated readings, and what gains and shared errors do to them."""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.model.beginnings import settled
from sonicvacuum.forward import SOLITARY, measured, of_amplitudes
from sonicvacuum.forward.columns import filled
from sonicvacuum.forward.striker import Strikers
from sonicvacuum.observe.contacts import BALL_QUANTITIES
from sonicvacuum.physics.scales import WAVE_POWER

# A ball whose contact has not opened is followed for twice as long, so many times at most: contacts of a
# five thousandth of the stiffness open by then.
DOUBLED = 3
# One that does not open then explains nothing: what it predicts is off by so many impact speeds, or durations
# of the simulation.
OFF = 1e3
# Amplitudes that are all within this of each other (natural log) show no slope of a curve; those of a table
# show one that bends once, from sound to solitary waves.
SPREAD, BENDS = 0.1, 2


def gain_power(scalar, gauge: str) -> float:
    """d log(quantity) / d log(gain of a gauge), of a speed at an amplitude that of a Hertz chain at rest."""
    options = scalar.options
    if scalar.quantity == "amplitude":
        return float(options["sensor"] == gauge)
    if scalar.quantity == "decay":
        return float(options["to"] == gauge) - float(options["from"] == gauge)
    if scalar.quantity == SOLITARY and options["sensor"] == gauge:
        return -WAVE_POWER  # a larger gain makes a given reading a smaller force
    return 0.0


def read(scalars, predicted: np.ndarray, errors) -> np.ndarray:
    """(L, n) predictions as they are compared: with shared errors in them, and no further than a bound.

    Args:
        scalars: the n scalars of a run.
        predicted: (L, n) values in SI.
        errors: source → (L,) how large the error of that source is, in its standard errors.
    """
    values = predicted.copy()
    for k, one in enumerate(scalars):
        for source, size in one.shared.items():
            values[:, k] *= np.exp(size * errors.get(source, 0.0))
        if one.bound:
            nearest = np.maximum if one.bound == "at_most" else np.minimum
            values[:, k] = nearest(values[:, k], one.value)
    return values


def held(scalars, values: np.ndarray) -> np.ndarray:
    """(L, n) whether a bound holds, of values over their standard errors: there nothing moves them."""
    at = np.array([one.value / one.sigma if one.bound else np.nan for one in scalars])
    return values == at


def gain_columns(experiment, run: int, value: np.ndarray) -> np.ndarray:
    """(L, S, M) change of the data of a run, (L, M) over their noise, with the logarithm of each gauge's
    gain.
    """
    data, gauges = experiment.runs[run], experiment.gauges
    samples = len(data.time)
    columns = np.zeros((len(value), len(gauges), value.shape[1]))
    for s in range(len(gauges)):
        columns[:, s, s * samples : (s + 1) * samples] = value[:, s * samples : (s + 1) * samples]
        for k, one in enumerate(data.scalars):
            at = len(gauges) * samples + k
            columns[:, s, at] = value[:, at] * gain_power(one, gauges[s].id)
        _along_tables(columns[:, s], value, data.scalars, gauges[s].id)
    if data.scalars:
        own = slice(len(gauges) * samples, None)
        columns[:, :, own] *= ~held(data.scalars, value[:, own])[:, None]
    return columns


def _along_tables(columns, value, scalars, gauge):
    """Slopes (L, M) to a gauge's gain of its speeds at amplitudes, from the curve that these are: it is flat
    under a static force, and steeper where contacts stiffen.
    """
    places = [
        k for k, one in enumerate(scalars) if one.quantity == SOLITARY and one.options["sensor"] == gauge
    ]
    force = np.log([scalars[k].options["amplitude"] for k in places])
    if len(places) < 2 or np.ptp(force) < SPREAD:
        return
    at = value.shape[1] - len(scalars) + np.array(places)
    shown = value[:, at] > 0.0
    sigma = np.array([scalars[k].sigma for k in places])
    speed = np.log(np.where(shown, value[:, at], 1.0) * sigma)
    bends = min(BENDS, len(np.unique(force)) - 1)
    curve = np.polynomial.polynomial.polyfit(force - force.mean(), speed.T, bends)
    power = np.polynomial.polynomial.polyval(force - force.mean(), np.polynomial.polynomial.polyder(curve))
    told = shown.all(axis=1)[:, None] & np.isfinite(power)
    columns[:, at] = np.where(told, -value[:, at] * power, columns[:, at])


def shared_column(experiment, run: int, value: np.ndarray, source: str) -> np.ndarray:
    """(L, M) change of the data of a run, (L, M) over their noise, with an error that its scalars share."""
    wanted = experiment.runs[run].scalars
    columns = np.zeros_like(value)
    if wanted:
        sizes = np.array([one.shared.get(source, 0.0) for one in wanted])
        own = value[:, -len(wanted) :]
        columns[:, -len(wanted) :] = np.where(held(wanted, own), 0.0, own * sizes)
    return columns


def of_batch(experiment, layout, batch, seen, gain, nu, again, refine: float = 1.0) -> list[np.ndarray]:
    """For each run of a batch (L, n) observables as they are compared.

    Args:
        experiment: the data set.
        layout: of its nuisances.
        batch: what was simulated, its R runs for each of L lanes.
        seen: the simulation.
        gain: (L, S) of the gauges.
        nu: (L, q) nuisances over their standard errors.
        again: as `beginnings.settled` takes it.
        refine: divides the step of further simulations.
    """
    wanted = [experiment.runs[run].scalars for run in batch.runs]
    if not any(wanted):
        return [np.zeros((len(nu), 0))] * len(wanted)
    errors = {layout.named(p): nu[:, p] for p in layout.other("shared")}
    each = np.repeat(gain, len(wanted), axis=0)
    values = settled(experiment, batch, seen, each, again)
    predicted = predict(experiment, wanted, seen, values, each, refine)
    if not experiment.beads and any(np.isnan(own).any() for own in predicted):
        predicted = _opened(wanted, predicted, seen, again, batch.duration)
    return [read(scalars, own, errors) for scalars, own in zip(wanted, predicted, strict=True)]


def predict(
    experiment, wanted, seen, values: np.ndarray, gain: np.ndarray, refine: float = 1.0
) -> list[np.ndarray]:
    """For each of R runs (L, n) values of its scalars in SI, 0 where the readings show no such thing; NaN of
    one ball whose contact has not opened, as 0 would be a ball that stops dead.

    Args:
        experiment: the data set.
        wanted: the n scalars of each run.
        seen: the simulation, R runs for each of L lanes.
        values: (L R, n') what gauges in the chain tell.
        gain: (L R, S) of the gauges.
        refine: divides the step of further simulations.
    """
    of_ball = any(one.quantity in BALL_QUANTITIES for scalars in wanted for one in scalars)
    strikers = Strikers(seen.history, seen.setup.chain) if of_ball else None
    found = []
    for k, scalars in enumerate(wanted):
        lanes = np.arange(k, len(values), len(wanted))
        own = values[lanes, : len(scalars)]
        solitary = [n for n, one in enumerate(scalars) if one.quantity == SOLITARY]
        if solitary:
            waves, gauged = [scalars[n] for n in solitary], _with_gains(seen, gain)
            own[:, solitary] = _solitary(experiment, waves, gauged, lanes, refine)
        for n, one in enumerate(scalars):
            if one.quantity in BALL_QUANTITIES:
                own[:, n] = _of_striker(experiment, one, seen, lanes, strikers, refine)
        found.append(np.nan_to_num(own, nan=0.0 if experiment.beads else np.nan, posinf=0.0, neginf=0.0))
    return found


def _opened(wanted, predicted, seen, again, duration):
    """The same with balls followed until their contacts open, whatever meets them later, and far from any
    data where they do not.
    """
    chains = np.arange(len(wanted) * len(predicted[0]))
    for turn in range(DOUBLED + 1):
        seen = again(chains, duration * 2.0**turn) if turn else seen
        strikers = Strikers(seen.history, seen.setup.chain)
        chains = chains[_rebounds(wanted, predicted, strikers, chains) & ~strikers.rests]
        if not len(chains):
            break
    for scalars, own in zip(wanted, predicted, strict=True):
        for n, one in enumerate(scalars):
            own[np.isnan(own[:, n]), n] = _never(one, duration)
    return predicted


def _rebounds(wanted, predicted, strikers, chains):
    """(n,) which of n chains, one after the other, have a number that is open still; others are filled in."""
    lane, run = np.divmod(chains, len(wanted))
    late = np.zeros(len(chains), dtype=bool)
    for k, scalars in enumerate(wanted):
        here = np.flatnonzero(run == k)
        for n, one in enumerate(scalars):
            told = strikers.rebound if one.quantity == "restitution" else strikers.contact_duration
            own = predicted[k][lane[here], n]
            own = np.where(np.isnan(own), told[here], own)
            predicted[k][lane[here], n] = own
            late[here] |= np.isnan(own)
    return late


def _never(scalar, duration):
    """What counts as predicted of a contact that does not open, on the side that a bound does not forgive."""
    off = OFF * (duration if scalar.quantity == "contact_duration" else 1.0)
    return scalar.value - off if scalar.bound == "at_least" else scalar.value + off


def _with_gains(seen, gain):
    """The simulation as its gauges have these gains (C, S): an amplitude that they read is another force."""
    sensors = (replace(g, gain=g.gain * gain[:, s]) for s, g in enumerate(seen.setup.sensors))
    return replace(seen, setup=replace(seen.setup, sensors=tuple(sensors)))


def _solitary(experiment, scalars, seen, lanes, refine):
    """(L, n) speeds of waves of n amplitudes in the chains of some lanes."""
    try:
        found = of_amplitudes(scalars, seen, lanes, experiment.diameter, refine)
        return np.array([[one.value for one in column] for column in found]).T
    except ValueError:  # of which lane, is found one by one
        return np.array([[_value(experiment, one, seen, lane, refine) for one in scalars] for lane in lanes])


def _of_striker(experiment, scalar, seen, lanes, strikers, refine):
    """A number of some lanes that the striker's motion tells."""

    def closer(lane):
        return _value(experiment, scalar, seen, lane, refine)

    try:
        found = getattr(strikers, scalar.quantity)[lanes]
    except ValueError:
        return [closer(lane) for lane in lanes.tolist()]
    return filled(found, lanes, closer)


def _value(experiment, scalar, seen, lane, refine):
    """One scalar of one lane; no number where its motion does not stay finite."""
    try:
        return measured(scalar, seen, lane, None, experiment.diameter, refine).value
    except (FloatingPointError, ValueError):
        return np.nan
