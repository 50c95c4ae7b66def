"""Dormand and Prince's pair 5(4) with error control for one chain, compiled.

The tableau is Table 2 of J. R. Dormand & P. J. Prince, J. Comput. Appl. Math. 6, 19 (1980), as
`scipy.integrate.RK45` has it, which takes longer to load than a small study to be scored. The state is one
vector: displacements, velocities and relaxing parts of the forces, each with one place more than there are
bodies, for a wall that does not move. Steps shrink where contacts open, close or turn, so that no law needs
events. Between steps displacements come from the fifth-degree Hermite polynomial of displacement, velocity
and acceleration at both ends, relaxing parts from the third-degree one.
"""

import math

import numpy as np
from numba import njit

from sonicvacuum_blind.laws import FORCE, INVERSE, LARGEST, LOAD, REST, decelerate, forces

SAFETY, SHRINK, GROW = 0.9, 0.2, 4.0
TRIES = 10_000_000
# Weights of the slopes before each stage, the last row for the step itself; times of the stages; weights of
# the error, fifth less fourth order.
_A = np.array(
    [
        [0, 0, 0, 0, 0, 0],
        [1 / 5, 0, 0, 0, 0, 0],
        [3 / 40, 9 / 40, 0, 0, 0, 0],
        [44 / 45, -56 / 15, 32 / 9, 0, 0, 0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0, 0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0],
        [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
_C = np.array([0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1, 1])
_E = np.array([-71 / 57600, 0, 71 / 16695, -71 / 1920, 17253 / 339200, -22 / 525, 1 / 40])
# Rows of the states: at the start and at the end of a step, in between; one over the error allowed.
# Numbers of Numpy's: for each of Python's, functions called with it would be compiled once more.
START, END, BETWEEN, WEIGHT = np.arange(4)
# Stages of the slopes: the first, and the second, whose place is free between steps.
FIRST, SPARE = np.arange(2)


@njit(nogil=True, error_model="numpy")
def _rates(t, y, at, slopes, s, table, uses, push, wall, room):
    """dy/dt of a state into a stage of `slopes`."""
    w = table.shape[1]
    n = w - 1
    forces(y, at, slopes, s, table, uses, room)
    if wall[0] != 0.0:
        room[FORCE, n] = wall[0] * y[at, n - 1] + wall[1] * y[at, w + n - 1]
    for i in range(n):
        slopes[s, i] = y[at, w + i]
    for i in range(n):
        slopes[s, w + i] = (room[FORCE, i] - room[FORCE, i + 1] + table[LOAD, i]) * table[INVERSE, i]
    if uses.drag:
        decelerate(y, at, slopes, s, table)
    amplitude, start, length = push
    if amplitude != 0.0 and start < t < start + length:
        slopes[s, w + 1] += amplitude * math.sin(math.pi * (t - start) / length) ** 2 * table[INVERSE, 1]


@njit(nogil=True, error_model="numpy")
def _combine(y, k, s, h):
    """START + h Σ a × slopes into END; weights that a stage does not have are zero."""
    a, b, c = h * _A[s, 0], h * _A[s, 1], h * _A[s, 2]
    d, e, f = h * _A[s, 3], h * _A[s, 4], h * _A[s, 5]
    for i in range(y.shape[1]):
        change = a * k[0, i] + b * k[1, i] + c * k[2, i] + d * k[3, i] + e * k[4, i] + f * k[5, i]
        y[END, i] = y[START, i] + change


@njit(nogil=True, error_model="numpy")
def _attempt(t, h, y, k, table, uses, push, wall, room):
    """A step of length h from START to END; its error over the one allowed."""
    for s in range(1, 7):
        _combine(y, k, s, h)
        _rates(t + _C[s] * h, y, END, k, s, table, uses, push, wall, room)
    largest = 0.0
    for i in range(y.shape[1]):
        e = _E[0] * k[0, i] + _E[2] * k[2, i] + _E[3] * k[3, i]
        e = abs((e + _E[4] * k[4, i] + _E[5] * k[5, i] + _E[6] * k[6, i]) * y[WEIGHT, i])
        # What is not a number stays.
        if largest == largest and not e <= largest:
            largest = e
    return h * largest


@njit(nogil=True, error_model="numpy")
def _turning(y, table, room, speed):
    """Fraction of a step after which the first contact turns from loading to unloading; 1 where none does."""
    w = table.shape[1]
    share, slow = 1.0, 1e-5 * speed
    for c in range(w - 1):
        delta = table[REST, c] + y[START, c] - y[START, c + 1]
        before, after = y[START, w + c] - y[START, w + c + 1], y[END, w + c] - y[END, w + c + 1]
        if delta > 0.0 and delta >= room[LARGEST, c] and before > slow and after < -slow:
            share = min(share, before / (before - after))
    return share


@njit(nogil=True, error_model="numpy")
def _between(s, h, y, k, w):
    """State at the fraction s of a step into BETWEEN."""
    for i in range(w):
        a, p, c2 = y[START, i], y[START, w + i] * h, 0.5 * k[0, w + i] * h * h
        m, d2 = y[END, w + i] * h, 0.5 * k[6, w + i] * h * h
        r0, r1, r2 = y[END, i] - a - p - c2, m - p - 2.0 * c2, 2.0 * (d2 - c2)
        c3, c4 = 10.0 * r0 - 4.0 * r1 + 0.5 * r2, -15.0 * r0 + 7.0 * r1 - r2
        c5 = 6.0 * r0 - 3.0 * r1 + 0.5 * r2
        y[BETWEEN, i] = a + s * (p + s * (c2 + s * (c3 + s * (c4 + s * c5))))
        y[BETWEEN, w + i] = (p + s * (2.0 * c2 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / h
    for i in range(2 * w, y.shape[1]):
        a, p, m = y[START, i], k[0, i] * h, k[6, i] * h
        r = y[END, i] - a
        y[BETWEEN, i] = a + s * (p + s * ((3.0 * r - 2.0 * p - m) + s * (p + m - 2.0 * r)))


@njit(nogil=True, error_model="numpy")
def _settle(y, k, table, uses, room):
    """Accept a step; whether its last slopes no longer hold, because a contact forgot or yielded."""
    w = table.shape[1]
    # Whole rows would take as long to compile as all the rest.
    for i in range(y.shape[1]):
        y[START, i] = y[END, i]
        k[0, i] = k[6, i]
    changed = False
    if uses.residual or uses.relaxing:
        for c in range(w - 1):
            delta = table[REST, c] + y[START, c] - y[START, c + 1]
            if uses.residual and delta > room[LARGEST, c]:
                room[LARGEST, c] = delta
                changed = True
            if uses.relaxing and delta <= 0.0 and y[START, 2 * w + c] != 0.0:
                y[START, 2 * w + c] = 0.0
                changed = True
    return changed


def begin(table, uses, speed: float, scale: float, tolerance: float) -> tuple:
    """States, slopes and room before the first step: the striker at its speed, all else at rest."""
    w = table.shape[1]
    y = np.zeros((4, 3 * w if uses.relaxing else 2 * w))
    y[START, w] = speed
    y[WEIGHT, :w] = 1.0 / (tolerance * scale)
    y[WEIGHT, w : 2 * w] = 1.0 / (tolerance * speed)
    y[WEIGHT, 2 * w :] = np.max(table[INVERSE]) * scale / (tolerance * speed**2)
    room = np.zeros((7, w))
    room[LARGEST] = np.maximum(table[REST], 0.0)
    return y, np.zeros((7, y.shape[1])), room


@njit(nogil=True, error_model="numpy")
def run(table, uses, push, wall, speed, scale, times, recorded, force, states, y, k, room):
    """Fill `force` (samples, recorded) and `states` (samples or 0, 2, bodies); number of steps.

    It is −1 where the motion diverges or takes more than `TRIES` attempts.

    Args:
        table, uses: the chain, `laws.numbers` and `laws.acting`.
        push, wall: as in `integrate.Problem`.
        speed, scale: of the striker in m/s, of its compression in m.
        times: (samples,) ascending, s.
        recorded: (recorded,) contacts.
        y, k, room: of `begin`.
    """
    unit, w = scale / speed, table.shape[1]
    t, h, done, steps = 0.0, 1e-3 * unit, 0, 0
    _rates(t, y, START, k, FIRST, table, uses, push, wall, room)
    for _ in range(TRIES):
        error = _attempt(t, h, y, k, table, uses, push, wall, room)
        if not error < np.inf:
            break
        factor = min(GROW, max(SHRINK, SAFETY * max(error, 1e-10) ** -0.2))
        # A discontinuity is crossed once the step is too short to matter.
        if error > 1.0 and h > 1e-9 * unit:
            h *= factor
            continue
        # The largest compression is frozen within a step: a step ends where a contact turns.
        share = _turning(y, table, room, speed) if uses.residual else 1.0
        if share < 1.0:
            h *= share
            continue
        while done < len(times) and times[done] <= t + h:
            _between((times[done] - t) / h, h, y, k, w)
            # Only the first and the last stage are needed any more.
            forces(y, BETWEEN, k, SPARE, table, uses, room)
            for r in range(len(recorded)):
                force[done, r] = room[FORCE, recorded[r] + 1]
            for i in range(w - 1 if len(states) else 0):
                states[done, 0, i], states[done, 1, i] = y[BETWEEN, i], y[BETWEEN, w + i]
            done += 1
        t += h
        steps += 1
        if done == len(times):
            return steps
        if _settle(y, k, table, uses, room):
            _rates(t, y, START, k, FIRST, table, uses, push, wall, room)
        h *= factor
    return -1
