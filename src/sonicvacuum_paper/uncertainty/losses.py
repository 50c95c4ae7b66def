"""Whether the reading of the paper depends on which law its one loss has.

Four laws of damping in the contact, which grow differently with the speed of impact, are put into the layer
and into Hertz's contact at 15 GPa, and a fifth, the viscous force of the layer itself, which is Kuwabara and
Kono's on Hertz's contact. Each has one number, calibrated on the same printed statement as the ladder's
Kuwabara–Kono loss: the 130 µs at g9. All else is predicted.
"""

import math
from collections.abc import Mapping

import numpy as np
import pandas as pd
from msgspec.structs import replace

from sonicvacuum.card import Card
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.uncertainty import inputs, reading, sample, sweeps
from sonicvacuum_paper.uncertainty.batch import LOSS, Batch, set_up
from sonicvacuum_paper.uncertainty.formats import LOSSES
from sonicvacuum_paper.uncertainty.layer_viscosity import ID as VISCOUS_LAYER
from sonicvacuum_paper.uncertainty.layer_viscosity import WITH_LAYER
from sonicvacuum_paper.uncertainty.viscoelastic import GENTLE

# Effect → its one parameter.
LAWS = {
    "linear-dashpot": "damping_kg_s",
    "tsuji": "alpha",
    LOSS: "time_us",
    "hunt-crossley": "damping_s_per_m",
}
# With the law that no search tries.
ALL = {**LAWS, VISCOUS_LAYER: "time_us"}
CONTACTS = ("layer", "matched")
CASES = ("fig3a", "fig5a", "fig6b")
DURATION = ("duration_02", "g9")
STRONG = (
    ("speed", reading.BETWEEN),
    DURATION,
    ("amplitude", "g9"),
    ("decay", reading.BETWEEN),
)
SPLIT, PULSES = ("valley_depth", "g9"), ("pulse_count", "wall")
# Strengths tried at once, over so many decades about the catalogue's typical one, and how often.
TRIED, DECADES, TURNS = 24, 3.0, 3


def table(cards: Mapping[str, Mapping[str, Card]]) -> pd.DataFrame:
    """What each law shows with each contact; `cards`: case of `CASES` → column of the ledger → card."""
    found = []
    for contact in CONTACTS:
        own = {case: cards[case][contact] for case in CASES}
        for law in ALL:
            # Without a layer its viscous force is that of the half-space.
            simulated = LOSS if law == VISCOUS_LAYER and contact != "layer" else law
            value = calibrated(own["fig3a"], simulated)
            found.append((contact, law, ALL[law], value, *_predicted(own, simulated, value)))
    return pd.DataFrame(found, columns=LOSSES)


def calibrated(card: Card, law: str) -> float:
    """The law's number at which the pulse of `card` (fig3a) lasts as long as printed; NaN where none does.

    The last number tried before it lasts longer: a tail that stays above the level makes durations jump.
    """
    typical = WITH_LAYER.effect(law).parameter(ALL[law]).scale
    low, high = typical * 10.0**-DECADES, typical * 10.0**DECADES
    for _ in range(TURNS):
        tried = np.geomspace(low, high, TRIED)
        longer = _seen(card, law, tried, (DURATION,))[DURATION] > 1e6 * PRINTED.duration_coated
        if longer[0] or not longer.any():
            return math.nan
        low, high = tried[longer.argmax() - 1], tried[longer.argmax()]
    return float(low)


def _seen(card, law, values, wanted, speed=None):
    """What is measured with the law at some values; a tail that stays above its level lasts for ever."""
    lossy = replace(card, effects={**card.effects, law: {ALL[law]: np.asarray(values)}})
    draws = inputs.neutral(len(values))
    batch = Batch.of(lossy, set_up(lossy, draws, speed), sample.lasting(card, speed))
    found = reading.of_lanes(batch, wanted, draws) if wanted else reading.of_peaks(batch, draws)
    if DURATION in found:
        found[DURATION] = np.where(np.isfinite(found[DURATION]), found[DURATION], np.inf)
    return found


def _predicted(cards, law, value):
    """One row of the table from the third column on."""
    if math.isnan(value):
        return (math.nan,) * (len(LOSSES) - 4)
    one = np.array([value])
    strong = _seen(cards["fig3a"], law, one, STRONG)
    gentle = [_seen(cards["fig3a"], law, one, (), speed) for speed in (*GENTLE, 0.44)]
    speed, *rest = (float(strong[key][0]) for key in STRONG)
    low = float(sweeps.low_speed(gentle)[0])
    split = float(_seen(cards["fig5a"], law, one, (SPLIT,))[SPLIT][0])
    return speed, low, *rest, split, float(_seen(cards["fig6b"], law, one, (PULSES,))[PULSES][0])
