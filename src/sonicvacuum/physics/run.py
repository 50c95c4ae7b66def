"""From a batch of chains to contact forces in time: the one way into the compiled steppers.

Chooses the step from the chains' own time scales, deals chains into groups of lanes, steps only as
many beads as the wave reaches, and keeps the audit (energy and momentum balance).
"""

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.contact import compression_at, contact_time
from sonicvacuum.physics.kernel import BLANES_MOAN, METHODS, advance
from sonicvacuum.physics.lanes import LANES
from sonicvacuum.physics.laws import memory_at_rest, rest_compression

# Step in units of the contact time (m²/(K²v))^{1/5}: relative errors of peak forces below 1e-6 and of
# arrivals below 1 ns for the splitting method; see the cost-accuracy study in the benchmarks.
STEP = {"splitting": 0.1, "runge-kutta": 0.05}
# The striker's contact opens abruptly; steps are this much finer until it is surely over.
EARLY_REFINEMENT = 8
EARLY_CONTACT_TIMES = 4.5
# A body moves once it is faster than this fraction of the impact speed.
FRONT = 1e-12
FIRST_BODIES = 64


@dataclass(frozen=True)
class History:
    """Forces of one batch.

    Attributes:
        time: (samples,) s, from the moment of impact.
        contacts: recorded contacts.
        force: (samples, contacts, lanes) N, without the static part.
        energy: (entries, lanes) total energy in J at equidistant moments, empty without audit or where the
            law stores no simple energy.
        momentum: (entries, lanes) total momentum less all impulses received (wall, weight), N s.
        striker_speed: (lanes,) speed of the striker at the end in m/s.
        step: (lanes,) step in s after the impact phase.
    """

    time: np.ndarray
    contacts: tuple[int, ...]
    force: np.ndarray
    energy: np.ndarray
    momentum: np.ndarray
    striker_speed: np.ndarray
    step: np.ndarray

    def of(self, contact: int) -> np.ndarray:
        """(samples, lanes) force of one contact in N."""
        return self.force[:, self.contacts.index(contact)]


def time_scale(chain: Chain) -> np.ndarray:
    """(lanes,) shortest time scale in s: of the impact, or of the beads' vibration under static force."""
    bodies = min(chain.beads + 1, 3)
    stiffness = np.maximum(chain.stiffnesses(bodies).max(axis=0), chain.wall_stiffness)
    mass = chain.masses(bodies).min(axis=0)
    impact = contact_time(mass, stiffness, chain.speed)
    weight = chain.beads * chain.bead_mass * chain.gravity
    rest = compression_at(chain.static_force + weight, chain.stiffness)
    # Highest frequency of the linear chain: 2 √(k/m), k = (3/2) K √delta0; inf time where nothing is borne.
    with np.errstate(divide="ignore"):
        vibration = 1.0 / np.sqrt(1.5 * chain.stiffness * np.sqrt(rest) / chain.bead_mass)
    return np.minimum(impact, vibration)


def _early(chain):
    """(lanes,) s for which the striker's contact may open for the first time."""
    heavy = np.maximum(1.0, chain.striker_mass / chain.bead_mass)
    return EARLY_CONTACT_TIMES * heavy * contact_time(chain.bead_mass, chain.striker_stiffness, chain.speed)


def simulate(
    chain: Chain,
    contacts,
    duration: float,
    interval: float,
    *,
    step: float | None = None,
    refine: float = 1.0,
    method: str = "blanes-moan",
    symplectic: bool = True,
    audit: bool = False,
    threads: int = 1,
) -> History:
    """Integrate a batch of chains from the moment of impact.

    Args:
        chain: what is integrated, `chain.lanes` chains.
        contacts: contacts whose force is recorded; contact c joins body c and c + 1, the striker being body 0.
        duration: s.
        interval: time between samples in s; independent of the step.
        step: step in s; None: `STEP` times the shortest time scale of each group of lanes.
        refine: divides the chosen step; 2 gives the halved step of an error estimate.
        method: "blanes-moan" (order 4) or "verlet" (order 2), for laws that depend on positions alone.
        symplectic: False takes the Runge–Kutta stepper of dissipative laws for any law.
        audit: keep the energy and momentum balance.
        threads: groups run on so many threads; results do not depend on it.

    Raises:
        ValueError: for a contact that does not exist, or a duration or interval that is not positive.
    """
    contacts = tuple(int(c) for c in contacts)
    for c in contacts:
        if not 0 <= c <= chain.beads:
            raise ValueError(
                f"contact {c} does not exist; a chain of {chain.beads} beads has 0 to {chain.beads}"
            )
    if not (duration > 0.0 and interval > 0.0):
        raise ValueError(f"duration {duration} s and interval {interval} s must be positive")
    samples = int(np.floor(duration / interval * (1.0 + 1e-12))) + 1
    laws = chain.laws(symplectic)
    order = np.argsort(time_scale(chain), kind="stable")
    dealt = _deal(order)
    bodies = min(chain.beads + 1, FIRST_BODIES)
    while True:
        batch = _Batch(chain, laws, dealt, bodies, contacts, samples, interval, audit)
        batch.run(step, refine, method, threads)
        if not np.any(batch.status[:, 2]):
            return batch.history(dealt, order)
        bodies = min(chain.beads + 1, 2 * bodies)


def _deal(order):
    """(groups, width) chains of each group, neighbours in time scale together; the last group repeats its last."""
    width = 1 if len(order) <= 2 else LANES
    groups = -(-len(order) // width)
    return np.pad(order, (0, groups * width - len(order)), mode="edge").reshape(groups, width)


class _Batch:
    """The arrays of one call of the stepper: group first, lane last (no lane axis for single chains)."""

    def __init__(self, chain, laws, dealt, bodies, contacts, samples, interval, audit):
        self.chain, self.laws, self.dealt, self.interval, self.audit = chain, laws, dealt, interval, audit
        self.contacts = np.array([c for c in contacts if c < bodies], dtype=np.int64)
        self.wanted = contacts
        table = chain.coefficients(laws, bodies)
        mass = chain.masses(bodies)
        self.inverse_mass = self._arrange(1.0 / mass)
        self.coefficients = self._arrange(table)
        self.u = np.zeros_like(self.inverse_mass)
        self.v = np.zeros_like(self.inverse_mass)
        self.v[:, 0] = self._arrange(chain.speed)
        self.weight = self._arrange(chain.striker_mass * chain.gravity)
        self.extendable = bodies <= chain.beads
        self._set_rest(chain, laws, bodies, table)
        lanes = self.u.shape[2:]
        groups = len(dealt)
        self.out = np.zeros((groups, samples, len(self.contacts), *lanes))
        self.status = np.zeros((groups, 3), dtype=np.int64)
        self.samples = samples

    def _arrange(self, values):
        """(…, lanes) → (groups, …[, LANES]), contiguous."""
        dealt = np.moveaxis(np.asarray(values)[..., self.dealt], -2, 0)
        return np.ascontiguousarray(dealt if self.dealt.shape[1] > 1 else dealt[..., 0])

    def _set_rest(self, chain, laws, bodies, table):
        load = chain.static_forces(bodies) if laws.preloaded else np.zeros((bodies, chain.lanes))
        delta = rest_compression(laws, table, load) if laws.preloaded else load
        self.memory = self._arrange(memory_at_rest(laws, table, delta))
        delta = delta - chain.gaps(bodies)
        kept = bodies if laws.preloaded else 1
        self.rest = self._arrange(delta[:kept])
        self.rest_force = np.zeros_like(self.rest)

    def steps(self, step, refine):
        """(groups,) late and early steps and the duration of the early phase."""
        chain, stepper = self.chain, "splitting" if self.laws.splits else "runge-kutta"
        scale = time_scale(chain)[self.dealt].min(axis=1)
        late = (np.full(len(scale), step) if step else STEP[stepper] * scale) / refine
        if step:
            return late, late, np.zeros(len(late))
        return late, late / EARLY_REFINEMENT, _early(chain)[self.dealt].max(axis=1)

    def run(self, step, refine, method, threads):
        """Integrate all groups, each thread its share."""
        late, early, until = self.steps(step, refine)
        scheme = METHODS[method] if self.laws.splits else None
        drift = np.array(scheme.drift if scheme else (0.0,))
        kick = np.array(scheme.kick if scheme else ())
        groups, bodies = self.u.shape[:2]
        count = int(np.ceil(((self.samples - 1) * self.interval / late).max() + (until / early).max())) + 2
        every = max(1, count // 400) if self.audit else 0
        entries = count // every + 2 if self.audit else 0
        self.step = late
        self.balance = np.zeros((groups, entries, 2, *self.u.shape[2:]))
        rows = 2 * len(self.contacts) + 4 * bodies
        bounds = np.linspace(0, groups, min(threads, groups) + 1).astype(int)
        threshold = FRONT * self.chain.speed[self.dealt].max(axis=1)

        def share(first, beyond):
            scratch = np.zeros((rows, max(2, self.memory.shape[2]), *self.u.shape[2:]))
            advance(
                self.laws,
                drift,
                kick,
                early,
                late,
                until,
                self.interval,
                self.contacts,
                self.u,
                self.v,
                self.memory,
                self.inverse_mass,
                self.coefficients,
                self.rest,
                self.rest_force,
                self.weight,
                threshold,
                self.extendable,
                every,
                scratch,
                self.out,
                self.balance,
                self.status,
                first,
                beyond,
            )

        if len(bounds) == 2:
            share(0, groups)
        else:
            with ThreadPoolExecutor(len(bounds) - 1) as pool:
                list(pool.map(share, bounds[:-1], bounds[1:]))

    def history(self, dealt, order):
        """The results in the chains' own order, contacts that the wave never reached at zero."""
        place = np.empty(len(order), dtype=int)
        place[order] = np.arange(len(order))
        spare = dealt.size - len(order)

        def collect(values):
            values = values if dealt.shape[1] > 1 else values[..., None]
            flat = np.moveaxis(values, 0, -2).reshape(*values.shape[1:-1], place.size + spare)
            return np.ascontiguousarray(flat[..., place])

        force = np.zeros((self.samples, len(self.wanted), len(order)))
        for r, c in enumerate(self.contacts):
            force[:, self.wanted.index(c)] = collect(self.out[:, :, r])
        entries = int(self.status[:, 1].min()) if self.audit else 0
        balance = collect(self.balance)[:entries]
        width = dealt.shape[1]
        return History(
            time=np.arange(self.samples) * self.interval,
            contacts=self.wanted,
            force=force,
            energy=balance[:, 0] if entries else np.zeros((0, len(order))),
            momentum=balance[:, 1] if entries else np.zeros((0, len(order))),
            striker_speed=collect(self.v[:, 0]),
            step=np.repeat(self.step, width)[place],
        )


def available_threads() -> int:
    """Number of processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
