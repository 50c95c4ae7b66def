"""The linearised model of every run: misfit, slopes and their products, from which everything else is
algebra.

Unknowns are the coordinates u of the free parameters and the nuisances in units of their standard errors,
whose Gaussian prior adds 1 to their diagonal.
"""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis


@dataclass(frozen=True)
class Normal:
    """Normal equations of L lanes, kept apart by run; n = p + q unknowns.

    Attributes:
        u: (L, p) and nu: (L, q), the point of expansion.
        chi2: (R, L) squared residuals over the noise.
        gradient: (R, L, n) slopes times residuals (data less prediction).
        hessian: (R, L, n, n) products of slopes.
    """

    u: np.ndarray
    nu: np.ndarray
    chi2: np.ndarray
    gradient: np.ndarray
    hessian: np.ndarray

    @property
    def free(self) -> int:
        """Number of free parameters."""
        return self.u.shape[1]

    @property
    def objective(self) -> np.ndarray:
        """(L,) χ² and the penalty of the nuisances."""
        return self.weighted(np.ones(len(self.u)))

    @property
    def has_slopes(self) -> np.ndarray:
        """(L,) whether slopes are known in all directions: beside a chain that can be followed may lie one
        that cannot.
        """
        gradient, hessian = self.total()
        return np.isfinite(gradient).all(axis=1) & np.isfinite(hessian).all(axis=(1, 2))

    def weighted(self, weight: np.ndarray) -> np.ndarray:
        """(L,) the same with the penalty times (L,) weights."""
        return self.chi2.sum(axis=0) + weight * np.square(self.nu).sum(axis=1)

    def total(self, weight: np.ndarray | float = 1.0) -> tuple[np.ndarray, np.ndarray]:
        """(L, n) gradient and (L, n, n) Hessian over all runs, prior included, its weight (L,) or 1."""
        gradient, hessian = self.gradient.sum(axis=0), self.hessian.sum(axis=0)
        weight = np.broadcast_to(weight, len(self.u))[:, None]
        gradient[:, self.free :] -= weight * self.nu
        places = np.arange(self.free, gradient.shape[1])
        hessian[:, places, places] += weight
        return gradient, hessian

    def take(self, lanes) -> "Normal":
        """The same for some lanes."""
        return Normal(
            self.u[lanes],
            self.nu[lanes],
            self.chi2[:, lanes],
            self.gradient[:, lanes],
            self.hessian[:, lanes],
        )

    def replaced(self, lanes, other: "Normal") -> None:
        """Put another's lanes in the place of some of these."""
        self.u[lanes], self.nu[lanes] = other.u, other.nu
        self.chi2[:, lanes], self.gradient[:, lanes] = other.chi2, other.gradient
        self.hessian[:, lanes] = other.hessian


def linearise(
    forward: Forward, hypothesis: Hypothesis, u, nu, places=None, steps=None, precise: bool = False
) -> Normal:
    """Normal equations at (L, p) coordinates and (L, q) nuisances.

    Lanes that cannot be simulated have χ² = inf.
    """
    return linearised(forward, hypothesis, u, nu, places, steps, precise)[0]


def linearised(
    forward: Forward, hypothesis: Hypothesis, u, nu, places=None, steps=None, precise=False, held=None
) -> tuple[Normal, list[np.ndarray]]:
    """The same, with the columns that they are made of; see `Forward.columns`."""
    columns = forward.columns(hypothesis, u, nu, places, precise, steps, held)
    return from_slopes(forward, np.shape(u)[1], u, nu, columns), columns


def from_slopes(forward: Forward, free: int, u, nu, columns) -> Normal:
    """Normal equations from the columns of every run, see `Forward.columns`."""
    lanes = len(u)
    unknowns, runs = free + forward.layout.size, len(columns)
    chi2 = np.empty((runs, lanes))
    gradient, hessian = np.zeros((runs, lanes, unknowns)), np.zeros((runs, lanes, unknowns, unknowns))
    for run, parts in enumerate(columns):
        parts = parts.copy()
        parts[:, 0] = forward.data(run) - parts[:, 0]
        with np.errstate(over="ignore", invalid="ignore"):  # lanes that run away are left out below
            products = parts @ parts.transpose(0, 2, 1)
        where = np.concatenate([np.arange(free), free + forward.local(run)])
        chi2[run] = products[:, 0, 0]
        gradient[run][:, where] = products[:, 0, 1:]
        hessian[run][np.ix_(np.arange(lanes), where, where)] = products[:, 1:, 1:]
    bad = ~np.isfinite(chi2.sum(axis=0))
    chi2[:, bad], gradient[:, bad], hessian[:, bad] = np.inf, 0.0, 0.0
    return Normal(np.array(u, dtype=float), np.array(nu, dtype=float), chi2, gradient, hessian)
