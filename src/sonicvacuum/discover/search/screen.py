"""The score test: what the residual of a fitted model says about every deviation from it, before any is
fitted.

Slopes of the free parameters and the nuisances are projected out; what is left of a direction is its
signature, of length d′ for one typical deviation. All is algebra on the products of columns (`Screen.gram`),
run by run.

The Fisher score with nuisance parameters: Rao, Proc. Camb. Phil. Soc. 44, 50 (1948).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sonicvacuum.discover.fit.normal import Normal, from_slopes
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import directions as ways
from sonicvacuum.discover.search.directions import Direction

# Signatures that keep less than this of their length after projection are left out.
RESOLVED = 1e-7
NULLS = 6000
SEED = 20061


@dataclass(frozen=True)
class Screen:
    """Scores at a fitted model; K directions.

    Attributes:
        directions: K of them.
        score: (R, K) slopes times residuals by run, not projected.
        cross: (R, n, K) products with the columns of the fitted model.
        products: (R, K, K) of the directions.
        normal: normal equations of the model, from the same columns.
        fit: the model.
    """

    directions: tuple[Direction, ...]
    score: np.ndarray
    cross: np.ndarray
    products: np.ndarray
    normal: Normal
    fit: Fit

    @cached_property
    def projected(self) -> tuple[np.ndarray, np.ndarray]:
        """(K,) scores and (K, K) Gram matrix with parameters and nuisances projected out."""
        gradient, hessian = self.normal.total()
        cross = self.cross.sum(axis=0)
        solved = np.linalg.lstsq(hessian[0], np.column_stack([cross, gradient[0]]), rcond=1e-12)[0]
        gram = self.products.sum(axis=0) - cross.T @ solved[:, :-1]
        return self.score.sum(axis=0) - cross.T @ solved[:, -1], 0.5 * (gram + gram.T)

    @cached_property
    def length(self) -> np.ndarray:
        """(K,) d′ of one typical deviation; 0 where nothing of it is left."""
        raw = np.sqrt(np.einsum("kk->k", self.products.sum(axis=0)))
        left = np.sqrt(np.maximum(np.diag(self.projected[1]), 0.0))
        return np.where(left > RESOLVED * raw, left, 0.0)

    @cached_property
    def z(self) -> np.ndarray:
        """(K,) score over its standard error; one-sided directions cannot be negative."""
        with np.errstate(divide="ignore", invalid="ignore"):
            z = np.where(self.length > 0.0, self.projected[0] / self.length, 0.0)
        return np.where([d.two_sided for d in self.directions], z, np.maximum(z, 0.0))

    @cached_property
    def correlation(self) -> np.ndarray:
        """(K, K) cosines between signatures."""
        safe = np.where(self.length > 0.0, self.length, 1.0)
        cosines = self.projected[1] / np.outer(safe, safe)
        dead = self.length == 0.0
        cosines[dead] = 0.0
        cosines[:, dead] = 0.0
        return cosines

    @property
    def strength(self) -> np.ndarray:
        """(K,) estimated deviations in typical ones."""
        return np.divide(self.z, self.length, out=np.zeros_like(self.z), where=self.length > 0.0)

    def moved(self, k, strength=None) -> tuple[np.ndarray, np.ndarray]:
        """(p,) coordinates and (q,) nuisances of the model, as they follow when direction k takes its
        estimate, or the directions k the strengths given.
        """
        gradient, hessian = self.normal.total()
        strength = self.strength[k] if strength is None else strength
        cross = self.cross.sum(axis=0)[:, np.atleast_1d(k)]
        rest = gradient[0] - cross @ np.atleast_1d(strength)
        step = np.linalg.lstsq(hessian[0], rest, rcond=1e-12)[0]
        free = self.normal.free
        return self.fit.u + step[:free], self.fit.nu + step[free:]

    @cached_property
    def _nulls(self) -> np.ndarray:
        """(NULLS,) largest z² over all directions in draws of pure noise."""
        draws = np.random.default_rng(np.random.SeedSequence(SEED)).standard_normal((NULLS, len(self.z)))
        values, vectors = np.linalg.eigh(self.correlation)
        noise = draws @ (vectors * np.sqrt(np.maximum(values, 0.0))).T
        two_sided = np.array([d.two_sided for d in self.directions])
        largest = np.where(two_sided, np.abs(noise), np.maximum(noise, 0.0)).max(axis=1, initial=0.0)
        return np.square(largest)

    def threshold(self, false_alarm: float) -> float:
        """Largest z² that pure noise exceeds, over all directions together, with this probability."""
        return float(np.quantile(self._nulls, 1.0 - false_alarm))

    def best(self) -> dict[str, int]:
        """Effect → its direction of the largest |z|."""
        result: dict[str, int] = {}
        for k, d in enumerate(self.directions):
            if d.effect not in result or abs(self.z[k]) > abs(self.z[result[d.effect]]):
                result[d.effect] = k
        return result


def screen(
    forward: Forward,
    fit: Fit,
    families: list[ways.Family],
    rough: bool = False,
    also: Sequence[ways.Family] = (),
) -> Screen:
    """Scores of families of directions at a fitted model; `rough` ones take half the simulations.

    `also` are families whose rough slopes will be asked for there next: taken beside, and remembered.
    """
    base = forward.columns(fit.hypothesis, fit.u[None], fit.nu[None], precise=not rough)

    def taken(branch, asked):
        family, roughly = asked
        alike = ways.like_nuisance(branch, family, base, fit.normal.free)
        return alike or ways.simulate(branch, fit.hypothesis, fit.u, fit.nu, family, roughly)[0]

    # The others are the larger ones, of many places: they come first, so that all end together.
    asked = [*((family, True) for family in also), *((family, rough) for family in families)]
    parts = abreast.each(forward, taken, asked, calls=abreast.SLOPES)[len(also) :]
    # None where the record excludes every effect.
    none = [np.zeros((0, columns.shape[2])) for columns in base]
    slopes = [np.concatenate([none[run], *(p[run] for p in parts)]) for run in range(len(base))]
    directions = tuple(d for f in families for d in f.directions)
    return from_columns(forward, fit, directions, base, slopes)


def from_columns(forward, fit, directions, base, slopes) -> Screen:
    """A screen from the model's columns (1, c, M) and the slopes (K, M) of each run.

    A parameter that stands at its bound is not free to take up what is left.
    """
    held = 1 + np.flatnonzero(fit.at_bound())
    base = [_without(c, held) for c in base] if len(held) else base
    free, unknowns = fit.normal.free, fit.normal.gradient.shape[2]
    runs, count = len(base), len(directions)
    score, cross = np.empty((runs, count)), np.zeros((runs, unknowns, count))
    products = np.empty((runs, count, count))
    normal = from_slopes(forward, free, fit.u[None], fit.nu[None], base)
    for run, (columns, slope) in enumerate(zip(base, slopes, strict=True)):
        where = np.concatenate([np.arange(free), free + forward.local(run)])
        score[run] = slope @ (forward.data(run) - columns[0, 0])
        cross[run, where] = columns[0, 1:] @ slope.T
        products[run] = slope @ slope.T
    return Screen(directions, score, cross, products, normal, fit)


def _without(columns, held):
    """Columns of one run with some at zero."""
    columns = columns.copy()
    columns[:, held] = 0.0
    return columns
