"""A force gauge behind the last contact: what the wall bears."""

import numpy as np

from sonicvacuum.gauges.base import Kind


def contacts(gauge, beads: int) -> tuple[int, ...]:
    """The last contact."""
    return (beads,)


def feel(gauge, motion, beads: int) -> np.ndarray:
    """(S, ...) force of the last contact in N."""
    return np.asarray(motion.of(beads))


def distance(gauge, beads: int, diameter) -> float:
    """It sits at the wall."""
    return 0.0


KIND = Kind(
    id="wall",
    title="Force at the wall",
    unit="N",
    suffix="N",
    in_bead=False,
    feel=feel,
    distance=distance,
    contacts=contacts,
)
