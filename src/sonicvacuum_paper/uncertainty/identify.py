"""Which modulus, thickness and loss of the coating the printed numbers of the text allow.

The bonded layer with a Kuwabara–Kono loss, on a grid of the three; a thickness of several contact radii is
Hertz. Three printed numbers, 197 m/s, 130 m/s at 0.25 N and 130 µs, and a reading of Fig. 7, that about 3 N
is the largest force. Both speeds share the error of the gauges' distance. Normal errors, flat in the
logarithms of all three: what is drawn is how probable a pair is when the third is anything.
"""

from itertools import product

import numpy as np
import pandas as pd
from scipy.interpolate import RegularGridInterpolator
from scipy.special import log_ndtr

from sonicvacuum.card import Card
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.uncertainty import inputs, reading, sweeps
from sonicvacuum_paper.uncertainty.batch import LAYER, Batch, set_up
from sonicvacuum_paper.uncertainty.formats import MAP
from sonicvacuum_paper.verdict import BOUND

AXES = {
    "modulus_GPa": np.geomspace(1.4, 24.0, 9),
    "thickness_um": np.geomspace(20.0, 400.0, 8),
    "loss_us": np.geomspace(0.3, 15.0, 8),
}
FINE = 41
PAIRS = (("modulus_GPa", "thickness_um"), ("modulus_GPa", "loss_us"), ("thickness_um", "loss_us"))
# Relative standard errors: of the shared distance, of each speed besides, of the duration; and 3 N ± 0.5 N.
SHARED, HIGH, LOW, LASTING = PRINTED.speed_error / BOUND, 0.01, 0.04, 14.0 / 130.0
FORCE = (3.0, 0.5)
# A tail that never falls to the level.
ENDLESS = 1000.0  # us
# A pulse that is too weak to travel, or never so weak.
STANDING = 1.0  # m/s
RECORD = 1.2e-3  # s; the reflection is back at the gauges by then but for the softest


def table(card: Card) -> pd.DataFrame:
    """For each pair of axes the content of the smallest region that holds a point: 0 is the most probable.

    Args:
        card: fig3a as a layer with a loss.
    """
    fine, density = likelihood(card)
    found = []
    for pair in PAIRS:
        kept = [list(AXES).index(name) for name in pair]
        (dropped,) = {0, 1, 2} - set(kept)
        content = contained(density.sum(axis=dropped))
        places = product(range(FINE), range(FINE))
        found += [(*pair, fine[kept[0]][i], fine[kept[1]][j], content[i, j]) for i, j in places]
    return pd.DataFrame(found, columns=MAP)


def likelihood(card: Card) -> tuple[list[np.ndarray], np.ndarray]:
    """The three fine axes, and the likelihood of the printed numbers on them, 1 where it is highest."""
    fine = [np.geomspace(axis[0], axis[-1], FINE) for axis in AXES.values()]
    return fine, np.exp(_log_likelihood(_refined(observed(card), fine)))


def observed(card: Card) -> np.ndarray:
    """(4, …axes) logarithms of speed, speed at 0.25 N and duration, and the force, at the grid's points."""
    points = np.array(list(product(*AXES.values()))).T
    draws = inputs.neutral(points.shape[1])
    draws["parylene-c"] = points[0] / (card.bead.surface.modulus_Pa / 1e9)
    draws["thickness"] = points[1] / card.effects[LAYER]["layer_thickness_um"]

    def batch(speed=None):
        return Batch.of(card, set_up(card, draws, speed, points[2]), RECORD)

    strong = batch()
    lasts = reading.of_lanes(strong, (("duration_02", "g9"),), draws)["duration_02", "g9"]
    high = reading.of_peaks(strong, draws)
    low = sweeps.low_speed([reading.of_peaks(batch(v), draws) for v in (0.03, 0.08)] + [high])
    lasts, low = np.where(np.isfinite(lasts), lasts, ENDLESS), np.where(np.isfinite(low), low, STANDING)
    speed = np.where(np.isfinite(high[sweeps.SPEED]), high[sweeps.SPEED], STANDING)
    rows = [np.log(speed), np.log(low), np.log(lasts), high["amplitude", "g9"]]
    return np.array(rows).reshape(4, *map(len, AXES.values()))


def _refined(seen, fine):
    """The same on a finer grid, linear in the logarithms."""
    coarse = tuple(np.log(axis) for axis in AXES.values())
    points = np.stack(np.meshgrid(*map(np.log, fine), indexing="ij"), axis=-1)
    return np.array([RegularGridInterpolator(coarse, rows)(points) for rows in seen])


def _log_likelihood(seen):
    """Log likelihood of the printed numbers, up to a constant."""
    speeds = np.log([PRINTED.speed_coated, PRINTED.speed_low])
    off = np.moveaxis(seen[:2], 0, -1) - speeds
    inverse = np.linalg.inv(np.diag([HIGH**2, LOW**2]) + SHARED**2)
    apart = np.einsum("...i,ij,...j->...", off, inverse, off)
    lasting = (seen[2] - np.log(1e6 * PRINTED.duration_coated)) / LASTING
    found = -0.5 * (apart + lasting**2) + log_ndtr((FORCE[0] - seen[3]) / FORCE[1])
    found = np.where(np.isfinite(found), found, -np.inf)
    return found - found.max()


def contained(density: np.ndarray) -> np.ndarray:
    """Probability of all that is at least as probable as a point; contours at 0.68 and 0.95 hold so much."""
    order = np.argsort(-density, axis=None, kind="stable")
    summed = np.cumsum(density.ravel()[order]) / density.sum()
    found = np.empty(density.size)
    found[order] = summed
    return found.reshape(density.shape)
