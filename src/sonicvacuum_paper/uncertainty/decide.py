"""Which one experiment on this chain would tell the layer with a loss from Hertz at 15 GPa with a loss.

Three series are simulated under both: coatings of other thickness on the same balls, a static force on the
chain, and strikers of other speed. What is measured: speed between the gauges, duration at half height and
decay from one gauge to the other. Each model may be fitted anew: its free numbers have the spread that is
written in `FREE`, and the separation is that of the closest pair, linear in these.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from msgspec.structs import replace

from sonicvacuum.card import Card
from sonicvacuum.physics.theory import bead_mass
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.uncertainty import inputs, reading
from sonicvacuum_paper.uncertainty.batch import LOSS, Batch, set_up
from sonicvacuum_paper.uncertainty.formats import EXPERIMENTS, MODELS
from sonicvacuum_paper.verdict import BOUND

MEASURED = (("speed", reading.BETWEEN), ("duration_half", "g9"), ("decay", reading.BETWEEN))
# Relative standard errors: of what a chain's gauges share (distance; nothing; gain), and of one measurement.
SHARED, OWN = (PRINTED.speed_error / BOUND, 0.0, 0.04), (0.01, 0.03, 0.02)
# Spread of what a fit may change: Hertz has lost its handbook and takes any modulus.
FREE = {
    "layer_loss": {"parylene-c": 0.05, "thickness": 0.1, "loss": 0.5},
    "matched_loss": {"parylene-c": 1.0, "loss": 1.0},
}
STEP = 0.05
MICRO = 1e-6


@dataclass(frozen=True)
class Series:
    """One experiment: what is changed, to which values; `anew` where each value needs beads of its own."""

    name: str
    unit: str
    values: tuple[float, ...]
    anew: bool = False


SERIES = (
    Series("thickness of the coating", "um", (25.0, 50.0, 100.0, 200.0), anew=True),
    Series("static force", "N", (0.0, 1.0, 5.0, 20.0)),
    Series("speed of the striker", "m/s", (0.03, 0.1, 0.3, 1.0)),
)
RECORD = 2.0e-3


def table(cards: Mapping[str, Card]) -> pd.DataFrame:
    """Every point of every series under both models, with the separation of its series in standard errors.

    Args:
        cards: model → fig3a under it.
    """
    found = []
    for series in SERIES:
        seen = {model: _measured(cards[model], series, FREE[model]) for model in MODELS}
        apart = [separation(seen, series, kept) for kept in ((0,), (0, 1, 2))]
        for model, (values, _) in seen.items():
            for at, point in zip(series.values, np.exp(values), strict=True):
                found.append((series.name, series.unit, at, model, *point, *apart))
    return pd.DataFrame(found, columns=EXPERIMENTS)


def separation(seen, series: Series, kept) -> float:
    """Standard errors between the models by the measurements `kept`, both fitted anew as well as can be."""
    points = len(series.values)
    own = np.diag(np.tile(np.square(OWN), points))
    alike = np.eye(points) if series.anew else np.ones((points, points))
    spread = own + np.kron(alike, np.diag(np.square(SHARED)))
    for model, (_, slopes) in seen.items():
        for slope, width in zip(slopes, FREE[model].values(), strict=True):
            spread = spread + width**2 * np.outer(slope, slope)
    one, other = (values.ravel() for values, _ in seen.values())
    which = [p * len(MEASURED) + k for p in range(points) for k in kept]
    off = (one - other)[which]
    return float(np.sqrt(off @ np.linalg.solve(spread[np.ix_(which, which)], off)))


def _measured(card: Card, series: Series, free):
    """(points, 3) logarithms of what is measured; their slopes on the free numbers, one (points·3,) each."""
    values, slopes = [], []
    for at in series.values:
        rows = _at(card, series, at, tuple(free))
        values.append(rows[0])
        slopes.append((rows[1:] - rows[0]) / STEP)
    return np.array(values), list(np.array(slopes).transpose(1, 0, 2).reshape(len(free), -1))


def _at(card, series, at, free):
    """(1 + free numbers, 3) logarithms: as it is, then each free number larger by STEP."""
    draws = inputs.neutral(1 + len(free))
    loss = np.full(1 + len(free), card.effects[LOSS]["time_us"])
    for place, name in enumerate(free, 1):
        changed = loss if name == "loss" else draws[name]
        changed[place] *= np.exp(STEP)
    speed = at if series.unit == "m/s" else None
    if series.unit == "um":
        card, draws["thickness"] = (
            _coated(card, at * MICRO),
            draws["thickness"] * at * MICRO / PRINTED.coating,
        )
    if series.unit == "N":
        card = replace(card, static_force_N=at)
    batch = Batch.of(card, set_up(card, draws, speed, loss), RECORD)
    found = reading.of_lanes(batch, MEASURED, draws)
    return np.log(np.stack([found[key] for key in MEASURED], axis=1))


def _coated(card, thickness):
    """The card with beads of the same core under a coating of another thickness."""
    core, density = PRINTED.core_diameter / 2.0, PRINTED.coating_density
    shell, own = (bead_mass(core, t, density, density) for t in (thickness, PRINTED.coating))
    mass = card.bead.mass_kg + float(shell - own)
    bead = replace(card.bead, diameter_m=2.0 * (core + thickness), coating_m=thickness, mass_kg=mass)
    return replace(card, bead=bead)
