"""Tails of the distributions that the tests ask for: probabilities of values beyond a given one.

Those of `scipy.stats`, by the incomplete gamma function (Abramowitz & Stegun, Handbook of Mathematical
Functions, 6.5.29 and 6.5.31) and the error function of Python: `scipy.special`, which has them too, takes
longer to load than a tenth of a search takes.
"""

import math

import numpy as np

# Sums end where a term is this share of them.
_LAST = 1e-16
_erfc = np.frompyfunc(math.erfc, 1, 1)


def chi_squared(value: float, freedom: float) -> float:
    """Probability that χ² of so many degrees of freedom exceeds a value."""
    return _gamma(0.5 * float(freedom), 0.5 * float(value))[1]


def chi_squared_at(p: float, freedom: float) -> float:
    """Value that χ² of so many degrees of freedom exceeds with probability p, 0 < p ≤ ½."""
    # The logarithm of the tail is concave: after its first step Newton's method comes from above. The digits
    # that are right double with each step.
    value, before = freedom, 0.0
    while abs(value - before) > 1e-8 * value:
        tail = chi_squared(value, freedom)
        density = 0.5 * _power(0.5 * freedom, 0.5 * value) / (0.5 * value)
        before, value = value, value + tail / density * math.log(tail / p)
    return value


def normal(value):
    """Probability that a standard normal number exceeds a value (any shape)."""
    return 0.5 * erfc(np.asarray(value) / math.sqrt(2.0))


def erfc(value: np.ndarray) -> np.ndarray:
    """The complementary error function of an array."""
    return np.asarray(_erfc(value), dtype=float)


def poisson(count: int, mean: float) -> float:
    """Probability of `count` events or more where `mean` are expected."""
    return _gamma(float(count), float(mean))[0] if count > 0 else 1.0


def _gamma(a, x):
    """Regularised incomplete gamma functions, lower and upper, the smaller one to full relative accuracy."""
    if x <= 0.0 or math.isinf(x):
        return (0.0, 1.0) if x <= 0.0 else (1.0, 0.0)
    front = _power(a, x)
    if x < a + 1.0:
        term = total = 1.0 / a
        n = a
        while term > _LAST * total:
            n += 1.0
            term *= x / n
            total += term
        lower = min(front * total, 1.0)
        return lower, 1.0 - lower
    # Lentz's way through the continued fraction, none of whose denominators is 0 here.
    b = x + 1.0 - a
    c, d, k = math.inf, 1.0 / b, 0.0
    total, change = d, 0.0
    while abs(change - 1.0) > _LAST:
        k += 1.0
        b += 2.0
        d = 1.0 / (b - k * (k - a) * d)
        c = b - k * (k - a) / c
        change = c * d
        total *= change
    upper = min(front * total, 1.0)
    return 1.0 - upper, upper


def _power(a, x):
    """x^a e^−x / Γ(a)."""
    return math.exp(a * math.log(x) - x - math.lgamma(a))


def discovery_rate(p: np.ndarray) -> np.ndarray:
    """(n,) p-values adjusted for the false-discovery rate.

    The step-up procedure of Benjamini & Hochberg, J. R. Stat. Soc. B 57, 289 (1995).
    """
    order = np.argsort(p, kind="stable")
    stepped = p[order] * len(p) / np.arange(1, len(p) + 1)
    adjusted = np.empty(len(p))
    adjusted[order] = np.minimum.accumulate(stepped[::-1])[::-1]
    return np.minimum(adjusted, 1.0)
