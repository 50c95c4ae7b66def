"""What the contact of the striker tells of many chains side by side, as arithmetic on whole columns.

What `observe.contacts` says of one chain after the other, to the bit, wherever the contact closes and opens;
it is a search's inner loop. All others are left to `observe`.
"""

from functools import cached_property

import numpy as np

from sonicvacuum.observe.trace import grid
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.history import History


class Strikers:
    """Quantities of the striker's contact in L chains.

    Args:
        history: of the chains, contact 0 recorded.
        chain: the chains.
    """

    def __init__(self, history: History, chain: Chain):
        self._time, self._chain = history.time, chain
        # Each lane in one piece, which is summed as it is when it is alone.
        self._force = np.ascontiguousarray(history.of(0).T)
        self._borne = self._force > 0.0
        self._any, self._samples = self._borne.any(axis=1), self._force.shape[1]

    @cached_property
    def contact_duration(self) -> np.ndarray:
        """(L,) in s as `contacts.contact_duration` has it, NaN where one has to look closer.

        Raises:
            ValueError: for times that are not equidistant, or too few of them.
        """
        _, interval = grid(self._time)
        first = self._borne.argmax(axis=1)
        open_again = ~self._borne & (np.arange(self._samples) > first[:, None])
        last = open_again.argmax(axis=1) - 1
        usual = self._any & (last >= first) & np.isfinite(self._force).all(axis=1)
        opened = last + self._overhang(last, -1)
        closed = np.where(first > 0, first - self._overhang(first, 1), 0.0)
        return np.where(usual, interval * (opened - closed), np.nan)

    def _overhang(self, edge, inward):
        """As in `contacts`, of each lane."""
        lane, inner = np.arange(len(edge)), edge + inward
        ends = np.stack([self._force[lane, edge], self._force[lane, inner % self._samples]])
        depth, before = np.cbrt(np.square(np.maximum(ends, 0.0)))
        step = np.where((inner >= 0) & (inner < self._samples), before - depth, 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(step > 0.0, np.minimum(1.0, depth / step), 1.0)

    @cached_property
    def rests(self) -> np.ndarray:
        """(L,) whether strikers have come to rest on what they met: in the second half of the times no force
        lifts them faster than their weight would let them fall.
        """
        late, chain = self._force[:, self._samples // 2 :], self._chain
        return (late > 0.0).all(axis=1) & (late.max(axis=1) < 2.0 * chain.striker_mass * chain.gravity)

    @cached_property
    def rebound(self) -> np.ndarray:
        """(L,) restitution at the first opening, whatever follows; NaN where there is none."""
        place, chain = np.arange(self._samples), self._chain
        free = ~self._borne & (place > self._borne.argmax(axis=1)[:, None])
        opened = free.argmax(axis=1)
        force = np.where(place <= opened[:, None], self._force, 0.0)
        impulse = np.trapezoid(force, self._time, axis=1) / chain.striker_mass
        speed = impulse - chain.gravity * self._time[opened] - chain.speed
        return np.where(self._any & free.any(axis=1), speed / chain.speed, np.nan)

    @cached_property
    def restitution(self) -> np.ndarray:
        """(L,) as `contacts.restitution` has it, NaN where one has to look closer."""
        mass, speed, gravity = self._chain.striker_mass, self._chain.speed, self._chain.gravity
        after = self._samples - self._borne[:, ::-1].argmax(axis=1)
        usual = self._any & (after < self._samples) & (mass > 0.0) & (speed > 0.0)
        opened = self._time[np.where(usual, after, 0)]
        with np.errstate(divide="ignore", invalid="ignore"):
            impulse = np.trapezoid(self._force, self._time, axis=1) / mass
            return np.where(usual, (impulse - gravity * opened - speed) / speed, np.nan)
