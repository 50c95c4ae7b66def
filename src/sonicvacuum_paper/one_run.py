"""One run of a simulated card, as the gauges of the paper see it and as virtual ones would.

A virtual gauge may sit in any bead; it has neither mass nor electronics. The paper counts beads from the
bottom: g<k> is the gauge in the k-th bead above the wall.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from sonicvacuum.gauges import Gauge, contacts_of, reading
from sonicvacuum.gauges.base import Recorded
from sonicvacuum.observe import quantities
from sonicvacuum.observe.run import Geometry, Run
from sonicvacuum.observe.trace import Measured, Trace
from sonicvacuum.physics.touching import touched
from sonicvacuum.simulation import Simulation

# Gauges of the paper, counted from the bottom; virtual ones take their place in chains without.
UPPER, LOWER = 9, 5


@dataclass(frozen=True, eq=False)
class OneRun:
    """One lane of a simulation, with the chosen step or half of it."""

    simulation: Simulation
    lane: int = 0
    refined: bool = False
    _contacts: dict = field(default_factory=dict, repr=False)

    @property
    def card(self):
        """The simulated card."""
        return self.simulation.card

    @property
    def diameter(self) -> float:
        """Outer diameter of the first bead in m."""
        return self.card.bead.diameter_m

    @cached_property
    def gauges(self) -> tuple[Gauge, ...]:
        """The gauges reported on, from the striker to the wall: the card's own, with its effects on gauges.

        Where they sit in fewer than two beads, virtual ones are put into those of g9 and g5.
        """
        found = list(self.simulation.sensors)
        if not any(s.kind == "wall" for s in found):
            found.append(Gauge(id=_free("wall", found), kind="wall", bead=None))
        taken = {s.bead for s in found if s.kind == "embedded"}
        if len(taken) < 2 and self.card.beads >= UPPER:
            places = {f"g{k}": self.card.beads + 1 - k for k in (UPPER, LOWER)}
            found += [
                replace(self._virtual(bead), id=_free(name, found))
                for name, bead in places.items()
                if bead not in taken
            ]
        return tuple(sorted(found, key=lambda s: (s.kind == "wall", s.bead or 0)))

    @cached_property
    def embedded(self) -> tuple[Gauge, ...]:
        """Those of the gauges that sit in beads."""
        return tuple(s for s in self.gauges if s.kind == "embedded")

    @cached_property
    def wall(self) -> Gauge:
        """The gauge at the wall."""
        return next(s for s in self.gauges if s.kind == "wall")

    @property
    def span(self) -> tuple[Gauge, Gauge] | None:
        """First and last embedded gauge, which bound speeds and contacts; None in a short chain."""
        return (self.embedded[0], self.embedded[-1]) if len(self.embedded) >= 2 else None

    def bead(self, bead: int) -> str | None:
        """Id of the virtual gauge in a bead; None where there is none or its contacts were not kept."""
        return f"bead {bead}" if f"bead {bead}" in self.view.readings else None

    @cached_property
    def view(self) -> Run:
        """Readings of all gauges, reported and virtual, in which pulses are found once."""
        beads = self.card.beads
        inner = [self._virtual(b) for b in range(1, beads + 1)]
        kept = [s for s in inner if set(contacts_of(s, beads)) <= set(self.simulation.contacts)]
        placed = (*self.gauges, *kept)
        recorded = self._recorded
        readings = {s.id: reading(s, recorded, beads) for s in placed}
        return Run(readings, self.simulation.time, Geometry(beads, self.card.specimen.diameters, placed))

    @property
    def _recorded(self):
        """What was recorded of this lane."""
        found = self.simulation.recorded(self.refined)
        forces = {c: self.contact(c).force for c in self.simulation.contacts}
        moved = [{b: m[:, self.lane] for b, m in one.items()} for one in (found.velocity, found.acceleration)]
        return Recorded(self.simulation.time, forces, *moved)

    def speed(self) -> Measured:
        """Speed in m/s between the first and the last embedded gauge."""
        if self.span is None:
            return Measured(float("nan"), "absent: the chain has fewer than two embedded gauges")
        return quantities.speed(self.view, *(s.id for s in self.span))

    def contact(self, contact: int) -> Trace:
        """Force of one contact without the static part."""
        if contact not in self._contacts:
            force = self.simulation.force_of(contact, self.refined)[:, self.lane]
            self._contacts[contact] = Trace(0.0, self.simulation.interval, np.ascontiguousarray(force))
        return self._contacts[contact]

    def static_force(self, contact: int) -> float:
        """Force in N at rest."""
        return float(self._at_rest[0][contact])

    def depth_at(self, contact: int, force: np.ndarray) -> np.ndarray:
        """(n,) compression in m of a contact that bears `force` (n,) in N, by the law of the run."""
        chain = self.simulation.chain.take(np.array([self.lane]))
        return chain.depth_at(contact, np.asarray(force)[:, None])[:, 0]

    def touched(self, contact: int, depth: float) -> tuple[float, float]:
        """Radius in m of what a contact touches at an approach in m, and central over mean pressure."""
        chain = self.simulation.chain.take(np.array([self.lane]))
        radius, concentration = touched(chain, contact, np.array([[depth]]))
        return float(radius[0, 0]), float(concentration[0, 0])

    def stiffness(self, contact: int) -> float:
        """Hertz constant in N/m^(3/2)."""
        return float(self._at_rest[2][contact])

    def reduced_radius(self, contact: int) -> float:
        """Effective radius in m."""
        return float(self._at_rest[1][contact])

    @cached_property
    def _at_rest(self):
        chain, bodies = self.simulation.chain, self.card.beads + 1
        tables = chain.static_forces(bodies), chain.reduced_radii(bodies), chain.stiffnesses(bodies)
        return [np.broadcast_to(t, (bodies, chain.lanes))[:, self.lane] for t in tables]

    def contacts_between_gauges(self) -> range:
        """Contacts between the first and the last embedded gauge."""
        upper, lower = self.span
        return range(upper.bead, lower.bead)

    @staticmethod
    def _virtual(bead):
        return Gauge(id=f"bead {bead}", kind="embedded", bead=bead)


def _free(name, gauges):
    """A name for a virtual gauge that no gauge of the card has."""
    return name if all(g.id != name for g in gauges) else _free(f"{name}_virtual", gauges)
