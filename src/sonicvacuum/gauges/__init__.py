"""Gauges: what reads a chain, one file a kind.

A gauge has a name, a kind, a place, electronics (bandwidth, droop, gain) and errors (`Gauge`, the one type
that cards, records, `observe` and `discover` share). A kind says what the gauge feels of the motion, in which
unit, where it sits and what a simulation has to record for it (`Kind`). The electronics are the same for all
kinds and act in one order: change from rest, then bandwidth and droop, then gain.

    from sonicvacuum.gauges import Gauge, needed, reading

    laser = Gauge(id="laser", kind="velocity", bead=9, lowpass_s=1e-6)
    contacts, bodies = needed([laser], beads=21)
    history = simulate(chain, contacts, 6e-4, 1e-6, bodies=bodies)
    trace = reading(laser, history, beads=21)                    # (S, lanes) m/s

Adding a kind: one file, one line. Suppose a gauge that reads the velocity of the striker. Write
`striker_velocity.py`:

    from sonicvacuum.gauges.base import Kind
    from sonicvacuum.laboratory.bodies import to_wall

    def feel(gauge, motion, beads):            # (S, lanes) from what was recorded, change from rest
        return motion.velocity_of(0) - motion.velocity_of(0)[0]

    KIND = Kind(
        id="striker-velocity", title="Velocity of the striker", unit="m/s", suffix="m_s", in_bead=False,
        feel=feel, bodies=lambda gauge, beads: (0,),
        distance=lambda gauge, beads, diameter: to_wall(diameter, 1, beads),      # where the pulse begins
    )

then add `striker_velocity` to the import and to `KINDS` below. `kind: striker-velocity` is then valid in
config.yaml and in records, its noise under `sigma_m_s`; simulation, discovery, tables and figures follow.
"""

from sonicvacuum.gauges import acceleration, embedded, velocity, wall
from sonicvacuum.gauges.base import (
    KINDS,
    Gauge,
    Kind,
    Motion,
    contacts_of,
    needed,
    position,
    reading,
)

KINDS |= {module.KIND.id: module.KIND for module in (embedded, wall, velocity, acceleration)}

__all__ = ["KINDS", "Gauge", "Kind", "Motion", "contacts_of", "needed", "position", "reading"]
