"""A valley of the misfit followed from end to end: all else at its best along the axis that data tell least.

From a fit, both ways along the longest axis of its errors, in steps that grow while the misfit hardly does.
Each starts where the last two point to, and everything but the place along the axis goes to its best by a
few steps of Gauss and Newton, slopes to the nuisances that take simulations held. Along a coordinate in place
of that axis the same walk is the coordinate's profile.
"""

from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover.fit.normal import Normal, from_slopes
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis

# Steps to either side at most; of Gauss and Newton at each, fewer where one promises no more χ² than this.
MOST, STEPS, SETTLED = 16, 4, 0.01
# A step that does not lower the misfit is tried once more at this share.
BACK = 0.25
# The valley ends where χ² is this much above its lowest; steps double below the one, halve above the other.
END, CALM, STEEP = 25.0, 1.0, 6.0
# First step, in standard errors; the longest, in a coordinate.
FIRST, LONGEST = 0.5, 0.5
# The shortest step, of the first one; how often a step is cut once the valley has shown: χ² that jumps, as a
# count does, or steep ends are met there. The least variance of a coordinate, where slopes say none.
SHORTEST, CUTS, LEAST = 2e-3, 2, 1e-24
# The valley ends at a bound where less than this share of a step is left to it.
NO_STEP = 0.05
# A coordinate so near its bound stands there, and is held by so much.
AT_BOUND, HELD = 1e-6, 1e9
# Finite differences across it: in standard errors of a coordinate known by itself, none longer.
ACROSS, FARTHEST = 1.0, 0.05


@dataclass(frozen=True)
class Valley:
    """Points of a valley, in order along it.

    Attributes:
        axis: (p,) unit vector along it, in coordinates of the search.
        across: (p, p − 1) orthonormal vectors across it.
        t: (m,) places along the axis, 0 at the fit, ascending.
        u, nu: (m, p) and (m, q) coordinates and nuisances.
        objective: (m,) χ² and penalty.
        root: (m, p − 1, p − 1) lower triangular, of the covariance across, nuisances fitted.
        follow: (m, q, p − 1) changes of the best nuisances with places across.
    """

    axis: np.ndarray
    across: np.ndarray
    t: np.ndarray
    u: np.ndarray
    nu: np.ndarray
    objective: np.ndarray
    root: np.ndarray
    follow: np.ndarray

    @property
    def lowest(self) -> int:
        """The place of the lowest point."""
        return int(np.argmin(self.objective))


def valley(
    forward: Forward, hypothesis: Hypothesis, now: Normal, covariance: np.ndarray, columns: list[np.ndarray]
) -> Valley | None:
    """The valley through a point, one lane; None where that cannot be simulated, or has no slopes.

    Args:
        forward: the predictor.
        hypothesis: of two coordinates or more.
        now: the point.
        covariance: (p, p) of its coordinates; its longest axis, in standard errors, is followed.
        columns: of a point nearby (`Forward.columns`); slopes to the nuisances are held.
    """
    longest = principal_axes(covariance)[-1]
    length = float(np.linalg.norm(longest))
    walk = _walk(forward, hypothesis, longest / length, now, columns)
    start = walk.settled(walk.origin, now.nu[0])
    if start is None:
        return None

    def side(branch, sign):
        return replace(walk, forward=branch).side(start, sign * min(FIRST * length, LONGEST))

    before, behind = abreast.each(forward, side, (-1.0, 1.0), calls=abreast.VALLEY)
    points = [*reversed(before), start, *behind]
    stacked = (np.array([getattr(p, name) for p in points]) for name in _Point.__annotations__)
    return Valley(walk.axis, walk.across, *stacked)


def profiles(
    forward: Forward, hypothesis: Hypothesis, now: Normal, error: np.ndarray, columns: list[np.ndarray]
) -> list[tuple[np.ndarray, np.ndarray]]:
    """For each coordinate (m,) values, ascending, and (m,) χ² and penalty there, all else at its best; none
    where the point cannot be simulated, or has no slopes.

    Args:
        forward, hypothesis, now, columns: as of `valley`, one coordinate being enough.
        error: (p,) standard errors of the coordinates.
    """

    def follow(branch, k):
        walk = _walk(branch, hypothesis, np.eye(now.free)[k], now, columns)
        start = walk.settled(walk.origin, now.nu[0])
        if start is None:
            return np.empty(0), np.empty(0)
        before, behind = (walk.side(start, sign * min(FIRST * error[k], LONGEST)) for sign in (-1.0, 1.0))
        points = [*reversed(before), start, *behind]
        return np.array([p.u[k] for p in points]), np.array([p.objective for p in points])

    return list(abreast.each(forward, follow, range(now.free), calls=abreast.VALLEY))


def principal_axes(covariance: np.ndarray) -> np.ndarray:
    """(p, p) axes of errors, of coordinates each in its own error, the longest last; one in each row, a
    standard error long.
    """
    error = np.sqrt(np.maximum(np.diag(covariance), LEAST))
    size, axes = np.linalg.eigh(covariance / np.outer(error, error))
    return (error[:, None] * axes * np.sqrt(np.maximum(size, 1e-12))).T


def root_of(covariance: np.ndarray) -> np.ndarray:
    """(n, n) lower triangular, of a covariance; what rounding makes negative is next to nothing."""
    size, axes = np.linalg.eigh(covariance)
    return np.linalg.cholesky((axes * np.maximum(size, LEAST + 1e-12 * size.max(initial=0.0))) @ axes.T)


def _steps(free, columns):
    """(p,) steps of the coordinates, by their slopes."""
    length = np.sqrt(sum(np.square(c[0, 1 : 1 + free]).sum(axis=1) for c in columns))
    return np.clip(ACROSS / np.maximum(length, 1e-9), 1e-5, FARTHEST)


@dataclass(frozen=True)
class _Point:
    """One point of a valley; see `Valley`."""

    t: float
    u: np.ndarray
    nu: np.ndarray
    objective: float
    root: np.ndarray
    follow: np.ndarray


def _walk(forward, hypothesis, axis, now, columns):
    across = np.linalg.svd(axis[None])[2][1:].T
    # A fit at a bound may lie beyond it by what its coordinate was rounded.
    origin = hypothesis.inside(now.u[0])
    return _Walk(forward, hypothesis, axis, across, columns, origin, _steps(now.free, columns))


@dataclass(frozen=True)
class _Walk:
    """What does not change along a valley."""

    forward: Forward
    hypothesis: Hypothesis
    axis: np.ndarray
    across: np.ndarray
    columns: list[np.ndarray]
    origin: np.ndarray
    steps: np.ndarray

    def side(self, start: _Point, step: float) -> list[_Point]:
        """Points to one side of the start, in order from it."""
        points, shortest, cuts = [start], SHORTEST * abs(step), 0
        for _ in range(MOST):
            new = self._beyond(points, step)
            if new is None or not (new.t - points[-1].t) * step > 0.0:
                break
            rise = abs(new.objective - points[-1].objective)
            if rise > END and abs(step) > shortest and cuts < CUTS:
                step *= 0.25
                cuts += len(points) > 1
                continue
            points.append(new)
            if new.objective > min(p.objective for p in points) + END:
                break
            step *= 2.0 if rise < CALM else 0.5 if rise > STEEP else 1.0
            step = float(np.clip(step, -LONGEST, LONGEST))
        return points[1:]

    def _beyond(self, side, step):
        """The next point of a side, at a bound where the step would leave it; None where the last one lies
        there, or nothing can be simulated.
        """
        last = side[-1]
        u, nu = last.u + step * self.axis, last.nu
        if len(side) > 1:
            share = step / (last.t - side[-2].t)
            u, nu = last.u + share * (last.u - side[-2].u), last.nu + share * (last.nu - side[-2].nu)
        inside = self.hypothesis.inside(u)
        if np.any(out := u != inside):
            share = float(((inside - last.u)[out] / (u - last.u)[out]).min())
            if share < NO_STEP:
                return None
            u, nu = last.u + share * (u - last.u), last.nu + share * (nu - last.nu)
        return self.settled(u, nu)

    def settled(self, u: np.ndarray, nu: np.ndarray) -> _Point | None:
        """The best point at the same place along the axis."""
        best, base, move = None, None, None
        for _ in range(STEPS):
            # What its nuisances alone exclude is not simulated: its chain may be one without end.
            possible = best is None or float(nu @ nu) < best.objective
            normal = self._normal(u, nu) if possible else None
            if normal and (not normal.has_slopes[0] or not np.isfinite(normal.objective[0])):
                break
            if normal and (best is None or normal.objective[0] < best.objective):
                gradient, hessian = normal.total()
                turn = np.eye(len(u) + len(nu))[:, 1:]
                turn[: len(u), : len(u) - 1] = self.across
                matrix = turn.T @ hessian[0] @ turn
                inverse = np.linalg.pinv(matrix, hermitian=True)
                best = self._point(u, nu, float(normal.objective[0]), matrix, inverse)
                base, move = (u, nu), self._step(u, turn, turn.T @ gradient[0], matrix)
                if float(gradient[0] @ move) < SETTLED:
                    break
            else:
                move = BACK * move
            u = self.hypothesis.inside((base[0] + move[: len(u)])[None])[0]
            nu = base[1] + move[len(u) :]
        return best

    def _step(self, u, turn, slope, matrix):
        """(p + q,) the step of Gauss and Newton; coordinates that it pushes out of their bounds are held."""
        held = np.zeros(len(u), dtype=bool)
        while True:
            rows = turn[: len(u)][held]
            move = turn @ (np.linalg.pinv(matrix + HELD * rows.T @ rows, hermitian=True) @ slope)
            there = u + move[: len(u)]
            inside = self.hypothesis.inside(there)
            pushed = (there != inside) & (np.abs(inside - u) < AT_BOUND) & ~held
            if not pushed.any():
                return move
            held |= pushed

    def _point(self, u, nu, objective, matrix, inverse):
        p = self.across.shape[1]
        root = root_of(inverse[:p, :p])
        follow = -np.linalg.lstsq(matrix[p:, p:], matrix[p:, :p], rcond=1e-12)[0]
        return _Point(float((u - self.origin) @ self.axis), u, nu, objective, root, follow)

    def _normal(self, u, nu):
        """Normal equations with slopes by differences to both sides of every coordinate, within bounds."""
        p = len(u)
        steps = np.diag(self.steps)
        many = np.concatenate([u[None], *(self.hypothesis.inside(u + s) for s in (steps, -steps))])
        apart = np.diag(many[1 : 1 + p] - many[1 + p :])
        found = self.forward.sampled(self.hypothesis, many, np.repeat(nu[None], len(many), axis=0))
        parts = []
        for run, value in enumerate(found):
            part = self.columns[run].copy()
            part[0, 0] = value[0]
            part[0, 1 : 1 + p] = (value[1 : 1 + p] - value[1 + p :]) / apart[:, None]
            part[0, 1 : 1 + p, self.forward.counts(run)] = 0.0
            parts.append(part)
        return from_slopes(self.forward, p, u[None], nu[None], parts)
