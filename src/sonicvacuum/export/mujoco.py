"""MuJoCo: a spring and a dashpot per unit mass; restitution and contact time do not depend on speed.

With a constant impedance d the documented motion under the constraint, a + d (b v + k r) = (1 − d) a_u with b
= damping/d_width and k = stiffness d/d_width², is a + damping v + stiffness r = (1 − d) a_u: the two numbers
of `solref` are the oscillator's own, whatever the mass. The force does not pull. A law of constant
restitution is thus met at every speed, and its contact time at the reference speed.
"""

import numpy as np

from sonicvacuum.export.base import RESTITUTION, Ball, Law, Number, Simulator, Written, shown
from sonicvacuum.physics.impact import oscillator_duration, tsuji_ratio

# Largest impedance that MuJoCo allows (mjMAXIMP): nearly all of gravity is then borne by the constraint.
IMPEDANCE = 0.9999
# Steps in one contact from which on MuJoCo's own integrators change the restitution by little.
STEPS = 100


def spring(ball: Ball, parameters: dict[str, float]) -> Written:
    """`solref` in the direct format that has the law's restitution and the reference impact's duration."""
    ratio = tsuji_ratio(parameters["alpha"])
    frequency = oscillator_duration(ratio) / ball.duration
    stiffness, damping = frequency**2, 2.0 * ratio * frequency
    solref = f"{shown(-stiffness)} {shown(-damping)}"
    pair = f'<pair geom1="ball" geom2="wall" condim="1" solref="{solref}"'
    return Written(
        (
            Number("stiffness", stiffness, "1/s^2"),
            Number("damping", damping, "1/s"),
            Number("solimp", IMPEDANCE, "1"),
            Number("timestep", ball.duration / STEPS, "s"),
        ),
        (
            f'<option timestep="{shown(ball.duration / STEPS)}" integrator="RK4"/>',
            f'<contact>{pair} solimp="{IMPEDANCE} {IMPEDANCE} 0.001 0.5 1"/></contact>',
        ),
        (
            "solref is (-stiffness, -damping); both are per unit mass, so that they hold for any mass",
            "for a step s times longer divide stiffness by s^2 and damping by s: the restitution stays, the "
            "contact lasts s times longer",
        ),
    )


def duration(ball: Ball, parameters: dict[str, float], speeds: np.ndarray) -> np.ndarray:
    """(speeds,) the reference impact's duration in s, at every speed."""
    return np.full(len(speeds), ball.duration)


SIMULATOR = Simulator(
    id="mujoco",
    title="MuJoCo",
    reference="mujoco.readthedocs.io: Modeling, Solver parameters; Computation, Constraint model",
    read="google-deepmind/mujoco: doc/modeling.rst, doc/computation/index.rst (01085bd2)",
    laws=(
        Law(
            "tsuji",
            "contact with solref in the direct format",
            "a + d (b v + k r) = (1 - d) a_u, b = damping/d_width, k = stiffness d/d_width^2, d = d_width "
            "constant, force not below zero",
            RESTITUTION,
            spring,
            duration,
        ),
    ),
    lacks="a Hertz spring, and any restitution that depends on speed",
)
