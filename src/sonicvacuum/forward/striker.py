"""What the contact of the striker tells of many chains side by side, as arithmetic on whole columns.

What `observe.contacts` says of one chain after the other, to the bit, wherever the contact closes and opens;
it is a search's inner loop. All others are left to `observe`.
"""

from collections.abc import Callable

import numpy as np

from sonicvacuum.observe.trace import grid
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.history import History


def told(quantity: str, history: History, chain: Chain, lanes: np.ndarray) -> np.ndarray:
    """(n,) values in SI of a quantity of the striker's contact in n lanes; NaN where one has to look closer.

    Args:
        quantity: one of `observe.contacts.BALL_QUANTITIES`.
        history: of all lanes, contact 0 recorded.
        chain: the chains.
        lanes: (n,) their places.

    Raises:
        ValueError: for times that are not equidistant, or too few of them.
    """
    # Of each lane in one piece, which is summed as it is when it is alone.
    force = np.ascontiguousarray(history.of(0).T[lanes])
    with np.errstate(divide="ignore", invalid="ignore"):
        return _FOUND[quantity](history.time, force, chain, lanes)


def _duration(time, force, chain, lanes):
    """As `contacts.contact_duration`."""
    _, interval = grid(time)
    borne = force > 0.0
    first = borne.argmax(axis=1)
    open_again = ~borne & (np.arange(force.shape[1]) > first[:, None])
    last = open_again.argmax(axis=1) - 1
    usual = borne.any(axis=1) & (last >= first) & np.isfinite(force).all(axis=1)

    opened = last + _overhang(force, last, -1)
    closed = np.where(first > 0, first - _overhang(force, first, 1), 0.0)
    return np.where(usual, interval * (opened - closed), np.nan)


def _overhang(force, edge, inward):
    """As in `contacts`, of each lane."""
    lane, inner = np.arange(len(force)), edge + inward
    ends = np.stack([force[lane, edge], force[lane, inner % force.shape[1]]])
    depth, before = np.cbrt(np.square(np.maximum(ends, 0.0)))
    step = np.where((inner >= 0) & (inner < force.shape[1]), before - depth, 0.0)
    return np.where(step > 0.0, np.minimum(1.0, depth / step), 1.0)


def _restitution(time, force, chain, lanes):
    """As `contacts.restitution`."""
    mass, speed, gravity = (n[lanes] for n in (chain.striker_mass, chain.speed, chain.gravity))
    borne = force > 0.0
    after = force.shape[1] - borne[:, ::-1].argmax(axis=1)
    usual = borne.any(axis=1) & (after < force.shape[1]) & (mass > 0.0) & (speed > 0.0)
    impulse = np.trapezoid(force, time, axis=1) / mass
    opened = time[np.where(usual, after, 0)]
    return np.where(usual, (impulse - gravity * opened - speed) / speed, np.nan)


_FOUND: dict[str, Callable] = {"contact_duration": _duration, "restitution": _restitution}
