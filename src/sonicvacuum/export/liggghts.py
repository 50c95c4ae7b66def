"""LIGGGHTS: `model hertz` by a restitution, `model hertz/stiffness` by constants.

At a wall the effective radius is the ball's and the effective mass its mass. Ball and wall are written as one
material whose modulus gives the contact's K.
"""

from sonicvacuum.export.base import MOTION, Ball, Law, Number, Simulator, Written, shown
from sonicvacuum.physics.impact import tsuji_ratio, uncut_restitution

# Refused by LIGGGHTS in SI units below these (src/global_properties.cpp).
LEAST_MODULUS, LEAST_RESTITUTION = 5e6, 0.05


def _global(name, value, pairs=False):
    kind = "peratomtypepair 1" if pairs else "peratomtype"
    return f"fix {name} all property/global {name} {kind} {shown(value)}"


def _model(model):
    return (
        f"pair_style gran model {model} limitForce on",
        "pair_coeff * *",
        f"fix wall all wall/gran model {model} limitForce on primitive type 1 zplane 0.0",
    )


def hertz(ball: Ball, parameters: dict[str, float]) -> Written:
    """`model hertz`: the coefficientRestitution that has the effect's α; ValueError for what is refused."""
    e = uncut_restitution(tsuji_ratio(parameters["alpha"]))
    if not e > LEAST_RESTITUTION:
        raise ValueError(f"coefficientRestitution is {e:.3g}; LIGGGHTS wants more than {LEAST_RESTITUTION:g}")
    if ball.modulus < LEAST_MODULUS:
        raise ValueError(f"youngsModulus is {ball.modulus:.3g} Pa; LIGGGHTS wants {LEAST_MODULUS:g} or more")
    note = "coefficientRestitution is that of a contact that may pull; with limitForce on the ball keeps more"
    return Written(
        (
            Number("youngsModulus", ball.modulus, "Pa"),
            Number("poissonsRatio", ball.poisson, "1"),
            Number("coefficientRestitution", e, "1"),
        ),
        (
            _global("youngsModulus", ball.modulus),
            _global("poissonsRatio", ball.poisson),
            _global("coefficientRestitution", e, pairs=True),
            *_model("hertz"),
        ),
        (
            note,
            "youngsModulus is what ball and wall, taken as one material, need for the contact's stiffness",
        ),
    )


def stiffness(ball: Ball, parameters: dict[str, float]) -> Written:
    """`model hertz/stiffness`: γ = gamman M* √(R* δ), hence gamman = (3/2) A K/(√R m)."""
    kn = ball.stiffness / ball.radius**0.5
    gamma = 1.5e-6 * parameters["time_us"] * kn / ball.mass
    given = {"kn": kn, "kt": 0.0, "gamman": gamma, "gammat": 0.0}
    return Written(
        (Number("kn", kn, "Pa"), Number("gamman", gamma, "1/(m s)")),
        (*(_global(name, value, pairs=True) for name, value in given.items()), *_model("hertz/stiffness")),
        ("gamman is multiplied by the effective mass: for other masses work it out anew",),
    )


SIMULATOR = Simulator(
    id="liggghts",
    title="LIGGGHTS",
    reference="LIGGGHTS(R)-PUBLIC documentation: gran model hertz, gran model hertz/stiffness",
    read="CFDEMproject/LIGGGHTS-PUBLIC: doc/gran_model_hertz.txt, src/normal_model_hertz.h, "
    "src/global_properties.cpp (25fc3965), doc/gran_model_hertz_stiffness.txt (3ccbfc7e); the formulas of "
    "model hertz are pictures in the documentation and were read in the source",
    laws=(
        Law(
            "tsuji",
            "model hertz, limitForce on",
            "F = (4/3) Y* (R* delta)^{1/2} delta - 2 (5/6)^{1/2} beta (S_n m*)^{1/2} v, "
            "S_n = 2 Y* (R* delta)^{1/2}, beta = ln e/(ln^2 e + pi^2)^{1/2}, cut at zero",
            MOTION,
            hertz,
        ),
        Law(
            "kuwabara-kono",
            "model hertz/stiffness, limitForce on",
            "F = kn (R* delta)^{1/2} delta + gamman m* (R* delta)^{1/2} v, cut at zero",
            MOTION,
            stiffness,
        ),
    ),
    lacks="a dashpot on a Hertz spring, damping in proportion to the elastic force, a power of velocity, "
    "relaxation",
)
