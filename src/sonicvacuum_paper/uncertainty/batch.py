"""One card with drawn numbers: its chains side by side, one lane a draw, and what the gauges read of them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from sonicvacuum.card import Card
from sonicvacuum.effects import Setup
from sonicvacuum.forward import Seen, see
from sonicvacuum.gauges import Gauge
from sonicvacuum.observe import quantities
from sonicvacuum.observe.run import Geometry, Run
from sonicvacuum.observe.trace import Measured
from sonicvacuum.physics.assemble import assemble
from sonicvacuum.simulation import sensors
from sonicvacuum_paper.one_run import LOWER, UPPER
from sonicvacuum_paper.uncertainty.formats import LAYER, LOSS
from sonicvacuum_paper.uncertainty.layer_viscosity import WITH_LAYER

Draws = Mapping[str, np.ndarray]
GRAM = 1e-3
INTERVAL = 1e-6  # s; peaks are found between samples to a hundredth of it


def set_up(card: Card, draws: Draws, speed=None, loss_us=None) -> Setup:
    """The chains and gauges of a card, lane k with the numbers of draw k.

    Args:
        card: one case of one model.
        draws: from `inputs.draws`.
        speed: of the striker in m/s, a number or one for each draw, before its own error; None: the card's.
        loss_us: time of the loss in us, a number or one for each draw; None: the card's.
    """
    count = len(draws["speed"])
    speed = card.striker.speeds_m_s[0] if speed is None else speed
    chain = assemble(card.specimen, card.strikers(np.broadcast_to(speed, count) * draws["speed"]))
    mass = draws["bead_mass"] * 0.01 * GRAM
    chain = replace(
        chain,
        striker_mass=chain.striker_mass + draws["striker_mass"] * last_digit(card.striker.mass_kg),
        gravity=chain.gravity * draws["weight"],
        bodies=chain.bodies.replaced(lambda body: replace(body, mass=body.mass + mass)),
    )
    for material in ("parylene-c", "stainless-steel", "alumina"):
        chain = chain.stiffened(material, draws[material])
    setup = Setup(chain, _gauges(card, draws))
    for name, parameters in card.effects.items():
        setup = WITH_LAYER.effect(name).apply(setup, **_drawn(name, parameters, draws, loss_us))
    return setup


def last_digit(mass: float) -> float:
    """Unit of the last digit, kg, of a mass printed in grams: 0.01 g or 0.001 g."""
    hundredths = mass / GRAM * 100.0
    return (0.01 if abs(hundredths - round(hundredths)) < 1e-6 else 0.001) * GRAM


def _drawn(name, parameters, draws, loss_us):
    if name == LAYER:
        return {"layer_thickness_um": parameters["layer_thickness_um"] * draws["thickness"]}
    if name == LOSS and loss_us is not None:
        return {"time_us": loss_us}
    return parameters


def _gauges(card, draws):
    """The card's gauges with drawn gains and discharge; virtual ideal ones where it has none."""
    found = []
    for gauge in sensors(card):
        own = draws.get(f"gain_{gauge.id}", 1.0)
        droop = gauge.droop_s * draws["droop"]
        found.append(replace(gauge, droop_s=droop, gain=draws["gain"] * own))
    if all(gauge.kind == "wall" for gauge in found):
        found += [Gauge(f"g{k}", "embedded", card.beads + 1 - k) for k in (UPPER, LOWER)]
    return tuple(found)


@dataclass(frozen=True, eq=False)
class Batch:
    """The lanes of one card, simulated; what it says of gauges is in the words of `one_run.OneRun`."""

    card: Card
    seen: Seen

    @classmethod
    def of(cls, card: Card, setup: Setup, duration: float) -> "Batch":
        """Simulate `duration` seconds."""
        beads, (upper, lower) = card.beads, (card.beads + 1 - k for k in (UPPER, LOWER))
        # All contacts between the gauges, for what single contacts bear.
        besides = tuple(Gauge(f"b{b}", "embedded", b) for b in range(upper, lower + 1) if b <= beads)
        return cls(card, see(setup, duration, INTERVAL, besides=besides))

    @property
    def lanes(self) -> int:
        """Number of chains."""
        return self.seen.setup.chain.lanes

    @cached_property
    def _runs(self):
        """Pulses of all lanes are found side by side."""
        from sonicvacuum.forward.together import runs_of  # and with it compiled code, as in `forward.see`

        geometry = Geometry(self.card.beads, self.card.specimen.diameters, self.seen.setup.sensors)
        return runs_of(self.seen.readings, self.seen.history.time, geometry)

    def lane(self, lane: int) -> "Lane":
        """One of the chains."""
        return Lane(self.card, self._runs[lane])


@dataclass(frozen=True, eq=False)
class Lane:
    """One chain of a batch, as far as `gauges` and `trains` ask a run."""

    card: Card
    view: Run

    @property
    def diameter(self) -> float:
        """Outer diameter of the first bead in m."""
        return self.card.bead.diameter_m

    @cached_property
    def gauges(self) -> dict[str, Gauge]:
        """Gauge by its name."""
        return {s.id: s for s in self.view.geometry.sensors}

    def speed(self) -> Measured:
        """Speed in m/s between the two embedded gauges."""
        return quantities.speed(self.view, f"g{UPPER}", f"g{LOWER}")
