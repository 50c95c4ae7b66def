"""The work that all codes are measured on, and how their answers are compared."""

import math
from dataclasses import dataclass

import numpy as np

from sonicvacuum.physics.chain import Body, Chain, Elastic
from sonicvacuum.physics.run import simulate

STEP = 1e-7
INTERVAL = 1e-6
# Contact 12/13 of P1, by two integrators at relative tolerance 1e-12.
P1_PEAK, P1_MOMENT = 6.7228375, 295.95806e-6
AGREEMENT = 0.005


@dataclass(frozen=True)
class Problem:
    """One piece of work: chains of coated beads, 4.86 mm and 0.44 g, hit at 0.44 m/s by 0.47 g.

    Attributes:
        name: P1 … P5.
        moduli: (chains,) Young's modulus in Pa of all bodies of each chain.
        beads: per chain.
        duration: s.
        contact: whose force is recorded and compared, every `INTERVAL`.
    """

    name: str
    moduli: np.ndarray
    beads: int
    duration: float
    contact: int

    @property
    def chain(self) -> Chain:
        """The chains, for the engine."""
        body = Elastic("coating", self.moduli, 0.388)
        return Chain(self.beads, Body(body, 0.44e-3, 2.43e-3), body, body, math.inf, 0.47e-3, 0.44)

    @property
    def samples(self) -> int:
        """Samples of the recorded force, the first at impact."""
        return round(self.duration / INTERVAL) + 1

    @property
    def times(self) -> np.ndarray:
        """(samples,) s."""
        return np.arange(self.samples) * INTERVAL

    @property
    def steps(self) -> int:
        """Steps of the codes that take `STEP`."""
        return round(self.duration / STEP)

    @property
    def contact_steps(self) -> int:
        """Contacts times steps times chains at `STEP`, all beads stepped."""
        return (self.beads + 1) * self.steps * len(self.moduli)

    def arrays(self):
        """(bodies, chains) Hertz constants in N/m^{3/2} and masses in kg."""
        chain = self.chain
        return chain.stiffnesses(self.beads + 1), chain.masses(self.beads + 1)


ONE = np.array([15e9])
PROBLEMS = {
    p.name: p
    for p in (
        Problem("P1", ONE, 21, 0.6e-3, 12),
        Problem("P2", ONE, 1000, 5e-3, 100),
        Problem("P3", np.linspace(2.76e9, 30e9, 1000), 21, 0.6e-3, 12),
        Problem("P4", ONE, 100_000, 2e-3, 60),
        Problem("P5", ONE, 1_000_000, 2e-3, 60),
    )
}


def peaks(force, tops=None):
    """Largest force of each column of (samples, chains), its moment, and the sample next to it.

    By a quartic through nine samples; to compare codes, around the same samples `tops`.
    """
    near = np.arange(-4, 5)
    found = []
    tops = np.argmax(force, axis=0) if tops is None else tops
    for column, top in zip(np.asarray(force).T, tops, strict=True):
        fit = np.polynomial.Polynomial.fit(near, column[int(top) - 4 : int(top) + 5], 4)
        roots = fit.deriv().roots()
        moment = min(roots[np.abs(roots.imag) < 1e-9].real, key=abs)
        found.append((fit(moment), (top + moment) * INTERVAL, top))
    return np.array(found).T


_references = {}


def reference(problem: Problem):
    """`peaks` of the engine at a sixteenth of its default step: (3, chains)."""
    if problem.name not in _references:
        fine = simulate(problem.chain, [problem.contact], problem.duration, INTERVAL, refine=16)
        _references[problem.name] = peaks(fine.of(problem.contact))
    return _references[problem.name]


def errors(problem: Problem, force):
    """Largest relative error of the peaks, and of their moments in s, over the chains computed."""
    expected = reference(problem)[:, : np.shape(force)[1]]
    found = peaks(force, expected[2])
    return np.abs(found[0] / expected[0] - 1.0).max(), np.abs(found[1] - expected[1]).max()
