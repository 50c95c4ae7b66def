"""Lanes that finite differences are taken from, a point and its neighbours in every unknown, and slopes."""

import numpy as np

from sonicvacuum.discover.model.hypothesis import Hypothesis

# A number that the readings do not show is predicted as 0, and of a ball whose contact does not open far from
# any datum (`scalars`): from one that they show it differs by more than this share of the larger.
NONE = 0.99


def displaced(hypothesis: Hypothesis, u, nu, steps, orders, nuisances, h: float):
    """Coordinates and nuisances of a set of lanes for each point, and the number of lanes in a set.

    In a set: the point itself; then, for each of the orders (multiples of the steps), every parameter
    displaced, and after them every group of nuisances.

    Args:
        hypothesis: whose coordinates these are; none is moved beyond its upper bound.
        u: (L, p) coordinates.
        nu: (L, q) nuisances.
        steps: (L, p) of the coordinates.
        orders: 1 for one-sided differences, 1 and 2 for those of second order.
        nuisances: groups of (place, standard error) that move together; an error of 0 means exact.
        h: relative step of these.
    """
    p = u.shape[1]
    each = p + len(nuisances)
    sets = 1 + len(orders) * each
    many_u, many_nu = np.repeat(u, sets, axis=0), np.repeat(nu, sets, axis=0)
    for o, order in enumerate(orders):
        first = 1 + o * each
        for k in range(p):
            step = order * steps[:, k]
            towards = np.where(u[:, k] + step > hypothesis.coordinates[k].high, -1.0, 1.0)
            many_u[first + k :: sets, k] += step * towards
        for k, group in enumerate(nuisances):
            for place, sigma in group:
                many_nu[first + p + k :: sets, place] += order * h / sigma if sigma else 0.0
    return many_u, many_nu, sets


def sizes(u, displaced_u, orders, each: int, h: float) -> np.ndarray:
    """(L, sets) by how much each lane departs from its point, to divide its change by; see `displaced`.

    Args:
        u: (L, p) coordinates of the points.
        displaced_u: (L sets, p) of all lanes.
        orders: as there.
        each: parameters and groups of nuisances.
        h: as there.
    """
    lanes, p = u.shape
    own = np.arange(p)
    many_u = displaced_u.reshape(lanes, 1 + len(orders) * each, p)
    size = np.full(many_u.shape[:2], h)
    for o, order in enumerate(orders):
        first = 1 + o * each
        size[:, first + p : first + each] *= order
        size[:, first + own] = (many_u[:, first + own] - u[:, None])[:, own, own]
    return size


def slopes(value: np.ndarray, size: np.ndarray, each: int, scalars: int) -> np.ndarray:
    """(L, each, M) slopes of a run's data, from those (L, sets, M) of lanes that depart by `size`; see
    `sizes`.

    None is taken from where there is a scalar, of which the last data are so many, to where there is none: it
    would say how near that cliff is, by which nothing is measured.
    """
    change, over = changes(value[:, :1], value[:, 1:], scalars)
    change /= size[:, 1:, None]
    if change.shape[1] == each:
        return change
    return second(change[:, :each], change[:, each:], over[:, :each], over[:, each:])


def changes(before: np.ndarray, after: np.ndarray, scalars: int) -> tuple[np.ndarray, np.ndarray]:
    """(…, M) changes of data, 0 of those of the last n, the scalars, that there are on one side alone; (…, n)
    which these are.
    """
    change, own = after - before, slice(after.shape[-1] - scalars, None)
    larger = np.maximum(np.abs(before[..., own]), np.abs(after[..., own]))
    over = np.abs(change[..., own]) > NONE * larger
    change[..., own] *= ~over
    return change, over


def second(once: np.ndarray, twice: np.ndarray, near: np.ndarray, far: np.ndarray) -> np.ndarray:
    """(…, M) slopes of second order from those over one step and over two, of which the last n lead over
    a cliff (…, n); of first order where only two steps do.
    """
    found = 2.0 * once - twice
    own = slice(found.shape[-1] - near.shape[-1], None)
    found[..., own] = np.where(near, 0.0, np.where(far, once[..., own], found[..., own]))
    return found
