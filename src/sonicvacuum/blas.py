"""One thread for linear algebra: sums in another order have other last digits, which no machine shares.

The compiled kernels have their own threads, whose results do not depend on their number; this is about the
BLAS libraries that numpy and scipy call.
"""

import os
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

# What the libraries in the wheels of numpy and scipy read when they are loaded.
THREADS = "OPENBLAS_NUM_THREADS"

P = ParamSpec("P")
R = TypeVar("R")


def one_thread(function: Callable[P, R]) -> Callable[P, R]:
    """A function during which BLAS uses one thread, whatever the environment says; restored when it ends."""

    @wraps(function)
    def guarded(*args: P.args, **options: P.kwargs) -> R:
        from threadpoolctl import threadpool_limits

        if os.environ.get(THREADS) != "1":
            # A library that is loaded later would not be limited: scipy brings one of its own.
            import scipy.linalg  # noqa: F401

        with threadpool_limits(1, user_api="blas"):
            return function(*args, **options)

    return guarded
