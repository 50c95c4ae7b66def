"""Whether relaxation of the polymer alone could turn a static modulus into 15 GPa at the rate of impact.

Causality ties stiffening to loss (Kramers–Kronig; Booij & Thoone, Rheol. Acta 21, 15 (1982)): the loss
tangent is about (π/2) d ln E/d ln ω. Spread evenly over the decades between a static test and the impact, a
ratio r means one loss tangent everywhere; crowded into one relaxation time (standard linear solid) it may be
hidden between the two. Both are put into the Hertz chain of Fig. 3a: the first as the Kuwabara–Kono loss of
that loss tangent at the pulse's own frequency, the second as it is.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from msgspec.structs import replace

from sonicvacuum.card import Card
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.uncertainty import inputs, reading, sweeps
from sonicvacuum_paper.uncertainty.batch import LOSS, Batch, set_up
from sonicvacuum_paper.uncertainty.formats import BROAD, RELAXATION, SINGLE

# 1/s: a tensile or membrane test, not stated in the paper; the impact, as printed.
STATIC_RATE, IMPACT_RATES = 1e-3, (1e2, 1e3)
RELAXATION_US = (10.0, 30.0, 60.0, 100.0, 170.0, 300.0, 1e3, 1e4)
MEASURED = (
    ("speed", reading.BETWEEN),
    ("amplitude", "g9"),
    ("decay", reading.BETWEEN),
    ("duration_half", "g9"),
    ("duration_02", "g9"),
)
# Strikers among which g9 reads 0.25 N, m/s.
GENTLE = (0.03, 0.06, 0.12, 0.24)
RECORD, LONG = 1.2e-3, 2.4e-3  # s


@dataclass(frozen=True)
class Solid:
    """A way from a static modulus to 15 GPa: name, static modulus (Pa), times (us), loss tangents."""

    name: str
    static: float
    times: np.ndarray
    tangents: np.ndarray


def table(card: Card) -> pd.DataFrame:
    """What the chain of Fig. 3a shows for each solid; `card` is fig3a as Hertz at 15 GPa without a loss."""
    plain = Solid("elastic", PRINTED.modulus_matched, np.array([0.0]), np.array([0.0]))
    found = _seen(card, plain, {})
    omega = np.pi / (2e-6 * found[0][7])  # of a half-sine that lasts twice its width at half height
    for static in (PRINTED.modulus_handbook, PRINTED.modulus_membrane):
        broad, single = _broad(static, omega), _single(static, omega)
        found += _seen(card, broad, {LOSS: {"time_us": broad.times}})
        ratio = PRINTED.modulus_matched / static
        relaxing = {"strength": np.full(len(single.times), ratio - 1.0), "tau_us": single.times}
        soft = card.stiffened(card.bead.surface.name, 1.0 / ratio)
        found += _seen(soft, single, {"relaxing-contact": relaxing})
    return pd.DataFrame(found, columns=RELAXATION)


def _broad(static, omega):
    """Equal parts of the ratio in each decade: tan δ = (π/2) ln r/ln(rates), and the loss time tan δ/ω."""
    rates = np.log(np.array(IMPACT_RATES) / STATIC_RATE)
    tangents = np.pi / 2.0 * np.log(PRINTED.modulus_matched / static) / rates
    return Solid(BROAD, static, 1e6 * tangents / omega, tangents)


def _single(static, omega):
    """One relaxation time: tan δ = (r − 1) x/(1 + r x²), x = ω τ; at once the modulus is 15 GPa."""
    times, ratio = np.array(RELAXATION_US), PRINTED.modulus_matched / static
    x = omega * times * 1e-6
    return Solid(SINGLE, static, times, (ratio - 1.0) * x / (1.0 + ratio * x**2))


def _seen(card, solid, effects):
    """Rows of the table for one solid: Fig. 3a, and the speed where g9 reads 0.25 N."""
    card, draws = replace(card, effects=effects), inputs.neutral(len(solid.times))
    strong = Batch.of(card, set_up(card, draws), RECORD)
    measured = reading.of_lanes(strong, MEASURED, draws)
    gentle = [reading.of_peaks(Batch.of(card, set_up(card, draws, v), LONG), draws) for v in GENTLE]
    low = sweeps.low_speed([*gentle, reading.of_peaks(strong, draws)])
    columns = [*(measured[key] for key in MEASURED), low]
    return [
        (solid.name, solid.static / 1e9, time, tangent, *row)
        for time, tangent, *row in zip(solid.times, solid.tangents, *columns, strict=True)
    ]
