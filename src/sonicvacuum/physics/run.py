"""From a batch of chains to contact forces and motions in time: the one way into the compiled stepper.

Chooses each chain's step, deals chains into groups of lanes, steps only as many beads as the wave
reaches, and keeps the audit (energy and momentum balance).
"""

import math
import os
from itertools import pairwise

import numpy as np

from sonicvacuum.physics import composition, watch
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.composition import INVERSE_MASS, REST, Composition, V
from sonicvacuum.physics.history import History
from sonicvacuum.physics.kernels import advance, prepare
from sonicvacuum.physics.lanes import LANES
from sonicvacuum.physics.laws import depth_at, memory_at_rest
from sonicvacuum.physics.methods import CARPENTER_KENNEDY, METHODS
from sonicvacuum.physics.steps import choose_steps, reachable_bodies

# A body moves once it is faster than this fraction of the impact speed.
FRONT = 1e-12
# A sample within this fraction of a step after the step's end belongs to it: they coincide but for rounding.
COINCIDENCE = 1e-9
AUDIT_ENTRIES = 400
# Shares of the work per thread, so that threads end together though groups differ in cost.
SHARES = 8
# Beyond so many bodies one chain or two take no lanes: eight copies cost more than compiling.
LONG = 1000
# Steps that no counter holds, and no computer takes.
COUNTLESS = 2.0**53
# Steps of one body (in all lanes of a group) below which a call is over in a fraction of a second.
SHORT = 5e6
# And below which threads take longer to begin than the call by itself.
BRIEF = 1e5


def simulate(
    chain: Chain,
    contacts,
    duration: float,
    interval: float,
    *,
    bodies=(),
    step: float | None = None,
    refine: float = 1.0,
    method: str = "blanes-moan",
    symplectic: bool = True,
    audit: bool = False,
    threads: int = 1,
    alone: bool = False,
) -> History:
    """Integrate a batch of chains from the moment of impact.

    The result for a chain does not depend on `threads`, nor on the other chains of the batch as long as these
    have no other laws. A batch is stepped by the union of its laws: beside a chain that loses energy one that
    loses none takes the Runge–Kutta stepper too, and differs by the steppers' errors, 1e-6 of the peak.
    `alone` changes rounding errors only.

    Args:
        chain: what is integrated, `chain.lanes` chains.
        contacts: those whose force is recorded; contact c joins body c and c + 1, the striker being body 0.
        duration: s.
        interval: time between samples in s; independent of the step.
        bodies: those whose velocity and acceleration are recorded, the striker being 0.
        step: step in s for all chains and times; None: chosen for each chain, see `steps`.
        refine: divides the chosen step; 2 gives the halved step of an error estimate.
        method: "blanes-moan" (order 4) or "verlet" (order 2), for laws that depend on positions alone.
        symplectic: False takes the Runge–Kutta stepper of dissipative laws for any law.
        audit: keep the energy and momentum balance.
        threads: groups run on so many threads.
        alone: whether one chain or two are computed without lanes, as long ones are: a short one takes two
            thirds of the time then, and code that has to be compiled first.

    Raises:
        ValueError: for a contact, body or method that does not exist, a duration, interval, step or
            refinement that is not positive, or no thread.
        FloatingPointError: when the motion ceases to be finite.
    """
    bodies = tuple(int(b) for b in bodies)
    contacts = _with_neighbours(tuple(int(c) for c in contacts), bodies)
    _check_request(chain, contacts, bodies, duration, interval, step, refine, method, threads)
    laws = chain.laws(symplectic)
    scheme = METHODS[method] if laws.splits else CARPENTER_KENNEDY
    samples = int(np.floor(duration / interval * (1.0 + 1e-12))) + 1
    every = chain.beads + 1
    reachable = min(every, reachable_bodies(chain, duration))
    while True:
        batch = _Batch(
            chain, laws, reachable, contacts, bodies, samples, interval, step, refine, audit, alone
        )
        batch.run(scheme, threads)
        if not batch.status[:, composition.RAN_OUT].any():
            return batch.history()
        reachable = min(every, 2 * reachable)


def _with_neighbours(contacts, bodies):
    """The contacts asked for, then those of the bodies that are not among them."""
    needed = {c for b in bodies for c in (b - 1, b) if c >= 0}
    return (*contacts, *sorted(needed - set(contacts)))


def _check_request(chain, contacts, bodies, duration, interval, step, refine, method, threads):
    for b in bodies:
        if not 0 <= b <= chain.beads:
            raise ValueError(
                f"body {b} does not exist; a chain of {chain.beads} beads has 0 to {chain.beads}"
            )
    for c in contacts:
        if not 0 <= c <= chain.beads:
            raise ValueError(
                f"contact {c} does not exist; a chain of {chain.beads} beads has 0 to {chain.beads}"
            )
    if not (duration > 0.0 and interval > 0.0):
        raise ValueError(f"duration {duration} s and interval {interval} s must be positive")
    if not (refine > 0.0 and (step is None or step > 0.0)):
        raise ValueError(f"step {step} s and refine {refine} must be positive")
    if method not in METHODS:
        raise ValueError(f"method is {method!r}; use one of {', '.join(METHODS)}")
    if threads < 1:
        raise ValueError(f"threads is {threads}; it must be 1 or more")


def _zeros(*shape):
    """Zeros aligned to the 64 bytes of a cache line and a register."""
    size = math.prod(shape)
    buffer = np.zeros(size + 8)
    start = -(buffer.__array_interface__["data"][0] // 8) % 8
    return buffer[start : start + size].reshape(shape)


def _deal(cost, alone):
    """(groups, width) chains of each group, like costs together, dearest first; the last chain fills up."""
    order = np.argsort(-cost, kind="stable")
    width = 1 if alone and len(order) <= 2 else LANES
    groups = -(-len(order) // width)
    dealt = np.empty(groups * width, dtype=np.int64)
    dealt[: len(order)] = order
    dealt[len(order) :] = order[-1]
    return dealt.reshape(groups, width)


class _Batch:
    """The arrays of one call of the stepper: group first, lane last."""

    def __init__(self, chain, laws, bodies, contacts, watched, samples, interval, step, refine, audit, alone):
        self.chain, self.laws, self.bodies = chain, laws, bodies
        self.wanted, self.samples, self.interval = contacts, samples, interval
        self.recorded = [c for c in contacts if c < bodies]
        self.watched, self.moving = watched, [b for b in watched if b < bodies]
        coefficients, mass = chain.coefficients(laws, bodies), chain.masses(bodies)
        self._choose_steps(coefficients, mass, step, refine)
        self.dealt = _deal(self.steps, alone or bodies > LONG)
        self.composition = Composition(laws, self.dealt.shape[1], audit, bool(watched))
        self._fill_table(coefficients, mass)
        self._set_clock()
        self._make_room(audit)

    def _choose_steps(self, coefficients, mass, step, refine):
        lanes, end = self.chain.lanes, (self.samples - 1) * self.interval
        if step is None:
            steps = choose_steps(self.chain, self.laws, coefficients, mass, refine)
        else:
            steps = np.full(lanes, step / refine), np.full(lanes, step / refine), np.zeros(lanes)
        self.fine, self.late, self.until = fine, late, until = steps
        with np.errstate(all="ignore"):
            self.steps = np.minimum(until, end) / fine + np.maximum(end - until, 0.0) / late
        countless = ~(self.steps < COUNTLESS)
        if countless.any():
            worst = int(countless.argmax())
            raise FloatingPointError(
                f"chain {worst}: asks for {self.steps[worst]:.3g} steps of {self.late[worst]:.3g} s; "
                "a number of its bodies or laws is far too large or too small"
            )

    def _spread(self, values):
        """(…, lanes) → (groups, …, width)."""
        spread = values[..., self.dealt]
        return spread.transpose(spread.ndim - 2, *range(spread.ndim - 2), spread.ndim - 1)

    def _fill_table(self, coefficients, mass):
        c, bodies = self.composition, self.bodies
        self.table = _zeros(len(self.dealt), bodies + 1, c.columns, c.width)
        self.table[:, 0, V] = self.chain.speed[self.dealt]
        # The wall has no mass to divide by; the stepper leaves it alone.
        body = self.table[:, :bodies]
        body[:, :, INVERSE_MASS] = self._spread(1.0 / mass)
        body[:, :, c.first_coefficient : c.first_memory] = self._spread(coefficients)
        if not (self.laws.preloaded or c.memories):
            return
        load = self.chain.static_forces(bodies)
        delta = depth_at(self.laws, coefficients, load)
        memory = memory_at_rest(self.laws, coefficients, delta)
        body[:, :, c.first_memory : c.first_increment] = self._spread(memory)
        if self.laws.preloaded:
            body[:, :, REST] = self._spread(delta - self.chain.gaps(bodies))

    def _set_clock(self):
        tolerance = COINCIDENCE * self.late
        clock = self.clock = _zeros(len(self.dealt), composition.CLOCK_ROWS, self.dealt.shape[1])
        for row, values in (
            (composition.FINE_STEP, self.fine),
            (composition.STEP, self.late),
            (composition.FINE_UNTIL, self.until),
            (composition.LAST, (self.samples - 1) * self.interval - tolerance),
            (composition.WEIGHT, self.chain.striker_mass * self.chain.gravity),
            (composition.THRESHOLD, FRONT * self.chain.speed),
            (composition.TOLERANCE, tolerance),
            (composition.DUE, self.interval - tolerance),
        ):
            clock[:, row] = values[self.dealt]

    def _make_room(self, audit):
        groups, width = self.dealt.shape
        self.cursor = np.ones((groups, width), dtype=np.int64)
        rows = len(self.recorded) + 2 * len(self.moving)
        self.out = np.empty((self.chain.lanes, rows, self.samples))
        self.out[:, :, 0] = 0.0
        for b, body in enumerate(self.moving):
            if body == 0:
                self.out[:, len(self.recorded) + 2 * b, 0] = self.chain.speed
                self.out[:, len(self.recorded) + 2 * b + 1, 0] = self.chain.gravity
        self.status = np.zeros((groups, composition.STATUS_ENTRIES), dtype=np.int64)
        count = int(self.steps.max()) + 2
        self.every = max(1, count // AUDIT_ENTRIES) if audit else 0
        entries = count // self.every + 2 if audit else 0
        self.balance = np.zeros((groups, entries, 2, width))

    def run(self, scheme, threads):
        """Integrate all groups, each thread a share at a time."""
        groups, width = self.dealt.shape
        contacts = np.array(self.recorded, dtype=np.int64)
        row = {c: r for r, c in enumerate(self.recorded)}
        places = [(b, row.get(b - 1, -1), row[b]) for b in self.moving]
        watched = np.array(places, dtype=np.int64).reshape(-1, 3)
        extendable = self.bodies <= self.chain.beads

        def share(begin, end):
            work = _zeros(3, 2 * len(contacts) + 2 * len(watched) + 3, width)
            return (
                self.composition,
                scheme.first,
                scheme.second,
                self.interval,
                contacts,
                watched,
                self.table,
                extendable,
                self.clock,
                self.cursor,
                self.dealt,
                work,
                self.out,
                self.every,
                self.balance,
                self.status,
                begin,
                end,
            )

        everything = share(0, groups)
        prepare(*everything)
        expected = float(self.steps[self.dealt].max(axis=1).sum())
        alone = threads == 1 or groups == 1
        if expected * self.bodies < (SHORT if alone else BRIEF):
            advance(*everything)
        else:
            count = 1 if threads == 1 else min(SHARES * threads, groups)
            bounds = np.linspace(0, groups, count + 1).astype(int).tolist()
            shares = [share(*ends) for ends in pairwise(bounds)]
            made = self.status[:, composition.MADE]
            watch.run(advance, shares, threads, self._stop, lambda: min(1.0, made.sum() / expected))
        self._check_finite()

    def _stop(self):
        self.status[:, composition.STOP] = 1

    def _check_finite(self):
        sane = np.isfinite(self.table[:, :, V]).all(axis=1)
        if not sane.all():
            chain = int(self.dealt[~sane][0])
            raise FloatingPointError(
                f"chain {chain}: the motion is no longer finite at a step of {self.late[chain]:.3g} s; "
                "check its parameters, or set a smaller step or a larger refine"
            )

    def _collect(self, values):
        """(groups, …, width) → (…, lanes)."""
        collected = np.empty((*values.shape[1:-1], self.chain.lanes))
        collected[..., self.dealt] = values.transpose(*range(1, values.ndim - 1), 0, values.ndim - 1)
        return collected

    def history(self):
        """The results in the chains' own order, what the wave never reached at zero."""
        count = len(self.recorded)
        force = self._complete(self.out[:, :count], self.wanted)
        velocity = self._complete(self.out[:, count::2], self.watched)
        acceleration = self._complete(self.out[:, count + 1 :: 2], self.watched)
        entries = int(self.status[:, composition.BALANCED].min())
        balance = self._collect(self.balance[:, :entries]) if entries else np.empty((0, 2, self.chain.lanes))
        return History(
            time=np.arange(self.samples) * self.interval,
            contacts=self.wanted,
            force=force.transpose(2, 1, 0),
            energy=balance[:, 0] if self.laws.stores_energy else balance[:0, 0],
            momentum=balance[:, 1],
            striker_speed=self._collect(self.table[:, 0, V]),
            step=self.late,
            bodies=self.watched,
            velocity=velocity.transpose(2, 1, 0),
            acceleration=acceleration.transpose(2, 1, 0),
        )

    def _complete(self, found, wanted):
        """(lanes, wanted, samples) of contacts or bodies from those that were stepped, the others at zero."""
        if found.shape[1] == len(wanted):
            return found
        whole = np.zeros((self.chain.lanes, len(wanted), self.samples))
        whole[:, [w < self.bodies for w in wanted]] = found
        return whole


def available_threads() -> int:
    """Number of processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
