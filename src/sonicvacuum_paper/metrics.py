"""All metrics of one simulated card, each found twice: with the chosen time step and with half of it."""

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from sonicvacuum.blas import one_thread
from sonicvacuum.files import InputError
from sonicvacuum.observe.trace import Measured
from sonicvacuum.simulation import Simulation
from sonicvacuum_paper import contacts, gauges, sweep, trains
from sonicvacuum_paper.one_run import OneRun
from sonicvacuum_paper.rows import Row, absent

Found = dict[tuple[str, str, str], tuple[str, Measured]]
# quantity → unit and function; a function of (run, gauge).
AT_GAUGES = {
    "amplitude": ("N", gauges.amplitude),
    "arrival": ("us", gauges.arrival),
    "duration": ("us", gauges.duration),
    "duration_02": ("us", lambda run, gauge: gauges.duration(run, gauge, 0.02)),
    "duration_05": ("us", lambda run, gauge: gauges.duration(run, gauge, 0.05)),
    "duration_half": ("us", lambda run, gauge: gauges.duration(run, gauge, 0.5)),
    "width": ("diameters", gauges.width),
    "width_02": ("diameters", lambda run, gauge: gauges.width(run, gauge, 0.02)),
    "width_05": ("diameters", lambda run, gauge: gauges.width(run, gauge, 0.05)),
    "width_half": ("diameters", lambda run, gauge: gauges.width(run, gauge, 0.5)),
    "preload_over_amplitude": ("1", gauges.preload_over_amplitude),
    "pulse_count": ("1", trains.pulse_count),
    "pulse_count_05": ("1", trains.pulse_count_05),
    "third_pulse_fraction": ("1", trains.third_pulse_fraction),
    "extra_pulse_fraction": ("1", trains.extra_pulse_fraction),
    "valley_depth": ("1", trains.valley_depth),
    "droop_peak": ("1", gauges.droop_peak),
    "droop_undershoot": ("1", gauges.droop_undershoot),
}
AT_EMBEDDED = {
    "gauge_over_contact": ("1", gauges.gauge_over_contact),
    "offset_amplitude": ("1", gauges.offset_amplitude),
    "shape_deviation": ("1", gauges.shape_deviation),
    "window_over_train": ("1", trains.window_over_train),
}
# Functions of (run, upper gauge, lower gauge).
BETWEEN_GAUGES = {"speed": ("m/s", gauges.speed), "decay": ("1", gauges.decay)}
BETWEEN_EMBEDDED = {
    "extra_pulses_upper_stronger": ("1", trains.extra_pulses_upper_stronger),
    "offset_speed": ("1", gauges.offset_speed),
}
# Functions of the run.
WHOLE = {"speed_change": ("1", gauges.speed_change), "split_distance": ("diameters", trains.split_distance)}
# What is reported of each run of a sweep, whose contacts are kept between its gauges only.
OF_SWEEPS = (
    "amplitude",
    "arrival",
    "duration_half",
    "width_half",
    "preload_over_amplitude",
    "gauge_over_contact",
    "speed",
    "decay",
)
CONTACTS_OF_SWEEPS = ("contact_force", "contact_depth", "strain_rate")


@one_thread
def card_rows(simulation: Simulation) -> list[Row]:
    """The metrics of a card: of each run, and of the sweep where it has several.

    Runs of a sweep are named `card@speed` (m/s); the numerical error is the change on halving the step.

    Raises:
        InputError: for two speeds of a sweep that six digits do not tell apart.
    """
    lanes = len(simulation.speeds)
    names = [
        simulation.card.name if lanes == 1 else f"{simulation.card.name}@{speed:g}"
        for speed in simulation.speeds
    ]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"{name}: striker.speed_m_s holds this speed twice; remove one")
    rows = []
    both = [[OneRun(simulation, lane, refined) for lane in range(lanes)] for refined in (False, True)]
    for name, plain, refined in zip(names, *both, strict=True):
        rows += _rows(_one(plain, name, lanes > 1), _one(refined, name, lanes > 1))
        rows += list(_balance(simulation, name, plain.lane))
    if lanes > 1:
        rows += _rows(*(_sweep(runs, simulation.card.name) for runs in both))
    return [*rows, *_model(simulation)]


def _model(simulation: Simulation) -> Iterator[Row]:
    """What was simulated: modulus of the beads' surface, effects included; number of effects with losses."""
    yield Row(
        simulation.card.name,
        "modulus",
        "",
        float(simulation.chain.first.surface.modulus[0]) / 1e9,
        "GPa",
        0.0,
    )
    yield Row(simulation.card.name, "loss_effects", "", float(_losses(simulation)), "1", 0.0)


def _losses(simulation: Simulation) -> int:
    """Number of effects that take energy."""
    return sum(simulation.catalogue.effect(name).dissipative for name in simulation.card.effects)


def _one(run: OneRun, name: str, brief: bool) -> Found:
    found = {(name, q, s): (unit, value) for q, s, unit, value in _of_gauges(run, brief)}
    for quantity, sensor, unit, value in contacts.entries(run):
        if not brief or quantity in CONTACTS_OF_SWEEPS:
            found[name, quantity, sensor] = unit, value
    return found


def _of_gauges(run: OneRun, brief: bool) -> Iterator[tuple[str, str, str, Measured]]:
    """(quantity, sensor, unit, value); brief: what a sweep reports of each of its runs."""
    for table, groups in (
        (AT_GAUGES, [(g,) for g in run.gauges]),
        (AT_EMBEDDED, [(g,) for g in run.embedded]),
        (BETWEEN_GAUGES, list(pairwise(run.gauges))),
        (BETWEEN_EMBEDDED, list(pairwise(run.embedded))),
        (WHOLE, [()]),
    ):
        for quantity, (unit, function) in table.items():
            if brief and quantity not in OF_SWEEPS:
                continue
            for group in groups:
                yield quantity, "-".join(g.id for g in group), unit, function(run, *group)


def _sweep(runs: list[OneRun], name: str) -> Found:
    return {(name, quantity, ""): ("1", function(runs)) for quantity, function in sweep.OVER_RUNS.items()}


def _rows(plain: Found, refined: Found) -> list[Row]:
    """Values of the plain runs; a value that half the step does not confirm is none."""
    rows = []
    for key, (unit, value) in plain.items():
        other = refined[key][1]
        reason = value.reason or (other.reason and f"with half the time step: {other.reason}")
        if reason or not math.isfinite(value.value):
            rows.append(absent(*key, unit, reason or "not a number"))
        else:
            rows.append(Row(*key, float(value.value), unit, abs(float(other.value - value.value))))
    return rows


def _balance(simulation: Simulation, name: str, lane: int) -> Iterator[Row]:
    """Striker's speed, and the largest drift of energy and momentum in units of what the striker brought."""
    speed, mass = float(simulation.speeds[lane]), simulation.card.striker.mass_kg
    yield Row(name, "striker_speed", "", speed, "m/s", 0.0)
    brought = {"energy_drift": 0.5 * mass * speed**2, "momentum_drift": mass * speed}
    for quantity, balance in (("energy_drift", simulation.energy), ("momentum_drift", simulation.momentum)):
        taken = quantity == "energy_drift" and _losses(simulation) > 0
        if len(balance) == 0 or taken:
            reason = "losses take energy" if taken else "the law keeps no simple balance"
            yield absent(name, quantity, "", "1", reason)
            continue
        drift = np.abs(balance[:, lane] - balance[0, lane]).max() / brought[quantity]
        yield Row(name, quantity, "", float(drift), "1", math.nan)
