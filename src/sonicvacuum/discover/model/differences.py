"""Lanes that finite differences are taken from: a point, and its neighbours in every unknown."""

import numpy as np

from sonicvacuum.discover.model.hypothesis import Hypothesis


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
