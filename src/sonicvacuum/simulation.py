"""One card from simulation to gauge readings: what the pipeline keeps of a case and reads back.

Every card is simulated twice, with the chosen step and with half of it: the difference of any quantity
between the two is its numerical error.
"""

import os
import zipfile
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from sonicvacuum.blas import one_thread
from sonicvacuum.card import Card
from sonicvacuum.effects import CATALOGUE, Catalogue, Setup
from sonicvacuum.files import InputError, check_file, replacing
from sonicvacuum.files import reading as reading_file
from sonicvacuum.gauges import Gauge, needed, reading
from sonicvacuum.gauges.base import Recorded
from sonicvacuum.laboratory import ranges
from sonicvacuum.physics import validity
from sonicvacuum.physics.assemble import assemble
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.extent import Extent, TooLargeError, estimate
from sonicvacuum.physics.history import History
from sonicvacuum.physics.scales import STRIKER_POWER, impact_scales

# An aimed striker's speed is settled when the gauge's peak is this close to its aim.
AIM_TOLERANCE = 1e-6


@dataclass(frozen=True)
class Simulation:
    """A simulated card.

    Attributes:
        card: what was simulated.
        speeds: (runs,) striker speeds in m/s; an aimed speed is the one found.
        time: (samples,) s.
        contacts: recorded contacts.
        force: (samples, contacts, runs) dynamic contact forces in N.
        refined: the same with half the step.
        energy: (entries, runs) in J, see `History`.
        momentum: (entries, runs) in N s, likewise.
        bodies: recorded bodies, none where every gauge reads a force.
        motion: (2, 2, samples, bodies, runs) velocity in m/s and acceleration in m/s² of those bodies, with
            the chosen step and with half of it.
        warnings: what is doubtful about the motion, one sentence each.
        catalogue: knows the card's effects.
    """

    card: Card
    speeds: np.ndarray
    time: np.ndarray
    contacts: tuple[int, ...]
    force: np.ndarray
    refined: np.ndarray
    energy: np.ndarray
    momentum: np.ndarray
    bodies: tuple[int, ...] = ()
    motion: np.ndarray | None = None
    warnings: tuple[str, ...] = ()
    catalogue: Catalogue = CATALOGUE

    def __repr__(self) -> str:
        gauges = ", ".join(s.id for s in self.card.sensors)
        runs = ", ".join(f"{speed:.3g} m/s" for speed in self.speeds)
        return f"<Simulation {self.card.name}: {len(self.time)} samples at {runs}, {gauges}>"

    @cached_property
    def _setup(self) -> Setup:
        return set_up(self.card, self.speeds, self.catalogue)

    @property
    def chain(self) -> Chain:
        """The chains as integrated, lane k at speed k."""
        return self._setup.chain

    @property
    def sensors(self) -> tuple[Gauge, ...]:
        """The card's own gauges, with its effects on them."""
        return self._setup.sensors

    @property
    def interval(self) -> float:
        """Time between samples in s."""
        return self.card.interval_s

    def force_of(self, contact: int, refined: bool = False) -> np.ndarray:
        """(samples, runs) dynamic force in N of one contact."""
        return (self.refined if refined else self.force)[:, self.contacts.index(contact)]

    def recorded(self, refined: bool = False) -> Recorded:
        """All that was recorded with one of the two steps, (samples, runs) each."""
        force = self.refined if refined else self.force
        moved = [
            {b: part[:, k] for k, b in enumerate(self.bodies)} for part in self._motion[1 if refined else 0]
        ]
        return Recorded(self.time, {c: force[:, k] for k, c in enumerate(self.contacts)}, *moved)

    @property
    def _motion(self):
        return np.zeros((2, 2, len(self.time), 0, 0)) if self.motion is None else self.motion

    def read(self, sensor: Gauge, refined: bool = False) -> np.ndarray:
        """(samples, runs) reading of any gauge for which enough was recorded."""
        return reading(sensor, self.recorded(refined), self.card.beads)

    def readings(self, refined: bool = False) -> dict[str, np.ndarray]:
        """Sensor id → (samples, runs) reading of the card's own gauges, with the effects on gauges."""
        return {s.id: self.read(s, refined) for s in self.sensors}


def set_up(card: Card, speeds=None, catalogue: Catalogue = CATALOGUE) -> Setup:
    """Chains and gauges of a card with its effects in them; lane k is struck at `speeds[k]` in m/s.

    Raises:
        InputError: for an effect that is not in the catalogue or cannot act in this chain, or parameters that
            it does not take.
    """
    setup = Setup(assemble(card.specimen, card.strikers(speeds)), sensors(card))
    for name, parameters in card.effects.items():
        try:
            one = catalogue.effect(name)
            told = one.refused(setup, **parameters)
            setup = setup if told else one.apply(setup, **parameters)
        except ValueError as error:
            told = str(error)
        if told:
            raise InputError(f"{card.name}: effects.{name}: {told}")
    return setup


def sensors(card: Card) -> tuple[Gauge, ...]:
    """The card's gauges, without effects."""
    return tuple(s.gauge for s in card.sensors)


def recorded_contacts(card: Card) -> tuple[int, ...]:
    """All contacts of a single run; of a sweep those from the first gauge to the last, and the wall.

    All as well of a sweep with gauges in fewer than two beads: virtual ones are put elsewhere then.
    """
    inside = {s.bead for s in card.sensors if s.kind == "embedded"}
    if len(card.striker.speeds_m_s) == 1 or len(inside) < 2:
        return tuple(range(card.beads + 1))
    return (*range(min(inside) - 1, max(inside) + 1), card.beads)


def extent(card: Card, catalogue: Catalogue = CATALOGUE) -> Extent:
    """What simulating a card, at the chosen step and at half of it, asks for: steps, samples, memory."""
    chain, contacts = set_up(card, catalogue=catalogue).chain, len(recorded_contacts(card))
    return estimate(chain, contacts, card.duration_s, card.interval_s, copies=3)


def check_extent(card: Card, catalogue: Catalogue = CATALOGUE) -> Extent:
    """What a card asks for; InputError where that is more than a computer gives, see `physics.extent`."""
    try:
        Extent(card.beads, 1.0, 1.0, 1.0).check()  # before anything is made for each bead
        asked = extent(card, catalogue)
        asked.check()
    except TooLargeError as error:
        raise InputError(f"{card.name}: {error}") from None
    return asked


def check_scales(card: Card, catalogue: Catalogue = CATALOGUE) -> None:
    """InputError for times that show nothing of the impact, or an aim far from its force, as of records."""
    force, contact = impact_scales(set_up(card, catalogue=catalogue).chain)
    if aim := card.striker.aim:
        try:
            ranges.force_range(force).check("striker.aim.amplitude_N", aim.amplitude_N)
        except ranges.LaboratoryError as error:
            raise InputError(f"{card.name}: {error}") from None
    _check_times(card, 1e6 * contact)


def _check_times(card, contact):
    """Duration and sampling interval beside a contact of so many us."""
    shortest, longest = ranges.SHORTEST_RECORD * contact, ranges.LONGEST_INTERVAL * contact
    duration, interval = 1e6 * card.duration_s, 1e6 * card.interval_s
    told = ""
    if duration < shortest:
        told = f"duration_us: is {duration:g} us, while a contact lasts {contact:.3g} us"
        told += ranges.suspicion("us", duration, shortest, 1e4 * contact, {"ms": 1e-3, "s": 1e-6})
    elif interval > longest:
        told = f"sample_us: is {interval:g} us, while a contact lasts {contact:.3g} us"
        told += ranges.suspicion("us", interval, 0.0, longest, {"ns": 1e3})
    if told:
        raise InputError(f"{card.name}: {told}")


@one_thread
def simulate(card: Card, catalogue: Catalogue = CATALOGUE, limits: bool = True) -> Simulation:
    """Simulate a card, at the chosen step and at half of it.

    Raises:
        InputError: for effects or an aim that cannot be; with `limits`, for more than a computer gives, and
            for times that show nothing of the impact.
    """
    if limits:
        check_extent(card, catalogue)
        check_scales(card, catalogue)
    speeds = np.array(card.striker.speeds_m_s)
    if card.striker.aim is not None:
        speeds = _aimed(card, speeds, catalogue)
    contacts = recorded_contacts(card)
    try:
        plain, refined = (_simulate(card, speeds, contacts, catalogue, r, audit=r == 1.0) for r in (1.0, 2.0))
        warnings = _doubts(card, set_up(card, speeds, catalogue), plain)
    except (FloatingPointError, validity.MeaninglessError) as error:
        raise InputError(f"{card.name}: {error}") from None
    return Simulation(
        card=card,
        speeds=speeds,
        time=plain.time,
        contacts=contacts,
        force=plain.force,
        refined=refined.force,
        energy=plain.energy,
        momentum=plain.momentum,
        bodies=plain.bodies,
        motion=np.array([(h.velocity, h.acceleration) for h in (plain, refined)]) if plain.bodies else None,
        warnings=warnings,
        catalogue=catalogue,
    )


def _doubts(card, setup, history):
    """What is doubtful about a simulation, see `physics.validity`."""
    surfaces = [bead.surface for bead in card.specimen.bodies.kinds]
    found = validity.warnings(setup.chain, history, {s.name: s.yield_Pa for s in surfaces})
    for gauge in setup.sensors:
        found.append(validity.unseen(gauge.id, reading(gauge, history, card.beads), card.interval_s))
    return tuple(told for told in found if told)


def _simulate(card, speeds, contacts, catalogue=CATALOGUE, refine=1.0, audit=False) -> History:
    # And with it compiled code: not for what is read only.
    from sonicvacuum.physics.run import simulate as integrate

    chain = set_up(card, speeds, catalogue).chain
    _, bodies = needed(sensors(card), card.beads)
    history = integrate(
        chain, contacts, card.duration_s, card.interval_s, bodies=bodies, refine=refine, audit=audit
    )
    kept = [history.contacts.index(c) for c in contacts]
    return replace(history, contacts=contacts, force=history.force[:, kept]) if bodies else history


def _aimed(card, speeds, catalogue):
    """Striker speeds at which the aimed sensor's peak is the wanted one; peaks grow about as speed^(6/5)."""
    sensor = next(s for s in set_up(card, speeds, catalogue).sensors if s.id == card.striker.aim.sensor)
    aim = card.striker.aim.amplitude_N
    for _ in range(20):
        history = _simulate(card, speeds, needed((sensor,), card.beads)[0], catalogue)
        peak = reading(sensor, history, card.beads).max(axis=0)
        if np.all(np.abs(peak - aim) < AIM_TOLERANCE * aim):
            return speeds
        if np.any(peak <= 0.0):
            break
        speeds = speeds * (aim / peak) ** STRIKER_POWER
    raise InputError(
        f"{card.name}: striker.aim: no speed found at which {sensor.id} reads {aim} N; "
        "start from another speed_m_s, or simulate for longer"
    )


def save(simulation: Simulation, path) -> None:
    """Write all but the card to an .npz file; equal simulations give equal bytes."""
    with replacing(path, "wb") as stream:
        np.savez(
            stream,
            speeds=simulation.speeds,
            contacts=np.array(simulation.contacts),
            force=simulation.force,
            refined=simulation.refined,
            energy=simulation.energy,
            momentum=simulation.momentum,
            **({"warnings": np.array(simulation.warnings)} if simulation.warnings else {}),
            **(
                {"bodies": np.array(simulation.bodies), "motion": simulation.motion}
                if simulation.bodies
                else {}
            ),
        )


def load(card: Card, path, catalogue: Catalogue = CATALOGUE) -> Simulation:
    """The simulation that `save` wrote for this card; InputError where the file is not one."""
    with reading_file(path, "run sonicvacuum simulate again"):
        parts = _arrays(path)
        time = np.arange(len(parts["force"])) * card.interval_s
        contacts = tuple(int(c) for c in parts.pop("contacts"))
        bodies = tuple(int(b) for b in parts.pop("bodies", ()))
        warnings = tuple(str(w) for w in parts.pop("warnings", ()))
        known = {"bodies": bodies, "warnings": warnings, "catalogue": catalogue}
        simulation = Simulation(card=card, time=time, contacts=contacts, **known, **parts)
        _check_whole(simulation)
    return simulation


def _arrays(path):
    """Arrays of an .npz file; the directory is held against the file before anything is unpacked."""
    check_file(path)
    with zipfile.ZipFile(path) as listing:
        if sum(part.file_size for part in listing.infolist()) > 2 * os.path.getsize(path):
            raise ValueError("it is packed, which simulate never does")
    with np.load(path, allow_pickle=False) as data:
        return dict(data)


def _check_whole(simulation):
    """ValueError for arrays of other shapes than the card's, or numbers that are none."""
    card, runs = simulation.card, len(simulation.card.striker.speeds_m_s)
    samples = int(np.floor(card.duration_s / card.interval_s * (1.0 + 1e-12))) + 1
    force = (samples, len(simulation.contacts), runs)
    if simulation.contacts != recorded_contacts(card):
        raise ValueError("other contacts than the card's are recorded")
    for name, shape in (("speeds", (runs,)), ("force", force), ("refined", force)):
        if getattr(simulation, name).shape != shape:
            raise ValueError(f"{name} has the shape {getattr(simulation, name).shape}, the card's is {shape}")
    for name in ("speeds", "force", "refined", "energy", "momentum"):
        array = getattr(simulation, name)
        if array.dtype != np.float64 or not np.isfinite(array).all():
            raise ValueError(f"{name} holds what is no finite number")
    if simulation.bodies:
        moved = (2, 2, samples, len(simulation.bodies), runs)
        if simulation.motion.shape != moved or not np.isfinite(simulation.motion).all():
            raise ValueError("motion is not that of the recorded bodies")
