"""The compiled steppers: one pass over the bodies advances positions, forces and velocities.

Bodies are numbered from the striker (0) to the last bead; contact c joins body c and body c + 1, the
last contact is the wall. Only bodies that the wave has reached are stepped: the first body beyond
them is at rest, and so is the wall, hence both are the same boundary, zero displacement.

Two explicit steppers share the force laws:

* `advance_splitting`: symplectic splitting into drifts (positions) and kicks (velocities), for laws
  that depend on positions alone. Coefficients: `Method`.
* `advance_runge_kutta`: low-storage Runge–Kutta in five stages, order four (Carpenter & Kennedy,
  NASA TM 109112, 1994), for laws with rates or memory.

Samples fall between steps: the compression of each recorded contact is interpolated by the cubic
Hermite polynomial of its values and rates at both ends of the step, and the law gives the force.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numba.extending import overload

from sonicvacuum.physics.lanes import FASTMATH, absolute, get, get2, largest, put, put2
from sonicvacuum.physics.laws import (
    advance_memory,
    body_acceleration,
    contact_energy,
    contact_force,
    dynamic,
    compression,
    static_work,
)

# Bodies that are switched on together, ahead of the wave.
MARGIN = 4


@dataclass(frozen=True)
class Method:
    """A symmetric splitting method: drifts and kicks in units of the step.

    Attributes:
        name: identifies the method.
        order: order of convergence for smooth forces.
        drift: (stages + 1,) coefficients of the position updates; the last merges with the next step's first.
        kick: (stages,) coefficients of the velocity updates.
    """

    name: str
    order: int
    drift: tuple[float, ...]
    kick: tuple[float, ...]


def _symmetric(values, stages):
    return tuple(values) + tuple(reversed(values[: stages - len(values)]))


def _blanes_moan():
    """The method S6 of Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313, Table 2: six stages, order four."""
    a = [0.0792036964311957, 0.353172906049774, -0.0420650803577195]
    b = [0.209515106613362, -0.143851773179818]
    drift = [*a, 1.0 - 2.0 * sum(a)]
    kick = [*b, 0.5 - sum(b)]
    return Method("blanes-moan", 4, _symmetric(drift, 7), _symmetric(kick, 6))


VERLET = Method("verlet", 2, (0.5, 0.5), (1.0,))
BLANES_MOAN = _blanes_moan()
METHODS = {m.name: m for m in (VERLET, BLANES_MOAN)}

# Carpenter & Kennedy 1994, solution 3 of the five-stage, fourth-order, two-register schemes.
_RK_KEEP = np.array(
    [
        0.0,
        -567301805773 / 1357537059087,
        -2404267990393 / 2016746695238,
        -3550918686646 / 2091501179385,
        -1275806237668 / 842570457699,
    ]
)
_RK_GAIN = np.array(
    [
        1432997174477 / 9575080441755,
        5161836677717 / 13612068292357,
        1720146321549 / 2090206949498,
        3134564353537 / 4481467310338,
        2277821191437 / 14882151754819,
    ]
)
RUNGE_KUTTA_STAGES = len(_RK_KEEP)

_compile = njit(cache=True, fastmath=FASTMATH, error_model="numpy", nogil=True)
_inlined = njit(fastmath=FASTMATH, error_model="numpy", nogil=True)


@_inlined
def _pass_splitting(
    laws, u, v, inverse_mass, coefficients, memory, rest, rest_force, weight, drift, kick, active
):
    """Drift all bodies, then kick them; returns the dynamic force on the boundary behind the last one."""
    last = active - 1
    pull = weight
    x = get(u, 0) + drift * get(v, 0)
    for i in range(last):
        speed = get(v, i)
        ahead = get(u, i + 1) + drift * get(v, i + 1)
        delta = compression(laws, rest, i, x - ahead)
        push = dynamic(laws, rest_force, i, contact_force(laws, coefficients, memory, i, delta, speed))
        put(u, i, x)
        put(v, i, speed + kick * get(inverse_mass, i) * (pull - push))
        pull = push
        x = ahead
    speed = get(v, last)
    delta = compression(laws, rest, last, x)
    push = dynamic(laws, rest_force, last, contact_force(laws, coefficients, memory, last, delta, speed))
    put(u, last, x)
    put(v, last, speed + kick * get(inverse_mass, last) * (pull - push))
    return push


@_inlined
def _pass_runge_kutta(
    laws,
    u,
    v,
    increments,
    inverse_mass,
    coefficients,
    memory,
    memory_increments,
    rest,
    rest_force,
    weight,
    keep,
    gain,
    step,
    active,
):
    """One low-storage stage of all bodies; returns the dynamic force on the boundary."""
    last = active - 1
    pull = weight
    x = get(u, 0)
    speed = get(v, 0)
    push = weight
    for i in range(active):
        # The body ahead of the last one is at rest: subtracting x and speed from themselves keeps the type.
        ahead = get(u, i + 1) if i < last else x - x
        speed_ahead = get(v, i + 1) if i < last else x - x
        delta = compression(laws, rest, i, x - ahead)
        force = contact_force(laws, coefficients, memory, i, delta, speed - speed_ahead)
        advance_memory(laws, coefficients, memory, memory_increments, i, delta, keep, gain, step)
        push = dynamic(laws, rest_force, i, force)
        acceleration = get(inverse_mass, i) * (pull - push)
        if i > 0:
            acceleration = acceleration + body_acceleration(laws, coefficients, i, speed)
        moved = keep * get2(increments, i, 0) + step * speed
        sped = keep * get2(increments, i, 1) + step * acceleration
        put2(increments, i, 0, moved)
        put2(increments, i, 1, sped)
        put(u, i, x + gain * moved)
        put(v, i, speed + gain * sped)
        pull = push
        x = ahead
        speed = speed_ahead
    return push


def _step(
    laws,
    drift,
    kick,
    pending,
    u,
    v,
    increments,
    inverse_mass,
    coefficients,
    memory,
    memory_increments,
    old,
    contacts,
    rest,
    rest_force,
    weight,
    step,
    active,
):
    """One step by the stepper that suits the laws; returns the impulse on the boundary (compiled code only)."""
    raise TypeError("_step exists in compiled code only")


def _step_splitting(
    laws,
    drift,
    kick,
    pending,
    u,
    v,
    increments,
    inverse_mass,
    coefficients,
    memory,
    memory_increments,
    old,
    contacts,
    rest,
    rest_force,
    weight,
    step,
    active,
):
    impulse = weight - weight
    late = pending
    for j in range(len(kick)):
        a = drift[j] * step + late
        late = 0.0
        b = kick[j] * step
        push = _pass_splitting(
            laws, u, v, inverse_mass, coefficients, memory, rest, rest_force, weight, a, b, active
        )
        impulse = impulse + b * push
    return impulse


def _step_runge_kutta(
    laws,
    drift,
    kick,
    pending,
    u,
    v,
    increments,
    inverse_mass,
    coefficients,
    memory,
    memory_increments,
    old,
    contacts,
    rest,
    rest_force,
    weight,
    step,
    active,
):
    _keep_memory(memory, contacts, old)
    impulse = weight - weight
    increment = weight - weight
    for j in range(len(_RK_KEEP)):
        push = _pass_runge_kutta(
            laws,
            u,
            v,
            increments,
            inverse_mass,
            coefficients,
            memory,
            memory_increments,
            rest,
            rest_force,
            weight,
            _RK_KEEP[j],
            _RK_GAIN[j],
            step,
            active,
        )
        increment = _RK_KEEP[j] * increment + step * push
        impulse = impulse + _RK_GAIN[j] * increment
    return impulse


@overload(_step)
def _choose_step(
    laws,
    drift,
    kick,
    pending,
    u,
    v,
    increments,
    inverse_mass,
    coefficients,
    memory,
    memory_increments,
    old,
    contacts,
    rest,
    rest_force,
    weight,
    step,
    active,
):
    return _step_splitting if laws.laws.splits else _step_runge_kutta


@_inlined
def _note(laws, u, v, rest, contacts, pending, active, ends):
    """Write compression and rate of the recorded contacts, positions being `pending` seconds of drift behind."""
    for r in range(len(contacts)):
        c = contacts[r]
        rate = get(v, c)
        x = get(u, c) + pending * rate
        if c + 1 < active:
            ahead = get(v, c + 1)
            x = x - (get(u, c + 1) + pending * ahead)
            rate = rate - ahead
        put2(ends, r, 0, compression(laws, rest, c, x))
        put2(ends, r, 1, rate)


@_inlined
def _keep_memory(memory, contacts, old):
    for r in range(len(contacts)):
        for k in range(memory.shape[1]):
            put2(old, contacts[r], k, get2(memory, contacts[r], k))


@_inlined
def _emit(laws, coefficients, memory, old, blend, rest_force, contacts, start, end, step, fraction, out):
    """Dynamic force of the recorded contacts at a fraction of the step, by cubic Hermite compression."""
    f = fraction
    for r in range(len(contacts)):
        c = contacts[r]
        x0 = get2(start, r, 0)
        v0 = get2(start, r, 1)
        v1 = get2(end, r, 1)
        gap = get2(end, r, 0) - x0
        square = 3.0 * gap - step * (2.0 * v0 + v1)
        cube = step * (v0 + v1) - 2.0 * gap
        delta = x0 + f * (step * v0 + f * (square + f * cube))
        rate = v0 + (f * (2.0 * square + 3.0 * f * cube)) / step
        for k in range(memory.shape[1]):
            put2(blend, c, k, get2(old, c, k) * (1.0 - f) + get2(memory, c, k) * f)
        force = contact_force(laws, coefficients, blend, c, delta, rate)
        put(out, r, dynamic(laws, rest_force, c, force))


@_inlined
def _balance(
    laws, u, v, inverse_mass, coefficients, rest, rest_force, weight, impulse, pending, time, active, out
):
    """Total energy, total momentum less all impulses received since the start: both must stay constant."""
    energy = -weight * (get(u, 0) + pending * get(v, 0))
    momentum = impulse - weight * time
    for i in range(active):
        speed = get(v, i)
        x = get(u, i) + pending * speed
        if i + 1 < active:
            x = x - (get(u, i + 1) + pending * get(v, i + 1))
        energy = energy + 0.5 * speed * speed / get(inverse_mass, i)
        energy = energy + contact_energy(laws, coefficients, i, compression(laws, rest, i, x))
        energy = energy - contact_energy(laws, coefficients, i, compression(laws, rest, i, x - x))
        energy = energy - static_work(laws, rest_force, i, x)
        momentum = momentum + speed / get(inverse_mass, i)
    put(out, 0, energy)
    put(out, 1, momentum)


def _set_rest(laws, coefficients, memory, rest, rest_force):
    """Static force of every contact by the compiled law itself, so that a chain at rest stays so to the bit."""
    raise TypeError("_set_rest exists in compiled code only")


@overload(_set_rest)
def _choose_rest(laws, coefficients, memory, rest, rest_force):
    if not laws.laws.preloaded:
        return lambda laws, coefficients, memory, rest, rest_force: None

    def set_rest(laws, coefficients, memory, rest, rest_force):
        for c in range(len(rest)):
            delta = get(rest, c)
            put(rest_force, c, contact_force(laws, coefficients, memory, c, delta, delta - delta))

    return set_rest


@_inlined
def _reached(v, active, threshold):
    """Whether the last stepped body has begun to move."""
    return largest(absolute(get(v, active - 1))) > threshold


@_compile
def advance(
    laws,
    drift,
    kick,
    step_early,
    step_late,
    early,
    interval,
    contacts,
    u,
    v,
    memory,
    inverse_mass,
    coefficients,
    rest,
    rest_force,
    weight,
    threshold,
    extendable,
    balance_every,
    scratch,
    out,
    balance,
    status,
    first,
    beyond,
):
    """Integrate the groups `first` … `beyond` − 1, each a chain or eight chains, in place.

    Arrays have the group as first axis; those marked L have the lane as last axis, absent for single chains.

    Args:
        laws: LawSet of all chains.
        drift, kick: coefficients of a splitting method, used where the laws split; else drift is (0,), kick empty.
        step_early, step_late: (groups,) steps in s before and after the time `early` (groups,) in s.
        interval: time between samples in s; sample k is at (k) interval.
        contacts: (R,) contacts whose force is recorded.
        u, v: (groups, bodies, L) displacements from rest in m and velocities in m/s; final state on return.
        memory: (groups, bodies, memories, L).
        inverse_mass: (groups, bodies, L) in 1/kg.
        coefficients: (groups, bodies, n, L) of the law set, per contact.
        rest: (groups, bodies, L) compression of each contact at rest in m, negative for a gap; unused unless preloaded.
        rest_force: (groups, bodies, L) their static forces, set here from the law.
        weight: (groups, L) force on the striker in N.
        threshold: (groups,) speed in m/s above which a body counts as moving.
        extendable: whether further bodies exist beyond the arrays; then a group stops as the wave gets there.
        balance_every: steps between entries of the energy and momentum balance (0: none).
        scratch: (rows, columns, L) work space, shared by the groups of one call: see `scratch_rows`.
        out: (groups, samples, R, L) dynamic forces in N.
        balance: (groups, entries, 2, L) total energy in J and momentum less received impulses in N s.
        status: (groups, 3) on return: bodies stepped, entries of the balance, 1 if the wave ran out of the arrays.
        first, beyond: range of groups.
    """
    for g in range(first, beyond):
        _advance_group(
            laws,
            drift,
            kick,
            step_early[g],
            step_late[g],
            early[g],
            interval,
            contacts,
            u[g],
            v[g],
            memory[g],
            inverse_mass[g],
            coefficients[g],
            rest[g],
            rest_force[g],
            get(weight, g),
            threshold[g],
            extendable,
            balance_every,
            scratch,
            out[g],
            balance[g],
            status[g],
        )


@_inlined
def _advance_group(
    laws,
    drift,
    kick,
    step_early,
    step_late,
    early,
    interval,
    contacts,
    u,
    v,
    memory,
    inverse_mass,
    coefficients,
    rest,
    rest_force,
    weight,
    threshold,
    extendable,
    balance_every,
    scratch,
    out,
    balance,
    status,
):
    bodies = len(u)
    recorded = len(contacts)
    samples = len(out)
    stages = len(kick)
    start = scratch[:recorded]
    end = scratch[recorded : 2 * recorded]
    increments = scratch[2 * recorded : 2 * recorded + bodies]
    old = scratch[2 * recorded + bodies : 2 * recorded + 2 * bodies]
    blend = scratch[2 * recorded + 2 * bodies : 2 * recorded + 3 * bodies]
    memory_increments = scratch[2 * recorded + 3 * bodies : 2 * recorded + 4 * bodies]
    scratch[:] = 0.0
    _set_rest(laws, coefficients, memory, rest, rest_force)
    impulse = weight - weight
    active = min(MARGIN, bodies)
    sample = 0
    entry = 0
    count = 0
    time = 0.0
    pending = 0.0
    last_time = (samples - 1) * interval
    status[2] = 0
    _note(laws, u, v, rest, contacts, 0.0, active, start)
    for r in range(recorded):
        put(out[0], r, weight - weight)
    sample = 1
    if balance_every > 0:
        _balance(
            laws,
            u,
            v,
            inverse_mass,
            coefficients,
            rest,
            rest_force,
            weight,
            impulse,
            0.0,
            0.0,
            active,
            balance[0],
        )
        entry = 1
    while sample < samples:
        step = step_early if time < early else step_late
        impulse = impulse + _step(
            laws,
            drift,
            kick,
            pending,
            u,
            v,
            increments,
            inverse_mass,
            coefficients,
            memory,
            memory_increments,
            old,
            contacts,
            rest,
            rest_force,
            weight,
            step,
            active,
        )
        pending = drift[stages] * step
        before = time
        time = time + step
        count += 1
        while active < bodies and _reached(v, active, threshold):
            active = min(active + MARGIN, bodies)
        if extendable and active == bodies:
            status[2] = 1
            break
        _note(laws, u, v, rest, contacts, pending, active, end)
        # A sample that coincides with the step's end belongs to it in spite of rounding.
        while sample < samples and sample * interval <= time + 1e-9 * step:
            fraction = (sample * interval - before) / step
            _emit(
                laws,
                coefficients,
                memory,
                old,
                blend,
                rest_force,
                contacts,
                start,
                end,
                step,
                fraction,
                out[sample],
            )
            sample += 1
        start, end = end, start
        if balance_every > 0 and count % balance_every == 0 and entry < len(balance):
            _balance(
                laws,
                u,
                v,
                inverse_mass,
                coefficients,
                rest,
                rest_force,
                weight,
                impulse,
                pending,
                time,
                active,
                balance[entry],
            )
            entry += 1
    for i in range(active):
        put(u, i, get(u, i) + pending * get(v, i))
    status[0] = active
    status[1] = entry
