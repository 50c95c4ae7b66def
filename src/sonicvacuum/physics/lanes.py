"""Arithmetic of force laws: written once, for one number, an array, or eight chains in one register.

A *lane* is one independent chain. Eight lanes are stepped together, one per slot of a 512-bit
register (two or four registers on narrower machines). Force laws are written once, in ordinary
arithmetic and the functions below; they then work on floats and numpy arrays (tests, theory), on
scalars in compiled code (one long chain) and on vectors of eight lanes (ensembles). What they become
in compiled code is said in `physics.arithmetic`: whatever knows laws but integrates nothing does not
have to load a compiler.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import wraps

import numpy as np

LANES = 8


class Written(ABC):
    """A number of code that is being written, and knows what the functions below are for it (`tracing`)."""

    @abstractmethod
    def work_out(self, function: str, values: tuple) -> "Written":
        """What the function of this name makes of values, this number among them."""


def _of_any_number(function: Callable) -> Callable:
    """The same for numbers of code that is being written."""

    @wraps(function)
    def worked_out(*values):
        for value in values:
            if isinstance(value, Written):
                return value.work_out(function.__name__, values)
        return function(*values)

    return worked_out


@_of_any_number
def root(x):
    """sqrt(x) where x > 0, else 0 (float, array or lanes)."""
    return np.sqrt(np.maximum(x, 0.0))


@_of_any_number
def select(condition, yes, no):
    """`yes` where condition > 0, else `no` (floats, arrays or lanes)."""
    return np.where(np.asarray(condition) > 0.0, yes, no)


@_of_any_number
def power(x, exponent):
    """x**exponent where x > 0, else 0 (float, array or lanes); exponent > 0."""
    return np.maximum(x, 0.0) ** exponent


@_of_any_number
def absolute(x):
    """|x| (float, array or lanes)."""
    return np.abs(x)


@_of_any_number
def positive(x):
    """x where x > 0, else 0 (float, array or lanes)."""
    return np.maximum(x, 0.0)


@_of_any_number
def power_3_2(x):
    """x**(3/2) where x > 0, else 0, by a square root (float, array or lanes)."""
    return x * root(x)


@_of_any_number
def without_fusing(minuend, subtrahend):
    """minuend − subtrahend, never fused with the product that made the minuend: equal numbers give zero."""
    return minuend - subtrahend
