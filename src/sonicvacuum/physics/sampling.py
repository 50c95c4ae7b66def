"""Samples between steps: what is kept at both ends of a step, and what a sample within it is made of.

The compression of each recorded contact is interpolated by the cubic Hermite polynomial of its values and
rates at both ends, and the law gives the force. Of a recorded body the acceleration follows from the forces
at that moment, and the velocity is interpolated as the compression is, from velocity and acceleration at both
ends. Code that records bodies is compiled apart (`Frame.watched`): where only forces are asked for,
nothing of it exists.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numba.extending import overload

from sonicvacuum.physics.composition import BEFORE, BEHIND, BODY, DUE, INVERSE_MASS, TOLERANCE, WEIGHT, U, V
from sonicvacuum.physics.cubic import hermite
from sonicvacuum.physics.table import (
    INLINED,
    blend_memory,
    body_acceleration,
    first_blend,
    first_memory,
    get,
    is_any_positive,
    load,
    push,
    store,
    zero,
)

COMPILED_ONLY = "this function exists in compiled code only: it takes a frame that Numba knows"

_inlined = njit(**INLINED)
_hermite = _inlined(hermite)


class Recorder(NamedTuple):
    """What it takes to write the samples of one group; see `advance` for the arrays."""

    interval: float
    contacts: np.ndarray
    watched: np.ndarray
    clock: np.ndarray
    cursor: np.ndarray
    chains: np.ndarray
    scratch: np.ndarray
    out: np.ndarray


@_inlined
def note(c, table, first, contacts, pending, ends):
    """Keep approach and rate of the recorded contacts, positions being `pending` seconds of drift behind."""
    for r in range(len(contacts)):
        body = first + contacts[r]
        speed = get(c, table, body, V)
        ahead = get(c, table, body + 1, V)
        rate = speed - ahead
        store(c, ends, 2 * r, get(c, table, body, U) - get(c, table, body + 1, U) + pending * rate)
        store(c, ends, 2 * r + 1, rate)


@_inlined
def _acceleration(c, table, first, watched, weight, before, behind, velocity):
    """Acceleration of a body between two contacts; the striker feels its weight and no drag."""
    body = first + watched[BODY]
    if watched[BEFORE] < 0:
        return get(c, table, body, INVERSE_MASS) * (weight - behind)
    return get(c, table, body, INVERSE_MASS) * (before - behind) + body_acceleration(c, table, body, velocity)


def note_motion(c, table, first, recorder, ends):
    """Keep velocity and acceleration of the recorded bodies at one end of a step, once its contacts are."""
    raise TypeError(COMPILED_ONLY)


@overload(note_motion, jit_options=INLINED)
def _choose_note_motion(c, table, first, recorder, ends):
    return _keep_motion if c.frame.watched else lambda c, table, first, recorder, ends: None


def _keep_motion(c, table, first, recorder, ends):
    contacts, watched = recorder.contacts, recorder.watched
    weight = load(c, recorder.clock, WEIGHT)
    kept = 2 * len(contacts)
    for b in range(len(watched)):
        before = zero(c)
        r = watched[b, BEFORE]
        if r >= 0:
            approach, rate = load(c, ends, 2 * r), load(c, ends, 2 * r + 1)
            before = push(c, table, first + contacts[r], approach, rate, first_memory(c))
        r = watched[b, BEHIND]
        approach, rate = load(c, ends, 2 * r), load(c, ends, 2 * r + 1)
        behind = push(c, table, first + contacts[r], approach, rate, first_memory(c))
        velocity = get(c, table, first + watched[b, BODY], V)
        store(c, ends, kept + 2 * b, velocity)
        acceleration = _acceleration(c, table, first, watched[b], weight, before, behind, velocity)
        store(c, ends, kept + 2 * b + 1, acceleration)


@_inlined
def _sample(c, table, body, start, end, r, step, fraction):
    """Force of a recorded contact at a fraction of the step; its approach by cubic Hermite interpolation."""
    x = load(c, start, 2 * r)
    v = step * load(c, start, 2 * r + 1)
    w = step * load(c, end, 2 * r + 1)
    gap = load(c, end, 2 * r) - x
    square = 3.0 * gap - 2.0 * v - w
    cube = v + w - 2.0 * gap
    approach = x + fraction * (v + fraction * (square + fraction * cube))
    rate = (v + fraction * (2.0 * square + 3.0 * fraction * cube)) / step
    blend_memory(c, table, body, fraction, approach, rate)
    return push(c, table, body, approach, rate, first_blend(c))


def emit_motion(c, table, first, recorder, start, end, step, fraction):
    """Write velocity and acceleration of the recorded bodies, whose contact forces are in the scratch."""
    raise TypeError(COMPILED_ONLY)


@overload(emit_motion, jit_options=INLINED)
def _choose_emit_motion(c, table, first, recorder, start, end, step, fraction):
    if not c.frame.watched:
        return lambda c, table, first, recorder, start, end, step, fraction: None
    return _write_motion


def _write_motion(c, table, first, recorder, start, end, step, fraction):
    _, contacts, watched, clock, cursor, chains, scratch, out = recorder
    weight = load(c, clock, WEIGHT)
    count, kept = len(contacts), 2 * len(contacts)
    for b in range(len(watched)):
        velocity = _hermite(
            load(c, start, kept + 2 * b),
            step * load(c, start, kept + 2 * b + 1),
            load(c, end, kept + 2 * b),
            step * load(c, end, kept + 2 * b + 1),
            fraction,
        )
        before = zero(c)
        if watched[b, BEFORE] >= 0:
            before = load(c, scratch, 1 + watched[b, BEFORE])
        behind = load(c, scratch, 1 + watched[b, BEHIND])
        acceleration = _acceleration(c, table, first, watched[b], weight, before, behind, velocity)
        store(c, scratch, 1 + count, velocity)
        store(c, scratch, 2 + count, acceleration)
        for k in range(len(cursor)):
            if clock[DUE, k] < scratch[0, k]:
                out[chains[k], count + 2 * b, cursor[k]] = scratch[1 + count, k]
                out[chains[k], count + 2 * b + 1, cursor[k]] = scratch[2 + count, k]


@_inlined
def emit(c, table, first, recorder, start, end, before, time, step):
    """Write the samples that fall between `before` and `time`, chain by chain at its own moments."""
    interval, contacts, _, clock, cursor, chains, scratch, out = recorder
    store(c, scratch, 0, time)
    while is_any_positive(time - load(c, clock, DUE)):
        fraction = (load(c, clock, DUE) + load(c, clock, TOLERANCE) - before) / step
        for r in range(len(contacts)):
            store(c, scratch, 1 + r, _sample(c, table, first + contacts[r], start, end, r, step, fraction))
            for k in range(len(cursor)):
                if clock[DUE, k] < scratch[0, k]:
                    out[chains[k], r, cursor[k]] = scratch[1 + r, k]
        emit_motion(c, table, first, recorder, start, end, step, fraction)
        for k in range(len(cursor)):
            if clock[DUE, k] < scratch[0, k]:
                cursor[k] += 1
                due = cursor[k] * interval - clock[TOLERANCE, k]
                clock[DUE, k] = due if cursor[k] < out.shape[2] else np.inf
