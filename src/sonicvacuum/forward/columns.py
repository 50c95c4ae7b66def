"""Quantities of many simulated runs side by side, as arithmetic on whole columns.

What `observe.quantities` says of one run after the other, to the bit, of runs whose pulses look as most do
(`forward.together`): it is a search's inner loop. All others are left to `observe`, and so is whatever is
not asked for so often.
"""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from sonicvacuum.observe.quantities import QUANTITIES
from sonicvacuum.observe.run import Run


class Columns:
    """Quantities of L runs, all that one call of `forward.together.runs_of` made."""

    def __init__(self, runs: Sequence[Run]):
        self._together, self._geometry = runs[0].together, runs[0].geometry
        self._mains: dict[str, tuple[np.ndarray, np.ndarray]] = {}
        self._found: dict[tuple, np.ndarray] = {}

    def of(self, quantity: str, options: Mapping) -> np.ndarray:
        """(L,) values in SI, NaN where one has to look closer: at unusual runs, or at what is asked for."""
        key = quantity, *sorted(options.items())
        if key not in self._found:
            self._found[key] = self._asked(quantity, options)
        return self._found[key]

    def _asked(self, quantity, options):
        if quantity not in _FOUND or not self._as_asked(QUANTITIES[quantity], options):
            return np.full(len(self._together), np.nan)
        named = {"from_" if name == "from" else name: value for name, value in options.items()}
        with np.errstate(divide="ignore", invalid="ignore"):
            return _FOUND[quantity](self, **named)

    def _as_asked(self, entry, options):
        """Whether what is asked for is there; `observe` says what is wrong where it is not."""
        gauges = [options[name] for name in ("from", "to", "sensor") if name in options]
        allowed = set(entry.needs) <= set(options) <= {*entry.needs, *entry.options}
        return allowed and all(sensor in self._together for sensor in gauges)

    def _main(self, sensor):
        """Times and heights of main pulses, NaN where the reflection overlaps them."""
        if sensor not in self._mains:
            time, height = self._together.tops(sensor)
            clear = self._clear(sensor, time)
            self._mains[sensor] = np.where(clear, time, np.nan), np.where(clear, height, np.nan)
        return self._mains[sensor]

    def _clear(self, sensor, time):
        """Whether pulses are known not to be overlapped, as `Run` decides it."""
        geometry, together = self._geometry, self._together
        if geometry.position(sensor) == 0.0:
            return np.isfinite(time)
        if geometry.wall is None:
            return np.isfinite(time) & (not geometry.at_last_bead(sensor))
        return together.tops(geometry.wall)[0] - time > time - together.crossings(sensor, 0.5, rising=True)

    def _amplitude(self, sensor):
        return self._main(sensor)[1]

    def _arrival(self, sensor):
        return self._main(sensor)[0]

    def _speed(self, from_, to):
        apart = self._geometry.position(from_) - self._geometry.position(to)
        travel = self._arrival(to) - self._arrival(from_)
        return np.where(apart * travel > 0.0, apart / travel, np.nan)

    def _decay(self, from_, to):
        return self._amplitude(to) / self._amplitude(from_)

    def _onset(self, sensor, level=0.01):
        return np.where(np.isfinite(self._arrival(sensor)), self._edge(sensor, level, True), np.nan)

    def _duration(self, sensor, level=0.01):
        lasting = self._edge(sensor, level, False) - self._edge(sensor, level, True)
        return np.where(np.isfinite(self._arrival(sensor)), lasting, np.nan)

    def _duration_half(self, sensor):
        return self._duration(sensor, 0.5)

    def _width(self, from_, to, sensor, level=0.01):
        between = self._geometry.diameter_between(from_, to)
        return self._duration(sensor, level) * self._speed(from_, to) / between

    def _width_half(self, from_, to, sensor):
        return self._width(from_, to, sensor, 0.5)

    def _edge(self, sensor, level, rising):
        return self._together.crossings(sensor, level, rising)


def filled(found: np.ndarray, lanes: np.ndarray, closer: Callable[[int], float]) -> np.ndarray:
    """(n,) values of n lanes, NaN taken from `closer`, which looks closer at the lane of that place."""
    found = found.copy()
    for k in np.flatnonzero(np.isnan(found)).tolist():
        found[k] = closer(int(lanes[k]))
    return found


_FOUND = {
    "speed": Columns._speed,
    "amplitude": Columns._amplitude,
    "arrival": Columns._arrival,
    "onset": Columns._onset,
    "duration": Columns._duration,
    "duration_half": Columns._duration_half,
    "width": Columns._width,
    "width_half": Columns._width_half,
    "decay": Columns._decay,
}
