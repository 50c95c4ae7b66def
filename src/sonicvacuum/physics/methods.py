"""Coefficients of the explicit methods."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Method:
    """An explicit method of several stages, in units of the step.

    Attributes:
        name: identifies the method.
        order: order of convergence for smooth forces.
        first: splitting: (stages + 1,) drifts, of which the last merges with the next step's first;
            Runge–Kutta: (stages,) factors of the increments kept from the stage before.
        second: (stages,) kicks, or gains of the increments.
    """

    name: str
    order: int
    first: np.ndarray
    second: np.ndarray


def _symmetric(values, stages):
    return np.array([*values, *reversed(values[: stages - len(values)])])


def _blanes_moan():
    """Method S6 of Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313, Table 2: six stages, order four."""
    a = [0.0792036964311957, 0.353172906049774, -0.0420650803577195]
    b = [0.209515106613362, -0.143851773179818]
    drift = [*a, 1.0 - 2.0 * sum(a)]
    kick = [*b, 0.5 - sum(b)]
    return Method("blanes-moan", 4, _symmetric(drift, 7), _symmetric(kick, 6))


VERLET = Method("verlet", 2, np.array([0.5, 0.5]), np.array([1.0]))
BLANES_MOAN = _blanes_moan()
# Solution 3 of Carpenter & Kennedy, NASA TM 109112 (1994): five stages, order four, two registers.
CARPENTER_KENNEDY = Method(
    "carpenter-kennedy",
    4,
    np.array(
        [
            0.0,
            -567301805773 / 1357537059087,
            -2404267990393 / 2016746695238,
            -3550918686646 / 2091501179385,
            -1275806237668 / 842570457699,
        ]
    ),
    np.array(
        [
            1432997174477 / 9575080441755,
            5161836677717 / 13612068292357,
            1720146321549 / 2090206949498,
            3134564353537 / 4481467310338,
            2277821191437 / 14882151754819,
        ]
    ),
)
METHODS = {m.name: m for m in (VERLET, BLANES_MOAN)}
