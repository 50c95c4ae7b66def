"""Slopes over standard errors, for effects of several parameters.

Two parameters may nearly replace one another: strength and time of a contact that relaxes slowly. Data then
tell between them by a hair, and predictions jump by more than that, since a contact that opens for a moment
forgets. Differences of short steps take such jumps for slopes, and errors come out far too small. Here slopes
are lines through points up to a standard error to both sides, along the principal axes of the errors that the
fit tells itself; where errors come out other than these, or the data hold counts, the valley is followed
(`ridge`) and slopes are taken once more at its lowest point.
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.fit import ridge
from sonicvacuum.discover.fit.normal import Normal, from_slopes
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis

ROUNDS = 3
# Points along each axis, in standard errors, none further than this in a coordinate.
POINTS, FARTHEST = (-1.0, -0.5, 0.5, 1.0), 0.5
# Errors that differ by less than this factor are the same.
ALIKE = 1.5
# A coordinate with a larger error than this stands where data hardly change at all, near the limit of a law:
# what ends the valley lies elsewhere.
FLAT = 2.0


def asks(hypothesis: Hypothesis) -> bool:
    """Whether an effect has several parameters, of which one may replace the other."""
    return any(len(c.free) > 1 for c in hypothesis.components)


def broadened(
    forward: Forward,
    hypothesis: Hypothesis,
    now: Normal,
    wide: Normal | None,
    columns: list[np.ndarray],
    gross: bool = False,
) -> Normal:
    """A fit, one lane, with slopes over its own standard errors, at the lowest point of its valley; as it is
    where its errors stay what they were, and are no longer than errors can be.

    Args:
        forward: the predictor.
        hypothesis: with an effect of several parameters.
        now: the fit.
        wide: the same with slopes over its errors (`sloped`).
        columns: of a point nearby (`Forward.columns`), whose slopes to the nuisances are held.
        gross: whether so much is left that what the valley's floor gains is nothing beside that.
    """
    if wide is None or not wide.has_slopes[0]:
        return now
    if _alike(now, wide) and not _flat(wide) and not _counted(forward, len(columns)):
        return now
    here = wide if gross else _lowest(forward, hypothesis, wide, columns)
    for _ in range(ROUNDS):
        before, better = wide, sloped(forward, hypothesis, here, columns)
        if better is None or not better.has_slopes[0]:
            break
        wide = here = better
        if _alike(before, wide):
            break
    return wide


def _lowest(forward, hypothesis, wide, columns):
    """The lowest point of the valley; χ² and products of slopes are still those of where it was entered."""
    found = ridge.valley(forward, hypothesis, wide, covariance(wide), columns)
    if found is None or not found.objective[found.lowest] < wide.objective[0]:
        return wide
    at = slice(found.lowest, found.lowest + 1)
    return replace(wide, u=found.u[at], nu=found.nu[at])


def covariance(now: Normal) -> np.ndarray:
    """(p, p) covariance of the coordinates, nuisances fitted."""
    return np.linalg.pinv(now.total()[1][0], hermitian=True)[: now.free, : now.free]


def _alike(one, other):
    one, other = (np.maximum(np.diag(covariance(x)), ridge.LEAST) for x in (one, other))
    return np.abs(np.log(other / one)).max() < 2.0 * np.log(ALIKE)


def _counted(forward, runs):
    """Whether the data of so many runs hold counts: no slope leads to where one of them changes."""
    return any(len(forward.counts(run)) for run in range(runs))


def _flat(now):
    return np.diag(covariance(now)).max() > FLAT**2


def _axes(now):
    """(p, p) principal axes of the errors, one in each row, none longer than what is allowed."""
    rows = ridge.principal_axes(covariance(now))
    return rows * np.minimum(1.0, FARTHEST / np.abs(rows).max(axis=1))[:, None]


def _within(hypothesis, u, moves):
    """Points to either side; to the other one where a move leaves the bounds: clipped, it would leave the
    axis and climb out of the valley, which is no slope along it.
    """
    beyond = np.any(hypothesis.inside(u + moves) != u + moves, axis=1)
    return np.where(beyond[:, None], u - moves, u + moves)


def sloped(forward: Forward, hypothesis: Hypothesis, now: Normal, columns: list[np.ndarray]) -> Normal | None:
    """The normal equations with slopes over the axes; None where too few points can be simulated, or where no
    slopes tell the axes.
    """
    if not now.has_slopes[0]:
        return None
    axes = _axes(now)
    moves = np.concatenate([np.zeros((1, now.free)), *(x * axes for x in POINTS)])
    u = hypothesis.inside(_within(hypothesis, now.u, moves))
    u[0] = now.u[0]
    found = forward.sampled(hypothesis, u, np.repeat(now.nu, len(u), axis=0))
    sound = np.isfinite(sum(value.sum(axis=1) for value in found))
    # In units of the axes, so that the shortest counts like the longest.
    along = np.linalg.solve(axes.T, (u - now.u).T).T[sound]
    # With what bends along each axis, which is no slope where all points lie to one side of it.
    lines = np.column_stack([along, np.ones(len(along)), np.square(along)])
    if not sound[0] or np.linalg.matrix_rank(lines[:, : now.free + 1]) <= now.free:
        return None
    to_slopes = np.linalg.solve(axes, np.linalg.pinv(lines)[: now.free])
    own = [k for k, c in enumerate(hypothesis.coordinates) if not c.parameter.acts_like]
    parts = []
    for run, value in enumerate(found):
        part = columns[run].copy()
        slopes = to_slopes @ (value[sound] - value[0])
        slopes[:, forward.counts(run)] = 0.0
        part[0, 0], part[0, [1 + k for k in own]] = value[0], slopes[own]
        parts.append(part)
    return from_slopes(forward, now.free, now.u, now.nu, parts)
