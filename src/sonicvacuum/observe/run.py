"""The readings of one run together with where its gauges sit: pulses found once, shared by all quantities.

A gauge near the wall sees the incident pulse and its reflection. Two rules keep the reflection out:

* A gauge whose peak does not lead the wall's by more than its own rise (from half height to the peak) shows
  the reflection on top of the incident pulse: it is *overlapped*, and gives no main pulse. So does, without a
  wall gauge, the last bead. In simulated chains every gauge 1.5 diameters from the wall or further is clear
  of it, unless damping or preload draws the pulse out.
* Pulses are counted until `SAFETY` of the time that the main pulse needs to the wall and back.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from sonicvacuum.gauges import Gauge, position
from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.observe.pulse import Pulse, highest, main_pulse
from sonicvacuum.observe.shape import ending, onset
from sonicvacuum.observe.trace import Measured, Trace, grid, missing

# The reflection's front comes before its peak; 8.5 diameters from the wall, 0.9 leaves it 1.7 diameters.
SAFETY = 0.9


@dataclass(frozen=True)
class Geometry:
    """Where the gauges of a chain sit.

    Attributes:
        beads: number of beads.
        diameter_m: outer diameter of a bead in m, or of each of them.
        sensors: the gauges.

    Raises:
        ValueError: for two gauges of one name, a gauge outside the chain, or a diameter that is not positive.
    """

    beads: int
    diameter_m: Bodies | float
    sensors: tuple[Gauge, ...]

    def __post_init__(self):
        for diameter in self._diameters.kinds:
            if not diameter > 0.0:
                raise ValueError(f"diameter_m is {diameter}; it must be positive")
        ids = [s.id for s in self.sensors]
        for sensor in self.sensors:
            if ids.count(sensor.id) > 1:
                raise ValueError(
                    f"sensor {sensor.id} is given {ids.count(sensor.id)} times; names must differ"
                )
        _ = self._positions

    @cached_property
    def _positions(self):
        """Gauge → distance from the wall in m; ValueError for one outside the chain."""
        return {s.id: position(s, self.beads, self.diameter_m) for s in self.sensors}

    @property
    def _diameters(self):
        return self.diameter_m if isinstance(self.diameter_m, Bodies) else Bodies((self.diameter_m,))

    def sensor(self, id: str) -> Gauge:
        """The gauge of this name; ValueError when there is none."""
        for sensor in self.sensors:
            if sensor.id == id:
                return sensor
        raise ValueError(f"sensor {id!r} is not one of {', '.join(s.id for s in self.sensors) or 'none'}")

    def position(self, id: str) -> float:
        """Distance of a gauge from the wall in m."""
        return self._positions[self.sensor(id).id]

    @property
    def length(self) -> float:
        """Length of the chain in m."""
        counts = self._diameters.counts(1, self.beads)
        return sum(n * self._diameters.kinds[kind] for kind, n in sorted(counts.items()))

    def diameter_between(self, one: str, other: str) -> float:
        """Mean diameter in m of the beads between two gauges, each gauge's own bead counting half."""
        if self._diameters.uniform:
            return self._diameters.kinds[0]
        beads = [self.beads + 0.5 if s.bead is None else s.bead for s in map(self.sensor, (one, other))]
        return abs(self.position(one) - self.position(other)) / abs(beads[0] - beads[1])

    def at_last_bead(self, id: str) -> bool:
        """Whether a gauge sits no further from the wall than the last bead reaches."""
        return self.position(id) < self._diameters[max(1, self.beads)]

    @property
    def wall(self) -> str | None:
        """Name of the first gauge at the wall, None where there is none."""
        return next((s.id for s in self.sensors if s.kind == "wall"), None)


class Together(Protocol):
    """Pulses of many runs, found side by side; None or NaN where one has to look closer, see
    `forward.together`.
    """

    grid: tuple[float, float]

    def pulses(self, sensor: str) -> list[Pulse | None]:
        """Main pulse of each run at a gauge."""

    def crossings(self, sensor: str, level: float, rising: bool) -> np.ndarray:
        """(runs,) time in s at which the main pulse of each run passes `level` × its peak."""


@dataclass(frozen=True, eq=False)
class Run:
    """One run.

    Attributes:
        readings: for each gauge, (S,) readings in N.
        time: (S,) equidistant times in s.
        geometry: where the gauges sit.
        noise: standard deviation of one sample in N, one number or one for each gauge.
        floor: force in N that a main pulse must exceed.
        accept_overlap: take the first peak of an overlapped gauge as it is.
        safety: fraction of the way to the wall and back after which pulses no longer count.
        together: the same readings with those of further runs, for a run without noise and floor.
        lane: place of this run there.
        goes_on: whether the readings are the beginning of longer ones.
        through: follow pulses through others that begin before the force has fallen to a level, for how long
            they last, see `shape`.

    Raises:
        ValueError: for times that are not equidistant; for a malformed reading, when it is used.
        Unsettled: when what is asked for may change as the readings go on.
    """

    readings: Mapping[str, np.ndarray]
    time: np.ndarray
    geometry: Geometry
    noise: float | Mapping[str, float] = 0.0
    floor: float = 0.0
    accept_overlap: bool = False
    safety: float = SAFETY
    together: Together | None = None
    lane: int = 0
    goes_on: bool = False
    through: bool = False
    _grid: tuple[float, float] = field(init=False, repr=False)
    _known: dict = field(init=False, repr=False, default_factory=dict)

    def __post_init__(self):
        time = np.asarray(self.time, dtype=float)
        if time.ndim != 1:
            raise ValueError(f"time has shape {time.shape}; it must be (S,)")
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "_grid", self.together.grid if self.together else grid(time))

    def trace(self, sensor: str) -> Trace:
        """The checked signal of a gauge."""
        return self._once("trace", sensor, self._trace)

    def first(self, sensor: str) -> Pulse:
        """The main pulse of a gauge, whether or not the reflection overlaps it."""
        return self._once("first", sensor, self._first)

    def main(self, sensor: str) -> Pulse:
        """The main pulse of a gauge; none where the reflection overlaps it (unless that is accepted)."""
        return self._once("main", sensor, self._main)

    def edge(self, sensor: str, level: float, rising: bool, through: bool = False) -> Measured:
        """Time in s at which the pulse of `first` rises or falls through `level` × its peak."""
        asked = level, rising, through
        return self._once(asked, sensor, lambda sensor: self._edge(sensor, *asked))

    def reflection_time(self, sensor: str) -> Measured:
        """Time in s at which the reflection of the main pulse peaks at a gauge.

        From the main pulse's arrivals at the gauge (t) and at the wall (t_w), at one speed both ways:
        t_w + (t_w − t). Without the wall's arrival, t_w − t is the distance over the speed from another
        gauge. At the wall itself the pulse comes back from the top: twice the chain's length over that speed.
        """
        return self._once("reflection", sensor, self._reflection)

    def echo(self, sensor: str) -> Pulse:
        """The pulse that the wall sends back, as a gauge inside the chain sees it after the incident one.

        It is the highest peak from `SAFETY` of the way to the time at which it is expected until as much of
        the way to the top and back. Forces come back as they went, motions with the other sign
        (`gauges.Kind.echo`); the pulse has the height of the incident one's sign.
        """
        return self._once("echo", sensor, self._echo)

    def free_until(self, sensor: str) -> float:
        """Time in s until which pulses count: `safety` of the way to the reflection, or no end if unknown."""
        back = self.reflection_time(sensor)
        start = self.main(sensor).time
        return start + self.safety * (back.value - start) if back.known else math.inf

    def _echo(self, sensor):
        main, back = self.main(sensor), self.reflection_time(sensor)
        here = self.geometry.position(sensor)
        if here == 0.0:
            return Pulse(math.nan, math.nan, reason="overlapped: at the wall the two are one pulse")
        if not back.known:
            return Pulse(math.nan, math.nan, reason=back.reason)
        above = self.geometry.length - here
        way = back.value - main.time
        end = back.value + self.safety * max(way * above / here, 0.5 * way)
        trace = self.trace(sensor)
        seen = replace(trace, force=self.geometry.sensor(sensor).what.echo * trace.force)
        return highest(seen, main, self.free_until(sensor), end)

    def _once(self, what, sensor, find):
        key = (what, sensor)
        if key not in self._known:
            self._known[key] = find(sensor)
        return self._known[key]

    def _trace(self, sensor):
        self.geometry.sensor(sensor)
        if sensor not in self.readings:
            raise ValueError(
                f"sensor {sensor} has no reading; there are {', '.join(self.readings) or 'none'}"
            )
        force = np.asarray(self.readings[sensor], dtype=float)
        if force.shape != self.time.shape:
            raise ValueError(f"sensor {sensor}: reading has shape {force.shape}, time {self.time.shape}")
        noise = self.noise.get(sensor, 0.0) if isinstance(self.noise, Mapping) else self.noise
        try:
            return Trace(*self._grid, force, noise, self.goes_on).checked()
        except ValueError as error:
            raise ValueError(f"sensor {sensor}: {error}") from None

    def _first(self, sensor):
        found = self._seen(sensor) and self.together.pulses(sensor)[self.lane]
        return found or main_pulse(self.trace(sensor), self.floor)

    def _edge(self, sensor, level, rising, through):
        if self._seen(sensor):
            found = float(self.together.crossings(sensor, level, rising)[self.lane])
            if not math.isnan(found):
                return Measured(found)
        return (onset if rising else ending)(self.trace(sensor), self.first(sensor), level, through)

    def _seen(self, sensor):
        """Whether pulses of this gauge are found together with those of other runs."""
        return self.together is not None and sensor in self.readings

    def _main(self, sensor):
        first = self.first(sensor)
        if self.accept_overlap or not first.found or self.geometry.position(sensor) == 0.0:
            return first
        if self._overlapped(sensor, first):
            return Pulse(math.nan, math.nan, reason="overlapped: the wall's reflection lies on the pulse")
        return first

    def _overlapped(self, sensor, first):
        wall = self._wall_arrival()
        if wall is None:
            return self.geometry.at_last_bead(sensor)
        rise = self.edge(sensor, 0.5, rising=True)
        return rise.known and wall - first.time <= first.time - rise.value

    def _wall_arrival(self):
        wall = self.geometry.wall
        if wall is None or wall not in self.readings:
            return None
        first = self.first(wall)
        return first.time if first.found else None

    def _reflection(self, sensor):
        main = self.main(sensor)
        if not main.found:
            return missing(main.reason)
        way = self._way_to_the_wall(sensor, main)
        if way is None:
            return missing("unknown: no second gauge tells the speed")
        return Measured(main.time + 2.0 * way)

    def _way_to_the_wall(self, sensor, main):
        """Travel time in s from a gauge to the wall, from the wall to the top for a gauge at the wall."""
        geometry, wall = self.geometry, self._wall_arrival()
        here = geometry.position(sensor)
        if here > 0.0 and wall is not None:
            return wall - main.time
        apart = {s.id: geometry.position(s.id) - here for s in geometry.sensors if s.id in self.readings}
        apart = {s: x for s, x in apart.items() if x != 0.0 and self.main(s).found}
        if not apart:
            return None
        far = max(apart, key=lambda s: abs(apart[s]))
        slowness = (main.time - self.main(far).time) / apart[far]
        return (here or geometry.length) * slowness if slowness > 0.0 else None
