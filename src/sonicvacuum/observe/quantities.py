"""The list of quantities: what an experiment reports, how it is found, its unit, what must be named.

One list for the command line, the records of measured data and the ledger. A quantity is one function and one
entry of `QUANTITIES`. The conventions are those of the measured-data record: an embedded gauge sits at its
bead's centre, the wall gauge at the wall, speeds are distance over peak-to-peak time of the main pulse
(Daraio & Nesterenko, PRE 73, 026612, 2006).
"""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np

from sonicvacuum.observe import contacts, pulse, shape, sweep
from sonicvacuum.observe.run import Geometry, Run
from sonicvacuum.observe.trace import Measured, missing


@dataclass(frozen=True)
class Quantity:
    """One entry of the list.

    Attributes:
        function: finds it. Over a run: function(run, **needs and options) → Measured.
        unit: SI unit of the value.
        needs: what a request for it must name, as in a record's observable ("from" is the argument `from_`).
        over: what the function is given: "run" (readings), "sweep" (amplitudes and speeds of many runs),
            "contact" (force and constants of one contact), "striker" (its speeds before and after).
    """

    function: Callable
    unit: str
    needs: tuple[str, ...]
    over: str = "run"

    @property
    def options(self) -> tuple[str, ...]:
        """Names of what may be given besides: arguments with a default."""
        return _with_default(self.function)


@cache
def _with_default(function):
    """Names of a function's arguments that have a default; kept, as each value of each lane is checked."""
    arguments = inspect.signature(function).parameters.values()
    return tuple(a.name for a in arguments if a.default is not a.empty)


def measure(
    quantity: str, readings: Mapping[str, np.ndarray], time: np.ndarray, geometry: Geometry, **options
) -> Measured | tuple[Measured, ...]:
    """One quantity of one run, or of many runs with the same times.

    Args:
        quantity: a key of `QUANTITIES` whose `over` is "run".
        readings: for each gauge its reading in its unit, change from rest, (S,), or (S, L) for L runs.
        time: (S,) equidistant times in s.
        geometry: where the gauges sit.
        options: what the quantity needs and allows (`from_` or **{"from": …}); `noise`, `floor`,
            `accept_overlap` and `safety` go to `Run`.

    Returns:
        The value in SI units, or NaN and the reason why the readings do not give it; a tuple of L for (S, L).

    Raises:
        ValueError: unknown quantity, gauge or option, something needed that is not given, malformed arrays.
    """
    settings = {name: options.pop(name) for name in _SETTINGS if name in options}
    readings = {name: np.asarray(r) for name, r in readings.items()}
    wide = {r.shape[1] for r in readings.values() if r.ndim == 2}
    if not wide:
        return measure_run(quantity, Run(readings, time, geometry, **settings), **options)
    if len(wide) > 1 or any(r.ndim != 2 for r in readings.values()):
        raise ValueError(f"readings have shapes {[r.shape for r in readings.values()]}; all must be (S, L)")
    columns = ({name: r[:, k] for name, r in readings.items()} for k in range(wide.pop()))
    return tuple(measure_run(quantity, Run(c, time, geometry, **settings), **options) for c in columns)


def measure_run(quantity: str, run: Run, **options) -> Measured:
    """As `measure`, on a `Run`: several quantities of one run then share the pulses found."""
    entry = _entry(quantity, tuple(options))
    return entry.function(
        run, **{"from_" if name == "from" else name: value for name, value in options.items()}
    )


@lru_cache(maxsize=256)
def _entry(quantity, options):
    """The quantity that takes options of these names; ValueError where there is none."""
    entry = QUANTITIES.get(quantity)
    if entry is None:
        raise ValueError(f"quantity {quantity!r} is not one of {', '.join(QUANTITIES)}")
    if entry.over != "run":
        raise ValueError(f"quantity {quantity!r} is found over a {entry.over}: call its function")
    given = ["from" if name == "from_" else name for name in options]
    for name in entry.needs:
        if name not in given:
            raise ValueError(f"quantity {quantity!r} needs {name!r}")
    for name in given:
        if name not in entry.needs and name not in entry.options:
            allowed = ", ".join((*entry.needs, *entry.options))
            raise ValueError(f"quantity {quantity!r} takes no {name!r}, only {allowed}")
    return entry


def speed(run: Run, from_: str, to: str) -> Measured:
    """Distance between two gauges over the peak-to-peak time of the main pulse, in m/s.

    Raises:
        ValueError: for two gauges at one place.
    """
    apart = run.geometry.position(from_) - run.geometry.position(to)
    if apart == 0.0:
        raise ValueError(f"speed from {from_} to {to}: both sit at the same place")
    first, last = run.main(from_), run.main(to)
    if not (first.found and last.found):
        return missing(f"{to}: {last.reason}" if first.found else f"{from_}: {first.reason}")
    travel = last.time - first.time
    if not apart * travel > 0.0:
        return missing(f"no passage: the peak at {to} is not later in the order of the way from {from_}")
    return Measured(apart / travel)


def amplitude(run: Run, sensor: str) -> Measured:
    """Peak of the main pulse above rest, in the unit of the gauge."""
    main = run.main(sensor)
    return Measured(main.force, main.reason)


def arrival(run: Run, sensor: str) -> Measured:
    """Time of the main pulse's peak, in s."""
    main = run.main(sensor)
    return Measured(main.time, main.reason)


def onset(run: Run, sensor: str, level: float = 0.01) -> Measured:
    """Time at which the main pulse rises through level × peak, in s."""
    main = run.main(sensor)
    if not main.found:
        return shape.onset(run.trace(sensor), main, level)
    return run.edge(sensor, level, True, run.through)


def duration(run: Run, sensor: str, level: float = 0.01) -> Measured:
    """Time for which the main pulse exceeds level × peak, in s."""
    main = run.main(sensor)
    if not main.found:
        return shape.duration(run.trace(sensor), main, level)
    return shape.lasting(*(run.edge(sensor, level, rising, run.through) for rising in (True, False)))


def duration_half(run: Run, sensor: str) -> Measured:
    """Time for which the main pulse exceeds half its peak, in s."""
    return duration(run, sensor, 0.5)


def width(run: Run, from_: str, to: str, sensor: str, level: float = 0.01) -> Measured:
    """Length of the main pulse, duration × speed, in (mean) diameters of the beads between the gauges."""
    lasting, fast = duration(run, sensor, level), speed(run, from_, to)
    if not (lasting.known and fast.known):
        return fast if lasting.known else lasting
    return Measured(lasting.value * fast.value / run.geometry.diameter_between(from_, to))


def width_half(run: Run, from_: str, to: str, sensor: str) -> Measured:
    """Length of the main pulse at half its peak in bead diameters."""
    return width(run, from_, to, sensor, 0.5)


def pulse_count(run: Run, sensor: str, threshold: float = pulse.THRESHOLD) -> Measured:
    """Number of separate peaks above threshold × main peak before the reflection returns."""
    return _before_reflection(run, sensor, _count, threshold=threshold)


def decay(run: Run, from_: str, to: str) -> Measured:
    """Amplitude at `to` over amplitude at `from`."""
    before, after = amplitude(run, from_), amplitude(run, to)
    if not (before.known and after.known):
        return missing(f"{to}: {after.reason}" if before.known else f"{from_}: {before.reason}")
    return Measured(after.value / before.value)


def valley_depth(run: Run, sensor: str) -> Measured:
    """How far the force falls between the first two pulses: 1 to rest, 0 no split."""
    return _before_reflection(run, sensor, shape.valley_depth)


def extra_pulse_fraction(run: Run, sensor: str) -> Measured:
    """Highest later peak before the reflection returns, as a fraction of the main one."""
    return _before_reflection(run, sensor, shape.extra_pulse_fraction)


def asymmetry(run: Run, sensor: str, level: float = 0.5) -> Measured:
    """(fall − rise)/(fall + rise) of the main pulse between its peak and level × peak."""
    return shape.asymmetry(run.trace(sensor), run.main(sensor), level)


def reflection_time(run: Run, sensor: str) -> Measured:
    """Time at which the reflection of the main pulse peaks at a gauge, in s."""
    return run.reflection_time(sensor)


def echo_delay(run: Run, sensor: str) -> Measured:
    """Time from the peak of the incident pulse to that of the pulse which the wall sends back, in s."""
    echo = run.echo(sensor)
    return Measured(echo.time - run.main(sensor).time, echo.reason)


def echo_ratio(run: Run, sensor: str) -> Measured:
    """Amplitude of the pulse which the wall sends back over that of the incident one."""
    echo = run.echo(sensor)
    return Measured(echo.force / run.main(sensor).force, echo.reason)


def _before_reflection(run, sensor, function, **options):
    main = run.main(sensor)
    if not main.found:
        return missing(main.reason)
    return function(run.trace(sensor), main, run.free_until(sensor), **options)


def _count(trace, main, until, threshold):
    return Measured(float(len(pulse.pulses(trace, main, until, threshold))))


_SETTINGS = ("noise", "floor", "accept_overlap", "safety")

QUANTITIES = {
    "speed": Quantity(speed, "m/s", ("from", "to")),
    "amplitude": Quantity(amplitude, "N", ("sensor",)),
    "arrival": Quantity(arrival, "s", ("sensor",)),
    "onset": Quantity(onset, "s", ("sensor",)),
    "duration": Quantity(duration, "s", ("sensor",)),
    "duration_half": Quantity(duration_half, "s", ("sensor",)),
    "width": Quantity(width, "diameters", ("from", "to", "sensor")),
    "width_half": Quantity(width_half, "diameters", ("from", "to", "sensor")),
    "pulse_count": Quantity(pulse_count, "1", ("sensor",)),
    "decay": Quantity(decay, "1", ("from", "to")),
    "valley_depth": Quantity(valley_depth, "1", ("sensor",)),
    "extra_pulse_fraction": Quantity(extra_pulse_fraction, "1", ("sensor",)),
    "asymmetry": Quantity(asymmetry, "1", ("sensor",)),
    "reflection_time": Quantity(reflection_time, "s", ("sensor",)),
    "echo_delay": Quantity(echo_delay, "s", ("sensor",)),
    "echo_ratio": Quantity(echo_ratio, "1", ("sensor",)),
    "speed_at_amplitude": Quantity(sweep.speed_at_amplitude, "m/s", ("amplitude", "sensor"), "sweep"),
    "loglog_slope": Quantity(sweep.loglog_slope, "1", ("from", "to", "sensor"), "sweep"),
    "max_compression": Quantity(contacts.max_compression, "m", ("contact",), "contact"),
    "contact_radius": Quantity(contacts.contact_radius, "m", ("contact",), "contact"),
    "mean_pressure": Quantity(contacts.mean_pressure, "Pa", ("contact",), "contact"),
    "peak_pressure": Quantity(contacts.peak_pressure, "Pa", ("contact",), "contact"),
    "strain_rate": Quantity(contacts.strain_rate, "1/s", ("contact",), "contact"),
    "contact_duration": Quantity(contacts.contact_duration, "s", (), "contact"),
    "restitution": Quantity(contacts.restitution, "1", (), "striker"),
}
