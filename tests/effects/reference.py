"""The chain and every effect a second time: plain numpy and scipy, nothing of the package.

Written from the catalogue's formulas alone, one chain at a time, as first-order equations of all bodies with
the true forces (weights and preloads act as such, nothing is measured from rest), integrated by DOP853.
"""

import math
from dataclasses import dataclass, field
from functools import cache

import numpy as np
from scipy.integrate import DOP853, solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

G = 9.81


@dataclass
class Plain:
    """One chain in plain numbers, SI; what an effect may change."""

    beads: int = 6
    radius: float = 2.43e-3
    modulus: float = 2.76e9
    poisson: float = 0.388
    wall_modulus: float = 193e9
    wall_poisson: float = 0.30
    core_modulus: float = 193e9
    core_poisson: float = 0.30
    striker_modulus: float = 370e9
    striker_poisson: float = 0.22
    mass: float = 0.44e-3
    striker_mass: float = 0.47e-3
    speed: float = 0.44
    gravity: float = 0.0
    preload: float = 0.0
    mass_factor: dict = field(default_factory=dict)
    gap: dict = field(default_factory=dict)
    wall_factor: float = 1.0
    exponent: float = 1.5
    layer: float = math.inf
    residual: float = 0.0
    dashpot: float = 0.0
    dissipative_time: float = 0.0
    tsuji: float = 0.0
    hunt: float = 0.0
    gamma: float = 0.0
    alpha: float = 1.75
    strength: float = 0.0
    tau: float = 1.0
    drag: float = 0.0
    friction: float = 0.0
    lowpass: float = 0.0
    droop: float = math.inf
    gain: dict = field(default_factory=dict)
    offset: dict = field(default_factory=dict)

    def masses(self):
        """Masses of striker and beads."""
        beads = [self.mass * self.mass_factor.get(i, 1.0) for i in range(1, self.beads + 1)]
        return np.array([self.striker_mass, *beads])

    def radii(self):
        """Effective radius of each contact: flat striker, equal beads, flat wall."""
        return np.array([self.radius] + [self.radius / 2] * (self.beads - 1) + [self.radius])

    def constants(self):
        """Hertz constant of each contact."""
        soft = self.modulus / (1 - self.poisson**2)
        hard = self.striker_modulus / (1 - self.striker_poisson**2)
        wall = self.wall_modulus / (1 - self.wall_poisson**2)
        plane = [soft * hard / (soft + hard)] + [soft / 2] * (self.beads - 1) + [soft * wall / (soft + wall)]
        constants = 4 / 3 * np.array(plane) * np.sqrt(self.radii())
        constants[-1] *= self.wall_factor
        return constants


def layer_compliance(x, p: Plain):
    """Surface compliance of a bonded layer over that of a half-space of it (Burmister 1945)."""
    shear = p.modulus / (1 + p.poisson) / p.core_modulus * (1 + p.core_poisson)
    own, other = 3 - 4 * p.poisson, 3 - 4 * p.core_poisson
    a, b = (shear * other - own) / (1 + shear * other), (shear - 1) / (shear + own)
    e = np.exp(-2 * x)
    return (1 + 4 * b * x * e - a * b * e**2) / (1 - (a + b + 4 * b * x**2) * e + a * b * e**2)


@cache
def inverse_layer_factor(*materials):
    """Hertz force over force of a layer under a rigid body, a spline over ln chi, from the integral equation.

    Of materials modulus, poisson, core_modulus and core_poisson: see `sonicvacuum.physics.layered`.
    """
    p = Plain(
        modulus=materials[0], poisson=materials[1], core_modulus=materials[2], core_poisson=materials[3]
    )
    x, w = np.polynomial.legendre.leggauss(400)
    x, lack = 11 * (x + 1), 11 * w * (1 - layer_compliance(11 * (x + 1), p))
    s, w = np.polynomial.legendre.leggauss(90)
    s, w = (s + 1) / 2, w / 2
    chi, inverse = [], []
    for a in np.geomspace(0.002, 8, 90):
        waves = np.cos(a * np.outer(np.append(s, 1), x))
        kernel = a * (waves * lack) @ waves[:-1].T * w
        right = np.stack([np.ones_like(s), s**2], axis=1)
        flat, bowl = np.linalg.solve(np.pi / 2 * np.eye(len(s)) - kernel[:-1], right).T
        depth = (1 + kernel[-1] @ bowl) / (1 + kernel[-1] @ flat)
        chi.append(a * np.sqrt(depth))
        inverse.append(4 / 3 * depth**1.5 / np.pi / (w @ (depth * flat - bowl)))
    return CubicSpline(np.log(chi), inverse)


def layer_factor(p: Plain, delta):
    """Force over Hertz force; striker and wall in series with the layer at equal chi."""
    chi = np.sqrt(p.radii() * np.maximum(delta, 0)) / p.layer
    inverse = inverse_layer_factor(p.modulus, p.poisson, p.core_modulus, p.core_poisson)
    own = np.where(chi > 0.002, inverse(np.log(np.maximum(chi, 0.002))), 1.0)
    plane = [
        e / (1 - nu**2)
        for e, nu in ((p.striker_modulus, p.striker_poisson), (p.wall_modulus, p.wall_poisson))
    ]
    facing = np.zeros(p.beads + 1)
    facing[[0, -1]] = p.modulus / (1 - p.poisson**2) / np.array(plane)
    return (1 + facing) / (own + facing)


def loading(p: Plain, delta):
    """Elastic force of every contact while it is loaded."""
    d = np.maximum(delta, 0.0)
    force = p.constants() * (1e-6) ** 1.5 * (d / 1e-6) ** p.exponent
    return force if math.isinf(p.layer) else force * layer_factor(p, d)


def elastic(p: Plain, delta, deepest):
    """Elastic force with the unloading branch below the deepest compression so far."""
    force = loading(p, delta)
    if p.residual == 0.0:
        return force
    remains = p.residual * deepest
    width = np.where(deepest > 0.0, deepest - remains, 1.0)
    part = np.clip((delta - remains) / width, 0.0, 1.0)
    return np.where(delta < deepest, loading(p, deepest) * part**1.5, force)


def contact_forces(p: Plain, delta, rate, memory):
    """Total force of every contact, never pulling."""
    m, k, d = p.masses(), p.constants(), np.maximum(delta, 0.0)
    pair = m * np.append(m[1:], np.inf)
    reduced = np.append(pair[:-1] / (m[:-1] + m[1:]), m[-1])
    force = elastic(p, delta, memory)
    total = force * (1.0 + 1.5 * p.hunt * rate)
    total = total + p.dashpot * rate
    total = total + 1.5 * p.dissipative_time * k * np.sqrt(d) * rate
    total = total + p.tsuji * np.sqrt(reduced * k) * d**0.25 * rate
    total = total + p.gamma * np.sign(rate) * np.abs(rate) ** p.alpha
    if p.strength:
        total = total + memory
    return np.where(delta > 0.0, np.maximum(total, 0.0), 0.0)


def smooth_sign(velocity):
    """sgn(velocity), a cubic below 1 mm/s."""
    s = np.clip(velocity / 1e-3, -1.0, 1.0)
    return 1.5 * s - 0.5 * s**3


def rest(p: Plain):
    """Compression of every contact at rest."""
    load, borne = np.zeros(p.beads + 1), p.preload
    for c in range(1, p.beads + 1):
        borne += p.masses()[c] * p.gravity
        if c in p.gap:
            borne = 0.0
        load[c] = borne
    delta = np.zeros(p.beads + 1)
    for c in np.flatnonzero(load):
        excess = lambda x, c=c: loading(p, np.full(p.beads + 1, x))[c] - load[c]  # noqa: E731
        delta[c] = brentq(excess, 0.0, 1e-3, xtol=1e-20, rtol=1e-14)
    for contact, width in p.gap.items():
        delta[contact] = -width
    return delta


def solve(p: Plain, times):
    """(samples, contacts) forces beyond the static ones at the given times."""
    n, mass, start = p.beads + 1, p.masses(), rest(p)
    push = mass * p.gravity
    before = contact_forces(p, start, np.zeros(n), start if p.residual else np.zeros(n))
    # The holder keeps what rests on nothing: a constant push that balances every bead at rest.
    push[1:] = before[1:] - before[:-1]

    def kinematics(y):
        u, v = y[:n], y[n : 2 * n]
        return start + u - np.append(u[1:], 0.0), v - np.append(v[1:], 0.0), y[2 * n :]

    def motion(t, y, deepest=None):
        delta, rate, memory = kinematics(y)
        force = contact_forces(p, delta, rate, memory if deepest is None else np.maximum(deepest, delta))
        v = y[n : 2 * n]
        a = (np.append(0.0, force[:-1]) - force + push) / mass
        a[1:] -= p.drag * v[1:] + p.friction * smooth_sign(v[1:]) / mass[1:]
        return np.concatenate([v, a, growth(delta, rate, memory)])

    def growth(delta, rate, memory):
        if p.strength:
            slope = 1.5 * p.constants() * np.sqrt(np.maximum(delta, 0.0))
            # Out of contact the branch force is forgotten within a microsecond instead of at once.
            return np.where(delta > 0.0, -memory / p.tau + p.strength * slope * rate, -memory / 1e-6)
        return np.zeros(n)

    y0 = np.zeros(3 * n)
    y0[n] = p.speed
    given = {"rtol": 1e-9, "max_step": 2e-6}
    given["atol"] = np.concatenate([np.full(n, 1e-15), np.full(n, 1e-10), np.full(n, 1e-9)])
    if p.residual:
        states = _turning(motion, lambda y: kinematics(y)[:2], times, y0, start, given)
        return np.array([contact_forces(p, *kinematics(y)[:2], deepest) for y, deepest in states]) - before
    run = solve_ivp(motion, (0.0, times[-1]), y0, "DOP853", t_eval=times, **given)
    assert run.success, run.message
    return np.array([contact_forces(p, *kinematics(y)) for y in run.y.T]) - before


def _turning(motion, kinematics, times, y, deepest, given):
    """(state, deepest compressions so far) at every time, for contacts that remember how far they went.

    Where one turns that goes deeper than ever the integration ends, and begins anew from there: what it
    remembers has a corner, which a step across it would smear by as much as rounding happens to say.
    """
    found, t = [(y, deepest)], 0.0
    while t < times[-1]:
        solver = DOP853(lambda t, y, deepest=deepest: motion(t, y, deepest), t, y, times[-1], **given)
        turn = None
        while solver.status == "running" and turn is None:
            before = kinematics(solver.y)[1]
            solver.step()
            delta, after = kinematics(solver.y)
            inside = solver.dense_output()
            # Slower than this nothing turns but what is at rest.
            turned = np.flatnonzero((before > 1e-9) & (after < 0.0) & (delta > 0.99 * deepest))
            if len(turned):
                rates = [lambda t, c=c, at=inside: kinematics(at(t))[1][c] for c in turned]
                turn = min(brentq(rate, solver.t_old, solver.t, xtol=1e-18) for rate in rates)
            end = solver.t if turn is None else turn
            for now in times[len(found) :][times[len(found) :] <= end]:
                found.append((inside(now), np.maximum(deepest, kinematics(inside(now))[0])))
        assert solver.status != "failed"
        t, y = end, inside(end)
        deepest = np.maximum(deepest, kinematics(y)[0])
    return found


def read(p: Plain, times, forces, sensors):
    """(samples, sensors) readings; a sensor is (kind, bead). Filters by integration of their equations."""
    readings = []
    for index, (kind, bead) in enumerate(sensors):
        share = 0.5 + p.offset.get(index, 0.0)
        signal = (
            forces[:, -1] if kind == "wall" else share * forces[:, bead - 1] + (1 - share) * forces[:, bead]
        )
        signal = _leaked(_smoothed(signal, times, p.lowpass), times, p.droop)
        readings.append(p.gain.get(index, 1.0) * signal)
    return np.stack(readings, axis=1)


def _smoothed(x, times, tau):
    """tau y' + y = x by the trapezoidal rule."""
    if tau == 0.0:
        return x
    h, y = (times[1] - times[0]) / (2 * tau), np.zeros_like(x)
    for k in range(1, len(x)):
        y[k] = ((1 - h) * y[k - 1] + h * (x[k] + x[k - 1])) / (1 + h)
    return y


def _leaked(x, times, tau):
    """y' + y/tau = x' by the trapezoidal rule."""
    if math.isinf(tau):
        return x
    h, y = (times[1] - times[0]) / (2 * tau), np.zeros_like(x)
    for k in range(1, len(x)):
        y[k] = ((1 - h) * y[k - 1] + x[k] - x[k - 1]) / (1 + h)
    return y


EFFECTS = {
    "dynamic-modulus": lambda p, modulus_ratio: {"modulus": p.modulus * modulus_ratio},
    "contact-exponent": lambda p, exponent: {"exponent": exponent},
    "coating-thickness": lambda p, layer_thickness_um: {"layer": layer_thickness_um * 1e-6},
    "plastic-contact": lambda p, residual_fraction: {"residual": residual_fraction},
    "linear-dashpot": lambda p, damping_kg_s: {"dashpot": damping_kg_s},
    "kuwabara-kono": lambda p, time_us: {"dissipative_time": time_us * 1e-6},
    "tsuji": lambda p, alpha: {"tsuji": alpha},
    "hunt-crossley": lambda p, damping_s_per_m: {"hunt": damping_s_per_m},
    "velocity-power": lambda p, gamma, alpha=1.75: {"gamma": gamma, "alpha": alpha},
    "relaxing-contact": lambda p, strength, tau_us=30.0: {"strength": strength, "tau": tau_us * 1e-6},
    "viscous-drag": lambda p, rate_per_s: {"drag": rate_per_s},
    "guide-friction": lambda p, force_N: {"friction": force_N},
    "static-preload": lambda p, force_N: {"preload": p.preload + force_N},
    "gravity": lambda p, fraction: {"gravity": G * fraction},
    "contact-gap": lambda p, gap_um, contact: {"gap": {contact: gap_um * 1e-6}},
    "mass-defect": lambda p, mass_ratio, bead: {"mass_factor": {bead: mass_ratio}},
    "wall-compliance": lambda p, stiffness_ratio: {"wall_factor": stiffness_ratio},
    "striker-error": lambda p, speed_ratio=1.0, mass_ratio=1.0: {
        "speed": p.speed * speed_ratio,
        "striker_mass": p.striker_mass * mass_ratio,
    },
    "sensor-lowpass": lambda p, tau_us: {"lowpass": tau_us * 1e-6},
    "sensor-droop": lambda p, tau_us: {"droop": tau_us * 1e-6},
    "sensor-gain": lambda p, gain_ratio, sensor: {"gain": {sensor: gain_ratio}},
    "sensor-offset": lambda p, offset_fraction, sensor: {"offset": {sensor: offset_fraction}},
}
