"""Integrator for hidden-effect data: Dormand and Prince's pair 5(4) with error control, a chain at a time,
compiled.

The tableau is scipy's (`scipy.integrate.RK45`; Dormand & Prince, J. Comput. Appl. Math. 6, 19, 1980). Steps
shrink where contacts open, close or turn, so that no law needs events. Forces between steps come from the
fifth-degree Hermite polynomial of displacement, velocity and acceleration at both ends of a step.
"""

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.integrate import RK45

from sonicvacuum.blind.laws import C, contact, deceleration, marked

TOLERANCE = 1e-8
SAFETY, SHRINK, GROW = 0.9, 0.2, 4.0
_A = np.zeros((7, 7))
_A[:6, :5] = RK45.A
_A[6, :6] = RK45.B
_C = np.append(RK45.C, 1.0)
_E = np.array(RK45.E)
_RESIDUAL, _RELAXING = C["residual"], C["relaxing"]


@dataclass(frozen=True)
class Problem:
    """One chain and its impact; contact c joins bodies c and c + 1, the last one joins the last bead to the
    wall.

    Attributes:
        mass: (bodies,) kg, the striker first.
        load: (bodies,) constant force in N towards the wall on each body (weight, preload, support).
        rest: (contacts,) compression in m at rest; negative where a contact is open.
        rows: (contacts, columns) numbers of the contact laws, `laws.CONTACT`.
        drag: (bodies, columns) numbers of drag and friction, `laws.BODY`.
        speed: m/s of the striker at time 0.
        push: (amplitude N, start s, length s) of a sin² force on bead 1, all zero for none.
        wall: (stiffness N/m, damping kg/s) that hold the last body where contacts are one fewer than bodies:
            a wall with a mass of its own; zeros for a fixed wall.
    """

    mass: np.ndarray
    load: np.ndarray
    rest: np.ndarray
    rows: np.ndarray
    drag: np.ndarray
    speed: float
    push: tuple[float, float, float] = (0.0, 0.0, 0.0)
    wall: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Motion:
    """What came out.

    Attributes:
        force: (samples, contacts recorded) N, whole force, static part included.
        displacement, velocity: (samples, bodies) m and m/s, (0, bodies) unless asked for.
        steps: number of accepted steps.
    """

    force: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    steps: int


def integrate(
    problem: Problem, times: np.ndarray, contacts, *, states: bool = False, tolerance: float = TOLERANCE
) -> Motion:
    """Forces of some contacts at given true times.

    Args:
        problem: the chain.
        times: (samples,) ascending true times in s, 0 or later.
        contacts: whose force is recorded.
        states: record all displacements and velocities too.
        tolerance: error of one step over the impact's own compression and speed.

    Raises:
        ValueError: where the steps become too small or too many: laws that the chain cannot follow.
    """
    hertz = problem.rows[:, 0]
    mass = float(np.min(problem.mass))
    scale = (1.25 * mass * problem.speed**2 / float(np.max(hertz))) ** 0.4
    contact_time = scale / problem.speed
    force, u, v, steps = _integrate(
        problem.mass,
        problem.load,
        problem.rest,
        marked(problem.rows),
        problem.drag,
        problem.speed,
        np.array(problem.push),
        np.array(problem.wall),
        np.ascontiguousarray(times),
        np.array(tuple(contacts), dtype=np.int64),
        states,
        tolerance,
        scale,
        contact_time,
    )
    if steps < 0:
        raise ValueError(f"no solution to {tolerance:g}: the laws are too stiff for the chain")
    return Motion(force, u, v, steps)


@njit(nogil=True, error_model="numpy")
def _slopes(t, u, v, q, largest, rest, rows, drag, mass, load, push, wall, acceleration, growth, drags):
    bodies, contacts = len(mass), len(rest)
    before = 0.0
    for i in range(bodies):
        after = 0.0
        if i < contacts:
            ahead_u, ahead_v = (u[i + 1], v[i + 1]) if i + 1 < bodies else (0.0, 0.0)
            after, growth[i] = contact(rest[i] + u[i] - ahead_u, v[i] - ahead_v, q[i], largest[i], rows, i)
        else:
            after = wall[0] * u[i] + wall[1] * v[i]
        acceleration[i] = (before - after + load[i]) / mass[i]
        if drags:
            acceleration[i] -= deceleration(v[i], drag, i)
        before = after
    if push[0] != 0.0 and push[1] < t < push[1] + push[2]:
        acceleration[1] += push[0] * math.sin(math.pi * (t - push[1]) / push[2]) ** 2 / mass[1]


@njit(nogil=True, error_model="numpy")
def _combine(start, slopes, weights, stages, h, out):
    """start + h Σ weights × slopes over the first stages; bodies innermost, for the vector unit."""
    out[:] = start
    for j in range(stages):
        w = h * weights[j]
        if w != 0.0:
            for i in range(len(start)):
                out[i] += w * slopes[j, i]


@njit(nogil=True, error_model="numpy")
def _stages(
    t, h, u, v, q, largest, rest, rows, drag, mass, load, push, wall, ku, kv, kq, du, dv, dq, remembers, drags
):
    """Stages 1 to 6 of the pair; stage 0 is known. Leaves the new state in du, dv, dq."""
    for s in range(1, 7):
        _combine(u, ku, _A[s], s, h, du)
        _combine(v, kv, _A[s], s, h, dv)
        if remembers:
            _combine(q, kq, _A[s], s, h, dq)
        ku[s] = dv
        _slopes(
            t + _C[s] * h, du, dv, dq, largest, rest, rows, drag, mass, load, push, wall, kv[s], kq[s], drags
        )


@njit(nogil=True, error_model="numpy")
def _worst(slopes, h, scale, scratch):
    """Largest error of a step over its scale."""
    scratch[:] = 0.0
    _combine(scratch, slopes, _E, 7, h, scratch)
    return np.max(np.abs(scratch)) / scale


@njit(nogil=True, error_model="numpy")
def _turning(u, v, du, dv, rest, largest, speed):
    """Fraction of a step after which the first contact turns from loading to unloading; 1 where none does."""
    share, slow = 1.0, 1e-5 * speed
    for c in range(len(rest)):
        ahead = c + 1 < len(u)
        delta = rest[c] + u[c] - (u[c + 1] if ahead else 0.0)
        before = v[c] - (v[c + 1] if ahead else 0.0)
        after = dv[c] - (dv[c + 1] if ahead else 0.0)
        if delta > 0.0 and delta >= largest[c] and before > slow and after < -slow:
            share = min(share, before / (before - after))
    return share


@njit(nogil=True, error_model="numpy")
def _hermite(s, h, a, b, va, vb, aa, ab):
    """Displacement and velocity at the fraction s of a step, from u, v and acceleration at both ends."""
    p, m, k = va * h, vb * h, b - a
    c2 = 0.5 * aa * h * h
    d2 = 0.5 * ab * h * h
    r0, r1, r2 = k - p - c2, m - p - 2.0 * c2, 2.0 * (d2 - c2)
    c3 = 10.0 * r0 - 4.0 * r1 + 0.5 * r2
    c4 = -15.0 * r0 + 7.0 * r1 - r2
    c5 = 6.0 * r0 - 3.0 * r1 + 0.5 * r2
    x = a + s * (p + s * (c2 + s * (c3 + s * (c4 + s * c5))))
    y = (p + s * (2.0 * c2 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / h
    return x, y


@njit(nogil=True, error_model="numpy")
def _integrate(
    mass, load, rest, rows, drag, speed, push, wall, times, recorded, states, tolerance, scale, contact_time
):
    bodies, contacts, samples = len(mass), len(rest), len(times)
    u, v, q = np.zeros(bodies), np.zeros(bodies), np.zeros(contacts)
    v[0] = speed
    largest = np.maximum(rest, 0.0)
    ku, kv, kq = np.zeros((7, bodies)), np.zeros((7, bodies)), np.zeros((7, contacts))
    du, dv, dq = np.zeros(bodies), np.zeros(bodies), np.zeros(contacts)
    force = np.zeros((samples, len(recorded)))
    kept = samples if states else 0
    all_u, all_v = np.zeros((kept, bodies)), np.zeros((kept, bodies))
    spare = np.zeros(bodies)
    drags = np.max(np.abs(drag)) > 0.0
    plastic, remembers = np.max(rows[:, _RESIDUAL]) > 0.0, np.max(rows[:, _RELAXING]) > 0.0
    scale_q = tolerance * mass.min() * speed / contact_time
    t, h, done, steps, tries = 0.0, 1e-3 * contact_time, 0, 0, 0
    _slopes(t, u, v, q, largest, rest, rows, drag, mass, load, push, wall, kv[0], kq[0], drags)
    ku[0] = v
    while done < samples:
        _stages(
            t,
            h,
            u,
            v,
            q,
            largest,
            rest,
            rows,
            drag,
            mass,
            load,
            push,
            wall,
            ku,
            kv,
            kq,
            du,
            dv,
            dq,
            remembers,
            drags,
        )
        error = max(_worst(ku, h, tolerance * scale, spare), _worst(kv, h, tolerance * speed, spare))
        if remembers:
            error = max(error, _worst(kq, h, scale_q, spare[:contacts]))
        tries += 1
        if tries > 10_000_000 or not error < np.inf:
            return force, all_u, all_v, -1
        factor = min(GROW, max(SHRINK, SAFETY * max(error, 1e-10) ** -0.2))
        # A discontinuity is crossed once the step is too short to matter.
        if error > 1.0 and h > 1e-9 * contact_time:
            h *= factor
            continue
        if plastic:
            # The largest compression is frozen within a step: a step ends where a contact turns.
            share = _turning(u, v, du, dv, rest, largest, speed)
            if share < 1.0:
                h *= share
                continue
        while done < samples and times[done] <= t + h:
            s = (times[done] - t) / h
            for r in range(len(recorded)):
                c = recorded[r]
                x, y = _hermite(s, h, u[c], du[c], v[c], dv[c], kv[0, c], kv[6, c])
                if c + 1 < bodies:
                    ahead = _hermite(
                        s, h, u[c + 1], du[c + 1], v[c + 1], dv[c + 1], kv[0, c + 1], kv[6, c + 1]
                    )
                    x, y = x - ahead[0], y - ahead[1]
                k, p, m = dq[c] - q[c], kq[0, c] * h, kq[6, c] * h
                slow = q[c] + s * (p + s * ((3.0 * k - 2.0 * p - m) + s * (p + m - 2.0 * k)))
                force[done, r], _ = contact(rest[c] + x, y, slow, largest[c], rows, c)
            if states:
                for i in range(bodies):
                    all_u[done, i], all_v[done, i] = _hermite(
                        s, h, u[i], du[i], v[i], dv[i], kv[0, i], kv[6, i]
                    )
            done += 1
        t += h
        steps += 1
        memory_lost = False
        for c in range(contacts):
            ahead = du[c + 1] if c + 1 < bodies else 0.0
            delta = rest[c] + du[c] - ahead
            if plastic:
                largest[c] = max(largest[c], delta)
            if delta <= 0.0 and dq[c] != 0.0:
                dq[c] = 0.0
                memory_lost = True
        u[:], v[:], q[:] = du, dv, dq
        if plastic or memory_lost:
            _slopes(t, u, v, q, largest, rest, rows, drag, mass, load, push, wall, kv[0], kq[0], drags)
            ku[0] = v
        else:
            ku[0], kv[0], kq[0] = ku[6], kv[6], kq[6]
        h *= factor
    return force, all_u, all_v, steps
