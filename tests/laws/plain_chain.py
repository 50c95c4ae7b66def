"""A chain of any bodies written out plainly, and its motion by scipy: shares no line with the engine."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain

G = 9.81
STEEL = ("steel", 193e9, 0.30)
POLYMER = ("polymer", 1.46e9, 0.46)
FOAM = ("bone foam", 16e6, 0.30)


@dataclass(frozen=True)
class Plain:
    """One body: mass in kg, radius in m (infinite for flat faces), name, modulus and Poisson's ratio."""

    mass: float
    radius: float
    material: tuple = STEEL


def ball(diameter, material=STEEL, density=8000.0):
    """A solid sphere of so many m."""
    return Plain(density * math.pi / 6.0 * diameter**3, diameter / 2.0, material)


def hertz(one, other):
    """K of F = K delta^{3/2} (Johnson, Contact Mechanics, 1985, Eqs. 4.3, 4.10 and 4.23)."""
    compliance = sum((1.0 - b.material[2] ** 2) / b.material[1] for b in (one, other))
    return 4.0 / 3.0 / compliance / math.sqrt(1.0 / one.radius + 1.0 / other.radius)


def reference(bodies, speed, times, gravity=0.0, push=0.0):
    """(times, contacts) forces in N less those at rest; `bodies` are striker, beads and wall."""
    count = len(bodies) - 1
    mass = np.array([b.mass for b in bodies[:-1]])
    k = np.array([hertz(a, b) for a, b in pairwise(bodies)])
    at_rest = np.concatenate([[0.0], push + np.cumsum(mass[1:]) * gravity])
    approach = (at_rest / k) ** (2 / 3)
    load = mass * gravity
    load[1] += push

    def forces(x):
        delta = approach + x - np.append(x[1:], 0.0)
        return k * np.where(delta > 0.0, delta, 0.0) ** 1.5

    def motion(_, y):
        f = forces(y[:count])
        return np.append(y[count:], (load + np.append(0.0, f[:-1]) - f) / mass)

    start = np.zeros(2 * count)
    start[count] = speed
    tolerance = np.repeat([1e-17, 1e-12], count)
    path = solve_ivp(motion, (0.0, times[-1]), start, "DOP853", times, rtol=1e-11, atol=tolerance)
    assert path.success
    return np.array([forces(x) - at_rest for x in path.y[:count].T])


def engine(bodies, speed, gravity=0.0, push=0.0, length=None) -> Chain:
    """The same chain for the engine; the beads' pattern is repeated to `length` beads."""
    striker, *beads, wall = bodies
    made = tuple(_body(b) for b in beads)
    return Chain(
        beads=length or len(beads),
        bodies=Bodies(made),
        striker=Elastic(*striker.material),
        wall=Elastic(*wall.material),
        striker_radius=striker.radius,
        striker_mass=striker.mass,
        speed=speed,
        gravity=gravity,
        static_force=push,
    )


def _body(bead):
    flat = math.isinf(bead.radius)
    return Body(Elastic(*bead.material), bead.mass, 9.5e-3 if flat else bead.radius, flat=flat)
