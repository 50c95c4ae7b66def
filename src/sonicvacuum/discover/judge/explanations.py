"""Probabilities over explanations: none, effects, sets of effects, each with or without something unknown
beside them.

Evidence weighs what explains the data as it stands; what is left gives the odds that something unknown is
there as well (`evidence`, `calibration`). That share goes to the explanations that count a smooth discrepancy
as noise, by their evidence there, where they were worked out, else to `unknown` alone. Effects that act alike
are one explanation with several names. Each has its own evidence: equal where nothing tells the names apart,
less for a general law that comes out as a special one, of which the data leave room for less.
"""

import math
from collections.abc import Iterable, Mapping

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import evidence
from sonicvacuum.discover.fit.calibration import Calibration, of_package
from sonicvacuum.discover.fit.evidence import Candidate, Combination
from sonicvacuum.discover.fit.refit import Fit, predicted
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.effects import IDS

NONE, UNKNOWN = "none", "unknown"


def key(effects: Iterable[str]) -> str:
    """Name of an explanation: its effects in alphabetical order, `unknown` last; `none` without any."""
    names = list(effects)
    known = sorted(n for n in names if n != UNKNOWN)
    return " + ".join([*known, *([UNKNOWN] if UNKNOWN in names else [])]) or NONE


def effects(name: str) -> list[str]:
    """Effects of an explanation, `unknown` included."""
    return [] if name == NONE else name.split(" + ")


def together(
    tried: Iterable[Combination], grown: Iterable[Combination], own: Combination
) -> list[Combination]:
    """All sets that were fitted on noise as it is, each as it is best, the best first; `own` in any case."""
    found = [*sorted((*tried, *grown), key=lambda c: c.log_bayes), own]
    sets = {frozenset(c.effects): c for c in found if len(c.effects) > 1 and np.isfinite(c.log_bayes)}
    return sorted(sets.values(), key=lambda c: -c.log_bayes)


def aliases(forward: Forward, null: Fit, found: list[Candidate]) -> list[str]:
    """Effects that change these data as the best one does, it included; one name where it is alone."""
    if not found:
        return []
    best, *others = found
    near = [c for c in others if abs(c.gain - best.gain) < policy.ALIAS_GAIN]
    if not near or best.gain < 1.0:
        return [best.effect]
    base = predicted(forward, null)
    own = predicted(forward, best.fit) - base
    alike = [best.effect]
    for c in near:
        change = predicted(forward, c.fit) - base
        if change @ own > policy.ALIAS_COSINE * np.linalg.norm(change) * np.linalg.norm(own):
            alike.append(c.effect)
    return alike


def log_weights(
    singles: Iterable[Candidate],
    combinations: Iterable[Combination],
    odds: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """Explanation → log of prior times evidence.

    `odds` are those of `evidence.log_weights`; the prior of a set is the product of its effects'.
    """
    odds = odds or {}
    logs = evidence.log_weights({c.effect: c.log_bayes for c in singles}, odds)
    each = math.log((1.0 - evidence.PRIOR_NONE - evidence.PRIOR_UNKNOWN) / len(IDS))
    for c in combinations:
        if c.effects and all(odds.get(name, 1.0) > 0.0 for name in c.effects):
            prior = sum(each + math.log(odds.get(name, 1.0)) for name in c.effects)
            logs[key(c.effects)] = prior + c.log_bayes
    return logs


def probabilities(
    logs: Mapping[str, float],
    left: float,
    beside: Mapping[str, float] | None = None,
    calibration: Calibration | None = None,
) -> dict[str, float]:
    """Probability of every explanation; they sum to 1.

    Args:
        logs: explanation → log weight, `none` among them (`log_weights`).
        left: p-value of what the best of them leaves.
        beside: explanation → log weight with a smooth discrepancy counted as noise; `none` stands for
            `unknown` alone.
        calibration: that of the package where not given.
    """
    calibration = calibration or of_package()
    of_set = len(effects(max(logs, key=logs.get))) > 1
    found = calibration.probabilities(logs, math.log(evidence.unknown_odds(left)), of_set)
    share = found.pop(UNKNOWN)
    result = {
        name: found.get(name, 0.0) for name in (NONE, UNKNOWN, *IDS) if name in found or name == UNKNOWN
    }
    result |= {name: value for name, value in found.items() if name not in result}
    top = max(beside.values()) if beside else 0.0
    weights = {k: math.exp(calibration.temper * (v - top)) for k, v in (beside or {NONE: 0.0}).items()}
    total = sum(weights.values())
    for name, weight in weights.items():
        whole = key([*effects(name), UNKNOWN])
        result[whole] = result.get(whole, 0.0) + share * weight / total
    return result


def consistent(found: Mapping[str, float], named: Iterable[str]) -> tuple[dict[str, float], str]:
    """Probabilities in which what is named is the likeliest, and what was likelier ("" where nothing was).

    What failed a test is no longer worth its evidence: all else together is held to what it is worth then.
    """
    own = key(named)
    best = max(found, key=found.get)
    mine = found.get(own, 0.0)
    if best == own or mine >= found[best]:
        return dict(found), ""
    rest = sum(value for name, value in found.items() if name != own)
    usual = {NONE: policy.REFUSED_NONE, UNKNOWN: policy.REFUSED_UNKNOWN}.get(own, policy.REFUSED)
    # As much as the likeliest of the others, if that is more.
    share = 1.0 - max(usual, 1.001 * found[best] / (found[best] + rest))
    held = {name: share * value / rest for name, value in found.items() if name != own}
    return {own: 1.0 - share} | held, best


def doubted(found: Mapping[str, float], named: Iterable[str], most: float) -> dict[str, float]:
    """Probabilities in which what is named has at most `most`, what it loses going to `unknown`."""
    own = key(named)
    excess = max(0.0, found.get(own, 0.0) - most)
    return {**found, own: found.get(own, 0.0) - excess, UNKNOWN: found.get(UNKNOWN, 0.0) + excess}


def no_surer(
    found: Mapping[str, float], named: Iterable[str], smooth_only: bool = False
) -> tuple[dict[str, float], list[str]]:
    """Probabilities in which effects named beside something unknown are no surer than such names came true,
    and what is said of it.

    Unless it is smooth (`smooth_only`), what is unknown is no noise of any kernel: evidence cannot say that
    it is not, by itself, what seems to be an effect and something besides.
    """
    known = [name for name in named if name != UNKNOWN]
    if not known or UNKNOWN not in named:
        return dict(found), []
    if len(known) > 1 and not smooth_only:
        return _hardly_a_set(found, known)
    one = policy.SMOOTH_BESIDE if smooth_only else policy.ONE_BESIDE
    most = one if len(known) == 1 else policy.SMOOTH_SET_BESIDE
    if found.get(key(named), 0.0) <= most:
        return dict(found), []
    reason = f"{' + '.join(known)} may be part of what is unknown: no surer than such names proved right"
    return doubted(found, named, most), [reason]


def _hardly_a_set(found, known):
    """The same of a set beside what has shapes: all sets there lose alike, to one of those named, or none."""
    sets = {name: p for name, p in found.items() if UNKNOWN in effects(name) and len(effects(name)) > 2}
    total = sum(sets.values())
    if total <= policy.SET_BESIDE:
        return dict(found), []
    excess = total - policy.SET_BESIDE
    less = {**found, **{name: p * policy.SET_BESIDE / total for name, p in sets.items()}}
    for name in known:
        one = key([name, UNKNOWN])
        less[one] = less.get(one, 0.0) + policy.ONE_OF_SET * excess / len(known)
    less[UNKNOWN] = less.get(UNKNOWN, 0.0) + (1.0 - policy.ONE_OF_SET) * excess
    reason = (
        f"{' + '.join(known)} come nearest to what is there, and are hardly just that: beside something "
        "unknown with a shape of its own such sets were never right as a whole"
    )
    return less, [reason]


def clear(weights: Mapping[str, float], named: Iterable[str]) -> bool:
    """Whether a set of effects is likelier than all others together beside what is left."""
    own = weights.get(key(named), -np.inf)
    others = [w for name, w in weights.items() if name != key(named)]
    return own - np.logaddexp.reduce(others) > np.log(policy.CLEAR) if others else True


def one_of(weights: Mapping[str, float]) -> list[str]:
    """That something of the catalogue is there, where only which is open; [] where that is not so sure."""
    total = np.logaddexp.reduce(list(weights.values()))
    odds = {name: float(np.exp(w - total)) for name, w in weights.items()}
    none = odds.pop(NONE, 0.0)
    if none > 1.0 - policy.STANDS_OUT:
        return []
    likely = sorted(((p, name) for name, p in odds.items() if p > policy.TOLD), reverse=True)
    told = ", ".join(f"{name} {p:.2f}" for p, name in likely)
    return [f"something of the catalogue is there with probability {1.0 - none:.2f}, which is open: {told}"]
