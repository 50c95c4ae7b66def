"""How probable each statement of the paper is under each model, by what the draws show of it.

A printed number that a simulation must equal: the share of draws that lie at least as far to one side as the
printed number, doubled; each draw has the error of reading that is left when gauges, levels and calibration
are drawn (`reading` in claims.csv). A deviation: the share of draws within its bound. Bounds, counts and
orders: the share of draws for which they hold. Either is a probability under that model, free of a chosen
standard error; with N draws it is known to 1/N, and 2/(N + 1) is the least that is said of an equality.
"""

import math
from collections.abc import Iterable, Mapping

import numpy as np

from sonicvacuum.card import Card
from sonicvacuum.effects import CATALOGUE
from sonicvacuum_paper.claims import Claim
from sonicvacuum_paper.columns import TWINS
from sonicvacuum_paper.compare import COMPARISONS, SPLIT_MARGIN, interpolated
from sonicvacuum_paper.ladder import LOSS, MODELS, SIMULATION
from sonicvacuum_paper.uncertainty.inputs import SEED
from sonicvacuum_paper.uncertainty.sample import Found
from sonicvacuum_paper.uncertainty.table import Agreement
from sonicvacuum_paper.verdict import BOUND, REPRODUCED, Target, judge

# Below this share of draws that have the quantity nothing is said.
ENOUGH = 0.5


def build(
    cards: Mapping[str, Card], sampled: Mapping[str, Found], claims: Iterable[Claim]
) -> list[Agreement]:
    """All statements that a simulation of the draws can tell, under all models.

    `cards`: column → its card of fig3a.
    """
    moduli = {c: card.bead.surface.modulus_Pa for c, card in cards.items() if c in sampled}
    lossy = {c for c, card in cards.items() if any(CATALOGUE.effect(e).dissipative for e in card.effects)}
    found = []
    for place, claim in enumerate(claims):
        if claim.kind != SIMULATION:
            continue
        for column in (c for c in MODELS if c in sampled):
            values = _values(claim, column, sampled, moduli)
            if values is None or (claim.needs == LOSS and column not in lossy):
                continue
            noise = np.random.default_rng(np.random.SeedSequence([SEED, place])).normal(size=len(values))
            found += _of_claim(claim, column, values, noise)
    return found


def _of_claim(claim, column, values, noise):
    known = np.isfinite(values)
    if known.mean() < ENOUGH:
        return []
    target = Target.parse(claim.test, claim.value, claim.sigma, claim.claim)
    left = float(claim.reading) if claim.reading else target.sigma
    share = probability(target, values[known], left * noise[known])
    low, median, high = np.percentile(values[known], [5.0, 50.0, 95.0])
    return [Agreement(claim.claim, column, low, median, high, int(known.sum()), share)]


def probability(target: Target, values: np.ndarray, error: np.ndarray) -> float:
    """Probability of agreement, see above; `error` (draws,) is that of reading the printed number."""
    count = len(values)
    if target.test == "within" and target.low == 0.0:  # a deviation, which has no other side
        return float((values <= BOUND * target.sigma).mean())
    if target.test in ("equals", "within"):
        read = values + error
        tail = min(int((read <= target.low).sum()), int((read >= target.low).sum()))
        return min(1.0, 2.0 * (tail + 1) / (count + 1))
    if target.sigma > 0.0:
        held = (values + error >= target.low) & (values + error <= target.high)
    else:
        held = np.array([judge(target, float(v)).verdict == REPRODUCED for v in values])
    return float(held.mean())


def _values(claim, column, sampled, moduli):
    """(draws,) of a statement's metric under a model; None where it is not sampled."""
    case, quantity, sensor = claim.metric.split("/")
    found = sampled[column]
    if case != "compare":
        return found.get((case, quantity, sensor))
    if quantity == "hertz_modulus_fig3a":
        return _hertz_modulus(found, sampled, moduli)
    if quantity == "losses_delay_splitting":
        key, twin = ("fig5a", "valley_depth", sensor), sampled.get(TWINS.get(column, ""), {})
        if key not in found or key not in twin:
            return None
        return _combined(lambda one, other: one < other - SPLIT_MARGIN, [found[key], twin[key]])
    for name, place, needs, function in COMPARISONS:
        if (name, place) == (quantity, sensor) and all(need in found for need in needs):
            return _combined(function, [found[need] for need in needs])
    return None


def _combined(function, arrays):
    rows = zip(*arrays, strict=True)
    return np.array(
        [math.nan if np.isnan(row).any() else float(function(*row)) for row in map(np.array, rows)]
    )


def _hertz_modulus(found, sampled, moduli):
    """GPa at which a loss-free Hertz chain with the same draw runs as fast; as `compare.equivalent_row`."""
    key = "fig3a", "speed", "g9-g5"
    columns = [c for c in ("handbook", "matched") if c in sampled]
    if len(columns) < 2 or key not in found:
        return None
    speeds = [sampled[c][key] for c in columns]
    own = [moduli[c] for c in columns]
    return _combined(lambda v, *known: interpolated(v, known, own) / 1e9, [found[key], *speeds])
