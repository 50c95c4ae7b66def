"""How a simulated number is held against a claim of the paper, or against the limit of an assumption.

* `equals`: difference over sigma; beyond `LIMIT` sigma it disagrees.
* `at_least`, `at_most`, `between`: distance beyond the bound over sigma, 0 within; with sigma 0 the bound
  is strict.
* `within`: sigma stands for a bound, √6 sigma; beyond it, and only there, it disagrees.
* `count`: the integer itself; `order`: 1, the order holds, or 0.
* `not-testable`, `misprint`: no number; the second contradicts itself.

The numerical error joins sigma in quadrature, and a difference below it never disagrees. A count or an
order that changes with the time step is not testable.
"""

import math
from dataclasses import dataclass

from sonicvacuum.files import InputError

# A difference of more than this many standard errors disagrees.
LIMIT = 2.0
# A bound that is the sum of two equal errors, each anywhere within its own half, is so many standard errors.
BOUND = math.sqrt(6.0)
# A number that misses a strict bound by less than this part of itself misses it by rounding.
ROUNDING = 1e-12
UNTESTED = ("not-testable", "misprint")
TESTS = ("equals", "within", "at_least", "at_most", "between", "count", "order", *UNTESTED)
REPRODUCED, DISAGREES, NOT_TESTABLE = "reproduced", "disagrees", "not testable"
# What no model without losses can show; what the paper's own numbers contradict.
OUTSIDE, INCONSISTENT = "outside the model", "inconsistent in the paper"
VERDICTS = (REPRODUCED, DISAGREES, OUTSIDE, INCONSISTENT, NOT_TESTABLE)


@dataclass(frozen=True)
class Target:
    """What is asked of a number.

    Attributes:
        test: one of `TESTS`.
        low, high: bounds; equal for `equals`, `count` and `order`, infinite where there is none.
        sigma: one standard error; 0 for a strict bound.
    """

    test: str
    low: float
    high: float
    sigma: float = 0.0

    @classmethod
    def parse(cls, test: str, value: str, sigma: str = "", where: str = "") -> "Target":
        """A target from the cells of a table; InputError with `where` (file and row) if they do not fit."""
        if test not in TESTS:
            raise InputError(f"{where}: test is {test!r}; use one of {', '.join(TESTS)}")
        if test in UNTESTED:
            return cls(test, math.nan, math.nan)
        parts = value.split("..")
        try:
            bounds, spread = [float(p) for p in parts], float(sigma or 0.0)
        except ValueError:
            raise InputError(
                f"{where}: value {value!r} or sigma {sigma!r} is not a number; write 3 or 1..3"
            ) from None
        if len(bounds) != (2 if test == "between" else 1):
            raise InputError(
                f"{where}: value is {value!r}; `between` needs lo..hi, every other test one number"
            )
        if spread < 0.0 or bounds[0] > bounds[-1]:
            raise InputError(f"{where}: sigma {sigma!r} must not be negative and {value!r} must ascend")
        if test in ("equals", "within") and spread == 0.0:
            raise InputError(f"{where}: sigma is missing; `{test}` needs a positive one")
        low = -math.inf if test == "at_most" else bounds[0]
        high = math.inf if test == "at_least" else bounds[-1]
        return cls(test, low, high, spread)


@dataclass(frozen=True)
class Judged:
    """Outcome for one number.

    Attributes:
        verdict: reproduced, disagrees or not testable.
        difference_sigma: signed distance beyond the bounds
            in standard errors, 0 within them; NaN where the bound is strict, as for counts and orders.
        reason: why it is not testable; empty otherwise.
    """

    verdict: str
    difference_sigma: float = math.nan
    reason: str = ""


def judge(target: Target, value: float, numerical_error: float = 0.0) -> Judged:
    """Hold a number with its numerical error (NaN counts as 0) against a target."""
    if target.test in UNTESTED:
        return Judged(NOT_TESTABLE, reason="no metric tests this statement")
    if math.isnan(value):
        return Judged(NOT_TESTABLE, reason="no value")
    error = 0.0 if math.isnan(numerical_error) else abs(numerical_error)
    if target.test in ("count", "order"):
        return _whole(target, value, error)
    beyond = max(value - target.high, 0.0) + min(value - target.low, 0.0)
    if target.sigma > 0.0:
        difference = beyond / math.hypot(target.sigma, error)
        limit = BOUND if target.test == "within" else LIMIT
        return Judged(DISAGREES if abs(difference) > limit else REPRODUCED, difference)
    if abs(beyond) > max(error, ROUNDING * abs(value)):
        return Judged(DISAGREES)
    return Judged(REPRODUCED, 0.0)


def _whole(target, value, error):
    if error >= 0.5:
        return Judged(NOT_TESTABLE, reason="the number changes with the time step")
    return Judged(REPRODUCED if abs(value - target.low) < 0.5 else DISAGREES)
