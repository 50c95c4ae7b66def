"""What explanations of a record weigh, and which effects a slip stands for."""

import math
from collections.abc import Sequence

import numpy as np

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.judged import Judged, noise_volume, occam
from sonicvacuum.discover.faults.table import FAULTS
from sonicvacuum.discover.fit import evidence
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import explanations
from sonicvacuum.discover.rounds import Investigation, significant

# Slips and an effect within this Δχ² explain alike.
ALIKE = 9.0
# What slips and effects both move, see `table.Fault.alias`.
NUISANCES = {fault.alias for fault in FAULTS.values()} - {""}


def unexplained(found: Investigation) -> bool:
    """Whether something is left that nothing found explains."""
    return "unknown" in found.named


def refused(found: Investigation) -> bool:
    """Whether nothing is named although one effect passes the noise of the catalogue: another test failed."""
    best, prior = found.candidates[:1], found.forward.experiment.prior_odds
    return not found.named and any(significant(c, found.threshold, prior) for c in best)


def logs_of(found: Investigation) -> dict[str, float]:
    """Explanation of a record → log of prior times evidence, against its nominal model's."""
    prior = found.forward.experiment.prior_odds
    return explanations.log_weights(found.candidates, found.combinations, prior)


def weight_of(found: Investigation) -> float:
    """Log of prior times evidence of all explanations of a record together, against its nominal model's."""
    return float(np.logaddexp.reduce(list(logs_of(found).values())))


def alias(judged: Judged, found: Investigation) -> bool:
    """Whether a slip moves these data exactly as one effect that is named, all else of it being the same."""
    if judged.model is None or unexplained(found) or not _aliased(found, judged):
        return False
    return judged.gain > found.null.objective - found.final.objective - ALIKE


def acts_like(found: Investigation, name: str) -> set[str]:
    """The nuisances as which an effect's parameters act."""
    return {p.acts_like for p in found.forward.experiment.catalogue.effect(name).parameters} - {None}


def _aliased(found, judged):
    """Effects named that act as a slip does."""
    nuisance = FAULTS[judged.slip.fault].alias
    return [n for n in found.named if nuisance and nuisance in acts_like(found, n)]


def give_way(
    found: Investigation, share: float, like: Judged | None, after: Investigation | None = None
) -> str:
    """Give a share of all probabilities to what is missing where a slip was made instead of effects: of all
    that are named, or of those that act `like` it. Told in words.

    Args:
        found: effects of the record as it is; its probabilities are changed.
        share: probability of the slip.
        like: a slip that moves the data exactly as one effect, None where it stands for all.
        after: effects of the record with the slip put right, where they are known.
    """
    told = found.probabilities
    if like is not None:
        missing = [n for n in found.named if n not in _aliased(found, like)]
    else:
        missing = [n for n in after.named if n != explanations.UNKNOWN] if after else []
    if like is None and missing:
        for name in {*told, *after.probabilities}:
            told[name] = (1.0 - share) * told.get(name, 0.0) + share * after.probabilities.get(name, 0.0)
    else:
        for name, own in list(told.items()):
            if kept := _without(name, found, like):
                told[name] -= share * own
                told[kept] = told.get(kept, 0.0) + share * own
    return f"only {', '.join(missing)}" if missing else "none"


def _without(name: str, found: Investigation, like: Judged | None) -> str:
    """The explanation that is left of one where a slip stands for its effects, or for those that act `like`
    it; "" where the slip stands for none of them.
    """
    effects = explanations.effects(name)
    if name in (explanations.NONE, explanations.UNKNOWN):
        return ""
    if like is None:
        return explanations.NONE
    kept = [n for n in effects if n not in _aliased(found, like)]
    return explanations.key(kept) if len(kept) < len(effects) else ""


def part_without(found: Investigation, names: Sequence[str]) -> tuple[str, Fit] | None:
    """A set that is named, some effects left out, as it was fitted; None where it was not."""
    rest = explanations.key(n for n in found.named if n not in names)
    fits = {explanations.key([c.effect]): c.fit for c in found.candidates}
    fits |= {explanations.key(c.effects): c.fit for c in found.combinations}
    return (rest, fits[rest]) if rest in fits else None


def weight_beside(found: Investigation, rest: str) -> float:
    """Log of prior times evidence of an explanation, against the nominal model's of none."""
    return logs_of(found)[rest] - math.log(evidence.PRIOR_NONE)


def odds_of(slip: Judged, found: Investigation, after: Investigation) -> float:
    """Log odds of a slip by the nominal models of the record as it is and with it put right."""
    gain = found.null.objective - after.null.objective
    if slip.slip.continuous:
        gain -= float(found.sizes.sum() - after.sizes.sum())
    else:
        gain += noise_volume(found.forward.experiment) - noise_volume(after.forward.experiment)
    return 0.5 * gain + occam(slip.slip, slip.size, gain) + slip.slip.log_prior


def hollow(found: Investigation, after: Investigation) -> bool:
    """Whether what is left after a slip is nearly all that was left before."""
    if not unexplained(after):
        return False
    before, now = (max(f.final.objective - float(f.sizes.sum()), 1.0) for f in (found, after))
    return now > policy.LEFT * before


def as_likely(rivals: Sequence[Judged]) -> list[Judged]:
    """Those of some slips, the likeliest first, that explain as well as the first."""
    return [j for j in rivals if j.log_odds > rivals[0].log_odds - 0.5 * ALIKE]


def parts(rivals: Sequence[Judged], like: Judged | None) -> np.ndarray:
    """Parts of the probability that slips have, and last an effect that is `like` one of them."""
    odds = np.array([j.log_odds for j in rivals] + ([like.log_odds] if like else []))
    weights = np.exp(odds - odds.max())
    return weights / weights.sum()


def least_gain(found: Investigation, fit: Fit) -> float | None:
    """What a slip has to gain beside a fit to be weighed against the effects that were found; None where
    these leave more than noise, or there are none.
    """
    if unexplained(found) or found.final is found.null:
        return None
    own, here = (found.null.objective - one.objective for one in (found.final, fit))
    return max(policy.SHARE * own - here - 2.0 * ALIKE, 0.0)
