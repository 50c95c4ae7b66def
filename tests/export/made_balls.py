"""A steel ball on a steel wall, and simulators' contact equations written down from their documentation."""

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from sonicvacuum.effects import CATALOGUE
from sonicvacuum.export.bounce import bounces, subject
from sonicvacuum.export.session import by_hand

SPEEDS = np.array([0.1, 0.45, 2.0])
BALL = {"mass_g": 4.0, "diameter_mm": 10.0, "material": "stainless-steel", "wall": "alumina"}
MASS, RADIUS = 4e-3, 5e-3


def asked(effects=None, speeds=(0.1, 2.0)):
    """The ball with effects (effect → parameters)."""
    return by_hand(**BALL, speeds=speeds, effects=effects or {})


def bounced(id, **parameters):
    """Chain, restitution and contact time at `SPEEDS` of the ball with one effect, by the engine."""
    one = subject(asked().nominal, {id: parameters}, CATALOGUE)
    return one.chain, *bounces(one.chain, SPEEDS)


def rebound(force, speed, stiffness):
    """Restitution and duration of m a = −force(depth, rate), cut at zero, by a solver of its own.

    The first step is elastic and short: a dashpot's force may start with an infinite slope. Depths are scaled
    by the Hertz contact's, times by its duration.
    """
    depth = (1.25 * MASS * speed**2 / stiffness) ** 0.4
    time = depth / speed

    def motion(_, state):
        return state[1], -max(0.0, force(state[0] * depth, state[1] * speed)) * time / (MASS * speed)

    def out(_, state):
        return force(state[0] * depth, state[1] * speed) if state[0] > 0.0 else state[0]

    out.terminal, out.direction = True, -1.0
    first = 1e-7
    found = solve_ivp(motion, (first, 40.0), (first, 1.0), events=out, rtol=1e-9, atol=1e-11, method="DOP853")
    return -found.y[1, -1], (found.t[-1]) * time


# Each: written → force(depth, rate) in N, as documented. Where it stands is told by `read` of the simulator.
def lammps_coeff_restitution(w):
    log = math.log(w["e"])
    factor = -2.0 * math.sqrt(5.0 / 6.0) * log / math.sqrt(math.pi**2 + log**2)

    def force(depth, rate):
        spring = w["k_n"] * math.sqrt(RADIUS * max(depth, 0.0))  # k_nd: force over overlap
        return spring * depth + factor * math.sqrt(1.5 * spring * MASS) * rate

    return force


def lammps_viscoelastic(w):
    def force(depth, rate):
        contact = math.sqrt(RADIUS * max(depth, 0.0))
        return w["k_n"] * contact * depth + w["eta_n0"] * contact * MASS * rate

    return force


def lammps_velocity(w):
    return lambda depth, rate: w["k_n"] * math.sqrt(RADIUS * max(depth, 0.0)) * depth + w["eta_n0"] * rate


def liggghts_hertz(w):
    modulus = w["youngsModulus"] / (2.0 * (1.0 - w["poissonsRatio"] ** 2))
    log = math.log(w["coefficientRestitution"])
    beta = log / math.sqrt(log**2 + math.pi**2)

    def force(depth, rate):
        contact = math.sqrt(RADIUS * max(depth, 0.0))
        gamma = -2.0 * math.sqrt(5.0 / 6.0) * beta * math.sqrt(2.0 * modulus * contact * MASS)
        return 4.0 / 3.0 * modulus * contact * depth + gamma * rate

    return force


def liggghts_stiffness(w):
    def force(depth, rate):
        contact = math.sqrt(RADIUS * max(depth, 0.0))
        return w["kn"] * contact * depth + w["gamman"] * MASS * contact * rate

    return force


def _yade_stiffness(w):
    """4/3 E √R*, R* half the ball's at a wall whose radius is taken as the ball's."""
    modulus = w["young"] / (2.0 * (1.0 - w["poisson"] ** 2))
    return 4.0 / 3.0 * modulus * math.sqrt(RADIUS / 2.0)


def yade_betan(w):
    stiffness = _yade_stiffness(w)

    def force(depth, rate):
        tangent = 1.5 * stiffness * math.sqrt(max(depth, 0.0))
        return stiffness * max(depth, 0.0) ** 1.5 + 2.0 * w["betan"] * math.sqrt(MASS * tangent) * rate

    return force


def yade_falling(w):
    """A from en at vn by the approximant of Müller & Pöschel (2011), its root sought here anew."""
    stiffness = _yade_stiffness(w)
    above = (1.0, 1.07232, 0.574198, 0.141552)
    below = (1.0, 1.07232, 1.72765, 1.37842, 1.19449, 0.467273, 0.235585)

    def approximant(s):
        return sum(a * s**k for k, a in enumerate(above)) / sum(b * s**k for k, b in enumerate(below))

    star = brentq(lambda s: approximant(s) - w["en"], 0.0, 20.0, xtol=1e-13)
    time = 2.0 / 3.0 * star**2 * w["vn"] ** -0.2 * (stiffness / MASS) ** -0.4

    def force(depth, rate):
        tangent = 1.5 * stiffness * math.sqrt(max(depth, 0.0))
        return stiffness * max(depth, 0.0) ** 1.5 + time * tangent * rate

    return force


def mujoco(w):
    """Mass times what the constraint adds to a free ball: −d (b v + k r), r negative in contact."""
    impedance = width = w["solimp"]
    b, k = w["damping"] / width, w["stiffness"] * impedance / width**2
    return lambda depth, rate: MASS * impedance * (b * rate + k * depth)


def drake(w):
    k, d = w["point_contact_stiffness"], w["hunt_crossley_dissipation"]
    return lambda depth, rate: k * max(depth, 0.0) * max(0.0, 1.0 + d * rate)


def drake_hydroelastic(w):
    """Pressure E (1 − r/R) at a rigid plane, integrated over the disc that the ball covers."""
    modulus, d = w["hydroelastic_modulus"], w["hunt_crossley_dissipation"]

    def force(depth, rate):
        x = max(depth, 0.0)
        height = RADIUS - x
        area = (RADIUS**2 - height**2) / 2.0 - (RADIUS**3 - height**3) / (3.0 * RADIUS)
        return 2.0 * math.pi * modulus * area * max(0.0, 1.0 + d * rate)

    return force


DOCUMENTED = {
    ("lammps", "tsuji"): lammps_coeff_restitution,
    ("lammps", "kuwabara-kono"): lammps_viscoelastic,
    ("lammps", "linear-dashpot"): lammps_velocity,
    ("liggghts", "tsuji"): liggghts_hertz,
    ("liggghts", "kuwabara-kono"): liggghts_stiffness,
    ("yade", "tsuji"): yade_betan,
    ("yade", "kuwabara-kono"): yade_falling,
    ("mujoco", "tsuji"): mujoco,
    ("drake", "hunt-crossley"): drake,
}
