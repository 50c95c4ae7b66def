"""Pulses of many simulated signals on one time axis, found side by side in compiled code.

What `observe` finds in one signal after the other, to the bit, wherever a signal looks as most simulated ones
do: one main pulse that rises and falls without a break. All others are left to `observe`. Between the chains
of a search, measuring quantities took more time than the chains.
"""

from pathlib import Path
from types import FunctionType

import numpy as np

from sonicvacuum.observe import pulse, trace
from sonicvacuum.observe.pulse import HIGHER, MAIN, PROMINENCE, Pulse
from sonicvacuum.observe.run import Geometry, Run
from sonicvacuum.observe.trace import (
    AHEAD,
    DEGREE,
    TOP,
    cubic,
    grid,
    newton,
    root,
    summit,
    value_at,
)
from sonicvacuum.physics.kernels import Compiled

# Neither reordered nor fused: the same roundings as in Python.
_OPTIONS = {"error_model": "numpy", "nogil": True, "_nrt": False}
# Columns of what is known of each pulse: whether it looks as most do, its highest sample, the one by which it
# has fallen, first and last sample of its top.
_USUAL, _PEAK, _SEEN, _LEFT, _RIGHT = range(5)


def runs_of(
    signals: np.ndarray, time: np.ndarray, geometry: Geometry, goes_on: bool = False, through: bool = False
) -> list[Run]:
    """Simulated runs from their readings (L, S, T), gauges as in the geometry, and times (T,) in s.

    `goes_on`: whether these are the beginnings of longer ones; `through`: see `Run`.
    """
    ids = [sensor.id for sensor in geometry.sensors]
    together = Together(np.asarray(time, dtype=float), signals, ids, goes_on)
    return [
        Run(
            dict(zip(ids, one, strict=True)),
            time,
            geometry,
            together=together,
            lane=lane,
            goes_on=goes_on,
            through=through,
        )
        for lane, one in enumerate(signals)
    ]


class Together:
    """Signals (L, S, T) of L lanes at S gauges and equidistant times (T,) in s; ValueError for other times.

    Where they go on, one has to look closer at what more of them may change.

    Attributes:
        grid: first time and interval in s.
    """

    def __init__(self, time: np.ndarray, signals: np.ndarray, sensors: list[str], goes_on: bool = False):
        self.grid, self._goes_on = grid(time), goes_on
        self._signals = np.ascontiguousarray(signals, dtype=float)
        self._place = {sensor: s for s, sensor in enumerate(sensors)}
        self._found: dict[str, tuple[np.ndarray, ...]] = {}
        self._pulses: dict[str, list[Pulse | None]] = {}
        self._times: dict[tuple[str, float, bool], np.ndarray] = {}

    def __len__(self) -> int:
        """Number of lanes."""
        return len(self._signals)

    def __contains__(self, sensor: str) -> bool:
        """Whether there are signals of a gauge."""
        return sensor in self._place

    def tops(self, sensor: str) -> tuple[np.ndarray, np.ndarray]:
        """(L,) times in s and heights in N of the main pulse at a gauge; NaN where one has to look closer."""
        return self._of(sensor)[1:]

    def pulses(self, sensor: str) -> list[Pulse | None]:
        """Main pulse of each lane at a gauge; None where one has to look closer."""
        if sensor not in self._pulses:
            rows = zip(*(column.tolist() for column in self._of(sensor)), strict=True)
            self._pulses[sensor] = [
                Pulse(time, top, peak, seen, right - left + 1) if usual else None
                for (usual, peak, seen, left, right), time, top in rows
            ]
        return self._pulses[sensor]

    def crossings(self, sensor: str, level: float, rising: bool) -> np.ndarray:
        """(L,) times in s at which each lane's main pulse passes `level` × its peak; NaN where one has to
        look closer.
        """
        key = sensor, level, rising
        if key not in self._times:
            self._times[key] = self._crossings(*key)
        return self._times[key]

    def _of(self, sensor):
        """What is known of each lane's pulse, its time and its height."""
        if sensor not in self._found:
            s, known = self._place[sensor], np.zeros((len(self), 5), dtype=np.int64)
            signals = self._signals[:, s]
            # Of whole rows by NumPy, eight samples at a time; a sum is finite if all forces are.
            largest = np.where(np.isfinite(signals.sum(axis=1)), signals.max(axis=1), 0.0)
            _find_tops(self._signals, s, largest, known)
            time, height = self._summits(s, known)
            if self._goes_on:
                stays = known[:, _RIGHT] < self._signals.shape[2] - AHEAD
                stays &= largest <= HIGHER * height
                time[~stays], height[~stays], known[~stays, _USUAL] = np.nan, np.nan, 0
            self._found[sensor] = known, time, height
        return self._found[sensor]

    def _summits(self, s, known):
        """(L,) times in s and heights in N of pulses whose tops are known."""
        lanes = np.flatnonzero(known[:, _USUAL])
        tops = known[lanes][:, [_LEFT, _RIGHT]]
        coefficients, bounds = np.empty((len(lanes), DEGREE + 1)), np.empty((len(lanes), 3))
        for k, (lane, top, peak) in enumerate(
            zip(lanes.tolist(), tops.tolist(), known[lanes, _PEAK].tolist(), strict=True)
        ):
            coefficients[k], *bounds[k], tops[k, 0], tops[k, 1] = summit(self._signals[lane, s], *top, peak)
        left, right = tops.T
        climbed = np.empty(len(lanes))
        _climb_all(coefficients, bounds, climbed)
        start, interval = self.grid
        time, height = np.full((2, len(self)), np.nan)
        time[lanes] = start + interval * (left + 0.5 * (climbed + 1.0) * (right - left))
        height[lanes] = value_at(coefficients.T, climbed)
        return time, height

    def _crossings(self, sensor, level, rising):
        known, _, height = self._of(sensor)
        # Where there is no pulse, its peak is at sample −1.
        peak = np.where(known[:, _USUAL] > 0, known[:, _PEAK], -1)
        target = np.where(peak < 0, 0.0, level * height)
        places = np.full(len(self), np.nan)
        if 0.0 < level < 1.0:
            _find_crossings(self._signals, self._place[sensor], peak, target, rising, places)
        if self._goes_on:
            places[~(np.ceil(places) < self._signals.shape[2] - AHEAD)] = np.nan
        start, interval = self.grid
        return start + interval * places


def _with(function, **callees):
    """A function and what it calls of `observe`, compiled there: one formula, one place."""
    from numba import njit

    compiled = {name: njit(**_OPTIONS)(callee) for name, callee in callees.items()}
    names = {**function.__globals__, **compiled}
    return FunctionType(function.__code__, names, function.__name__)


def _tops(signals, s, largest, found):
    """As `pulse.main_pulse` of each lane, up to the fit of the top; `largest` is 0 where it has none."""
    samples = signals.shape[2]
    for lane in range(len(signals)):
        force = signals[lane, s]
        if not largest[lane] > 0.0:
            continue
        seen = 0
        while not force[seen] >= MAIN * largest[lane]:
            seen += 1
        peak, highest = seen, force[seen]
        while seen < samples and not force[seen] < highest - PROMINENCE * highest:
            if force[seen] > highest:
                peak, highest = seen, force[seen]
            seen += 1
        if seen == samples or peak == 0:
            continue
        low = highest - TOP * highest
        before, after = peak, peak
        while before >= 0 and not force[before] < low:
            before -= 1
        while after < samples and not force[after] < low:
            after += 1
        left = max(0, peak - max(peak - before - 1, 3))
        right = min(samples - 1, peak + max(after - peak - 1, 3))
        if right - left < DEGREE:
            continue
        found[lane, _PEAK], found[lane, _SEEN] = peak, seen
        found[lane, _LEFT], found[lane, _RIGHT] = left, right
        found[lane, _USUAL] = 1


def _crossings(signals, s, peak, target, rising, places):
    """As `shape.onset` or `shape.ending` of each lane with a peak (−1: none), where the signal only falls."""
    samples, way = signals.shape[2], -1 if rising else 1
    for lane in range(len(signals)):
        force, level, t = signals[lane, s], target[lane], peak[lane]
        if t < 0 or force[t] < level:
            continue
        while 0 <= t + way < samples and force[t] >= level and force[t + way] <= force[t]:
            t += way
        if not force[t] < level:
            continue
        before = t if rising else t - 1
        first = min(max(before - 1, 0), samples - 4)
        c = cubic(
            force[first] - level, force[first + 1] - level, force[first + 2] - level, force[first + 3] - level
        )
        lower = float(before - first)
        places[lane] = first + root(c, lower, lower + 1.0)


def _climb(coefficients, bounds, places):
    """`trace.newton` for the polynomial of each lane; where it starts and its bounds beside it."""
    for k in range(len(places)):
        c, b = coefficients[k], bounds[k]
        # Unpacked by hand: a length that might be wrong is an error of Python's, for which Numba is loaded.
        places[k] = newton((c[0], c[1], c[2], c[3], c[4], c[5], c[6]), b[0], b[1], b[2])


def _made_crossings():
    return _with(_crossings, cubic=cubic, root=_with(root, value_at=trace.value_at)), _OPTIONS


def _made_climb():
    steps = _with(newton, slope_and_curvature=trace.slope_and_curvature)
    return _with(_climb, newton=steps), _OPTIONS


_SOURCES = (Path(__file__), Path(trace.__file__), Path(pulse.__file__))
_find_tops = Compiled(lambda: (_tops, _OPTIONS), "tops", _SOURCES)
_find_crossings = Compiled(_made_crossings, "crossings", _SOURCES)
_climb_all = Compiled(_made_climb, "climb", _SOURCES)
