"""A laser vibrometer on a bead: the bead's velocity, positive towards the wall."""

import numpy as np

from sonicvacuum.gauges.base import Kind
from sonicvacuum.gauges.embedded import distance


def bodies(gauge, beads: int) -> tuple[int, ...]:
    """The bead; bodies are counted from the striker, which is 0."""
    return (gauge.bead,)


def feel(gauge, motion, beads: int) -> np.ndarray:
    """(S, ...) velocity of the bead in m/s."""
    return np.asarray(motion.velocity_of(gauge.bead))


KIND = Kind(
    id="velocity",
    title="Velocity of a bead",
    unit="m/s",
    suffix="m_s",
    in_bead=True,
    feel=feel,
    distance=distance,
    bodies=bodies,
    echo=-1.0,
)
