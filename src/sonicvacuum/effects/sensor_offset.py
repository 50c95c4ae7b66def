"""The gauge is not in the middle of its bead and reads its two contacts with unequal weights."""

from dataclasses import replace

import numpy as np

from sonicvacuum.effects.base import Effect, Parameter, Setup, change_sensors, plain


def change(setup: Setup, offset_fraction, sensor) -> Setup:
    """Shift the gauge of one bead towards the contact before it (positive) or behind it."""

    def shifted(index, one):
        if one.kind != "embedded":
            return one
        shift = np.where(np.equal(sensor, index), offset_fraction, 0.0)
        return replace(one, offset_fraction=plain(one.offset_fraction + shift))

    return change_sensors(setup, shifted)


def embedded(setup: Setup) -> tuple[int, ...]:
    """Sensors inside beads."""
    return tuple(k for k, s in enumerate(setup.sensors) if s.kind == "embedded")


EFFECT = Effect(
    id="sensor-offset",
    title="Gauge off centre",
    missing="the gauge is not in the middle of its bead",
    equation="y = (1/2 + e) F_before + (1/2 - e) F_after",
    energy="none: the chain is not touched",
    reference="Daraio & Nesterenko, Phys. Rev. E 73, 026612 (2006), Experiments: gauges placed to 1 mm; "
    "chosen here: weights linear in the place; a rigid ball cut there would have 3 e/2 - 2 e^3 for e, by "
    "the masses of its parts",
    parameters=(
        Parameter(
            "offset_fraction", "1", 0.0, -0.5, 0.5, "normal", 0.2, "shift over the bead's diameter", -0.5, 0.5
        ),
    ),
    places="sensor",
    choices=embedded,
    signature="one gauge early (positive) or late, at every speed in proportion: by e times the transit "
    "time of a bead on average over the pulse, its peak by two to three times that and a little higher",
    when_to_use="gauges glued between halves of beads; a speed that differs between pairs of gauges",
    when_not="a wall sensor; a delay common to all sensors of a run is the trigger",
    dissipative=False,
    change=change,
)
