"""A bent valley between two parameters, with walls known in closed form."""

import numpy as np

from sonicvacuum.discover.fit import broad
from sonicvacuum.discover.fit.normal import from_slopes
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.nuisances import Layout

WIDE, NARROW, BEND = 0.6, 0.01, 0.15


class Valley:
    """Data of one run whose misfit is a valley: a + b over WIDE along it, b − a − BEND (a + b)² over NARROW
    across, a and b in coordinates off the middle; one nuisance adds a third of itself to the first.

    `jumps`: data that jump as the coordinates pass multiples of short distances.
    """

    simulations, threads = 0, 1

    def branch(self, beside):
        return self

    def learned(self, branch):
        pass

    def join(self, learned):
        pass

    def __init__(self, middle, jumps=0):
        self.middle, self.layout = np.asarray(middle), Layout(1, 0, ())
        random = np.random.default_rng(np.random.SeedSequence(11))
        self.period = random.uniform(0.009, 0.013, (jumps, 2))
        self.phase = random.uniform(0.0, 1.0, (jumps, 2))

    def local(self, run):
        return self.layout.local(run)

    def counts(self, run):
        return np.zeros(0, dtype=int)

    def data(self, run):
        return np.zeros(2 + len(self.period))

    def values(self, u, nu):
        a, b = (u - self.middle).T
        along, across = (a + b + 0.3 * WIDE * nu[:, 0]) / WIDE, (b - a - BEND * (a + b) ** 2) / NARROW
        place = (u - self.middle)[:, None] / self.period + self.phase
        jumps = 0.02 * np.sign(np.sin(2.0 * np.pi * place)).sum(axis=2)
        return np.column_stack([along, across, jumps])

    def sampled(self, hypothesis, u, nu, places=None):
        u = np.asarray(u)
        assert all(
            c.low <= x.min() and x.max() <= c.high for c, x in zip(hypothesis.coordinates, u.T, strict=True)
        )
        return [self.values(u, np.asarray(nu))]

    def columns(self, hypothesis, u, nu, places=None, precise=False, steps=None, held=None, step=0.02):
        moves = np.concatenate([np.zeros((1, 2)), step * np.eye(2)])
        value = self.values(u + moves, np.repeat(nu, 3, axis=0))
        own = np.concatenate([value[:1], (value[1:] - value[0]) / step])
        rest = np.zeros((self.layout.size, value.shape[1]))
        rest[list(self.local(0)).index(0), 0] = 0.3
        return [np.concatenate([own, rest])[None]]

    def fit(self, hypothesis, u):
        u, nu = np.asarray(u, dtype=float)[None], np.zeros((1, self.layout.size))
        return Fit(hypothesis, from_slopes(self, 2, u, nu, self.columns(hypothesis, u, nu)))


def broadened(forward, two, now, columns):
    return broad.broadened(forward, two, now, broad.sloped(forward, two, now, columns), columns)
