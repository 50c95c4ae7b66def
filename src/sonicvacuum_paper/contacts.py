"""What single contacts bear in one run; definitions in `workflow/resources/claims.md`, "One run: contacts".

Between the gauges the contact with the largest force stands for all; at the wall it is the last one. Depth
and force are totals at the main peak, static part included.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from sonicvacuum.laboratory.specimen import Bead
from sonicvacuum.observe.contacts import contact_radius, mean_pressure, peak_pressure
from sonicvacuum.observe.pulse import Pulse, main_pulse
from sonicvacuum.observe.shape import duration, onset
from sonicvacuum.observe.trace import Measured, missing
from sonicvacuum.physics import layer_law
from sonicvacuum_paper.one_run import OneRun
from sonicvacuum_paper.printed import ASSUMED

MICRO = 1e6
RISE_LEVEL = 0.01
Entry = tuple[str, str, Measured]


@dataclass(frozen=True)
class Loaded:
    """A contact at its main peak.

    Attributes:
        run, contact: which.
        pulse: its main pulse, dynamic part.
        force: total in N.
        depth: approach in m, by the law of the run.
        radius: of the touching area in m, by the law of the run.
        concentration: pressure at its centre over the mean one, by that law.
        coatings: how many share the approach.
    """

    run: OneRun
    contact: int
    pulse: Pulse
    force: float
    depth: float
    radius: float
    concentration: float
    coatings: int

    @classmethod
    def of(cls, run: OneRun, contact: int) -> "Loaded":
        """The contact at its peak; NaN where it has none."""
        pulse, force = _peak(run, contact)
        depth = float(run.depth_at(contact, [force])[0])
        coatings = 1 if contact == run.card.beads else 2
        return cls(run, contact, pulse, force, depth, *run.touched(contact, depth), coatings)

    @property
    def chi(self) -> float:
        """√(R* depth) over the coating's thickness."""
        hertz = contact_radius(self.depth, self.run.reduced_radius(self.contact))
        return float(hertz) / self.bead.coating_m

    @property
    def bead(self):
        """The bead of the card."""
        return self.run.card.bead

    @property
    def confined_modulus(self) -> float:
        """E_c = E (1 − ν)/((1 + ν)(1 − 2ν)) of the coating in Pa: no strain sideways."""
        e, nu = self.bead.surface.modulus_Pa, self.bead.surface.poisson
        return e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))


def heaviest(run: OneRun) -> Loaded:
    """The contact with the largest force between the first and the last embedded gauge."""
    forces = {c: _peak(run, c)[1] for c in run.contacts_between_gauges()}
    return Loaded.of(run, max(forces, key=lambda c: -math.inf if math.isnan(forces[c]) else forces[c]))


def _peak(run, contact):
    """Main pulse of a contact, and the total force at its peak."""
    pulse = main_pulse(run.contact(contact))
    return pulse, pulse.force + run.static_force(contact)


def entries(run: OneRun) -> Iterator[tuple[str, str, str, Measured]]:
    """(quantity, sensor, unit, value) of all contact metrics of a run."""
    places = [(Loaded.of(run, run.card.beads), run.wall.id)]
    if run.span is not None:
        places.insert(0, (heaviest(run), "-".join(s.id for s in run.span)))
    for contact, sensor in places:
        for quantity, unit, value in _of(contact):
            reason = (
                "" if value.known and math.isfinite(value.value) else value.reason or contact.pulse.reason
            )
            yield quantity, sensor, unit, Measured(value.value, reason)


def _of(c: Loaded) -> Iterator[Entry]:
    yield "contact_force", "N", Measured(c.force)
    yield "contact_depth", "um", Measured(c.depth * MICRO)
    yield "contact_radius", "um", Measured(c.radius * MICRO)
    yield "contact_radius_over_bead_radius", "1", Measured(c.radius / (0.5 * c.bead.diameter_m))
    lasting = contact_time(c)
    yield "contact_time", "us", Measured(lasting.value * MICRO, lasting.reason)
    transit = c.bead.diameter_m / ASSUMED.wave_speed_steel
    yield "contact_time_over_transit", "1", Measured(lasting.value / transit, lasting.reason)
    if c.bead.coating_m is not None:
        yield from _coated(c, lasting)


def _coated(c, lasting):
    layer, surface = c.bead.coating_m, c.bead.surface
    yield "contact_depth_over_thickness", "1", Measured(c.depth / (c.coatings * layer))
    yield "contact_radius_over_thickness", "1", Measured(c.radius / layer)
    yield "coating_strain", "1", Measured(c.depth / (c.coatings * layer))
    if surface.yield_Pa is not None:
        onset_pressure = ASSUMED.yield_onset * surface.yield_Pa
        yield (
            "mean_pressure_over_yield",
            "1",
            Measured(float(mean_pressure(c.force, c.radius)) / surface.yield_Pa),
        )
        yield (
            "peak_pressure_over_onset",
            "1",
            Measured(float(peak_pressure(c.force, c.radius, c.concentration)) / onset_pressure),
        )
    if c.coatings == 2:
        yield "core_compliance_fraction", "1", Measured(core_compliance(c))
        yield "half_space_correction", "1", Measured(half_space_correction(c.chi, c.bead))
        hertz = c.run.stiffness(c.contact) * c.depth**1.5
        yield "thin_layer_over_hertz", "1", Measured(thin_layer_force(c) / hertz)
        yield from _strain_rates(c)
    if surface.density_kg_m3 is not None:
        crossing = layer / math.sqrt(c.confined_modulus / surface.density_kg_m3)
        yield "contact_time_over_coating_transit", "1", Measured(lasting.value / crossing, lasting.reason)


def _strain_rates(c):
    rise = onset(c.run.contact(c.contact), c.pulse, RISE_LEVEL)
    static = c.run.static_force(c.contact)
    approach = c.depth - float(c.run.depth_at(c.contact, [static])[0])
    two_coatings = 2.0 * c.bead.coating_m
    speed = approach / (c.pulse.time - rise.value)
    yield "strain_rate", "1/s", Measured(speed / two_coatings, rise.reason)
    yield "strain_rate_bead", "1/s", Measured(speed / (0.5 * c.bead.diameter_m), rise.reason)
    fastest = largest_rate(c, static) if c.pulse.found else math.nan
    yield "strain_rate_peak", "1/s", Measured(fastest / two_coatings, c.pulse.reason)


def largest_rate(c: Loaded, static: float) -> float:
    """Largest d(delta)/dt in m/s before the main peak."""
    trace = c.run.contact(c.contact)
    depth = c.run.depth_at(c.contact, trace.force[: c.pulse.peak + 2] + static)
    return float(np.gradient(depth, trace.interval).max())


def contact_time(c: Loaded) -> Measured:
    """Twice the full width at half height in s, so that no level in the tail is needed."""
    if not c.pulse.found:
        return missing(c.pulse.reason)
    half = duration(c.run.contact(c.contact), c.pulse, 0.5)
    return Measured(2.0 * half.value, half.reason)


def core_compliance(c: Loaded) -> float:
    """Central sink of two cores under the coating's Hertz pressure, over the approach: 1.5 F/(E'_core r δ).

    The centre of a half-space under a Hertz pressure sinks by 3F(1 − ν²)/(4 E r) (Johnson 1985, Eq. 3.42a).
    """
    core = c.bead.core
    plane = core.modulus_Pa / (1.0 - core.poisson**2)
    return 1.5 * c.force / (plane * c.radius * c.depth)


def half_space_correction(x: float, bead: Bead) -> float:
    """Force on a layer bonded to its core over that on a half-space of it at the same depth.

    Exact contact (`sonicvacuum.physics.layered`); x = √(R* × approach) over the layer's thickness.
    """
    layer, core = (m.modulus_Pa / (1.0 - m.poisson**2) for m in (bead.surface, bead.core))
    deep, a = layer_law.coefficients(bead.surface.poisson, np.array([layer / core]), bead.core.poisson)
    return float(layer_law.factor(x, deep[0], a[0]))


def thin_layer_force(c: Loaded) -> float:
    """Force in N of two thin bonded layers at the contact's approach, π R* E_c δ²/(2D)."""
    radius = c.run.reduced_radius(c.contact)
    return math.pi * radius * c.confined_modulus * c.depth**2 / (2.0 * c.bead.coating_m)
