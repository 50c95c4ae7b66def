"""The preview of a chain: simulated at the step and at half of it, measured by the functions of `observe`."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from msgspec.structs import replace as changed

from sonicvacuum.card import Card
from sonicvacuum.effects.coating_thickness import EFFECT as LAYER
from sonicvacuum.files import InputError
from sonicvacuum.forward import virtual
from sonicvacuum.gauges import Gauge
from sonicvacuum.laboratory import ranges
from sonicvacuum.laboratory.next_run import gauge_beads
from sonicvacuum.laboratory.ranges import LaboratoryError
from sonicvacuum.observe.pulse import main_pulse
from sonicvacuum.observe.quantities import measure_run
from sonicvacuum.observe.run import Geometry, Run
from sonicvacuum.observe.trace import Trace
from sonicvacuum.physics.extent import LIFT
from sonicvacuum.physics.scales import (
    COUNTING,
    EMBEDDED_SHARE,
    STRIKER_POWER,
    impact_scales,
    passage_of,
    sampling_of,
)
from sonicvacuum.prediction.setup import card_of, check_size
from sonicvacuum.simulation import Simulation, set_up, simulate

# Samples across a pulse at half its height: with so many its arrival is read to 2e-5 of that width, its
# duration to 7e-4 (module `observe.trace`).
SAMPLES_PER_PULSE = 10
# At rest before the impact, in durations of the longest pulse: baseline and noise are read there.
REST = 2.0
_FEWER = f"fewer beads, or {LIFT}"


@dataclass(frozen=True)
class GaugePrediction:
    """What one gauge will show; what the signal does not give is None, and `note` says why.

    Attributes:
        gauge: the number of its bead, or `wall`.
        reading_N: peak of the main pulse as the gauge reads it.
        contact_force_N: peak of the larger of the contact forces beside the gauge.
        arrival_us: time of the peak after the impact.
        onset_us: time at which the pulse rises through 1 % of its peak.
        duration_us: time above 1 % of the peak.
        duration_half_us: time above half of the peak.
        note: what to know of this gauge.
    """

    gauge: str
    reading_N: float | None
    contact_force_N: float | None
    arrival_us: float | None
    onset_us: float | None
    duration_us: float | None
    duration_half_us: float | None
    note: str = ""


@dataclass(frozen=True)
class ChainPrediction:
    """What a chain will show when it is struck.

    Attributes:
        beads: their number.
        bead_mass_g: as given, or from the density.
        striker_mass_g: likewise.
        coating_um: thickness of a coating, which acts as a layer bonded to its core; None of solid beads.
        striker_speed_m_s: as given, or the one at which the gauge reads what was aimed at.
        wave_speed_m_s: between the two gauges `speed_from` and `speed_to`, peak to peak.
        gauges: in the order asked for.
        window_us: first and last instant to record, the impact at 0: rest, and the last gauge's pulse.
        echo_until_us: record until then to have the wall's reflection at every gauge in a bead as well.
        sampling_us: longest interval between samples that resolves the shortest pulse.
        time_us: (S,) times of the simulation.
        readings_N: gauge → (S,) readings.
        warnings: what is doubtful about the motion, one sentence each, see `physics.validity`.
    """

    beads: int
    bead_mass_g: float
    striker_mass_g: float
    coating_um: float | None
    striker_speed_m_s: float
    wave_speed_m_s: float | None
    speed_from: str | None
    speed_to: str | None
    gauges: tuple[GaugePrediction, ...]
    window_us: tuple[float, float] | None
    echo_until_us: float | None
    sampling_us: float | None
    time_us: np.ndarray = field(repr=False, compare=False)
    readings_N: dict[str, np.ndarray] = field(repr=False, compare=False)
    warnings: tuple[str, ...] = ()


def predict(
    *,
    beads: int,
    diameter: str | float,
    material: str,
    speed: str | float | None = None,
    mass: str | float | None = None,
    coating: str | float | None = None,
    core: str | None = None,
    wall: str | None = None,
    orientation: str = "horizontal",
    preload: str | float | None = None,
    striker: str = "sphere",
    striker_mass: str | float | None = None,
    striker_diameter: str | float | None = None,
    striker_material: str | None = None,
    gauges: str | Sequence[int | str] | None = None,
    aim: str | float | None = None,
    limits: bool = True,
) -> ChainPrediction:
    """What a chain of equal beads will show: speed, forces, durations, arrivals, what the recorder needs.

    Quantities are numbers in SI units, or texts with their unit such as `20mm`.

    Args:
        beads: number of beads; bead 1 is struck, the last one touches the wall.
        diameter: outer diameter of a bead.
        material: what touches, a name of the table of materials.
        speed: of the striker; with an aim, where the search for it begins.
        mass: of a bead; from the density where it is not given.
        coating: its thickness, of coated beads. It acts as a layer bonded to its core, stiffer than the
            half-space of Hertz's law where contacts are not much narrower than it is thick
            (`physics.layer_law`).
        core: their inner material.
        wall: material of the wall; the beads' (their core's) where not given.
        orientation: `horizontal`, or `vertical` with the wall below.
        preload: static force on bead 1.
        striker: `sphere` or `flat`. By default a ball like the beads.
        striker_mass: from diameter and density where it is not given.
        striker_diameter: of a ball, from mass and density where it is not given.
        striker_material: the beads' (their core's) where not given.
        gauges: numbers of beads and `wall`, as `3,7,wall` or [3, 7, "wall"].
        aim: peak force at the first of the gauges, or `GAUGE=FORCE`.
        limits: refuse a chain that asks for more time or memory than a computer gives.

    Returns:
        What is expected, SI units or those in the names: the wave's speed, force and duration, arrival and
        peak at each gauge, window to record and sampling.

    Raises:
        InputError: naming the argument, its value and the cure.

    Examples:
        >>> import sonicvacuum as sv
        >>> seen = sv.predict(beads=10, diameter="20mm", material="bearing-steel", speed=0.5)
        >>> round(seen.bead_mass_g, 1), round(seen.wave_speed_m_s, -1)
        (32.7, 580.0)
    """
    asked = {**locals()}
    del asked["limits"]
    card = _layered(card_of(**asked))
    if limits:
        check_size(card, _FEWER)
    if card.striker.aim is not None:
        card = _settled(card, limits)
    return measured(_simulated(card, limits))


def _layered(card: Card) -> Card:
    """The case with its coating as the layer that it is."""
    thick = card.bead.coating_m
    if thick is None:
        return card
    return changed(card, effects={**card.effects, LAYER.id: {LAYER.parameters[0].name: thick * 1e6}})


def _cut(card: Card) -> Card:
    """The case for as long as the pulse takes to the wall and back, sampled finely enough for it."""
    chain = set_up(card).chain
    return changed(card, duration_s=passage_of(chain, COUNTING), interval_s=sampling_of(chain))


def _simulated(card: Card, limits: bool) -> Simulation:
    card = _cut(card)
    if limits:
        check_size(card, _FEWER)
    return simulate(card, limits=limits)


def _settled(card: Card, limits: bool) -> Card:
    """The case with the striker speed at which the aimed gauge reads the wanted peak, and no aim."""
    speed = card.striker.speeds_m_s[0]
    force = EMBEDDED_SHARE * impact_scales(set_up(card).chain)[0]
    speed *= (card.striker.aim.amplitude_N / force) ** STRIKER_POWER
    for name, found in (("started", speed), ("settled", None)):
        if found is None:
            found = float(_simulated(card, limits).speeds[0])
        try:
            ranges.SPEED.check("aim", found)
        except LaboratoryError:
            raise InputError(
                f"aim: {card.striker.aim.amplitude_N:g} N needs a striker at {found:.3g} m/s; "
                "choose another force or another striker"
            ) from None
        aim = card.striker.aim if name == "started" else None
        card = changed(card, striker=changed(card.striker, speeds_m_s=(found,), aim=aim))
    return card


def measured(simulation: Simulation) -> ChainPrediction:
    """What a simulation of one run shows."""
    card, extra = simulation.card, _extra(simulation)
    geometry = Geometry(card.beads, card.specimen.diameters, (*simulation.sensors, *extra))
    readings = {g.id: simulation.read(g)[:, 0] for g in geometry.sensors}
    clear = Run(readings, simulation.time, geometry)
    seen = tuple(_gauge(simulation, clear, gauge) for gauge in simulation.sensors)
    fast, first, last = _speed(clear, simulation.sensors, extra)
    return ChainPrediction(
        beads=card.beads,
        bead_mass_g=card.bead.mass_kg * 1e3,
        striker_mass_g=card.striker.mass_kg * 1e3,
        coating_um=card.effects.get(LAYER.id, {}).get(LAYER.parameters[0].name),
        striker_speed_m_s=float(simulation.speeds[0]),
        wave_speed_m_s=fast,
        speed_from=first,
        speed_to=last,
        gauges=seen,
        window_us=_window(seen),
        echo_until_us=_echo(clear, seen),
        sampling_us=min((g.duration_half_us for g in seen if g.duration_half_us), default=0.0)
        / SAMPLES_PER_PULSE
        or None,
        time_us=simulation.time * 1e6,
        readings_N={g.id: readings[g.id] for g in simulation.sensors},
        warnings=simulation.warnings,
    )


def _extra(simulation):
    """Gauges that only the simulation has: for the speed, and to know when the reflection returns."""
    beads = simulation.card.beads
    pair = tuple(Gauge(f"bead {b}", "embedded", b) for b in gauge_beads(beads))
    return (*pair, *virtual((*simulation.sensors, *pair), beads))


def _gauge(simulation: Simulation, clear: Run, gauge: Gauge) -> GaugePrediction:
    """One gauge; where the reflection lies on its pulse, the first peak as it is, with a note."""
    overlapped = clear.main(gauge.id)
    shown = clear if overlapped.found else replace(clear, accept_overlap=True)
    amplitude, arrival, onset, lasting, half = (
        measure_run(q, shown, sensor=gauge.id)
        for q in ("amplitude", "arrival", "onset", "duration", "duration_half")
    )
    contacts = gauge.what.contacts(gauge, simulation.card.beads)
    peaks = [main_pulse(Trace.of(simulation.time, simulation.force_of(c)[:, 0])).force for c in contacts]
    reasons = (m.reason for m in (overlapped, amplitude, lasting, half) if m.reason)
    us = 1e6
    return GaugePrediction(
        gauge=gauge.id,
        reading_N=_known(amplitude.value),
        contact_force_N=_known(float(np.max(peaks))),
        arrival_us=_known(arrival.value * us),
        onset_us=_known(onset.value * us),
        duration_us=_known(lasting.value * us),
        duration_half_us=_known(half.value * us),
        note="; ".join(dict.fromkeys(reasons)),
    )


def _known(value):
    return float(value) if math.isfinite(value) else None


def _speed(clear, own, extra):
    """Speed in m/s and the two gauges between which it is taken: the user's own, if two sit in beads."""
    inside = sorted((g for g in own if g.kind == "embedded"), key=lambda g: g.bead)
    beads = [g for g in extra if g.kind == "embedded"]
    walls = [g for g in (*own, *extra) if g.kind == "wall"]
    for gauges in (inside, beads, [*inside, *walls]):
        gauges = [g for g in gauges if clear.main(g.id).found]
        if len(gauges) < 2 or clear.geometry.position(gauges[0].id) == clear.geometry.position(gauges[-1].id):
            continue
        found = measure_run("speed", clear, from_=gauges[0].id, to=gauges[-1].id)
        if found.known:
            return found.value, gauges[0].id, gauges[-1].id
    return None, None, None


def _window(seen):
    """First and last instant in us that hold the rest before the impact and the pulse at every gauge."""
    known = [g for g in seen if g.arrival_us is not None and g.duration_us is not None]
    if not known:
        return None
    longest = max(g.duration_us for g in known)
    return -REST * longest, max(g.arrival_us + g.duration_us for g in known)


def _echo(clear, seen):
    """Instant in us at which the wall's reflection has passed every gauge; at the wall it is one pulse with
    the first, and what comes there next comes from the top of the chain.
    """
    inside = [g for g in seen if clear.geometry.position(g.gauge) > 0.0]
    times = [(measure_run("reflection_time", clear, sensor=g.gauge), g.duration_us) for g in inside]
    ends = [t.value * 1e6 + lasting for t, lasting in times if t.known and lasting is not None]
    return max(ends, default=None)
