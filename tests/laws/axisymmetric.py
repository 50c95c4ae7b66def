"""Axisymmetric finite elements of a layer on its core: the layer's contact by a method of its own.

Nine-node elements on a rectangular grid, lengths in layer thicknesses, E1' = 1. The contact of radius a under
a profile is linear in the depth: F = depth S(a) − B(a), S of a flat punch and B of the bowl r²/2; the depth
that belongs to a makes F stationary in a (no pressure at the edge).
"""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

# Shape functions on −1, 0, 1 and points of Gauss's rule, in one direction.
_X, _W = np.polynomial.legendre.leggauss(3)
_N = np.stack([_X * (_X - 1) / 2, 1 - _X**2, _X * (_X + 1) / 2], axis=1)
_D = np.stack([_X - 0.5, -2 * _X, _X + 0.5], axis=1)


def graded(fine, start, end, growth=1.35):
    """Edges that follow `fine` and widen from `start` until `end`."""
    edges, step = list(fine), start
    while edges[-1] < end:
        edges.append(edges[-1] + step)
        step *= growth
    return np.array(edges)


def _stiffness(r0, dr, dz, modulus, poisson):
    """(18, 18) stiffness matrix of one element from r0 to r0 + dr, dz deep; both in the order (r, z)."""
    lame = modulus * poisson / (1 + poisson) / (1 - 2 * poisson)
    shear = modulus / 2 / (1 + poisson)
    law = lame * np.pad(np.ones((3, 3)), (0, 1)) + shear * np.diag([2, 2, 2, 1])
    total = np.zeros((18, 18))
    for p in range(3):
        for q in range(3):
            r = r0 + dr * (1 + _X[p]) / 2
            n = np.outer(_N[p], _N[q]).ravel()
            by_r, by_z = np.outer(_D[p], _N[q]).ravel() * 2 / dr, np.outer(_N[p], _D[q]).ravel() * 2 / dz
            strain = np.zeros((4, 18))  # rr, hoop, zz, rz
            strain[0, 0::2], strain[1, 0::2], strain[2, 1::2] = by_r, n / r, by_z
            strain[3, 0::2], strain[3, 1::2] = by_z, by_r
            total += _W[p] * _W[q] * dr * dz / 4 * 2 * np.pi * r * strain.T @ law @ strain
    return total


class Layered:
    """The surface's compliance to forces on its nodes up to the radius `reach`."""

    def __init__(self, r, z, reach, poisson, core, core_poisson):
        self.r = np.interp(np.arange(2 * len(r) - 1) / 2, np.arange(len(r)), r)
        rows, columns = len(self.r), 2 * len(z) - 1
        node = np.arange(rows * columns).reshape(rows, columns)
        entries = []
        for i in range(len(r) - 1):
            for k in range(len(z) - 1):
                in_layer = z[k + 1] < 1.0 + 1e-9
                nu = poisson if in_layer else core_poisson
                plane = 1.0 if in_layer else 1.0 / core
                block = _stiffness(r[i], r[i + 1] - r[i], z[k + 1] - z[k], plane * (1 - nu**2), nu)
                at = node[2 * i : 2 * i + 3, 2 * k : 2 * k + 3].ravel()
                dof = np.stack([2 * at, 2 * at + 1], axis=1).ravel()
                entries.append((np.repeat(dof, 18), np.tile(dof, 18), block.ravel()))
        i, j, v = (np.concatenate(part) for part in zip(*entries, strict=True))
        whole = coo_matrix((v, (i, j)), shape=(2 * node.size,) * 2).tocsc()
        # No sideways motion on the axis, none at all at the bottom.
        held = np.concatenate([2 * node[0], 2 * node[:, -1], 2 * node[:, -1] + 1])
        free = np.setdiff1d(np.arange(2 * node.size), held)
        surface = np.searchsorted(free, 2 * node[:, 0] + 1)[self.r < reach + 1e-9]
        loads = np.zeros((len(free), len(surface)))
        loads[surface, np.arange(len(surface))] = 1.0
        self.compliance = splu(whole[free][:, free]).solve(loads)[surface]

    def _forces(self, count):
        """Force on a flat punch and on the bowl r²/2 over the first `count` surface nodes."""
        shapes = np.stack([np.ones(count), self.r[:count] ** 2 / 2], axis=1)
        return np.linalg.solve(self.compliance[:count, :count], shapes).sum(axis=0)

    def contact(self, a):
        """Depth in a²/R and force in E1' a³/R of the contact of radius a, an edge of the grid."""
        (place,) = np.flatnonzero(np.isclose(self.r, a))
        before, here, after = (self._forces(place + 1 + k) for k in (-2, 0, 2))
        depth = (after[1] - before[1]) / (after[0] - before[0])
        return depth / a**2, (depth * here[0] - here[1]) / a**3
