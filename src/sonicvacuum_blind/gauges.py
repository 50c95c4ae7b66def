"""What gauges show of an impact, and the scalars read from them.

Change from rest → bandwidth → droop → gauge faults outside the catalogue → gain. Filters are sampled ten
times finer than the record and solved exactly for a force that is linear between samples (first-order
hold).
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import scipy

from sonicvacuum_blind.integrate import TOLERANCE, integrate
from sonicvacuum_blind.laws import static_forces
from sonicvacuum_blind.plan import Plan, problem

FINER = 10
# Motions kept, for effects that change gauges only.
REMEMBERED = 16


def read(plan: Plan, times: np.ndarray, tolerance: float = TOLERANCE) -> np.ndarray:
    """(gauges, samples) readings in N at equidistant true times in s; zero before the impact (time 0)."""
    finer = FINER if any(plan.electronics.get(k) for k in ("lowpass", "inverse_droop")) else 1
    interval = (times[1] - times[0]) / finer
    contacts = sorted({c for g in plan.gauges for c in _weights(plan, g)})
    # Gauges do not act back on the chain: what they are does not matter to how it moves.
    bare = replace(plan, gauges=(), electronics={})
    force = _forces(bare, tuple(contacts), float(times[0]), interval, (len(times) - 1) * finer + 1, tolerance)
    mix = np.zeros((len(plan.gauges), len(contacts)))
    for k, gauge in enumerate(plan.gauges):
        for contact, weight in _weights(plan, gauge).items():
            mix[k, contacts.index(contact)] = weight
    shown = _filtered(mix @ force, interval, plan.electronics)[:, ::finer]
    shown = _faults(shown, times, plan.electronics)
    return shown * np.array([[g.gain] for g in plan.gauges])


def _weights(plan, gauge):
    """contact → its share in what a gauge feels."""
    if gauge.kind == "wall":
        return {plan.beads: 1.0}
    return {gauge.bead - 1: 0.5 + gauge.offset, gauge.bead: 0.5 - gauge.offset}


@lru_cache(maxsize=REMEMBERED)
def _forces(plan, contacts, start, interval, samples, tolerance):
    """(contacts, samples) forces beyond the static ones; zero before the impact."""
    setting, static = _at_rest(replace(plan, speed=1.0))
    times = start + interval * np.arange(samples)
    after = times >= 0.0
    forces = np.zeros((len(contacts), samples))
    found = integrate(setting, times[after], contacts, speed=plan.speed, tolerance=tolerance).force.T
    forces[:, after] = found - static[list(contacts), None]
    return forces


@lru_cache(maxsize=REMEMBERED)
def _at_rest(plan):
    """The chain before any impact and its static forces; the striker's speed does not matter to them."""
    setting = problem(plan)
    return setting, static_forces(setting.rest, setting.rows)


def _filtered(shown, interval, electronics):
    """Readings through an RC low pass and a discharging gauge, exact for forces linear between samples."""
    if lowpass := electronics.get("lowpass", 0.0):
        stay = math.exp(-interval / lowpass)
        mean = -math.expm1(-interval / lowpass) * lowpass / interval
        shown = scipy.signal.lfilter([1.0 - mean, mean - stay], [1.0, -stay], shown, axis=1)
    if rate := electronics.get("inverse_droop", 0.0):
        mean = -math.expm1(-interval * rate) / (interval * rate)
        shown = scipy.signal.lfilter([mean, -mean], [1.0, -math.exp(-interval * rate)], shown, axis=1)
    return shown


def _faults(shown, times, electronics):
    """Faults of gauges that the catalogue does not hold."""
    if bend := electronics.get("bend"):
        shown = shown * (1.0 + bend * shown)
    if limit := electronics.get("inverse_limit"):
        shown = np.tanh(limit * shown) / limit
    if share := electronics.get("lag_share"):
        shown = (1.0 - share) * shown + share * np.stack([_play(y, electronics["play"]) for y in shown])
    if share := electronics.get("crosstalk"):
        shown = shown + share * (shown.sum(axis=0) - shown)
    if drift := electronics.get("drift"):
        shown = shown + drift * np.maximum(times, 0.0)
    return shown


def _play(y, width):
    """Output of a backlash of half width `width`: it follows only when pushed."""
    out, at = np.empty_like(y), 0.0
    for k, value in enumerate(y):
        at = min(max(at, value - width), value + width)
        out[k] = at
    return out


@dataclass(frozen=True)
class Pulse:
    """A main pulse: peak in N and its time in s, and the samples between which it exceeds half of it."""

    force: float
    time: float
    sample: int


def main_pulse(reading: np.ndarray, times: np.ndarray) -> Pulse:
    """The first local maximum above half the trace's largest value, by a parabola through three samples."""
    inner = reading[1:-1]
    peaks = (inner >= reading[:-2]) & (inner > reading[2:]) & (inner > 0.5 * reading.max())
    k = int(np.argmax(peaks)) + 1
    a, b, c = reading[k - 1], reading[k], reading[k + 1]
    bend = a - 2.0 * b + c
    shift = 0.5 * (a - c) / bend if bend < 0.0 else 0.0
    return Pulse(b - 0.25 * (a - c) * shift, times[k] + shift * (times[1] - times[0]), k)


def time_above(reading: np.ndarray, times: np.ndarray, pulse: Pulse, level: float) -> float:
    """Time in s for which the main pulse exceeds level × peak, straight lines between samples."""
    limit = level * pulse.force
    first = pulse.sample - int(np.argmax(reading[pulse.sample :: -1] < limit))
    last = pulse.sample + int(np.argmax(reading[pulse.sample :] < limit))
    interval = times[1] - times[0]
    rise = (limit - reading[first]) / (reading[first + 1] - reading[first])
    fall = (reading[last - 1] - limit) / (reading[last - 1] - reading[last])
    return times[last - 1] + fall * interval - times[first] - rise * interval


def position(plan: Plan, gauge: str) -> float:
    """Distance of a gauge from the wall in m, an embedded one at its bead's centre."""
    g = next(g for g in plan.gauges if g.id == gauge)
    return 0.0 if g.kind == "wall" else (plan.beads - g.bead + 0.5) * 2.0 * plan.bead_radius


def scalar(plan: Plan, readings: np.ndarray, times: np.ndarray, quantity: str, options: dict) -> float:
    """One observable of a run in SI units: speed, amplitude, duration or decay."""
    index = {g.id: k for k, g in enumerate(plan.gauges)}
    pulses = {name: main_pulse(readings[index[name]], times) for name in options.values() if name in index}
    if quantity == "speed":
        a, b = options["from"], options["to"]
        return (position(plan, a) - position(plan, b)) / (pulses[b].time - pulses[a].time)
    if quantity == "decay":
        return pulses[options["to"]].force / pulses[options["from"]].force
    name = options["sensor"]
    if quantity == "amplitude":
        return pulses[name].force
    if quantity == "duration":
        return time_above(readings[index[name]], times, pulses[name], options["level"])
    raise ValueError(f"quantity {quantity!r} is not made here")


def bounce(plan: Plan, tolerance: float = TOLERANCE) -> dict[str, float]:
    """Restitution and contact duration (s) of one ball on the wall."""
    setting = problem(plan)
    span = 8.0 * plan.contact_time
    while True:
        times = np.linspace(0.0, span, 4001)
        motion = integrate(setting, times, [0], states=True, tolerance=tolerance)
        force = motion.force[1:, 0]
        free = np.flatnonzero(force <= 0.0)
        if len(free) or span > 1e3 * plan.contact_time:
            break
        span *= 2.0
    end = int(free[0]) if len(free) else len(force) - 1
    a, b = force[end - 2], force[end - 1]
    # The contact opens where a straight line through the cube roots of squared force ends (a Hertz contact).
    beyond = b ** (2.0 / 3.0) / max(a ** (2.0 / 3.0) - b ** (2.0 / 3.0), 1e-300)
    duration = times[end] + min(1.0, beyond) * (times[1] - times[0])
    return {"restitution": -motion.velocity[end + 1, 0] / plan.speed, "contact_duration": duration}
