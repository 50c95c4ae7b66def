"""The exact contact on a layer as a formula for the kernel: Hertz force times a rational function of chi.

With chi = √(R* delta)/t and u = 1/(1 + chi/SCALE), Hertz force over force on a rigid body is written as

    1/g = c + a1 u + a2 u² + … ,   c = E1'/E0',   c + a1 + a2 + … = 1,

which is Hertz of the coating for narrow contacts and Hertz of the core for wide ones, exactly. The
coefficients are least squares of the exact solution (`layered`), relative to 1/g, up to a contact radius of
WIDEST thicknesses. They are linear in 1/g, so that interpolating them interpolates 1/g: they are worked out
at fixed ratios c, STEP apart in ln c, once for each pair of Poisson's ratios (some 20 ms each, as needed, and
then kept beside compiled code), and interpolated by fifth powers between.

A facing body of its own elasticity is put in series at equal chi, 1/g becoming (1/g + e)/(1 + e) with e =
E1'/E' of that body: exact where one of the two rules.

Errors of the force at given compression against the exact solution, contact radii up to 10 thicknesses: 3e-4
for Poisson's ratios below 0.4, 6e-4 up to 1/2; wider ones are led smoothly to the limit. The series for the
facing body is stiffer than exact by up to 1 % (the paper's coating on steel), 2.4 % (on any body), 9 % at a
Poisson's ratio of 1/2.
"""

from functools import lru_cache

import numpy as np

from sonicvacuum.blas import one_thread
from sonicvacuum.physics.layered import Layer, solve

# The term of the force law that it is.
NAME = "bonded-layer"
SCALE, POWERS = 0.8, 12
# Contact radii in thicknesses of the least squares; those beyond WIDEST only guide the way to the limit.
RADII, WIDEST, GUIDING = np.geomspace(0.01, 30.0, 44), 12.0, 0.1
# Fewer points than the reference solution takes: good to 1e-6.
COARSE = 0.6
# Ratios c in the range of which the law is meant, 1e-4 standing for a rigid core; and the grid between.
RIGID, SOFTEST = 1e-4, 10.0
STEP = 0.5
NEIGHBOURS = np.arange(-2, 4)


def factor(chi, deep, a):
    """Force over Hertz force at chi (any shape); `deep` the limit of 1/g for wide contacts, `a` (POWERS,)."""
    u = 1.0 / (1.0 + np.asarray(chi, dtype=float) / SCALE)
    return 1.0 / (deep + u * np.polynomial.polynomial.polyval(u, a))


def coefficients(poisson: float, core, core_poisson: float) -> tuple[np.ndarray, np.ndarray]:
    """Limit (n,) and coefficients (n, POWERS) of 1/g for n layers under rigid bodies.

    Args:
        poisson, core_poisson: Poisson's ratios of layer and core.
        core: (n,) E1'/E0', taken into the range from RIGID to SOFTEST.
    """
    core = np.clip(np.asarray(core, dtype=float), RIGID, SOFTEST)
    some, where = np.unique(core, return_inverse=True)
    place = np.log(some) / STEP
    nodes = np.floor(place).astype(int)[:, None] + NEIGHBOURS
    nearby = np.array([[_at_node(poisson, k, core_poisson) for k in row] for row in nodes.tolist()])
    a = np.einsum("ni,nik->nk", _lagrange(place - np.floor(place)), nearby)
    # What interpolation leaves of the sum goes to the highest power, so that narrow contacts are Hertz.
    a[:, -1] += 1.0 - some - a.sum(axis=1)
    return core, a[where]


# The same to the last bit whoever needs it first: what is kept is read by all.
@one_thread
def fitted(layer: Layer, refine: float = COARSE) -> np.ndarray:
    """(POWERS,) coefficients of one layer under a rigid body, from its exact solution."""
    exact = solve(layer, RADII, refine)
    inverse, c = 1.0 / exact.factor, layer.deep
    powers = (1.0 / (1.0 + exact.width / SCALE))[:, None] ** np.arange(1, POWERS + 1)
    weight = np.where(RADII <= WIDEST, 1.0, GUIDING) / inverse
    # The last coefficient follows from the sum.
    free, last = powers[:, :-1] - powers[:, -1:], powers[:, -1]
    wanted = inverse - c - (1.0 - c) * last
    found = np.linalg.lstsq(free * weight[:, None], wanted * weight, rcond=1e-13)[0]
    return np.append(found, 1.0 - c - found.sum())


@lru_cache(maxsize=4096)
def _at_node(poisson, node, core_poisson):
    from sonicvacuum.physics.compiled import kept  # and with it LLVM: not for a chain without a layer

    def made():
        return fitted(Layer(poisson, float(np.exp(STEP * node)), core_poisson)).tobytes()

    return np.frombuffer(kept(f"layer {poisson!r} {node} {core_poisson!r}", made))


def _lagrange(x):
    """(n, 6) Lagrange polynomials of the NEIGHBOURS at x (n,), between 0 and 1."""
    away = x[:, None] - NEIGHBOURS
    gaps = NEIGHBOURS[:, None] - NEIGHBOURS
    own = np.eye(len(NEIGHBOURS), dtype=bool)
    return np.prod(np.where(own, 1.0, away[:, None, :]) / np.where(own, 1.0, gaps), axis=2)
