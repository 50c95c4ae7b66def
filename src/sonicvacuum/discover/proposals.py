"""Where draws of the posterior are proposed: even points, Student's t, valleys that bend."""

import numpy as np

from sonicvacuum.discover.fit.ridge import Valley, root_of
from sonicvacuum.special import functions

# Degrees of freedom of Student's t: its tails are heavier than those of any likelihood that ends.
FREEDOM = 5.0
# Places along a valley for which its density is worked out, and the power to which that is raised: flatter.
GRID, FLATTER = 512, 0.8
# Beside a valley it is Gaussian for so many of its widths.
FAR = 4.0


def even(count: int, dimensions: int, seed: int) -> np.ndarray:
    """(count, dimensions) points in the unit cube.

    Of a Kronecker sequence (multiples of powers of 1 / φ_d, φ_d^{d+1} = φ_d + 1, shifted at random), which
    fills space more evenly than independent draws do.
    """
    shift = np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed))).random(dimensions)
    phi = np.real(np.roots([1.0, *np.zeros(dimensions - 1), -1.0, -1.0])).max()
    steps = phi ** -np.arange(1.0, dimensions + 1.0)
    return np.modf(shift + np.arange(1, count + 1)[:, None] * steps)[0]


def students(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, d) draws of Student's t from (n, d + 1) points of the unit cube, and (n,) logarithms of their
    density, up to a constant.
    """
    d = points.shape[1] - 1
    wide = np.sqrt(FREEDOM / functions().chdtri(FREEDOM, points[:, d]))[:, None]
    scaled = wide * functions().ndtri(points[:, :d])
    return scaled, -0.5 * (FREEDOM + d) * np.log1p(np.square(scaled).sum(axis=1) / FREEDOM)


def student(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, 1) draws of one dimension from (n, 1) points between 0 and 1, and (n,) logarithms of their density,
    up to a constant: quantiles, which lie more evenly than draws by way of a second number do.
    """
    scaled = functions().stdtrit(FREEDOM, points)
    return scaled, -0.5 * (FREEDOM + 1.0) * np.log1p(np.square(scaled[:, 0]) / FREEDOM)


def along(
    valley: Valley, covariance: np.ndarray, count: int, seed: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(n, p) coordinates along a valley, (n, q) nuisances as they follow, and (n,) logarithms of the density
    of the coordinates, up to a constant.

    The place along it by the misfit there and the width across, a little flatter; across by Student's t, as
    wide at least as a `covariance` (p, p) of the coordinates is beside the valley.
    """
    points = even(count, len(valley.axis) + 1, seed)
    root, width = _widest(valley, covariance)
    grid = np.linspace(valley.t[0], valley.t[-1], GRID)
    lowest = valley.objective.min()
    density = FLATTER * np.interp(grid, valley.t, width - 0.5 * (valley.objective - lowest))
    density = np.exp(density - density.max())
    grown = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    t = np.interp(points[:, 0] * grown[-1], grown, grid)
    scaled, log_across = students(points[:, 1:])
    root = _between(valley.t, t, root)
    beside = np.einsum("nij,nj->ni", root, scaled)
    follow = _between(valley.t, t, valley.follow)
    u = _between(valley.t, t, valley.u) + beside @ valley.across.T
    nu = _between(valley.t, t, valley.nu) + np.einsum("nij,nj->ni", follow, beside)
    return u, nu, np.log(np.interp(t, grid, density)) + log_across - _log_size(root)


def marginal(valley: Valley, covariance: np.ndarray, k: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """(count,) evenly spaced values of a coordinate along a valley, and (count,) what its points weigh there:
    by the misfit and the width across, which is that of `along`, in which they are Gaussian.
    """
    root, width = _widest(valley, covariance)
    grid = np.linspace(valley.t[0], valley.t[-1], GRID)
    log = np.interp(grid, valley.t, width - 0.5 * (valley.objective - valley.objective.min()))
    middle = np.interp(grid, valley.t, valley.u[:, k])
    wide = np.interp(grid, valley.t, np.linalg.norm(valley.across[k] @ root, axis=1))
    values = np.linspace((middle - FAR * wide).min(), (middle + FAR * wide).max(), count)
    # What is narrower than the distance of the values falls to the nearest ones.
    wide = np.maximum(wide, 0.5 * (values[1] - values[0]))
    share = np.exp(log - log.max()) / wide
    return values, np.exp(-0.5 * np.square((values[:, None] - middle) / wide)) @ share


def _widest(valley, covariance):
    """Roots of the covariance across, of each point, its neighbours and what is given the widest, and
    logarithms of their sizes: where predictions jump, one alone may be far too narrow.
    """
    beside = valley.across.T @ covariance
    along = beside @ valley.axis
    given = root_of(
        beside @ valley.across - np.outer(along, along) / (valley.axis @ covariance @ valley.axis)
    )
    size = _log_size(valley.root)
    near = np.clip(np.arange(len(size))[:, None] + [-1, 0, 1], 0, len(size) - 1)
    widest = near[np.arange(len(size)), np.argmax(size[near], axis=1)]
    wider = size[widest] < _log_size(given)
    root = np.where(wider[:, None, None], given, valley.root[widest])
    return root, np.where(wider, _log_size(given), size[widest])


def _log_size(root):
    return np.log(np.abs(np.linalg.det(root)))


def _between(places, t, values):
    """Values at places (m,), straight between them, at (n,) others."""
    before = np.clip(np.searchsorted(places, t) - 1, 0, len(places) - 2)
    share = (t - places[before]) / (places[before + 1] - places[before])
    share = share.reshape(-1, *[1] * (values.ndim - 1))
    return (1.0 - share) * values[before] + share * values[before + 1]
