"""The compiled stepper: one pass over the bodies advances positions, forces and velocities.

Bodies are numbered from the striker (0) to the last bead; contact c joins body c and body c + 1, and
behind the last bead stands the wall, a body that never moves. Only bodies that the wave has reached
are stepped: the first one beyond them is still at rest, so that it serves as their wall.

Two explicit steppers share the force laws (`compose`), which decide between them. Coefficients: `methods`.

* splitting: symplectic drifts (positions) and kicks (velocities), for laws that depend on positions
  alone;
* Runge–Kutta in low storage, for laws with rates or memory.

Every chain has its own step: a result does not depend on the chains that are computed along with it.
Samples fall between steps: see `sampling`. The laws are put in later, see `linking`.
"""

from numba import njit
from numba.extending import overload

from sonicvacuum.physics.composition import (
    BALANCED,
    DUE,
    FINE_STEP,
    FINE_UNTIL,
    INVERSE_MASS,
    LAST,
    MADE,
    RAN_OUT,
    REST_FORCE,
    STEP,
    STEPPED,
    STOP,
    THRESHOLD,
    WEIGHT,
    U,
    V,
)
from sonicvacuum.physics.lanes import absolute, select
from sonicvacuum.physics.sampling import COMPILED_ONLY, Recorder, emit, note, note_motion
from sonicvacuum.physics.table import (
    INLINED,
    advance_memory,
    body_acceleration,
    end_memory,
    first_increment,
    first_memory,
    follow_path,
    get,
    is_any_positive,
    keep_memory,
    load,
    preloaded,
    push,
    put,
    store,
    stored_energy,
    zero,
)

# Bodies that are switched on together, ahead of the wave.
MARGIN = 4

_inlined = njit(**INLINED)


@_inlined
def _pass_splitting(c, table, first, beyond, force_before, drift, kick):
    """Drift all bodies, then kick them; returns the force on the body beyond."""
    speed = get(c, table, first, V)
    x = get(c, table, first, U) + drift * speed
    for body in range(first, beyond):
        speed_ahead = get(c, table, body + 1, V)
        ahead = get(c, table, body + 1, U) + drift * speed_ahead
        force = push(c, table, body, x - ahead, speed, 0)
        put(c, table, body, U, x)
        put(c, table, body, V, speed + kick * get(c, table, body, INVERSE_MASS) * (force_before - force))
        force_before = force
        x = ahead
        speed = speed_ahead
    return force_before


@_inlined
def _step_splitting(c, table, first, beyond, weight, factors, gains, step, pending):
    """One step; returns the impulse on the body beyond. Positions then lack the last drift."""
    impulse = zero(c)
    for stage in range(len(gains)):
        kick = gains[stage] * step
        force = _pass_splitting(c, table, first, beyond, weight, factors[stage] * step + pending, kick)
        impulse = impulse + kick * force
        pending = zero(c)
    return impulse


@_inlined
def _pass_runge_kutta(c, table, first, beyond, force_before, keep, gain, step, moved_column):
    """One low-storage stage of all bodies; returns the force on the body beyond."""
    sped_column = moved_column + 1
    x = get(c, table, first, U)
    speed = get(c, table, first, V)
    for body in range(first, beyond):
        ahead = get(c, table, body + 1, U)
        speed_ahead = get(c, table, body + 1, V)
        force = push(c, table, body, x - ahead, speed - speed_ahead, first_memory(c))
        advance_memory(c, table, body, x - ahead, keep, gain, step)
        acceleration = get(c, table, body, INVERSE_MASS) * (force_before - force)
        if body > first:
            acceleration = acceleration + body_acceleration(c, table, body, speed)
        moved = keep * get(c, table, body, moved_column) + step * speed
        sped = keep * get(c, table, body, sped_column) + step * acceleration
        put(c, table, body, moved_column, moved)
        put(c, table, body, sped_column, sped)
        put(c, table, body, U, x + gain * moved)
        put(c, table, body, V, speed + gain * sped)
        force_before = force
        x = ahead
        speed = speed_ahead
    return force_before


@_inlined
def _step_runge_kutta(c, table, first, beyond, weight, factors, gains, step, pending):
    impulse = zero(c)
    increment = zero(c)
    for stage in range(len(gains)):
        force = _pass_runge_kutta(
            c, table, first, beyond, weight, factors[stage], gains[stage], step, first_increment(c)
        )
        increment = factors[stage] * increment + step * force
        impulse = impulse + gains[stage] * increment
    for body in range(first, beyond):
        follow_path(c, table, body, step)
    return impulse


def _step(c, table, first, beyond, weight, factors, gains, step, pending):
    """One step by the stepper that suits the laws; returns the impulse on the body beyond."""
    raise TypeError(COMPILED_ONLY)


@overload(_step, jit_options=INLINED)
def _choose_step(c, table, first, beyond, weight, factors, gains, step, pending):
    stepper = _step_splitting if c.frame.splits else _step_runge_kutta
    return stepper.py_func


def _audit(c, table, first, beyond, weight, impulse, pending, time, balance, status):
    """Keep total energy, and total momentum less all impulses received: both must stay constant."""
    raise TypeError(COMPILED_ONLY)


@overload(_audit, jit_options=INLINED)
def _choose_audit(c, table, first, beyond, weight, impulse, pending, time, balance, status):
    if not c.frame.audited:
        return lambda c, table, first, beyond, weight, impulse, pending, time, balance, status: None
    return _keep_balance


def _keep_balance(c, table, first, beyond, weight, impulse, pending, time, balance, status):
    energy = -weight * (get(c, table, first, U) + pending * get(c, table, first, V))
    momentum = impulse - weight * time
    for body in range(first, beyond):
        speed = get(c, table, body, V)
        rate = speed - get(c, table, body + 1, V)
        approach = get(c, table, body, U) - get(c, table, body + 1, U) + pending * rate
        mass = 1.0 / get(c, table, body, INVERSE_MASS)
        energy = energy + 0.5 * mass * speed * speed + stored_energy(c, table, body, approach)
        momentum = momentum + mass * speed
    entry = status[BALANCED]
    if entry < len(balance):
        store(c, balance, 2 * entry, energy)
        store(c, balance, 2 * entry + 1, momentum)
        status[BALANCED] = entry + 1


@_inlined
def _set_rest_force(c, table, body):
    """Keep the static force of a contact, by the law itself: what is at rest then stays so to the bit."""
    if preloaded(c) > 0:
        put(c, table, body, REST_FORCE, zero(c))
        put(c, table, body, REST_FORCE, push(c, table, body, zero(c), zero(c), first_memory(c)))


@_inlined
def _advance_group(
    c, factors, gains, table, first, bodies, extendable, recorder, start, end, every, balance, status
):
    """Integrate one group, whose bodies begin at row `first` of the table."""
    clock, contacts = recorder.clock, recorder.contacts
    weight = load(c, clock, WEIGHT)
    threshold = load(c, clock, THRESHOLD)
    pending_part = factors[-1] if len(factors) > len(gains) else 0.0
    beyond = first + min(MARGIN, bodies)
    time = zero(c)
    pending = zero(c)
    impulse = zero(c)
    count = 0
    noted = False
    for body in range(first, first + bodies):
        _set_rest_force(c, table, body)
        follow_path(c, table, body, zero(c))
    _audit(c, table, first, beyond, weight, impulse, pending, time, balance, status)
    while True:
        step = select(load(c, clock, FINE_UNTIL) - time, load(c, clock, FINE_STEP), load(c, clock, STEP))
        # A chain that is done rests while the others of its group go on.
        step = select(load(c, clock, LAST) - time, step, zero(c))
        if not is_any_positive(step):
            break
        while beyond < first + bodies and is_any_positive(absolute(get(c, table, beyond - 1, V)) - threshold):
            beyond = min(beyond + MARGIN, first + bodies)
        if extendable and beyond == first + bodies:
            status[RAN_OUT] = 1
            break
        before = time
        time = time + step
        sampled = is_any_positive(time - load(c, clock, DUE))
        if sampled:
            for r in range(len(contacts)):
                keep_memory(c, table, first + contacts[r], step)
        if sampled and not noted:
            note(c, table, first, contacts, pending, start)
            note_motion(c, table, first, recorder, start)
        impulse = impulse + _step(c, table, first, beyond, weight, factors, gains, step, pending)
        pending = pending_part * step
        if sampled:
            for r in range(len(contacts)):
                end_memory(c, table, first + contacts[r], step)
            note(c, table, first, contacts, pending, end)
            note_motion(c, table, first, recorder, end)
            emit(c, table, first, recorder, start, end, before, time, step)
            start, end = end, start
        noted = sampled
        count += 1
        status[MADE] = count
        if status[STOP] > 0:
            break
        if every > 0 and count % every == 0:
            _audit(c, table, first, beyond, weight, impulse, pending, time, balance, status)
    for body in range(first, beyond):
        put(c, table, body, U, get(c, table, body, U) + pending * get(c, table, body, V))
    status[STEPPED] = beyond - first


def advance(
    c,
    first,
    second,
    interval,
    contacts,
    watched,
    table,
    extendable,
    clock,
    cursor,
    chains,
    work,
    out,
    every,
    balance,
    status,
    begin,
    end,
):
    """Integrate the groups `begin` … `end` − 1, each one chain or eight, in place.

    Args:
        c: Frame; its width is the last axis L of the arrays marked so.
        first, second: coefficients of the `Method`.
        interval: time between samples in s.
        contacts: (R,) contacts whose force is recorded.
        watched: (B, 3) bodies whose motion is recorded: BODY, BEFORE and BEHIND of each.
        table: (groups, bodies + 1, columns, L) bodies, see `composition`; final state on return.
        extendable: whether further bodies exist beyond the table; then a group stops as the wave gets there.
        clock: (groups, CLOCK_ROWS, L) steps in s before and after the time FINE_UNTIL, moment of the last
            sample less TOLERANCE, weight of the striker in N, speed above which a body counts as moving,
            TOLERANCE of a sample's moment, moment of the next sample less TOLERANCE.
        cursor: (groups, L) next sample.
        chains: (groups, L) position of each chain in `out`.
        work: (3, 2 R + 2 B + 3, L) work space.
        out: (chains, R + 2 B, samples) forces in N beyond the static ones, then of each body the velocity in
            m/s and the acceleration in m/s².
        every: steps between entries of the balance.
        balance: (groups, entries, 2, L) total energy in J and momentum less received impulses in N s.
        status: (groups, STATUS_ENTRIES) see STEPPED to STOP.
        begin, end: range of groups.
    """
    bodies = table.shape[1] - 1
    for g in range(begin, end):
        recorder = Recorder(interval, contacts, watched, clock[g], cursor[g], chains[g], work[0], out)
        first_row = g * (bodies + 1)
        _advance_group(
            c,
            first,
            second,
            table,
            first_row,
            bodies,
            extendable,
            recorder,
            work[1],
            work[2],
            every,
            balance[g],
            status[g],
        )
