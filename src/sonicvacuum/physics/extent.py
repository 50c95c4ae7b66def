"""How much a simulation asks for, estimated before it starts: steps, bodies, samples, memory.

The ceilings lie far above what a laboratory needs and a computer does in hours, so that a slip of a unit (a
duration in ns, a sample every fs) is told at once instead of filling the memory or never ending.
"""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.steps import choose_steps, reachable_bodies

MOST_BEADS = 10_000_000
MOST_SAMPLES = 20_000_000
# Steps of one bead; some 10⁸ to 10⁹ are done in a second on one core.
MOST_WORK = 1e12
MOST_MEMORY = 8 << 30
# The step is estimated from so many bodies.
_SEEN = 64
LIFT = "lift the ceilings with --no-limits (limits=False in Python)"


class TooLargeError(ValueError):
    """What a simulation asks for lies beyond the ceilings; the message names the numbers."""


@dataclass(frozen=True)
class Extent:
    """What a simulation asks for.

    Attributes:
        beads: of one chain.
        samples: of one contact.
        work: steps of one body, all bodies that the wave reaches, and all chains.
        memory: bytes of the recorded forces and of the bodies.
    """

    beads: int
    samples: float
    work: float
    memory: float

    def check(self, cure: str = "") -> None:
        """TooLargeError where it lies beyond a ceiling; `cure` is what to take instead, where it is known
        better here than there.
        """
        for what, asked, most, usual in (
            ("beads", self.beads, MOST_BEADS, "fewer beads"),
            ("samples per contact", self.samples, MOST_SAMPLES, "a shorter duration or a longer interval"),
            ("steps of a bead", self.work, MOST_WORK, "a shorter duration, a softer chain or fewer speeds"),
            ("GiB of memory", self.memory / 2**30, MOST_MEMORY / 2**30, "fewer samples or speeds"),
        ):
            if not asked <= most:
                raise TooLargeError(
                    f"asks for {asked:.3g} {what}, more than {most:.3g}: are all units right? "
                    f"Take {cure or f'{usual}, or {LIFT}'}"
                )


def estimate(chain: Chain, contacts: int, duration: float, interval: float, copies: float = 1) -> Extent:
    """The extent of `copies` simulations of some chains, nothing being allocated that grows with it.

    Args:
        chain: what is integrated.
        contacts: how many are recorded.
        duration, interval: of the record and between its samples, in s.
        copies: how often; a halved step costs as much as two.
    """
    samples = duration / interval + 1.0
    with np.errstate(all="ignore"):
        bodies = float(chain.beads + 1)
        if chain.beads > _SEEN:
            bodies = min(bodies, reachable_bodies(chain, duration))
        seen = int(min(chain.beads + 1, _SEEN))
        laws = chain.laws()
        fine, late, until = choose_steps(chain, laws, chain.coefficients(laws, seen), chain.masses(seen))
        steps = np.minimum(duration, until) / fine + np.maximum(duration - until, 0.0) / late
    return Extent(
        beads=chain.beads,
        samples=samples,
        work=copies * bodies * float(steps.sum()),
        memory=8.0 * chain.lanes * (copies * samples * contacts + 16.0 * bodies),
    )
