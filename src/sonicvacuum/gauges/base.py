"""What a gauge is, what a kind of gauge is, and how a reading is formed from a recorded motion."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from sonicvacuum.gauges.electronics import filtered
from sonicvacuum.laboratory.bodies import Bodies

# Standard error of the logarithm of the gain of a gauge that was never calibrated: a factor of a thousand
# either way.
UNKNOWN_GAIN = math.log(1e3)


class Motion(Protocol):
    """What a simulation recorded of a chain; `physics.run.History` is one."""

    time: np.ndarray

    def of(self, contact: int) -> np.ndarray:
        """(S, ...) force of a contact in N without the static part."""

    def velocity_of(self, body: int) -> np.ndarray:
        """(S, ...) velocity of a body in m/s, positive towards the wall."""

    def acceleration_of(self, body: int) -> np.ndarray:
        """(S, ...) acceleration of a body in m/s²."""


def none_needed(gauge: "Gauge", beads: int) -> tuple[int, ...]:
    """Nothing has to be recorded."""
    return ()


@dataclass(frozen=True)
class Kind:
    """One kind of gauge.

    Attributes:
        id: its name in records and cards.
        title: a few words, for pages and axes.
        unit: of the reading.
        suffix: the unit as keys of a record end with it: `sigma_N`, `sigma_m_s`.
        in_bead: whether it belongs to one bead, whose number it then names.
        feel: (gauge, motion, beads) → (S, ...) what arrives at the electronics, change from rest.
        distance: (gauge, beads, diameter) → distance from the wall in m.
        contacts: (gauge, beads) → contacts whose force has to be recorded.
        bodies: (gauge, beads) → bodies whose motion has to be recorded.
        offsets: whether a place off the bead's middle changes the reading (`offset_fraction`).
        echo: sign of a reading of a pulse that comes back from the wall: 1 for forces, −1 for motions.
    """

    id: str
    title: str
    unit: str
    suffix: str
    in_bead: bool
    feel: Callable = field(repr=False)
    distance: Callable = field(repr=False)
    contacts: Callable = field(default=none_needed, repr=False)
    bodies: Callable = field(default=none_needed, repr=False)
    offsets: bool = False
    echo: float = 1.0

    @property
    def noise_key(self) -> str:
        """Key of the noise of one sample in a record."""
        return f"sigma_{self.suffix}"


# Id → kind, in the order in which they are listed; filled by the package.
KINDS: dict[str, Kind] = {}


@dataclass(frozen=True)
class Gauge:
    """One gauge.

    Attributes:
        id: its name.
        kind: key of `KINDS`.
        bead: the bead of a gauge that belongs to one, 1 (the one struck) to `beads`; None elsewhere.
        droop_s: RC time of the discharge in s, infinite (or None) where there is none.
        lowpass_s: time constant of the bandwidth in s; 0: unlimited.
        offset_fraction: ε in (½ + ε) F_before + (½ − ε) F_after, from −½ to ½: an embedded gauge off the
            middle of its bead, ε > 0 towards the striker.
        gain: reading per unit felt.
        sigma: white noise of one sample in the kind's unit; 0: not stated.
        gain_rel_sigma: standard error of the gain, relative, one gain for all runs; infinite: uncalibrated.
        delay_sigma_s: standard error of the delay of its channel in s.
        baseline_sigma: standard error of a constant offset in the kind's unit.
        drift_sigma: that of a slow drift over the record.

    Droop, bandwidth, offset and gain may be arrays (lanes,): the same gauge on chains that are read side by
    side.

    Raises:
        ValueError: for a value outside these ranges.
    """

    id: str
    kind: str
    bead: int | None = None
    droop_s: float | np.ndarray | None = math.inf
    lowpass_s: float | np.ndarray = 0.0
    offset_fraction: float | np.ndarray = 0.0
    gain: float | np.ndarray = 1.0
    sigma: float = 0.0
    gain_rel_sigma: float = 0.0
    delay_sigma_s: float = 0.0
    baseline_sigma: float = 0.0
    drift_sigma: float = 0.0

    def __post_init__(self):
        if self.droop_s is None:
            object.__setattr__(self, "droop_s", math.inf)
        self._check(self.kind in KINDS, "kind", f"one of {', '.join(KINDS)}")
        if self.what.in_bead:
            self._check(self.bead is not None and self.bead >= 1, "bead", "1 or more: this gauge has a bead")
        else:
            self._check(self.bead is None, "bead", f"None for a gauge of kind {self.kind}")
        if not self.what.offsets:
            centred = np.all(np.equal(self.offset_fraction, 0.0))
            self._check(centred, "offset_fraction", f"0 for a gauge of kind {self.kind}")
        self._check(np.all(np.greater(self.droop_s, 0.0)), "droop_s", "positive, or None")
        self._check(_within(self.lowpass_s, 0.0), "lowpass_s", "0 or positive")
        self._check(np.all(np.abs(self.offset_fraction) <= 0.5), "offset_fraction", "between -0.5 and 0.5")
        self._check(_within(self.gain, np.nextafter(0.0, 1.0)), "gain", "positive")

    def _check(self, good, name, must_be):
        if not good:
            raise ValueError(f"sensor {self.id}: {name} is {getattr(self, name)!r}; it must be {must_be}")

    @property
    def what(self) -> Kind:
        """The kind itself."""
        return KINDS[self.kind]

    @property
    def unit(self) -> str:
        """Unit of the reading."""
        return self.what.unit

    @property
    def calibrated(self) -> bool:
        """Whether the record states a standard error of the gain."""
        return math.isfinite(self.gain_rel_sigma)

    @property
    def log_gain_sigma(self) -> float:
        """Standard error of the logarithm of the gain."""
        return self.gain_rel_sigma if self.calibrated else UNKNOWN_GAIN

    def take(self, lanes: np.ndarray) -> "Gauge":
        """The gauge as some of the chains have it: `lanes` (n,) are their numbers, from 0."""
        names = ("droop_s", "lowpass_s", "offset_fraction", "gain")
        numbers = {n: np.ravel(getattr(self, n)) for n in names}
        own = {n: v[lanes] if len(v) > 1 else float(v[0]) for n, v in numbers.items()}
        return Gauge(self.id, self.kind, self.bead, **own)


def _within(values, least):
    """Whether all are finite and at least so large."""
    return bool(np.all(np.isfinite(values)) and np.all(np.greater_equal(values, least)))


def misplaced(kind: str, bead: int | None, beads: int) -> str | None:
    """What is wrong with the place of a gauge, in words for a key `bead`; None where nothing is."""
    what = KINDS[kind]
    article = "an" if kind[0] in "aeiou" else "a"
    if what.in_bead and bead is None:
        return f"missing; {article} {kind} sensor needs the number of its bead"
    if not what.in_bead and bead is not None:
        return f"is {bead}; the {kind} sensor sits in no bead: drop the key"
    if bead is not None and not 1 <= bead <= beads:
        return f"is {bead}; the chain has {beads} beads, counted from 1, the struck one"
    return None


def _checked(gauge, beads):
    if gauge.bead is not None and gauge.bead > beads:
        raise ValueError(f"sensor {gauge.id} sits in bead {gauge.bead}; the chain has {beads}")
    return gauge


def contacts_of(gauge: Gauge, beads: int) -> tuple[int, ...]:
    """Contacts whose force a gauge feels; contact c joins beads c and c + 1, contact `beads` is the wall.

    Raises:
        ValueError: for a gauge in a bead that the chain does not have.
    """
    return _checked(gauge, beads).what.contacts(gauge, beads)


def needed(gauges: Iterable[Gauge], beads: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Contacts and bodies that a simulation has to record for these gauges, sorted."""
    gauges = tuple(gauges)
    contacts = {c for g in gauges for c in contacts_of(g, beads)}
    bodies = {b for g in gauges for b in g.what.bodies(g, beads)}
    return tuple(sorted(contacts)), tuple(sorted(bodies))


def position(gauge: Gauge, beads: int, diameter: Bodies | float) -> float:
    """Distance from the wall in m: a gauge in a bead sits at its centre, the wall gauge at 0.

    `diameter` is that of a bead in m, or of each of them.
    """
    return _checked(gauge, beads).what.distance(gauge, beads, diameter)


def reading(
    gauge: Gauge, motion: Motion, beads: int, high_pass: Callable[..., np.ndarray] | None = None
) -> np.ndarray:
    """What the gauge shows: change from rest → bandwidth and droop → gain.

    Args:
        gauge: the gauge.
        motion: what was recorded of `beads` beads. Before its first sample chain and gauge are at rest.
        beads: number of beads.
        high_pass: as of `filtered`.

    Returns:
        (S, ...) in the unit of the gauge's kind.

    Raises:
        ValueError: when what the gauge needs was not recorded.
    """
    felt = _checked(gauge, beads).what.feel(gauge, motion, beads)
    interval = float(motion.time[1] - motion.time[0]) if len(motion.time) > 1 else 1.0
    return gauge.gain * filtered(felt, interval, gauge.lowpass_s, gauge.droop_s, high_pass)


@dataclass(frozen=True)
class Recorded:
    """A motion put together from arrays, for readings of what was not simulated just now.

    Attributes:
        time: (S,) s.
        force: contact → (S, ...) N.
        velocity: body → (S, ...) m/s.
        acceleration: body → (S, ...) m/s².
    """

    time: np.ndarray
    force: Mapping[int, np.ndarray]
    velocity: Mapping[int, np.ndarray] = field(default_factory=dict)
    acceleration: Mapping[int, np.ndarray] = field(default_factory=dict)

    def of(self, contact: int) -> np.ndarray:
        """(S, ...) force of a contact in N; ValueError where it was not recorded."""
        return _found(self.force, contact, "force of contact")

    def velocity_of(self, body: int) -> np.ndarray:
        """(S, ...) velocity of a body in m/s; ValueError where it was not recorded."""
        return _found(self.velocity, body, "velocity of body")

    def acceleration_of(self, body: int) -> np.ndarray:
        """(S, ...) acceleration of a body in m/s²; ValueError where it was not recorded."""
        return _found(self.acceleration, body, "acceleration of body")


def _found(recorded, place, what):
    if place not in recorded:
        raise ValueError(f"the {what} {place} was not recorded")
    return np.asarray(recorded[place])
