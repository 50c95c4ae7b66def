"""What gauges read, lane by lane, and readings between their samples.

The order is that of `observe.sensor`: contacts, bandwidth and droop, gain; here every property of a gauge may
differ from lane to lane.
"""

from collections.abc import Mapping

import numpy as np

from sonicvacuum.discover.experiment import Gauge
from sonicvacuum.observe.sensor import filtered

# Interpolation between samples: polynomials through six neighbours.
POINTS = 6
_OFFSETS = np.arange(POINTS) - (POINTS // 2 - 1)


def contacts_of(gauge: Gauge, beads: int) -> tuple[int, ...]:
    """The contacts that a gauge feels."""
    return (beads,) if gauge.kind == "wall" else (gauge.bead - 1, gauge.bead)


def contacts_needed(gauges: tuple[Gauge, ...], beads: int) -> tuple[int, ...]:
    """All contacts that the gauges feel, sorted."""
    return tuple(sorted({c for g in gauges for c in contacts_of(g, beads)}))


def readings(gauges: tuple[Gauge, ...], force_of: Mapping[int, np.ndarray], interval: float, beads: int):
    """(L, S, T) readings in N of contact forces (T, L), with L lanes."""
    signals = [_reading(g, [force_of[c] for c in contacts_of(g, beads)], interval) for g in gauges]
    return np.ascontiguousarray(np.stack(signals).transpose(2, 0, 1))


def _reading(gauge, forces, interval):
    if len(forces) == 1:
        force = forces[0]
    else:
        before = 0.5 + gauge.offset_fraction
        force = before * forces[0] + (1.0 - before) * forces[1]
    return gauge.gain * filtered(force, interval, gauge.lowpass_s, gauge.droop_s)


def lagrange(fraction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights of `POINTS` neighbours (L, POINTS) at `fraction` of the way to the next sample, and their
    slopes.

    Lagrange polynomials; exact for polynomials of degree 5.
    """
    x = np.asarray(fraction, dtype=float)[:, None]
    weights, slopes = np.empty((len(x), POINTS)), np.empty((len(x), POINTS))
    for k, node in enumerate(_OFFSETS):
        others = np.delete(_OFFSETS, k)
        parts = (x - others) / (node - others)
        weights[:, k] = parts.prod(axis=1)
        slopes[:, k] = sum(
            np.delete(parts, j, axis=1).prod(axis=1) / (node - other) for j, other in enumerate(others)
        )
    return weights, slopes


def shifted(simulated: np.ndarray, interval: float, time: np.ndarray, shift: np.ndarray):
    """Readings at recorded times, and their time derivative.

    Args:
        simulated: (L, S, T') readings, first sample at true time 0, at rest before.
        interval: between simulated samples in s.
        time: (T,) recorded times in s, their interval a multiple of the simulated one.
        shift: (L,) trigger shift in s; recorded time = true time + shift.

    Returns:
        Two (L, S, T) arrays, N and N/s.
    """
    stride = round((time[-1] - time[0]) / (len(time) - 1) / interval)
    place = (time[0] - shift) / interval
    whole = np.floor(place).astype(int)
    weights, slopes = lagrange(place - whole)
    value = np.zeros((*simulated.shape[:2], len(time)))
    rate = np.zeros_like(value)
    for lane, first in enumerate(whole):
        window = _window(simulated[lane], first + _OFFSETS[0], stride * (len(time) - 1) + POINTS)
        for k in range(POINTS):
            part = window[:, k : k + stride * (len(time) - 1) + 1 : stride]
            value[lane] += weights[lane, k] * part
            rate[lane] += slopes[lane, k] * part
    return value, rate / interval


def _window(signal, first, count):
    """`count` samples of (S, T') from `first`, zero before the first one, the last one held after the end."""
    index = np.arange(first, first + count)
    part = signal[:, np.clip(index, 0, signal.shape[1] - 1)]
    part[:, index < 0] = 0.0
    return part
