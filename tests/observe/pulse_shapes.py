"""Pulses with known peaks, widths and crossing times, and a run of such pulses in a chain with a wall."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import lambertw

from sonicvacuum.gauges import Gauge
from sonicvacuum.observe.run import Geometry


@dataclass(frozen=True)
class Shape:
    """A pulse that peaks with 1 at 0.

    Attributes:
        force: its values.
        crossings: when it rises and falls through a level.
    """

    force: Callable
    crossings: Callable

    @property
    def half(self) -> float:
        """Its width at half height."""
        rise, fall = self.crossings(0.5)
        return fall - rise


def _both(time):
    return -time, time


def cosine(power):
    """cos^power, zero beyond its first zeros: the long-wave soliton has power 6 in force."""

    def force(t):
        return np.where(np.abs(t) < math.pi / 2, np.cos(np.clip(t, -1.6, 1.6)), 0.0) ** power

    return Shape(force, lambda level: _both(math.acos(level ** (1 / power))))


def _skewed_crossings(level):
    """1 + t = x solves x exp(1 − x) = level^(1/6): the two real branches of Lambert's W."""
    z = -(level ** (1 / 6)) / math.e
    return tuple(float(-lambertw(z, branch).real) - 1.0 for branch in (0, -1))


SHAPES = {
    "sech2": Shape(
        lambda t: np.cosh(np.clip(t, -300, 300)) ** -2.0, lambda level: _both(math.acosh(level**-0.5))
    ),
    "cos4": cosine(4),
    "cos6": cosine(6),
    # (1 + t)⁶ exp(−6 t): falls more slowly than it rises.
    "skewed": Shape(lambda t: (np.maximum(1 + t, 0) * np.exp(-np.clip(t, -1, 100))) ** 6, _skewed_crossings),
}

DIAMETER = 4.86e-3
SPEED = 197.0
BEADS = 21
# Half-height width of a gauge's pulse in diameters, as simulated.
WIDTH = 1.6
_UNIT = WIDTH * DIAMETER / SPEED / cosine(6).half


def pulse(time, arrival, height=1.0):
    """cos⁶ pulse of the chain's width."""
    return height * cosine(6).force((time - arrival) / _UNIT)


def pulse_duration(level):
    """How long `pulse` exceeds a level, in s."""
    rise, fall = cosine(6).crossings(level)
    return (fall - rise) * _UNIT


def gauges(*beads):
    """Geometry of the paper's chain with gauges in some beads (named b13 …) and at the wall."""
    embedded = tuple(Gauge(f"b{bead}", "embedded", bead) for bead in beads)
    return Geometry(BEADS, DIAMETER, (*embedded, Gauge("wall", "wall", None)))


def chain_run(
    geometry, at_wall=5e-4, train=((0.0, 4.8),), reflected=1.0, interval=1e-6, last=9e-4, decay=0.0
):
    """Times and readings of pulses that run to the wall and back at one speed, not changed by each other.

    Args:
        geometry: where the gauges sit.
        at_wall: time in s at which the first pulse meets the wall.
        train: delay in s and height in N of each pulse.
        reflected: height of the reflection over that of the pulse.
        interval, last: of the record, in s.
        decay: loss of height per m.
    """
    time = np.arange(0.0, last, interval)
    readings = {}
    for sensor in geometry.sensors:
        x = geometry.position(sensor.id)
        readings[sensor.id] = sum(
            pulse(time, at_wall + delay - x / SPEED, height * math.exp(decay * x))
            + pulse(time, at_wall + delay + x / SPEED, reflected * height * math.exp(-decay * x))
            for delay, height in train
        )
    return time, readings
