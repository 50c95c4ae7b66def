"""A free-form contact law as a reader takes it: surface with its band, nearest names, short formula."""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.fit.evidence import Candidate
from sonicvacuum.discover.fit.reach import TOUCHING, approaches
from sonicvacuum.discover.fit.refit import Fit, predicted
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import is_law
from sonicvacuum.discover.search.free_law import FreeLaw
from sonicvacuum.discover.search.singles import setup_of
from sonicvacuum.effects.base import MICRO
from sonicvacuum.effects.free_form import COEFFICIENTS, free_force

# Knots of the surface along compression and along rate; odd, so that rest is among the latter.
DEPTHS, RATES = 21, 21
# Powers from which formulas start.
_POWERS = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0)
# Terms of formulas: elastic, stiffening with the rate, lossy.
_KINDS = (("e",), ("s",), ("l",), ("e", "l"), ("s", "l"))
# What one more parameter of a formula must gain in χ² per number on the surface.
_WORTH = 0.05


@dataclass(frozen=True)
class Surface:
    """Force of a contact between two beads over compression and rate.

    Attributes:
        depth: (D,) compressions in m.
        rate: (V,) rates of compression in m/s, positive while approaching.
        hertz: (D,) the nominal force in N.
        force: (D, V) the force found in N, cut at zero.
        beside: (D, V) what it has beside the nominal force, not cut.
        band: (D, V) its standard error.
        visited: (D, V) whether contacts were there.
    """

    depth: np.ndarray
    rate: np.ndarray
    hertz: np.ndarray
    force: np.ndarray
    beside: np.ndarray
    band: np.ndarray
    visited: np.ndarray


def surface(law: FreeLaw) -> Surface:
    """The law over what the recorded contacts went through."""
    stiffness = _stiffness(law.forward)
    depths, rates = _visited(law)
    grid = np.linspace(0.0, depths.max(), DEPTHS)
    rate = np.linspace(-1.0, 1.0, RATES) * np.abs(rates).max()
    basis = _basis(law, grid, rate, stiffness)
    beside = basis @ law.coefficients
    band = np.sqrt(np.einsum("dvi,ij,dvj->dv", basis, law.covariance, basis))
    hertz = stiffness * grid**1.5
    cells = np.histogram2d(depths, rates, bins=(_edges(grid), _edges(rate)))[0]
    force = np.maximum(hertz[:, None] + beside, 0.0)
    return Surface(grid, rate, hertz, force, beside, band, cells > 0)


def _edges(knots):
    middle = 0.5 * (knots[1:] + knots[:-1])
    return np.concatenate([[-np.inf], middle, [np.inf]])


def _stiffness(forward):
    """A contact between two beads of the first chain; ball and wall where there is no bead."""
    chain = forward.experiment.batches[0].chain
    return float(np.ravel(chain.stiffness if chain.beads else chain.striker_stiffness)[0])


def _visited(law: FreeLaw):
    """Compressions in m and rates in m/s, of all runs, of the first contacts of beads while they touch."""
    depths, rates = [], []
    for depth, rate in approaches(law.forward, law.fit):
        last = depth.shape[1] - 1
        shown = slice(min(1, max(last - 1, 0)), max(last, 1))
        depth, rate = depth[:, shown], rate[:, shown]
        touching = depth > TOUCHING * depth.max()
        depths.append(depth[touching])
        rates.append(rate[touching])
    return np.concatenate(depths), np.concatenate(rates)


def _basis(law: FreeLaw, depth, rate, stiffness):
    """(D, V, n) force of each free coefficient at 1."""
    elastic = stiffness * depth[:, None] ** 1.5
    scales = law.scales
    result = []
    own = 1.0 / scales.depth, 1.0 / scales.speed, scales.force
    for name in law.names:
        one = [float(name == other) for other in COEFFICIENTS]
        force = free_force(depth[:, None], rate[None], elastic, *own, *one)
        result.append(np.broadcast_to(force, (len(depth), len(rate))))
    return np.stack(result, axis=-1)


def nearest(law: FreeLaw, null: Fit, plain: Forward, found: list[Candidate]) -> list[tuple[str, float]]:
    """Contact laws of the catalogue by how far their best fit is from the free-form law, nearest first.

    The distance is that of the changes which both make in all data, over that of the free-form law: 0 is the
    same law, 1 no better than the nominal one.
    """
    base = predicted(plain, null)
    own = predicted(law.forward, law.fit) - base
    setup = setup_of(plain)
    distances = {}
    for c in found:
        if is_law(plain.experiment.catalogue.effect(c.effect), setup):
            change = predicted(plain, c.fit) - base
            distances[c.effect] = float(np.linalg.norm(change - own) / np.linalg.norm(own))
    return sorted(distances.items(), key=lambda d: d[1])


def formula(seen: Surface) -> str:
    """The shortest of a few formulas that says what the surface has beside the nominal force.

    Tried are c x^p, c x^p |v|^q and c x^p |v|^q sgn v with x = δ/µm and v in m/s: an elastic one, one that
    stiffens with the rate and a lossy one, alone or a lossy one beside one of the others; one more parameter
    must gain `_WORTH` per number.
    """
    x = np.repeat(seen.depth[:, None] / MICRO, len(seen.rate), axis=1)
    v = np.repeat(seen.rate[None], len(seen.depth), axis=0)
    where = seen.visited & (x > 0.0)
    error = np.hypot(seen.band, 0.01 * np.abs(seen.beside).max())[where]
    data = (x[where], v[where], seen.beside[where], error)
    found = [one for kinds in _KINDS if (one := _short(kinds, *data))]
    return min(found)[1] if found else ""


def _short(kinds, x, v, beside, error):
    """(score, text) of the best formula with terms of some kinds."""
    from scipy.optimize import least_squares

    def value(p):
        return sum(_term(kind, p[3 * k : 3 * k + 3], x, v) for k, kind in enumerate(kinds))

    best = None
    for power in _POWERS:
        start = np.concatenate([[0.1, power, 0.0 if kind == "e" else 1.0] for kind in kinds])
        start = start * np.where(np.arange(len(start)) % 3 == 0, np.abs(beside).max() / 0.1, 1.0)
        free = np.ones(len(start), dtype=bool)
        free[2::3] = [kind != "e" for kind in kinds]

        def left(p, start=start, free=free):
            whole = start.copy()
            whole[free] = p
            return (value(whole) - beside) / error

        low = np.where(np.arange(len(start)) % 3 == 0, -np.inf, 0.0)[free]
        high = np.where(np.arange(len(start)) % 3 == 0, np.inf, 6.0)[free]
        one = least_squares(left, start[free], bounds=(low, high), x_scale="jac")
        score = 2.0 * one.cost / len(x) + _WORTH * free.sum()
        if best is None or score < best[0]:
            whole = start.copy()
            whole[free] = one.x
            best = score, whole
    text = "F = K δ^1.5" + "".join(_text(kind, best[1][3 * k : 3 * k + 3]) for k, kind in enumerate(kinds))
    return float(best[0]), text


def _term(kind, p, x, v):
    size = p[0] * x ** p[1] * np.abs(v) ** (0.0 if kind == "e" else p[2])
    return size * np.sign(v) if kind == "l" else size


def _text(kind, p):
    sign = "−" if p[0] < 0.0 else "+"
    what = f" {sign} {abs(p[0]):.3g} N (δ/µm)^{p[1]:.2g}"
    rate = "" if kind == "e" else f" |v/(m/s)|^{p[2]:.2g}"
    return what + rate + (" sgn v" if kind == "l" else "")
