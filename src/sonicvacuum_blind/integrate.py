"""Integrator for hidden-effect data: one chain and its impact in, forces of contacts at given times out.

The method is in `stepper`, the force laws in `laws`.
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from sonicvacuum.physics.dispatchers import cached, prepare
from sonicvacuum_blind import stepper
from sonicvacuum_blind.laws import SOURCES, Acting, acting, numbers

TOLERANCE = 1e-8
_run = cached(stepper.run, (*SOURCES, Path(stepper.__file__)))


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

    @cached_property
    def table(self) -> np.ndarray:
        """(rows, bodies + 1) `laws.numbers` of the chain."""
        return numbers(self.rows, self.rest, self.load, self.mass, self.drag)

    @cached_property
    def acting(self) -> Acting:
        """Which laws act."""
        return acting(self.table)


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


class NoSolution(ValueError):
    """Laws that no chain can follow, or a strength far beyond what can be."""


def integrate(
    problem: Problem,
    times: np.ndarray,
    contacts,
    *,
    speed: float | None = None,
    states: bool = False,
    tolerance: float = TOLERANCE,
) -> Motion:
    """Forces of some contacts at given true times.

    Args:
        problem: the chain.
        times: (samples,) ascending true times in s, 0 or later.
        contacts: whose force is recorded.
        speed: of the striker in m/s, instead of the problem's.
        states: record all displacements and velocities too.
        tolerance: error of one step over the impact's own compression and speed.

    Raises:
        NoSolution: where the steps become too small or too many: laws that the chain cannot follow.
    """
    speed = float(problem.speed if speed is None else speed)
    scale = (1.25 * float(problem.mass.min()) * speed**2 / float(problem.rows[:, 0].max())) ** 0.4
    recorded = np.array(tuple(contacts), dtype=np.int64)
    force = np.zeros((len(times), len(recorded)))
    kept = np.zeros((len(times) if states else 0, 2, len(problem.mass)))
    times = np.ascontiguousarray(times, dtype=float)
    push, wall = tuple(map(float, problem.push)), tuple(map(float, problem.wall))
    room = stepper.begin(problem.table, problem.acting, speed, scale, tolerance)
    chain = (problem.table, problem.acting, push, wall)
    arguments = (*chain, speed, scale, times, recorded, force, kept, *room)
    prepare(_run, "hidden-effect data", arguments)
    steps = _run(*arguments)
    if steps < 0:
        raise NoSolution(f"no solution to {tolerance:g}: the laws are too stiff for the chain")
    return Motion(force, kept[:, 0], kept[:, 1], steps)
