"""What one contact bears: compression, radius and pressure of the touching area, rate of strain.

The force is the whole one, static part included; compression, radius and the pressure's shape are those of
the law in force (`physics.chain.Chain.depth_at`, `physics.touching.touched`), else Hertz's.
Daraio & Nesterenko, PRE 73, 026612 (2006) take the bead's
core as rigid, so that the compression of a contact is that of its coatings.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from sonicvacuum.observe.trace import Measured, Trace, missing

# What one ball on a wall can tell: quantities of the contact that the striker makes.
BALL_QUANTITIES = ("restitution", "contact_duration")


def max_compression(force_peak: ArrayLike, chain, contact: int) -> np.ndarray:
    """Compression in m at the force peak in N (any shape), by the law in force.

    `chain` is of one lane and has `depth_at`, as `physics.chain.Chain` has.
    """
    force = np.asarray(force_peak, dtype=float)
    return chain.depth_at(contact, force.reshape(-1, 1)).reshape(force.shape)


def contact_radius(compression: ArrayLike, reduced_radius: float, wider: ArrayLike = 1.0) -> np.ndarray:
    """Radius in m of the touching area: √(R* δ) (Johnson, Contact Mechanics, 1985, Eq. 4.22 and 4.23).

    `wider` is what the law in force multiplies it by (`physics.touching.relative`).
    """
    return np.sqrt(reduced_radius * np.maximum(compression, 0.0)) * wider


def mean_pressure(force: ArrayLike, radius: ArrayLike) -> np.ndarray:
    """Mean pressure in Pa on the touching area: F/(π a²)."""
    return np.asarray(force) / (math.pi * np.square(radius))


def peak_pressure(force: ArrayLike, radius: ArrayLike, concentration: ArrayLike = 1.5) -> np.ndarray:
    """Pressure in Pa at the centre of the touching area: 3/2 of the mean by Hertz (Johnson 1985, Eq. 4.24).

    `concentration` is that ratio by the law in force (`physics.touching.relative`).
    """
    return np.asarray(concentration) * mean_pressure(force, radius)


def strain_rate(compression_rate: ArrayLike, coating: float, coatings: int = 2) -> np.ndarray:
    """Nominal strain rate in 1/s of the coatings of a contact.

    The paper gives an interval (10²–10³ 1/s) and no definition. Here: the cores are rigid, so the compression
    δ is shared equally by the `coatings` layers (2 between beads, 1 on a bare wall) of thickness h =
    `coating` (m). Between beads the strain of each is δ/(2h) and its rate |dδ/dt|/(2h): a mean through the
    thickness, not the local rate.
    """
    return np.abs(compression_rate) / (coatings * coating)


def contact_duration(time: np.ndarray, force: np.ndarray) -> Measured:
    """Time in s for which a contact first bears force, from its force in N (S,) at equidistant times (S,).

    Between samples the ends follow from F^{2/3}, linear in time where a Hertz contact closes or opens at a
    finite speed; other laws are located to within one interval.

    Raises:
        ValueError: as `Trace.of`.
    """
    trace = Trace.of(time, force)
    borne = trace.force > 0.0
    if not borne.any():
        return missing("absent: the contact never bears force")
    first = int(borne.argmax())
    last = first + int((~borne[first:]).argmax()) - 1
    if last < first:
        return missing("truncated: the record ends before the contact opens")
    depth = np.cbrt(np.square(np.maximum(trace.force, 0.0)))
    opened = last + _overhang(depth, last, -1)
    closed = first - _overhang(depth, first, 1) if first > 0 else 0.0
    return Measured(trace.interval * (opened - closed))


def restitution(
    time: np.ndarray, force: np.ndarray, mass: float, speed: float, gravity: float = 0.0
) -> Measured:
    """Rebound speed over impact speed of the striker, from the impulse that it has received at last opening.

    Args:
        time: (S,) equidistant times in s from the moment of impact.
        force: (S,) on the striker in N.
        mass, speed: of the striker in kg and m/s, at impact.
        gravity: acceleration along the chain in m/s².

    Returns:
        The ratio, negative for a striker that follows the beads; NaN where its contact has not opened yet.

    Raises:
        ValueError: for a mass or speed that is not positive.
    """
    if not (mass > 0.0 and speed > 0.0):
        raise ValueError(f"mass {mass} kg and impact speed {speed} m/s must be positive")
    borne = np.flatnonzero(force > 0.0)
    if not len(borne):
        return missing("absent: the striker's contact never bears force")
    if borne[-1] == len(force) - 1:
        return missing("truncated: the record ends before the striker's contact opens")
    impulse = np.trapezoid(force, time) / mass
    return Measured(float((impulse - gravity * time[borne[-1] + 1] - speed) / speed))


def _overhang(depth, edge, inward):
    """Samples (at most 1) from `edge` outward to the zero of the line through it and its inner neighbour."""
    step = depth[edge + inward] - depth[edge] if 0 <= edge + inward < len(depth) else 0.0
    return float(min(1.0, depth[edge] / step)) if step > 0.0 else 1.0
