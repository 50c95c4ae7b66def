"""Tails of the distributions that the tests ask for: probabilities of values beyond a given one.

The functions that `scipy.stats` calls for them: it takes longer to load than a record of traces takes to be
searched.
"""

import numpy as np

from sonicvacuum.special import functions


def chi_squared(value: float, freedom: float) -> float:
    """Probability that χ² of so many degrees of freedom exceeds a value."""
    return float(functions().chdtrc(freedom, max(value, 0.0)))


def chi_squared_at(p: float, freedom: float) -> float:
    """Value that χ² of so many degrees of freedom exceeds with probability p."""
    return float(functions().chdtri(freedom, p))


def normal(value):
    """Probability that a standard normal number exceeds a value (any shape)."""
    return functions().ndtr(-np.asarray(value))


def poisson(count: int, mean: float) -> float:
    """Probability of `count` events or more where `mean` are expected."""
    return float(functions().pdtrc(count - 1, mean)) if count > 0 else 1.0


def discovery_rate(p: np.ndarray) -> np.ndarray:
    """(n,) p-values adjusted for the false-discovery rate.

    The step-up procedure of Benjamini & Hochberg, J. R. Stat. Soc. B 57, 289 (1995).
    """
    order = np.argsort(p, kind="stable")
    stepped = p[order] * len(p) / np.arange(1, len(p) + 1)
    adjusted = np.empty(len(p))
    adjusted[order] = np.minimum.accumulate(stepped[::-1])[::-1]
    return np.minimum(adjusted, 1.0)
