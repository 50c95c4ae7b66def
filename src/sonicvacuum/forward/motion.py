"""Simulate a setup and read its gauges, all lanes side by side."""

from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.effects import Setup
from sonicvacuum.gauges import Gauge, Motion, needed, reading
from sonicvacuum.physics.history import History


@dataclass(frozen=True)
class Seen:
    """What a simulation shows.

    Attributes:
        setup: the chains and the gauges.
        history: what was recorded.
        readings: (L, S, T) of the setup's gauges, each in its own unit, at the simulation's times.
    """

    setup: Setup
    history: History
    readings: np.ndarray


def see(
    setup: Setup,
    duration: float,
    interval: float,
    *,
    besides: tuple[Gauge, ...] = (),
    striker: bool = False,
    refine: float = 1.0,
    threads: int = 1,
    forgiving: bool = False,
) -> Seen:
    """Simulate a setup for `duration` with samples every `interval`, in s.

    Args:
        setup: chains and gauges.
        duration, interval: s.
        besides: gauges that will be read later.
        striker: whether the striker's contact is recorded too.
        refine: divides the step.
        threads: as in `physics.run.simulate`.
        forgiving: lanes whose motion does not stay finite show no numbers, instead of ending all.

    Raises:
        FloatingPointError: for such a lane, unless forgiving.
    """
    # And with it compiled code: not for records without a simulation.
    from sonicvacuum.physics.run import simulate

    beads = setup.chain.beads
    contacts, bodies = needed((*setup.sensors, *besides), beads)
    contacts = sorted({*contacts, *((0,) if striker else ())})

    def recorded(chain):
        return simulate(chain, contacts, duration, interval, bodies=bodies, refine=refine, threads=threads)

    history = _whatever(recorded, setup.chain) if forgiving else recorded(setup.chain)
    return Seen(setup, history, readings(setup.sensors, history, beads))


def _whatever(recorded, chain):
    """The history of all chains; those whose motion does not stay finite have forces that are no numbers."""
    try:
        return recorded(chain)
    except FloatingPointError:
        if chain.lanes == 1:
            return recorded(replace(chain, speed=chain.speed * 1e-3, actions=())).without_numbers()
    half = chain.lanes // 2
    shares = ((0, half), (half, chain.lanes))
    return History.side_by_side([_whatever(recorded, chain.take(np.arange(*share))) for share in shares])


def readings(gauges: tuple[Gauge, ...], motion: Motion, beads: int) -> np.ndarray:
    """(L, S, T) readings of a motion (T, L) with L lanes, each gauge in its own unit."""
    from sonicvacuum.forward.discharge import high_passed  # compiled, as the stepper is

    found = np.empty((motion.lanes, len(gauges), len(motion.time)))
    for s, gauge in enumerate(gauges):
        found[:, s] = reading(gauge, motion, beads, high_passed).T
    return found
