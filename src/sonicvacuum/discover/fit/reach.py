"""How far contacts go in an experiment: beyond that a law of no particular form, fitted to it, is unknown."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.effects.base import MICRO

# A contact touches where it is compressed by more than this share of the largest compression.
TOUCHING = 0.02
# So many contacts from the striker on, and the wall's, tell where contacts have been: the first see the most.
CONTACTS = 20


@dataclass(frozen=True)
class Reach:
    """How far the contacts of an experiment go, the wall's and the striker's included: largest compression in
    m, and largest rate in m/s while they touch.
    """

    depth: float
    rate: float

    @classmethod
    def of(cls, parameters: Mapping[str, float]) -> "Reach | None":
        """That of the effect's parameters; None where they state none."""
        if "deepest_um" not in parameters or "fastest_m_s" not in parameters:
            return None
        return cls(parameters["deepest_um"] * MICRO, parameters["fastest_m_s"])

    @property
    def parameters(self) -> dict[str, float]:
        """As the effect takes them."""
        return {"deepest_um": self.depth / MICRO, "fastest_m_s": self.rate}

    def exceeds(self, other: "Reach", share: float) -> bool:
        """Whether it goes farther than another by more than a share of that, in depth or in rate."""
        return self.depth > (1.0 + share) * other.depth or self.rate > (1.0 + share) * other.rate

    def __str__(self):
        return f"{self.depth / MICRO:.3g} um and {self.rate:.3g} m/s"


def reach(forward: Forward, one: Fit) -> Reach:
    """That of all runs, effects and nuisances as fitted."""
    depths, rates = [], []
    for depth, rate in approaches(forward, one):
        depths.append(depth.max())
        rates.append(np.abs(rate[depth > TOUCHING * depth.max()]).max())
    return Reach(float(max(depths)), float(max(rates)))


def approaches(forward: Forward, one: Fit) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Compressions in m and their rates in m/s of each batch, (samples, contacts, runs).

    The striker's contact comes first, `CONTACTS` of them at most, then the wall's; compressions at rest are
    counted, gaps are negative.
    """
    from scipy.integrate import cumulative_trapezoid

    from sonicvacuum.physics.run import simulate

    for batch in forward.experiment.batches:
        nominal = forward.nominal(batch, one.nu[None])
        changed = one.hypothesis.change(one.u[None])
        chain = changed(nominal, np.zeros(len(batch.runs), dtype=int)).chain
        contacts = [*range(min(chain.beads, CONTACTS)), chain.beads]
        bodies = sorted({*contacts, *(k + 1 for k in contacts[:-1])})
        seen = simulate(chain, (), batch.duration, batch.interval, bodies=bodies, threads=forward.threads)
        velocity = dict(zip(bodies, np.moveaxis(seen.velocity, 1, 0), strict=True))
        rate = np.stack([velocity[k] - velocity.get(k + 1, 0.0) for k in contacts], axis=1)
        static, gaps = (
            part[contacts] for part in (chain.static_forces(chain.beads + 1), chain.gaps(chain.beads + 1))
        )
        rest = np.stack([chain.depth_at(k, f[None])[0] for k, f in zip(contacts, static, strict=True)])
        moved = cumulative_trapezoid(rate, dx=batch.interval, axis=0, initial=0.0)
        yield moved + rest - gaps, rate
