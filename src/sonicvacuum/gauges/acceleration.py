"""An accelerometer on a bead: the bead's acceleration, positive towards the wall.

It is the sum of all forces on the bead at that moment over its mass, as the engine has them: contacts, drag
and friction, with the change of mass that an effect makes. Nothing is differentiated. A pulse shows as a
positive lobe and a negative one of the same area.
"""

import numpy as np

from sonicvacuum.gauges.base import Kind
from sonicvacuum.gauges.embedded import distance
from sonicvacuum.gauges.velocity import bodies


def feel(gauge, motion, beads: int) -> np.ndarray:
    """(S, ...) acceleration of the bead in m/s²."""
    return np.asarray(motion.acceleration_of(gauge.bead))


KIND = Kind(
    id="acceleration",
    title="Acceleration of a bead",
    unit="m/s2",
    suffix="m_s2",
    in_bead=True,
    feel=feel,
    distance=distance,
    bodies=bodies,
    echo=-1.0,
)
