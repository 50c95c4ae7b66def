"""Rules that need no more than the fits of single effects: a case in, a name out."""

import math

import numpy as np

from sonicvacuum_blind.baselines.cases import Case
from sonicvacuum_blind.score import NONE
from sonicvacuum_blind.strength import FALSE_ALARM


def best_chi2(case: Case) -> str:
    """The effect that fits best; none only where none fits better than the nominal model."""
    return _largest({s.effect: s.gain for s in case.singles})


def bic(case: Case) -> str:
    """The smallest Bayesian information criterion χ² + k ln N (Schwarz, Ann. Stat. 6, 461, 1978)."""
    return _largest({s.effect: s.gain - s.parameters * math.log(case.data) for s in case.singles})


def likeness(case: Case) -> float:
    """Largest |cosine| between the residual and a signature, 0 where there is none, times √N of N data.

    By chance alone a cosine is of the order 1/√N: so scaled, records of few and of many data compare.
    """
    cosines = (abs(s.cosine) for s in case.singles if not math.isnan(s.cosine))
    return math.sqrt(case.data) * max(cosines, default=0.0)


def nearest_shape(case: Case, least: float = 0.0) -> str:
    """The effect whose signature is most like the residual, none where `likeness` is not above `least`."""
    if likeness(case) <= least:
        return NONE
    return _largest({s.effect: abs(s.cosine) for s in case.singles if not math.isnan(s.cosine)})


def least_likeness(nulls: list[Case]) -> float:
    """Likeness that one in a hundred training cases without anything hidden exceeds; 0 without cases."""
    return float(np.quantile([likeness(c) for c in nulls], 1.0 - FALSE_ALARM)) if nulls else 0.0


def has_cosines(cases: list[Case]) -> bool:
    """Whether the tables hold what `nearest_shape` needs."""
    return any(not math.isnan(s.cosine) for c in cases for s in c.singles)


def _largest(values):
    """Key of the largest value, none where none is above zero; of equal ones the first in the alphabet."""
    best = max(sorted(values), key=values.get, default=None)
    return best if best is not None and values[best] > 0.0 else NONE
