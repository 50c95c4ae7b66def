"""Drake: Hunt–Crossley dissipation on a linear spring (point contact) or on a pressure field (hydroelastic).

The restitution of elastic force × (1 + d v) is the same for every elastic force (`physics.impact`): with d =
(3/2) c both contacts have that of the effect hunt-crossley at every speed. Stiffness and modulus are set so
that the contact lasts as long as the reference impact. The force of a fine hydroelastic ball on a rigid half-
space, π E x² for depths x small against the radius, is derived here from the documented pressure E times
extent, which falls linearly from centre to surface.
"""

import math

import numpy as np

from sonicvacuum.export.base import RESTITUTION, Ball, Law, Number, Simulator, Written, shown
from sonicvacuum.physics.impact import hunt_crossley_duration


def dissipation(parameters: dict[str, float]) -> float:
    """Drake's d in s/m: (3/2) of the effect's c."""
    return 1.5 * parameters["damping_s_per_m"]


def compliant(ball: Ball, parameters: dict[str, float]) -> Written:
    """Stiffness, dissipation and modulus of the ball against a wall that is rigid in comparison."""
    d = dissipation(parameters)
    number = d * ball.speed
    stiffness = ball.mass * (hunt_crossley_duration(number, 1.0) / ball.duration) ** 2
    length = ball.speed * ball.duration / hunt_crossley_duration(number, 2.0)
    modulus = ball.mass * ball.speed**2 / (math.pi * length**3)
    add = 'properties.AddProperty("material"'
    return Written(
        (
            Number("point_contact_stiffness", stiffness, "N/m"),
            Number("hunt_crossley_dissipation", d, "s/m"),
            Number("hydroelastic_modulus", modulus, "Pa"),
        ),
        (
            f'{add}, "point_contact_stiffness", {shown(stiffness)})',
            f'{add}, "hunt_crossley_dissipation", {shown(d)})',
            f"<drake:hydroelastic_modulus value='{shown(modulus)}'/>  <!-- instead of the stiffness -->",
        ),
        (
            "the wall: a stiffness a thousand times the ball's or more, so that k = k1 k2/(k1 + k2) "
            "and d = (k2 d1 + k1 d2)/(k1 + k2) are the ball's; hydroelastic: a rigid wall",
            "discrete_contact_approximation tamsi, similar or lagged; sap has another dissipation",
            "a discrete plant needs steps of a hundredth of the contact time or shorter",
        ),
    )


def duration(ball: Ball, parameters: dict[str, float], speeds: np.ndarray) -> np.ndarray:
    """(speeds,) of the point contact in s: √(m/k) times a function of d v."""
    d = dissipation(parameters)
    scale = ball.duration / hunt_crossley_duration(d * ball.speed, 1.0)
    return scale * np.array([hunt_crossley_duration(d * v, 1.0) for v in speeds])


SIMULATOR = Simulator(
    id="drake",
    title="Drake",
    reference="drake.mit.edu: Modeling Compliant Contact, with Modeling Dissipation and Hydroelastic Contact",
    read="RobotLocomotion/drake: multibody/plant/contact_model_doxygen.h (0465a03a), "
    "geometry/proximity/make_sphere_field.h",
    laws=(
        Law(
            "hunt-crossley",
            "compliant point contact, or hydroelastic contact",
            "f = k x (1 + d x')_+; hydroelastic: pressure E extent (1 + d x')_+",
            RESTITUTION,
            compliant,
            duration,
        ),
    ),
    lacks="a Hertz spring, and any dissipation but Hunt and Crossley's",
)
