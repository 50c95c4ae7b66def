"""Linear models with Gaussian noise and Gaussian priors, in which every statistic has a closed form."""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.fit.normal import Normal
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Layout
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.search.directions import Direction
from sonicvacuum.discover.search.screen import Screen
from sonicvacuum.effects import effect


@dataclass(frozen=True)
class Linear:
    """Data of R runs, y_r = A_r θ + unit noise; θ: `free` parameters, then nuisances with the prior N(0, 1).

    Attributes:
        columns: (R, T, n) the A_r.
        data: (R, T).
        free: number of parameters.
    """

    columns: np.ndarray
    data: np.ndarray
    free: int = 1

    @property
    def prior_rows(self) -> np.ndarray:
        """(q, n) rows that hold the nuisances at zero."""
        return np.eye(self.columns.shape[2])[self.free :]

    def solved(self, runs) -> np.ndarray:
        """(n,) least-squares solution of some runs and the prior."""
        rows = np.concatenate([*self.columns[list(runs)], self.prior_rows])
        known = np.concatenate([*self.data[list(runs)], np.zeros(len(self.prior_rows))])
        return np.linalg.lstsq(rows, known, rcond=None)[0]

    def normal(self, at: np.ndarray) -> Normal:
        """Normal equations at a point (n,)."""
        left = self.data - self.columns @ at
        return Normal(
            at[None, : self.free],
            at[None, self.free :],
            np.einsum("rt,rt->r", left, left)[:, None],
            np.einsum("rtn,rt->rn", self.columns, left)[:, None],
            np.einsum("rtn,rtm->rnm", self.columns, self.columns)[:, None],
        )

    def fit(self, hypothesis: Hypothesis) -> Fit:
        """The best fit to all runs."""
        return Fit(hypothesis, self.normal(self.solved(range(len(self.data)))))


def drawn(runs=3, size=40, free=1, nuisances=4, seed=3, strength=0.8) -> Linear:
    """A random model and its data."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    columns = rng.normal(size=(runs, size, free + nuisances))
    truth = np.r_[np.full(free, strength), rng.normal(size=nuisances)]
    return Linear(columns, columns @ truth + rng.normal(size=(runs, size)), free)


def of_drag(setup) -> Hypothesis:
    """A hypothesis with one free parameter, one-sided and searched by its logarithm."""
    drag = effect("viscous-drag")
    return Hypothesis((Component(drag, variants(drag, setup)[0]),))


def screened(columns: np.ndarray, data: np.ndarray, directions: tuple[Direction, ...]) -> Screen:
    """The screen of (K, T) slopes at a model without parameters or nuisances, data (T,) its residual."""
    empty = Linear(np.zeros((1, len(data), 0)), data[None], 0)
    return Screen(
        directions,
        (columns @ data)[None],
        np.zeros((1, 0, len(columns))),
        (columns @ columns.T)[None],
        empty.normal(np.zeros(0)),
        Fit(Hypothesis(), empty.normal(np.zeros(0))),
    )


@dataclass(frozen=True)
class Imagined:
    """A forward model of one run whose columns are given, for what is predicted of a further run.

    Attributes:
        of: id of the first effect, or "" → (c, M) prediction and slopes, in the order of `Forward.columns`.
        gauges: their number.
    """

    of: dict[str, np.ndarray]
    gauges: int

    @property
    def layout(self) -> Layout:
        """The layout of one run."""
        return Layout(1, self.gauges)

    @property
    def experiment(self):
        """Knows its gauges."""
        return type("Gauges", (), {"gauges": (None,) * self.gauges})

    def columns(self, hypothesis, u, nu):
        """The columns of a hypothesis, wherever it stands."""
        return [self.of["".join(hypothesis.ids)][None]]
