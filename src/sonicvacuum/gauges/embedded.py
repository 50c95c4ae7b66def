"""A piezoelectric gauge inside a bead: the mean of the two contact forces on it.

Daraio & Nesterenko, PRE 73, 026612 (2006), Experiments: the gauge is glued between two halves of a bead. Off
the middle it weighs the nearer contact more, linearly in its place.
"""

import numpy as np

from sonicvacuum.gauges.base import Kind
from sonicvacuum.laboratory.bodies import to_wall


def contacts(gauge, beads: int) -> tuple[int, ...]:
    """The contacts before and behind the bead."""
    return (gauge.bead - 1, gauge.bead)


def feel(gauge, motion, beads: int) -> np.ndarray:
    """(S, ...) N: (½ + ε) F_before + (½ − ε) F_after."""
    before, behind = (np.asarray(motion.of(c)) for c in contacts(gauge, beads))
    felt = (0.5 + gauge.offset_fraction) * before
    felt += (0.5 - gauge.offset_fraction) * behind
    return felt


def distance(gauge, beads: int, diameter) -> float:
    """From the wall to the bead's centre in m."""
    return to_wall(diameter, gauge.bead, beads)


KIND = Kind(
    id="embedded",
    title="Force in a bead",
    unit="N",
    suffix="N",
    in_bead=True,
    feel=feel,
    distance=distance,
    contacts=contacts,
    offsets=True,
)
