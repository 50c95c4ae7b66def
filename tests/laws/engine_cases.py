"""Chains that the tests of the engine share, and an integration that shares nothing with it."""

import math

import numpy as np
from scipy.integrate import solve_ivp

from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain

DURATION = 0.6e-3


def coated(modulus=15e9, bead_mass=0.44e-3, **changes) -> Chain:
    """The coated beads of Daraio & Nesterenko (2006) with a flat striker and wall of the beads' material."""
    body = Elastic("coating", modulus, 0.388)
    numbers = {
        "beads": 21,
        "bodies": Body(body, bead_mass, 2.43e-3),
        "striker": body,
        "wall": body,
        "striker_radius": math.inf,
        "striker_mass": 0.47e-3,
        "speed": 0.44,
    }
    return Chain(**(numbers | changes))


def reference(chain: Chain, contacts, times, rtol=1e-12):
    """(times, contacts) dynamic forces in N of the first chain of a batch, by DOP853 of scipy."""
    _, dynamic, solution = _solved(chain, times, rtol)
    bodies = chain.beads + 1
    return np.array([dynamic(u) for u in solution.y[:bodies].T])[:, list(contacts)]


def motion_reference(chain: Chain, times, rtol=1e-12):
    """(times, bodies) velocities in m/s and accelerations in m/s², likewise."""
    motion, _, solution = _solved(chain, times, rtol)
    bodies = chain.beads + 1
    return solution.y[bodies:].T, np.array([motion(0.0, y)[bodies:] for y in solution.y.T])


def _solved(chain, times, rtol):
    """Equation of motion, forces as a function of displacements, and the solution."""
    bodies = chain.beads + 1
    mass, stiffness = chain.masses(bodies)[:, 0], chain.stiffnesses(bodies)[:, 0]
    load, gap = chain.static_forces(bodies)[:, 0], chain.gaps(bodies)[:, 0]
    rest = (load / stiffness) ** (2 / 3) - gap
    weight = np.zeros(bodies)
    weight[0] = mass[0] * chain.gravity[0]

    def dynamic(u):
        delta = np.maximum(u - np.append(u[1:], 0.0) + rest, 0.0)
        return stiffness * delta**1.5 - load

    def motion(t, y):
        u, v = y[:bodies], y[bodies:]
        force = dynamic(u)
        return np.concatenate((v, (weight + np.append(0.0, force[:-1]) - force) / mass))

    start = np.zeros(2 * bodies)
    start[bodies] = chain.speed[0]
    scale = np.repeat([1e-6, 1.0], bodies)
    solution = solve_ivp(motion, (0, times[-1]), start, "DOP853", times, rtol=rtol, atol=rtol * scale)
    assert solution.success
    return motion, dynamic, solution


def peak(time, force):
    """Largest force and its moment, by a quartic through nine samples around the largest one."""
    top = int(force.argmax())
    near = np.arange(-4, 5)
    fit = np.polynomial.Polynomial.fit(near, force[top - 4 : top + 5], 4)
    roots = fit.deriv().roots()
    moment = min(roots[np.abs(roots.imag) < 1e-9].real, key=abs)
    return fit(moment), (top + moment) * (time[1] - time[0])
