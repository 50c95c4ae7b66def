"""Force gauges: which contacts they feel, where they sit, and how their electronics shape the reading.

Daraio & Nesterenko, PRE 73, 026612 (2006) read piezoelectric gauges glued into beads and one at the wall. A
gauge shows the change from rest (the static force has leaked away), limited by its bandwidth (a first-order
low pass) and by the discharge through its resistance (a first-order high pass, "droop"; RC about 1 ms in the
paper), times its gain. Both filters are exact for a force that is linear between samples, and so is their
sequence.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from sonicvacuum.laboratory.bodies import Bodies, to_wall

# Equal time constants are parted by this fraction either way: errors of its square, and of rounding over it.
_EQUAL = 1e-5


@dataclass(frozen=True)
class Sensor:
    """One gauge.

    Attributes:
        id: its name.
        kind: "embedded" (in a bead) or "wall" (behind the last contact).
        bead: the bead that holds an embedded gauge, 1 (the one struck) to `beads`; None at the wall.
        droop_s: RC time of the discharge in s; None: no discharge.
        lowpass_s: time constant of the bandwidth in s; 0: unlimited.
        offset_fraction: ε in (½ + ε) F_before + (½ − ε) F_after, from −½ to ½: an embedded gauge
            off the middle of its bead, ε > 0 towards the striker.
        gain: reading per force.

    The four numbers may be arrays (lanes,): the same gauge on chains that are read side by side.

    Raises:
        ValueError: for a value outside these ranges.
    """

    id: str
    kind: str
    bead: int | None
    droop_s: float | None = None
    lowpass_s: float = 0.0
    offset_fraction: float = 0.0
    gain: float = 1.0

    def __post_init__(self):
        self._check(self.kind in ("embedded", "wall"), "kind", "'embedded' or 'wall'")
        if self.kind == "wall":
            self._check(self.bead is None, "bead", "None for a gauge at the wall")
            self._check(
                np.all(np.equal(self.offset_fraction, 0.0)), "offset_fraction", "0 for a gauge at the wall"
            )
        else:
            self._check(self.bead is not None and self.bead >= 1, "bead", "1 or more for an embedded gauge")
        self._check(
            self.droop_s is None or np.all(np.greater(self.droop_s, 0.0)), "droop_s", "positive, or None"
        )
        self._check(_within(self.lowpass_s, 0.0), "lowpass_s", "0 or positive")
        self._check(np.all(np.abs(self.offset_fraction) <= 0.5), "offset_fraction", "between -0.5 and 0.5")
        self._check(_within(self.gain, np.nextafter(0.0, 1.0)), "gain", "positive")

    def _check(self, good, name, must_be):
        if not good:
            raise ValueError(f"sensor {self.id}: {name} is {getattr(self, name)!r}; it must be {must_be}")


def _within(values, least):
    """Whether all are finite and at least so large."""
    return bool(np.all(np.isfinite(values)) and np.all(np.greater_equal(values, least)))


def contacts_of(sensor: Sensor, beads: int) -> tuple[int, ...]:
    """The contacts that a gauge feels; contact c joins beads c and c + 1, contact `beads` is the wall.

    Raises:
        ValueError: for a gauge in a bead that the chain does not have.
    """
    if sensor.kind == "wall":
        return (beads,)
    if sensor.bead > beads:
        raise ValueError(f"sensor {sensor.id} sits in bead {sensor.bead}; the chain has {beads}")
    return (sensor.bead - 1, sensor.bead)


def contacts_needed(sensors: Iterable[Sensor], beads: int) -> tuple[int, ...]:
    """All contacts that the gauges feel, sorted: what a simulation has to record."""
    return tuple(sorted({contact for sensor in sensors for contact in contacts_of(sensor, beads)}))


def position(sensor: Sensor, beads: int, diameter: Bodies | float) -> float:
    """Distance from the wall in m: an embedded gauge sits at its bead's centre, the wall gauge at 0.

    `diameter` is that of a bead in m, or of each of them.
    """
    if sensor.kind == "wall":
        return 0.0
    contacts_of(sensor, beads)
    return to_wall(diameter, sensor.bead, beads)


def reading(sensor: Sensor, force_of: Mapping[int, np.ndarray], interval_s: float, beads: int) -> np.ndarray:
    """What the gauge shows: change from rest → bandwidth and droop → gain.

    Args:
        sensor: the gauge.
        force_of: for each contact needed, its force in N without the static part, shape (S, ...).
        interval_s: time between samples in s.
        beads: number of beads.

    Returns:
        Reading in N, shape (S, ...). Before the first sample the chain and the gauge are at rest.

    Raises:
        ValueError: when a contact is missing from `force_of`.
    """
    contacts = contacts_of(sensor, beads)
    missing = [c for c in contacts if c not in force_of]
    if missing:
        raise ValueError(f"sensor {sensor.id} needs the force of contact {missing[0]}; it was not recorded")
    if sensor.kind == "wall":
        force = np.asarray(force_of[contacts[0]])
    else:
        before, after = (np.asarray(force_of[c]) for c in contacts)
        force = (0.5 + sensor.offset_fraction) * before + (0.5 - sensor.offset_fraction) * after
    droop_s = math.inf if sensor.droop_s is None else sensor.droop_s
    return sensor.gain * filtered(force, interval_s, sensor.lowpass_s, droop_s)


def filtered(
    signal: ArrayLike, interval_s: float, lowpass_s: ArrayLike = 0.0, droop_s: ArrayLike = math.inf
) -> np.ndarray:
    """Low pass 1/(1 + s b), then high pass s d/(1 + s d), of a signal at rest before its first sample.

    The sequence equals d/(d − b) (H_d − H_b) with H the high pass, by partial fractions: no error from
    treating the low-passed signal as linear between samples. Two equal constants are parted a little about
    their mean. Off values (b = 0, d = ∞) return the signal itself, exactly.

    Args:
        signal: shape (S, ...), linear between samples; a first sample other than 0 is a jump.
        interval_s: time between samples in s.
        lowpass_s: b in s, a number or an array that broadcasts to the trailing shape of `signal`.
        droop_s: d in s, likewise; `inf`: none.
    """
    b, d = np.asarray(lowpass_s, dtype=float), np.asarray(droop_s, dtype=float)
    if np.all(b == 0.0) and np.all(np.isinf(d)):
        return np.array(signal, dtype=float)
    equal, mean = np.abs(d - b) < _EQUAL * b, 0.5 * (b + d)
    short, long = np.where(equal, mean * (1.0 - _EQUAL), b), np.where(equal, mean * (1.0 + _EQUAL), d)
    weight = np.where(equal, d, 1.0) / np.where(equal, long, 1.0) / (1.0 - short / long)
    return weight * (high_passed(signal, interval_s, long) - high_passed(signal, interval_s, short))


def high_passed(signal: ArrayLike, interval_s: float, time_constant_s: ArrayLike) -> np.ndarray:
    """First-order high pass: the exact solution of y' = x' − y/τ for x linear between samples.

    y[n + 1] = E y[n] + (1 − E)/h (x[n + 1] − x[n]), h = interval/τ, E = exp(−h), y[0] = x[0]. The recursion
    is summed by doubling its reach, log2(S) passes over whole arrays. τ = ∞ returns the signal, τ = 0 returns
    zeros. Shapes as in `filtered`.
    """
    signal = np.asarray(signal, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        h = interval_s / np.asarray(time_constant_s, dtype=float)
        weight = -np.expm1(-h) / h
    response = signal.copy()
    response[1:] = weight * np.diff(signal, axis=0)
    reach, decay = 1, np.exp(-h)
    while reach < len(signal) and np.any(decay > 0.0):
        response[reach:] += decay * response[:-reach]
        reach, decay = 2 * reach, decay * decay
    return np.where(h == 0.0, signal, np.where(np.isinf(h), 0.0, response))
