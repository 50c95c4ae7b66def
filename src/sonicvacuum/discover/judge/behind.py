"""What may hide behind what was named: one more effect that moves these data nearly as a named one does.

Of two laws of damping in one contact either makes up for the other, so that a pair of them leaves nothing
when one is named, and no pair is asked for. How much of it the data would let pass follows from slopes at the
final model: of an effect's change, of size d′, the model takes up all but a share s, so that the pair's
likelihood falls as exp(−(s d′)²/2 + s d′ z) with the score z of what is left. Under the prior of every
strength (flat in log d′, `evidence`) that is the pair's evidence beside the named effects' alone, to first
order.
"""

from collections.abc import Mapping

import numpy as np

from sonicvacuum.discover.fit import evidence
from sonicvacuum.discover.judge import explanations
from sonicvacuum.discover.search.screen import RESOLVED, Screen
from sonicvacuum.effects import IDS

# Points of the quadrature over log d′: the integrand changes over a factor of e and more.
_POINTS = 65
# Sets less likely than this beside what is named are not told of.
_FAINT = 1e-4
# What is named does nearly what an effect does where it leaves less than this share of that effect's change.
_HIDDEN = 0.5


def odds(scores: Screen, gain: float, least: float, prior: Mapping[str, float]) -> dict[str, float]:
    """Effect → odds that it acts beside the named ones, against these alone.

    Args:
        scores: at the final model, of effects that it has not.
        gain: Δχ² of the named effects: what hides among them has no larger one.
        least: Δχ² from which an effect is named: smaller ones are nobody's claim.
        prior: odds of effects against their usual prior.
    """
    low, high = np.sqrt(least), min(np.sqrt(max(gain, 0.0)), evidence.STRONG)
    if high <= low:
        return {}
    size = np.geomspace(low, high, _POINTS)[:, None]
    share, z = _share_left(scores)
    left = share * size
    both = np.array([d.two_sided for d in scores.directions])
    upper, lower = np.exp(left * (z - 0.5 * left)), np.exp(-left * (z + 0.5 * left))
    passed = np.where(both, 0.5 * (upper + lower), upper)
    evident = np.trapezoid(passed, np.log(size[:, 0]), axis=0) / np.log(evidence.STRONG / evidence.WEAK)
    usual = (1.0 - evidence.PRIOR_NONE - evidence.PRIOR_UNKNOWN) / len(IDS)
    result = {}
    for effect in dict.fromkeys(d.effect for d in scores.directions):
        own = [k for k, d in enumerate(scores.directions) if d.effect == effect]
        result[effect] = usual * prior.get(effect, 1.0) * float(np.mean(evident[own]))
    return result


def hides(scores: Screen, effect: str) -> bool:
    """Whether what is named takes up most of what an effect does, where that fits best what is left.

    One that shows can be as likely as one that hides, by the data alone.
    """
    share, z = _share_left(scores)
    fitting = [abs(z[k]) if d.two_sided else z[k] for k, d in enumerate(scores.directions)]
    own = [k for k, d in enumerate(scores.directions) if d.effect == effect]
    return bool(share[max(own, key=lambda k: fitting[k])] < _HIDDEN)


def _share_left(scores):
    """(K,) share of a change that the model leaves, and its score; 1 and 0 for what nuisances take up."""
    free, (_, hessian) = scores.normal.free, scores.normal.total()
    cross = scores.cross.sum(axis=0)[free:]
    products = np.einsum("kk->k", scores.products.sum(axis=0))
    taken = np.einsum("nk,nk->k", cross, np.linalg.lstsq(hessian[0, free:, free:], cross, rcond=1e-12)[0])
    whole = np.sqrt(np.maximum(products - taken, 0.0))
    seen = whole > RESOLVED * np.sqrt(products)
    share = np.divide(scores.length, whole, out=np.ones_like(whole), where=seen)
    z = np.divide(scores.projected[0], scores.length, out=np.zeros_like(whole), where=scores.length > 0.0)
    return np.minimum(share, 1.0), np.where(seen, z, 0.0)


def told(
    probabilities: Mapping[str, float], named: list[str], beside: Mapping[str, float]
) -> dict[str, float]:
    """Probabilities with the sets among them that hide behind what is named; they sum to 1.

    Args:
        probabilities: of explanations.
        named: ids.
        beside: of `odds`; sets that were fitted are among the explanations as they stand.
    """
    own = probabilities.get(explanations.key(named), 0.0)
    sets = {explanations.key([*named, n]): own * o for n, o in beside.items() if o > _FAINT}
    every = {**probabilities, **{name: p for name, p in sets.items() if name not in probabilities}}
    total = sum(every.values())
    return {name: p / total for name, p in every.items()}
