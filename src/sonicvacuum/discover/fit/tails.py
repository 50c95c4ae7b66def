"""Tails of the distributions that the tests ask for: probabilities of values beyond a given one.

The functions of `scipy.special` that `scipy.stats` calls for them; `scipy.stats` itself takes longer to load
than a record of traces takes to be searched. (scipy loads its parts when they are first used: `import scipy`
alone costs nothing, `from scipy.special import …` a quarter of a second wherever this module is imported.)
"""

import numpy as np
import scipy


def chi_squared(value: float, freedom: float) -> float:
    """Probability that χ² of so many degrees of freedom exceeds a value."""
    return float(scipy.special.chdtrc(freedom, max(value, 0.0)))


def chi_squared_at(p: float, freedom: float) -> float:
    """Value that χ² of so many degrees of freedom exceeds with probability p."""
    return float(scipy.special.chdtri(freedom, p))


def normal(value):
    """Probability that a standard normal number exceeds a value (any shape)."""
    return scipy.special.ndtr(-np.asarray(value))


def poisson(count: int, mean: float) -> float:
    """Probability of `count` events or more where `mean` are expected."""
    return float(scipy.special.pdtrc(count - 1, mean)) if count > 0 else 1.0


def discovery_rate(p: np.ndarray) -> np.ndarray:
    """(n,) p-values adjusted for the false-discovery rate.

    The step-up procedure of Benjamini & Hochberg, J. R. Stat. Soc. B 57, 289 (1995).
    """
    order = np.argsort(p, kind="stable")
    stepped = p[order] * len(p) / np.arange(1, len(p) + 1)
    adjusted = np.empty(len(p))
    adjusted[order] = np.minimum.accumulate(stepped[::-1])[::-1]
    return np.minimum(adjusted, 1.0)
