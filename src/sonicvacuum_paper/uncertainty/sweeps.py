"""What a few striker speeds give together in each draw: speed at 0.25 N, slope, distance from Eq. (7)."""

from collections.abc import Sequence

import numpy as np

from sonicvacuum.card import Card
from sonicvacuum.observe.sweep import loglog_slope, speed_at_amplitude
from sonicvacuum.physics import theory
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.sweep import COATED_RANGE
from sonicvacuum_paper.uncertainty.reading import BETWEEN, Values

# m/s; from below 0.25 N to about 3 N at the gauges.
SPEEDS = (0.03, 0.06, 0.11, 0.2, 0.36)
SPEED, READING, FORCE, STATIC = (
    (quantity, BETWEEN) for quantity in ("speed", "reading", "peak_force", "static")
)


def low_speed(points: Sequence[Values]) -> np.ndarray:
    """(draws,) speed where g9 reads 0.25 N."""
    readings, speeds = _stacked(points, ("amplitude", "g9")), _stacked(points, SPEED)
    return np.array(
        [speed_at_amplitude(PRINTED.amplitude_low, r, v).value for r, v in zip(readings, speeds, strict=True)]
    )


def of_points(card: Card, points: Sequence[Values]) -> Values:
    """Slope of speed on reading, and root mean square deviation from Eq. (7); as in `sweep`."""
    speed, read, force, static = (_stacked(points, key) for key in (SPEED, READING, FORCE, STATIC))
    coated = card.bead.coating_m is not None
    low, high = COATED_RANGE if coated else (0.0, np.inf)
    # The gauges' gain blurs the ends of the range.
    inside = (read >= 0.8 * low) & (read <= high)
    if coated:
        peak, modulus, name = read + static, PRINTED.modulus_matched, "curve_deviation"
    else:
        peak, modulus, name = force, card.bead.surface.modulus_Pa, "theory_deviation"
    bead = card.bead
    beads = (modulus, bead.surface.poisson, bead.diameter_m, bead.mass_kg)
    off = speed / theory.speed_with_precompression(peak, static, *beads) - 1.0
    off = np.where(inside, off, np.nan)
    slopes = [loglog_slope(r[k], v[k]).value for r, v, k in zip(read, speed, inside, strict=True)]
    return {("speed_slope", ""): np.array(slopes), (name, ""): np.sqrt(np.nanmean(off**2, axis=1))}


def _stacked(points, key):
    """(draws, speeds) of one quantity."""
    return np.stack([point[key] for point in points], axis=1)
